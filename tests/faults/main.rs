//! Hostile files and settings: each gives a document or one clear sentence. What they give is the table
//! `docs/faults.md`, which has to be as this makes it; `BOUNCE_AUDIO_REWRITE=1 cargo test --test faults` rewrites it, and
//! `docs/faults-of-writing.md`, which says what comes of results that cannot be written.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a failing test should panic"
)]

#[cfg(target_os = "linux")]
mod interrupts;
#[cfg(target_os = "linux")]
mod writing;

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use bounce_audio::random::SplitMix64;
use bounce_audio::synth::presets::preset;
use bounce_audio::synth::render;
use serde_json::Value;

/// The header of a WAV file, and what it claims.
#[derive(Clone, Copy)]
struct Header {
    tag: u16,
    channels: u16,
    rate_hz: u32,
    bits: u16,
    claimed: Option<u32>,
}

const PCM: Header = Header {
    tag: 1,
    channels: 1,
    rate_hz: 44_100,
    bits: 16,
    claimed: None,
};
const FLOAT: Header = Header {
    tag: 3,
    bits: 32,
    ..PCM
};

impl Header {
    fn over(self, samples: &[u8]) -> Vec<u8> {
        let frame_bytes = self.channels.wrapping_mul(self.bits.div_ceil(8));
        let claimed = self
            .claimed
            .unwrap_or_else(|| u32::try_from(samples.len()).unwrap());
        let mut wav = b"RIFF\0\0\0\0WAVEfmt \x10\0\0\0".to_vec();
        wav.extend(self.tag.to_le_bytes());
        wav.extend(self.channels.to_le_bytes());
        wav.extend(self.rate_hz.to_le_bytes());
        wav.extend(
            self.rate_hz
                .wrapping_mul(u32::from(frame_bytes))
                .to_le_bytes(),
        );
        wav.extend(frame_bytes.to_le_bytes());
        wav.extend(self.bits.to_le_bytes());
        wav.extend(b"data");
        wav.extend(claimed.to_le_bytes());
        wav.extend(samples);
        wav
    }
}

fn floats(samples: impl IntoIterator<Item = f32>) -> Vec<u8> {
    FLOAT.over(&bytes(samples))
}

fn bytes(samples: impl IntoIterator<Item = f32>) -> Vec<u8> {
    samples.into_iter().flat_map(f32::to_le_bytes).collect()
}

fn steps(samples: impl IntoIterator<Item = i16>) -> Vec<u8> {
    let bytes: Vec<u8> = samples.into_iter().flat_map(i16::to_le_bytes).collect();
    PCM.over(&bytes)
}

/// The drop of a preset, as floats.
fn drop_of(name: &str) -> Vec<f32> {
    render(&preset(name).unwrap(), 1).unwrap().samples
}

/// Bytes of noise.
fn noise(length: usize) -> Vec<u8> {
    let mut random = SplitMix64::new(1);
    (0..length)
        .map(|_| random.next_u64().to_le_bytes()[0])
        .collect()
}

/// A thousand clicks a second at random for as many seconds, 8 bits at 8 kHz.
fn a_million_transients() -> Vec<u8> {
    let mut random = SplitMix64::new(1);
    let clicks = (0..8_000_000).map(|_| match random.next_u64() % 8 {
        0 => random.next_u64().to_le_bytes()[0],
        _ => 128,
    });
    let header = Header {
        rate_hz: 8_000,
        bits: 8,
        ..PCM
    };
    header.over(&clicks.collect::<Vec<u8>>())
}

/// What is wrong with each file, and the file.
fn files() -> Vec<(&'static str, Vec<u8>)> {
    let a_second = 44_100;
    vec![
        ("nothing in it", Vec::new()),
        (
            "a letter",
            b"Dear diary, today I bounced a ball.\n".to_vec(),
        ),
        ("noise instead of a file", noise(100_000)),
        ("RIFX", [b"RIFX", &steps([1; 100])[4..]].concat()),
        ("only RIFF and WAVE", b"RIFF\x04\0\0\0WAVE".to_vec()),
        (
            "no format before the samples",
            b"RIFF\0\0\0\0WAVEdata\x04\0\0\0abcd".to_vec(),
        ),
        (
            "a format of 4 bytes",
            b"RIFF\0\0\0\0WAVEfmt \x04\0\0\0\x01\0\x01\0data\0\0\0\0".to_vec(),
        ),
        (
            "a chunk of 2 GiB that is not there",
            b"RIFF\0\0\0\0WAVEJUNK\0\0\0\x80".to_vec(),
        ),
        (
            "a header of 4 GiB, cut at 40 bytes",
            Header {
                claimed: Some(u32::MAX - 15),
                ..PCM
            }
            .over(&[])[..40]
                .to_vec(),
        ),
        (
            "a header of 4 GiB over 10 samples",
            Header {
                claimed: Some(u32::MAX - 15),
                ..PCM
            }
            .over(&[1; 20]),
        ),
        (
            "samples of format 17 (ADPCM), 4 bits",
            Header {
                tag: 17,
                bits: 4,
                ..PCM
            }
            .over(&[0; 100]),
        ),
        (
            "samples of 0 bits",
            Header { bits: 0, ..PCM }.over(&[0; 100]),
        ),
        (
            "samples of 64-bit integers",
            Header { bits: 64, ..PCM }.over(&[0; 800]),
        ),
        ("0 channels", Header { channels: 0, ..PCM }.over(&[0; 100])),
        (
            "65,535 channels of 8 bits",
            Header {
                channels: 65_535,
                bits: 8,
                ..PCM
            }
            .over(&noise(65_535 * 40)),
        ),
        (
            "65,535 channels of 16 bits",
            Header {
                channels: 65_535,
                ..PCM
            }
            .over(&noise(65_535 * 40)),
        ),
        ("0 Hz", Header { rate_hz: 0, ..PCM }.over(&[0; 100])),
        ("1 Hz", Header { rate_hz: 1, ..PCM }.over(&noise(100_000))),
        (
            "160 Hz",
            Header {
                rate_hz: 160,
                ..PCM
            }
            .over(&noise(100_000)),
        ),
        (
            "4 GHz",
            Header {
                rate_hz: 4_000_000_000,
                ..PCM
            }
            .over(&noise(100_000)),
        ),
        ("no samples", steps([])),
        ("one sample", steps([1_000])),
        ("all samples zero", steps(vec![0; 10 * a_second])),
        ("all samples equal", steps(vec![12_345; 10 * a_second])),
        (
            "a square wave of 1 kHz at full scale",
            steps((0..10 * a_second).map(|i| {
                if (i / 22) % 2 == 0 {
                    i16::MAX
                } else {
                    i16::MIN
                }
            })),
        ),
        (
            "a square wave of half the sample rate",
            steps((0..10 * a_second).map(|i| if i % 2 == 0 { i16::MAX } else { i16::MIN })),
        ),
        (
            "a square wave of 1 Hz at full scale",
            steps((0..10 * a_second).map(|i| {
                if (i / 22_050) % 2 == 0 {
                    i16::MAX
                } else {
                    i16::MIN
                }
            })),
        ),
        ("nothing but NaN", floats(vec![f32::NAN; a_second])),
        (
            "infinities of both signs",
            floats((0..a_second).map(|i| {
                if i % 2 == 0 {
                    f32::INFINITY
                } else {
                    f32::NEG_INFINITY
                }
            })),
        ),
        (
            "floats of 3·10³⁸ of both signs",
            floats((0..a_second).map(|i| if i % 2 == 0 { 3e38 } else { -3e38 })),
        ),
        (
            "clicks of 3·10³⁸",
            floats((0..10 * a_second).map(|i| if i % 5_000 == 0 { 3e38 } else { 0.0 })),
        ),
        (
            "a drop with every thousandth sample NaN",
            floats(
                drop_of("steel")
                    .iter()
                    .enumerate()
                    .map(|(i, x)| if i % 1_000 == 0 { f32::NAN } else { *x }),
            ),
        ),
        (
            "a drop in steps of 24 bits that are floats",
            floats(drop_of("steel").iter().map(|x| x * 8_388_608.0)),
        ),
        (
            "a drop 10¹⁵ times above full scale",
            floats(drop_of("steel").iter().map(|x| x * 1e15)),
        ),
        (
            "a drop 10³⁰ times too faint",
            floats(drop_of("steel").iter().map(|x| x * 1e-30)),
        ),
        (
            "a drop cut in the middle of a sample",
            floats(drop_of("steel"))[..300_001].to_vec(),
        ),
        ("a million transients", a_million_transients()),
    ]
}

/// Settings out of range, for a recording that holds a drop.
const SETTINGS: [&str; 32] = [
    "--start 5 --end 4",
    "--start -1",
    "--start 1000",
    "--start nan",
    "--start 1e300",
    "--end 0",
    "--start 3 --end 3.0000001",
    "--height 0",
    "--height -30cm",
    "--height 1e300",
    "--height 30.5kg",
    "--height 5m",
    "--height 5",
    "--height-error -1mm",
    "--height-error 1e300",
    "--gravity 0",
    "--gravity 1e-300",
    "--mass 0",
    "--mass 1e300",
    "--diameter -38mm",
    "--diameter 1e-300",
    "--contact-time 0",
    "--contact-time 10s",
    "--contact-time 1s",
    "--contact-time 20ms",
    "--contact-time 80us",
    "--channel 0",
    "--channel 2",
    "--channel 99999999999999999999",
    "--model elastic",
    "--timing best",
    "--colour red",
];

fn analyze(file: &Path, settings: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bounce-audio"))
        .arg("analyze")
        .arg(file)
        .args(["--format", "json"])
        .args(settings.split_whitespace())
        .output()
        .unwrap()
}

/// What the command said, with the name of the file taken out: its error, or the warnings of its document.
fn said(output: &Output, file: &Path) -> String {
    let error = String::from_utf8(output.stderr.clone()).unwrap();
    if output.status.code() == Some(2) {
        let document: Value = serde_json::from_slice(&output.stdout).unwrap();
        let fields: Vec<&String> = document.as_object().unwrap().keys().collect();
        assert_eq!(fields, ["error", "file"], "beside {error}");
        let reason = document["error"].as_str().unwrap();
        assert!(error.contains(reason), "{reason} is not in {error}");
        let first = error.lines().next().unwrap_or_default();
        return first.replace(&file.display().to_string(), "FILE");
    }
    assert!(error.is_empty(), "{error}");
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let drops = document["drops"].as_array().unwrap();
    let mut said: Vec<String> = drops.iter().map(a_drop).collect();
    let of = |holder: &Value| holder["warnings"].as_array().unwrap().clone();
    let warnings = drops.iter().flat_map(of).chain(of(&document));
    said.extend(warnings.map(|w| {
        format!(
            "{}: {}",
            w["code"].as_str().unwrap(),
            w["message"].as_str().unwrap()
        )
    }));
    said.join("; ")
}

fn a_drop(drop: &Value) -> String {
    let e = drop["restitution"]["value"].as_f64();
    format!(
        "a drop of {} impacts, e {}",
        drop["bounces"],
        e.map_or("unknown".to_owned(), |e| format!("{e:.3}"))
    )
}

fn add_row(table: &mut String, what: &str, output: &Output, file: &Path) {
    let said = said(output, file).replace('|', "\\|");
    let status = output
        .status
        .code()
        .map_or("killed".to_owned(), |code| code.to_string());
    writeln!(table, "| {what} | {status} | {said} |").unwrap();
}

fn table() -> String {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR"));
    let mut table = INTRODUCTION.to_owned();
    let file = folder.join("fault.wav");
    for (what, bytes) in files() {
        fs::write(&file, bytes).unwrap();
        add_row(&mut table, what, &analyze(&file, ""), &file);
    }
    let missing = folder.join("missing.wav");
    add_row(
        &mut table,
        "a file that is not there",
        &analyze(&missing, ""),
        &missing,
    );
    add_row(&mut table, "a folder", &analyze(&folder, ""), &folder);
    table += SETTINGS_INTRODUCTION;
    fs::write(&file, floats(drop_of("steel"))).unwrap();
    for settings in SETTINGS {
        add_row(
            &mut table,
            &format!("`{settings}`"),
            &analyze(&file, settings),
            &file,
        );
    }
    table
}

const INTRODUCTION: &str = "# What goes wrong, and what is then said

Each row is a file or a setting that is made, and given to `bounce-audio analyze FILE --format json`, by
`tests/faults`, which fails where this table is not what came of it. Status 0: a drop was found; 1: none; 2: it could
not be read, or an argument is wrong. With status 2 one sentence is on standard error and in JSON, else the warnings of the document
are given.

## Files

| file | status | said |
|---|---|---|
";

const SETTINGS_INTRODUCTION: &str = "
## Settings

| setting | status | said |
|---|---|---|
";

/// A table has to be as it is committed; `BOUNCE_AUDIO_REWRITE=1` writes it instead.
fn compare(name: &str, made: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(name);
    if std::env::var_os("BOUNCE_AUDIO_REWRITE").is_some() {
        fs::write(&path, made).unwrap();
    }
    let committed = fs::read_to_string(&path).unwrap();
    for (made, committed) in made.lines().zip(committed.lines()) {
        assert_eq!(made, committed);
    }
    assert_eq!(made.lines().count(), committed.lines().count());
    assert!(!made.contains("panicked"), "{made}");
}

#[test]
fn every_fault_gives_what_the_table_says() {
    let made = table();
    assert!(!made.contains("killed"), "{made}");
    compare("docs/faults.md", &made);
}
