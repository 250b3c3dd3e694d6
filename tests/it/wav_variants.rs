//! Every way in which programs write WAV that we know of: `fixtures/wav-variants` and its table.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::Output;

use bounce_audio::audio;
use serde_json::Value;

/// What the samples of a file are: `full_scale·sin(0.05·i)` cut to whole steps where it is integers.
#[derive(Debug, Clone, Copy)]
enum Wanted {
    /// Amplitude in steps, and steps in full scale; 0 of them for floats.
    Sine(f64, f64),
    /// Companded: the codes are of no sine. The first, the last and the sum of the samples of 16 bits, by another
    /// program (Python's audioop).
    Codes(i32, i32, i64),
    /// An error that says so.
    Refused(&'static str),
}

use Wanted::{Codes, Refused, Sine};

use crate::common::piped;

const BITS_8: Wanted = Sine(100.0, 128.0);
const BITS_16: Wanted = Sine(20_000.0, 32_768.0);
const BITS_24: Wanted = Sine(5_000_000.0, 8_388_608.0);
const BITS_32: Wanted = Sine(1e9, 2_147_483_648.0);
const FLOAT: Wanted = Sine(0.5, 1.0);
const NO_LENGTH: &str = "no length";
const ENDS_EARLY: &str = "before its header says";

/// File, its samples, how many frames, its encoding, and what each of its warnings says.
type Row = (
    &'static str,
    Wanted,
    usize,
    &'static str,
    &'static [&'static str],
);

const TABLE: [Row; 47] = [
    ("01_pcm16", BITS_16, 4800, "16-bit integer", &[]),
    ("02_pcm24_16bytefmt", BITS_24, 4800, "24-bit integer", &[]),
    ("03_pcm32_fmt16", BITS_32, 4800, "32-bit integer", &[]),
    ("04_pcm32_fmt18", BITS_32, 4800, "32-bit integer", &[]),
    ("05_f32_fmt16", FLOAT, 4800, "32-bit float", &[]),
    ("06_f32_fmt18_fact", FLOAT, 4800, "32-bit float", &[]),
    ("07_f64", FLOAT, 4800, "64-bit float", &[]),
    ("08_u8", BITS_8, 4800, "8-bit integer", &[]),
    ("09_ext_pcm24", BITS_24, 4800, "24-bit integer", &[]),
    ("10_ext_f32", FLOAT, 4800, "32-bit float", &[]),
    ("11_ext_f64", FLOAT, 4800, "64-bit float", &[]),
    ("12_odd_LIST_before", BITS_16, 4800, "16-bit integer", &[]),
    ("13_odd_LIST_unpadded", BITS_16, 4800, "16-bit integer", &[]),
    ("14_bext602_JUNK", BITS_16, 4800, "16-bit integer", &[]),
    (
        "15_data_size0",
        BITS_16,
        4800,
        "16-bit integer",
        &[NO_LENGTH],
    ),
    (
        "16_data_sizeFFFFFFFF",
        BITS_16,
        4800,
        "16-bit integer",
        &[NO_LENGTH],
    ),
    (
        "17_data_size7FFFFFFF_ish",
        BITS_16,
        4800,
        "16-bit integer",
        &[ENDS_EARLY],
    ),
    (
        "18_truncated_half",
        BITS_16,
        2400,
        "16-bit integer",
        &[ENDS_EARLY],
    ),
    (
        "19_trunc_odd_bytes",
        BITS_16,
        2400,
        "16-bit integer",
        &["last whole frame"],
    ),
    ("20_RF64", BITS_16, 4800, "16-bit integer", &[]),
    ("21_BW64", BITS_16, 4800, "16-bit integer", &[]),
    (
        "22_alaw",
        Codes(5504, 152, -6_954_824),
        4800,
        "8-bit A-law",
        &[],
    ),
    (
        "23_mulaw",
        Codes(32_124, 492, 4_156_752),
        4800,
        "8-bit µ-law",
        &[],
    ),
    ("24_fact12bytes", BITS_16, 4800, "16-bit integer", &[]),
    (
        "25_bad_byterate",
        BITS_16,
        4800,
        "16-bit integer",
        &["12345 bytes a second"],
    ),
    ("26_12bit_in_16", BITS_16, 4800, "16-bit integer", &[]),
    ("27_pcm20_in_24", BITS_24, 4800, "24-bit integer", &[]),
    ("28_ext_cbsize0", BITS_16, 4800, "16-bit integer", &[]),
    ("29_riff_size_wrong", BITS_16, 4800, "16-bit integer", &[]),
    ("30_trailing_garbage", BITS_16, 4800, "16-bit integer", &[]),
    ("31_f32_fmt40", FLOAT, 4800, "32-bit float", &[]),
    (
        "32_RIFX",
        Refused("RIFX (big-endian), not RIFF"),
        0,
        "",
        &[],
    ),
    ("33_empty_data", Refused("holds no audio"), 0, "", &[]),
    ("34_stereo16", BITS_16, 2400, "16-bit integer", &[]),
    (
        "35_f32_nan",
        FLOAT,
        4810,
        "32-bit float",
        &["read as zero: 10"],
    ),
    (
        "36_two_data",
        BITS_16,
        2400,
        "16-bit integer",
        &["second chunk"],
    ),
    ("37_odd_JUNK27_padded", BITS_16, 4800, "16-bit integer", &[]),
    (
        "38_odd_JUNK27_unpadded",
        BITS_16,
        4800,
        "16-bit integer",
        &[],
    ),
    ("39_LIST_inner_padded", BITS_16, 4800, "16-bit integer", &[]),
    (
        "40_truncated_orig_sizes",
        BITS_16,
        2399,
        "16-bit integer",
        &[ENDS_EARLY, "last whole frame"],
    ),
    (
        "41_datasize0_riffok",
        BITS_16,
        4800,
        "16-bit integer",
        &[NO_LENGTH],
    ),
    ("42_riff0_dataok", BITS_16, 4800, "16-bit integer", &[]),
    (
        "43_riffFFFFFFFF_dataok",
        BITS_16,
        4800,
        "16-bit integer",
        &[],
    ),
    ("44_PEAK_chunk_float", FLOAT, 4800, "32-bit float", &[]),
    ("45_fmt18_cb0_pcm16", BITS_16, 4800, "16-bit integer", &[]),
    (
        "46_odd_bext603_padded",
        BITS_16,
        4800,
        "16-bit integer",
        &[],
    ),
    ("47_id3_after", BITS_16, 4800, "16-bit integer", &[]),
];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/wav-variants")
}

fn path(name: &str) -> PathBuf {
    folder().join(format!("{name}.wav"))
}

/// A source that gives a byte or three at a time, as a pipe may.
struct Trickle<R>(R, usize);

impl<R: Read> Read for Trickle<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.1 = self.1 % 3 + 1;
        let most = buffer.len().min(self.1);
        self.0.read(&mut buffer[..most])
    }
}

#[test]
fn the_table_has_every_file() {
    let mut files: Vec<String> = fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "wav"))
        .map(|path| path.file_stem().unwrap().to_string_lossy().into_owned())
        .collect();
    files.sort();
    assert_eq!(files, TABLE.map(|row| row.0));
}

#[test]
fn every_sample_of_every_variant_is_read() {
    for (name, wanted, frames, encoding, warnings) in TABLE {
        let read = audio::read_file(&path(name));
        let trickled = audio::read(Trickle(fs::File::open(path(name)).unwrap(), 0));
        if let Refused(reason) = wanted {
            for error in [read.unwrap_err(), trickled.unwrap_err()] {
                assert!(error.to_string().contains(reason), "{name}: {error}");
            }
            continue;
        }
        let (read, trickled) = (read.unwrap(), trickled.unwrap());
        assert_eq!(
            (read.sample_rate_hz, read.encoding.as_str()),
            (48_000, encoding),
            "{name}"
        );
        check_samples(name, wanted, frames, &read.channels);
        assert_eq!(read.channels, trickled.channels, "{name}");
        assert_eq!(read.warnings, trickled.warnings, "{name}");
        assert_eq!(
            read.warnings.len(),
            warnings.len(),
            "{name}: {:?}",
            read.warnings
        );
        for (said, expected) in read.warnings.iter().zip(warnings) {
            assert!(said.contains(expected), "{name}: {said}");
        }
    }
}

fn check_samples(name: &str, wanted: Wanted, frames: usize, channels: &[Vec<f32>]) {
    assert!(channels.iter().all(|c| c.len() == frames), "{name}");
    match wanted {
        Sine(amplitude, full_scale) => {
            // Frames of the stereo file go on where those of one channel would.
            let interleaved = (0..frames).flat_map(|i| channels.iter().map(move |c| c[i]));
            // The file with NaN begins with them.
            let before = if name == "35_f32_nan" { 10 } else { 0 };
            for (i, got) in interleaved.enumerate() {
                let i = u32::try_from(i).unwrap();
                let exact = i
                    .checked_sub(before)
                    .map_or(0.0, |i| amplitude * (0.05 * f64::from(i)).sin());
                // Whole steps are the next ones towards zero.
                let exact = if full_scale > 1.0 {
                    exact.trunc()
                } else {
                    exact
                } / full_scale;
                assert!(
                    (f64::from(got) - exact).abs() < 4e-8,
                    "{name}: sample {i} is {got}, not {exact}"
                );
            }
        }
        Codes(first, last, sum) => {
            #[expect(clippy::cast_possible_truncation, reason = "whole steps of 16 bits")]
            let steps: Vec<i32> = channels[0].iter().map(|x| (x * 32_768.0) as i32).collect();
            let total: i64 = steps.iter().copied().map(i64::from).sum();
            assert_eq!(
                (steps[0], steps[frames - 1], total),
                (first, last, sum),
                "{name}"
            );
        }
        Refused(_) => {}
    }
}

fn analyze(file: &str, input: &[u8]) -> Output {
    piped(
        Path::new("."),
        &["analyze", file, "--format", "json"],
        input,
    )
}

#[test]
fn a_pipe_gives_what_the_file_gives_and_repairs_are_warnings() {
    for (name, wanted, _, _, warnings) in TABLE {
        let path = path(name).display().to_string();
        let (file, pipe) = (analyze(&path, &[]), analyze("-", &fs::read(&path).unwrap()));
        assert_eq!(file.status.code(), pipe.status.code(), "{name}");
        let said = |output: &Output, input: &str| {
            String::from_utf8_lossy(&output.stderr).replace(input, "IT")
        };
        assert_eq!(said(&file, &path), said(&pipe, "standard input"), "{name}");
        if matches!(wanted, Refused(_)) {
            assert_eq!(file.status.code(), Some(2), "{name}");
            continue;
        }
        let document: Value = serde_json::from_slice(&file.stdout).unwrap();
        let mut piped: Value = serde_json::from_slice(&pipe.stdout).unwrap();
        piped["file"] = Value::from(path);
        assert_eq!(document, piped, "{name}");
        let all = document["warnings"].as_array().unwrap();
        let repaired = all.iter().filter(|w| w["code"] == "repaired").count();
        assert_eq!(repaired, warnings.len(), "{name}");
    }
}
