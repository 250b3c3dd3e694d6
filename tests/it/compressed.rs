//! Compressed recordings: every format gives the drop that was put into it, what is damaged keeps its time, and what is
//! not read says how to convert it. `fixtures/compressed` says how the files were made.

use std::fs;
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

use bounce_audio::audio::{self, Recording, Stream, Track};
use bounce_audio::{Settings, analyze};
use serde_json::Value;

use crate::common::{empty_folder, piped};

fn path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("fixtures/compressed")
        .join(name)
}

fn bytes(name: &str) -> Vec<u8> {
    fs::read(path(name)).unwrap()
}

/// What all files were made of.
static ORIGINAL: LazyLock<Recording> = LazyLock::new(|| {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("compressed-original.wav");
    let made = Command::new(env!("CARGO_BIN_EXE_bounce-audio"))
        .arg("synth")
        .arg(path("drop.toml"))
        .arg("-o")
        .arg(&out)
        .output()
        .unwrap();
    assert!(made.status.success(), "{made:?}");
    audio::read_file(&out).unwrap()
});

/// Reads bytes in memory as a file is read.
fn read(bytes: &[u8]) -> Result<Recording, bounce_audio::Error> {
    Stream::open_seekable(Cursor::new(bytes))?.into_recording()
}

/// e and the times of the one drop in a recording.
fn drop_of(recording: &Recording) -> (f64, Vec<f64>) {
    let rate = f64::from(recording.sample_rate_hz);
    let analysis = analyze(&recording.channels[0], rate, &Settings::default()).unwrap();
    assert_eq!(analysis.drops.len(), 1);
    let drop = &analysis.drops[0];
    let times = drop.impacts.iter().map(|impact| impact.time_s).collect();
    (drop.restitution.as_ref().unwrap().estimate.value, times)
}

/// A format: its file, its name, how much later times are in seconds, and by how much loud impacts may be off.
///
/// AAC has 1024 samples before the first, which an edit list hides where there is one; an MP3 without the note of its encoder
/// has those of encoder and decoder, 1105; others say how much it is, and it goes. Lossless is exact. The codecs spread a click
/// over a block, which is heard as noise of 20 to 40 dB below it: that moves a time by microseconds, and the half-sample
/// (16 µs) is far above it.
const FORMATS: [(&str, &str, f64, f64); 18] = [
    ("drop.flac", "16-bit FLAC", 0.0, 0.0),
    ("drop-alac.m4a", "16-bit ALAC", 0.0, 0.0),
    ("drop.m4a", "AAC", 0.0, 16e-6),
    ("drop-moov-at-end.m4a", "AAC", 0.0, 16e-6),
    ("drop-h265.mp4", "AAC", 0.0, 16e-6),
    ("drop-pcm.mov", "16-bit PCM", 0.0, 0.0),
    ("drop.aiff", "16-bit PCM", 0.0, 0.0),
    ("drop.caf", "16-bit PCM", 0.0, 0.0),
    ("drop-fragments.mp4", "AAC", 1_024.0 / 32e3, 16e-6),
    ("drop.aac", "AAC", 1_024.0 / 32e3, 16e-6),
    ("drop.mp3", "MP3", 0.0, 16e-6),
    ("drop-plain.mp3", "MP3", 1_105.0 / 32e3, 16e-6),
    ("drop-stereo-vbr.mp3", "MP3", 0.0, 16e-6),
    ("drop.ogg", "Vorbis", 0.0, 16e-6),
    ("drop.opus", "Opus", OPUS_LATER_S, 16e-6),
    ("drop.webm", "Opus", OPUS_LATER_S, 16e-6),
    ("drop-opus.mp4", "Opus", OPUS_LATER_S, 16e-6),
    ("drop-aac.mka", "AAC", 1_024.0 / 32e3, 16e-6),
];

fn is_matroska(name: &str) -> bool {
    name.ends_with(".webm") || name.ends_with(".mka")
}

/// All times of Opus are earlier by two samples: one comes from going to another rate (a WAV of 48 kHz has 19 µs), the other from the
/// foot of what it makes of a click. ffmpeg's decoding has the same.
const OPUS_LATER_S: f64 = -47e-6;

/// The impacts that are loud enough for any codec: the first of the drop.
const LOUD: usize = 8;

/// The impacts that are told where the noise begins which a codec puts before a sound. What mends one takes it out here.
const EARLY: [(&str, usize); 1] = [("drop.ogg", 0)];

#[test]
fn every_format_gives_the_drop() {
    let (e, times) = drop_of(&ORIGINAL);
    for (name, encoding, later_s, off_s) in FORMATS {
        let read = audio::read_file(&path(name)).unwrap();
        assert_eq!(
            (read.encoding.as_str(), read.sample_rate_hz),
            (encoding, if encoding == "Opus" { 48_000 } else { 32_000 }),
            "{name}"
        );
        assert_eq!(read.lossy, off_s > 0.0, "{name}");
        assert!(read.warnings.is_empty(), "{name}: {:?}", read.warnings);
        if !read.lossy {
            assert_eq!(read.channels, ORIGINAL.channels, "{name}");
            continue;
        }
        let (e_here, times_here) = drop_of(&read);
        assert!((e_here - e).abs() < 1e-3, "{name}: e is {e_here}, not {e}");
        for (n, (here, there)) in times_here.iter().zip(&times).take(LOUD).enumerate() {
            let off = here - there - later_s;
            let is_right = off.abs() < off_s;
            let is_owed = EARLY.contains(&(name, n));
            assert!(is_right != is_owed, "{name}: impact {n} is off by {off} s");
        }
    }
}

/// The words of a text, in small letters.
fn words(text: &str) -> Vec<String> {
    let all = text.split(|c: char| !c.is_alphanumeric());
    all.map(str::to_lowercase).collect()
}

#[test]
fn what_is_read_is_named_where_it_is_said_what_is_read() {
    let said = read(b"a letter to somebody").unwrap_err().to_string();
    assert!(said.contains(audio::FORMATS), "{said}");
    let version = Command::new(env!("CARGO_BIN_EXE_bounce-audio"))
        .arg("--version")
        .output()
        .unwrap();
    assert!(String::from_utf8_lossy(&version.stdout).contains(audio::FORMATS));

    let file = |name| fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(name)).unwrap();
    let formats = words(audio::FORMATS);
    let without_opus = [
        file("python/package/bounce_audio/listening.py"),
        file("python/README.md"),
        file("web/page/index.html"),
    ];
    let without_opus = without_opus.map(|text| words(&text));
    for (name, encoding, ..) in FORMATS.into_iter().chain([("drop.wav", "WAV", 0.0, 0.0)]) {
        let ending = name.rsplit('.').next().unwrap().to_owned();
        assert!(formats.contains(&ending), "{ending}: {formats:?}");
        for text in &without_opus {
            let left_out = encoding == "Opus" || is_matroska(name);
            assert!(left_out || text.contains(&ending), "{ending}");
        }
    }
    // The left column of the table.
    let table = file("docs/compressed.md");
    let read: String = table
        .lines()
        .filter_map(|line| line.split('|').nth(1))
        .collect();
    let read = words(&read);
    for format in formats {
        let known = format == "and" || read.contains(&format);
        assert!(known, "docs/compressed.md does not name {format}");
    }
}

/// The tracks of `drop-second-track.m4a`, heard from the beginning.
const TWO: &str = "1 (AAC, 32000 Hz, 1 channel, silent), 2 (AAC, 32000 Hz, 1 channel, has sound)";

#[test]
fn of_two_tracks_the_one_with_sound_is_read_and_that_is_said() {
    let (e, times) = drop_of(&ORIGINAL);
    let read = audio::read_file(&path("drop-second-track.m4a")).unwrap();
    let said = format!("it has 2 tracks of sound, of which number 2 was read: {TWO}");
    assert_eq!(read.tracks.as_deref(), Some(&*said));
    assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    let (e_here, times_here) = drop_of(&read);
    assert!((e_here - e).abs() < 1e-3, "e is {e_here}, not {e}");
    for (here, there) in times_here.iter().zip(&times).take(LOUD) {
        assert!((here - there).abs() < 16e-6, "{here} s, not {there} s");
    }
    // What is read ahead to hear which has sound is not read again: a pipe gives the same.
    let pipe = audio::read(bytes("drop-second-track.m4a").as_slice()).unwrap();
    assert_eq!(
        (&pipe.channels, &pipe.tracks),
        (&read.channels, &read.tracks)
    );
}

#[test]
fn a_track_is_read_by_its_number_or_the_error_lists_those_that_there_are() {
    let track = |name, number| {
        let track = Track::Number(number);
        Stream::open_file_track(&path(name), track)?.into_recording()
    };
    let chosen = audio::read_file(&path("drop-second-track.m4a")).unwrap();
    let [first, second] = [1, 2].map(|n| track("drop-second-track.m4a", n).unwrap());
    assert!(first.channels.iter().flatten().all(|x| *x == 0.0));
    assert_eq!(second.channels, chosen.channels);
    assert_eq!((first.tracks, second.tracks), (None, None));
    let untold = TWO.replace(", silent", "").replace(", has sound", "");
    for (name, number, expected) in [
        (
            "drop-second-track.m4a",
            3,
            format!("it has 2 tracks of sound, and no number 3: {untold}"),
        ),
        (
            "drop.m4a",
            2,
            "it has one track of sound, and no number 2: 1 (AAC, 32000 Hz, 1 channel)".to_owned(),
        ),
        (
            "drop.flac",
            2,
            "it has one track of sound, and no number 2".to_owned(),
        ),
    ] {
        let error = track(name, number).unwrap_err().to_string();
        assert!(error.ends_with(&expected), "{name}: {error}");
        assert_eq!(track(name, 0).unwrap_err().to_string().len(), error.len());
    }
}

#[test]
fn the_command_says_which_option_chooses_a_track_and_draws_the_one_that_was_chosen() {
    let name = "drop-second-track.m4a";
    let folder = folder("tracks", &[(name, name)]);
    let run = |more: &[&str]| piped(&folder, &[&["analyze", name], more].concat(), &[]);
    let said = |output: &std::process::Output| {
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let output = run(&[]);
    assert!(said(&output).contains(&format!("{TWO} (--track)")));
    // Its sound is drawn too: what is silent would have no waveform.
    let output = run(&["--track", "2", "--plot", "chosen.svg"]);
    assert!(!said(&output).contains("tracks of sound"), "{output:?}");
    run(&["--plot", "first.svg"]);
    let drawn = |file| fs::read_to_string(folder.join(file)).unwrap();
    assert_eq!(drawn("chosen.svg"), drawn("first.svg"));
    let output = run(&["--track", "1"]);
    assert!(said(&output).contains("recording is silent"), "{output:?}");
}

#[test]
fn a_pipe_gives_what_a_file_gives() {
    for (name, ..) in FORMATS {
        let bytes = bytes(name);
        let file = audio::read_file(&path(name)).unwrap();
        let refused = match name {
            "drop-moov-at-end.m4a" => Some("+faststart"),
            "drop.caf" => Some("give the file itself"),
            _ => None,
        };
        if let Some(advice) = refused {
            let error = audio::read(bytes.as_slice()).unwrap_err().to_string();
            assert!(
                error.contains("pipe") && error.contains(advice),
                "{name}: {error}"
            );
            continue;
        }
        let pipe = audio::read(Trickle(Cursor::new(&bytes), 0)).unwrap();
        assert_eq!(
            (&file.channels, &file.warnings),
            (&pipe.channels, &pipe.warnings),
            "{name}"
        );
    }
}

/// An MP4 with another first entry in its edit list: how long it lasts, and from where it is presented.
fn edited(name: &str, lasts: u32, from: i32) -> Vec<u8> {
    let mut bytes = bytes(name);
    let list = bytes.windows(4).position(|kind| kind == b"elst").unwrap();
    let entry = list + 12;
    bytes[entry..entry + 4].copy_from_slice(&lasts.to_be_bytes());
    bytes[entry + 4..entry + 8].copy_from_slice(&from.to_be_bytes());
    bytes
}

#[test]
fn an_mp4_begins_where_its_edit_list_says() {
    for name in ["drop.m4a", "drop-moov-at-end.m4a", "drop-alac.m4a"] {
        let all = &read(&edited(name, 0, 0)).unwrap().channels[0];
        for from in [1, 1_024, 5_000, 30_000] {
            let read = read(&edited(name, 0, from)).unwrap();
            let hidden = usize::try_from(from).unwrap();
            assert_eq!(read.channels[0], all[hidden..], "{name} from {from}");
            assert!(read.warnings.is_empty(), "{name}: {:?}", read.warnings);
        }
        // Nothing is presented at all, or what is not there, or a time before the first: the whole stream is read.
        for (lasts, from) in [(30, -1), (0, i32::MAX), (0, -2)] {
            let read = read(&edited(name, lasts, from)).unwrap();
            assert_eq!(&read.channels[0], all, "{name} from {from}");
        }
    }
}

#[test]
fn an_empty_edit_is_silence_before_the_sound() {
    // A second entry is put behind the empty one: all that follows in the index moves, and the sound with it.
    let mut bytes = edited("drop-moov-at-end.m4a", 500, -1);
    let all = read(&bytes).unwrap().channels.remove(0);
    let at = |kind: &[u8]| bytes.windows(4).position(|this| this == kind).unwrap();
    let parts = [at(b"moov"), at(b"trak"), at(b"edts"), at(b"elst")];
    let list = parts[3];
    for part in parts {
        let length = u32::from_be_bytes(*bytes[part - 4..].first_chunk().unwrap()) + 12;
        bytes[part - 4..part].copy_from_slice(&length.to_be_bytes());
    }
    bytes[list + 11] = 2;
    let second = [0_u32, 1_024, 1 << 16].map(u32::to_be_bytes).concat();
    bytes.splice(list + 24..list + 24, second);
    let scale = bytes.windows(4).position(|this| this == b"mvhd").unwrap() + 16;
    let units_per_s = u32::from_be_bytes(*bytes[scale..].first_chunk().unwrap());
    let silent = 500 * 32_000 / usize::try_from(units_per_s).unwrap();
    let read = read(&bytes).unwrap().channels.remove(0);
    assert!(read[..silent].iter().all(|x| *x == 0.0));
    assert_eq!(read[silent..], all[1_024..]);
}

#[test]
fn what_is_damaged_before_the_beginning_is_not_told() {
    let mut bytes = edited("drop.m4a", 0, 30_000);
    let whole = read(&bytes).unwrap();
    let sound = bytes.windows(4).position(|kind| kind == b"mdat").unwrap();
    bytes[sound + 4..sound + 1_000].fill(0xFF);
    let torn = read(&bytes).unwrap();
    assert!(torn.warnings.is_empty(), "{:?}", torn.warnings);
    assert_eq!(torn.channels[0].len(), whole.channels[0].len());
    // What is cut before its beginning has no sound.
    let error = read(&bytes[..sound + 1_000]).unwrap_err().to_string();
    assert!(error.contains("sound begins"), "{error}");
}

#[test]
fn a_gap_of_the_time_stamps_is_silence() {
    let whole = audio::read_file(&path("drop.m4a")).unwrap();
    let gap = audio::read_file(&path("drop-gap.m4a")).unwrap();
    assert_eq!(gap.channels[0].len(), whole.channels[0].len());
    let (from, to) = unlike_s(&whole, &gap).unwrap();
    // Two packets of 1024 samples, 15 packets after those that are hidden, and what overlaps them.
    let packet_s = 1_024.0 / 32e3;
    assert!(
        from > 12.9 * packet_s && to < 17.1 * packet_s,
        "from {from} s to {to} s"
    );
    assert!(
        gap.warnings[0].contains("missing") && gap.warnings[0].contains("0.064 s"),
        "{:?}",
        gap.warnings
    );
}

#[test]
fn a_gap_of_the_time_stamps_of_a_webm_is_silence() {
    let [whole, gap] =
        ["drop.webm", "drop-gap.webm"].map(|name| audio::read_file(&path(name)).unwrap());
    let (all, left) = (whole.channels[0].len(), gap.channels[0].len());
    // Its time stamps are whole milliseconds.
    assert!(all.abs_diff(left) <= 48, "{all} {left}: {:?}", gap.warnings);
    // Five packets of 20 ms after 20, less the 6.5 ms that are hidden.
    let lost = &gap.channels[0][18_950..23_700];
    assert!(lost.iter().all(|x| *x == 0.0));
    assert!(whole.channels[0][18_950..23_700].iter().any(|x| *x != 0.0));
    assert!(gap.warnings[0].contains("0.101 s"), "{:?}", gap.warnings);
}

#[test]
fn what_cannot_be_decoded_keeps_the_gap_behind_it() {
    let all = bytes("drop-gap.m4a");
    let frames = read(&all).unwrap().channels[0].len();
    let sound = all.windows(4).position(|kind| kind == b"mdat").unwrap() + 4;
    let mut torn = 0;
    for at in (sound..all.len()).step_by(60) {
        let mut bytes = all.clone();
        bytes[at..all.len().min(at + 60)].fill(0xFF);
        let read = read(&bytes).unwrap();
        torn += usize::from(!read.warnings[0].contains("0.064 s"));
        assert_eq!(read.channels[0].len(), frames, "{at}: {:?}", read.warnings);
    }
    assert!(torn > 30, "{torn} were damaged");
}

/// A source that gives a few bytes at a time, as a pipe may.
struct Trickle<R>(R, usize);

impl<R: Read> Read for Trickle<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        self.1 = self.1 % 700 + 1;
        let most = buffer.len().min(self.1);
        self.0.read(&mut buffer[..most])
    }
}

/// Where two recordings are unlike each other, in seconds; none if nowhere.
///
/// AAC puts noise of its own in place of noise, other noise after a loss: it is of 0.001 here, and impacts are of 0.02 to 0.7.
fn unlike_s(one: &Recording, other: &Recording) -> Option<(f64, f64)> {
    let both = one.channels[0].iter().zip(&other.channels[0]);
    let unlike: Vec<usize> = both
        .enumerate()
        .filter(|(_, (a, b))| (*a - *b).abs() > 5e-3)
        .map(|(i, _)| i)
        .collect();
    let s = |i: &usize| f64::from(u32::try_from(*i).unwrap()) / f64::from(one.sample_rate_hz);
    Some((s(unlike.first()?), s(unlike.last()?)))
}

#[test]
fn what_is_damaged_is_silent_and_what_follows_keeps_its_time() {
    for (name, encoding, ..) in FORMATS {
        // Of an MP4 it is the sound that is damaged, not its index.
        let mut bytes = bytes(name);
        let whole = read(&bytes).unwrap();
        // Pictures come first in places.
        let middle = bytes.len() * if name == "drop-h265.mp4" { 7 } else { 5 } / 10;
        bytes[middle..middle + 600].fill(0);
        let torn = read(&bytes).unwrap_or_else(|e| panic!("{name}: {e}"));
        let (frames, frames_left) = (whole.channels[0].len(), torn.channels[0].len());
        if is_matroska(name) {
            // Behind the damage nothing says where the next packet is.
            assert!(frames_left <= frames, "{name}");
            assert!(
                frames_left > frames / 3,
                "{name}: {frames_left} of {frames}"
            );
            continue;
        }
        if name == "drop-stereo-vbr.mp3" {
            // Its frames have many lengths, by which it can only be estimated how many were lost.
            assert!(
                frames.abs_diff(frames_left) <= 1_152,
                "{frames} {frames_left}"
            );
            assert!(
                torn.warnings[0].contains("to a frame or so"),
                "{:?}",
                torn.warnings
            );
            continue;
        }
        assert_eq!(frames, frames_left, "{name}");
        if encoding == "16-bit PCM" {
            // Samples that are zeros are samples.
            continue;
        }
        let (from, to) = unlike_s(&whole, &torn).unwrap();
        // The packets that were hit, and those that lean on them.
        assert!(to - from < 0.35, "{name}: unlike from {from} s to {to} s");
        let said = torn.warnings.iter().any(|w| w.contains("damaged in"));
        // Without a sum over a packet zeros may be sound as good as any: nothing then says that they are none.
        assert!(
            said || matches!(encoding, "AAC" | "16-bit ALAC"),
            "{name}: {:?}",
            torn.warnings
        );
    }
}

#[test]
fn a_file_that_is_cut_gives_what_is_there() {
    for (name, ..) in FORMATS {
        let bytes = bytes(name);
        let whole = read(&bytes).unwrap();
        let cut = read(&bytes[..bytes.len() * 2 / 3]);
        let refused = match name {
            "drop-moov-at-end.m4a" => Some("index (moov) is missing or cut"),
            "drop.caf" => Some("or the file is cut"),
            _ => None,
        };
        if let Some(why) = refused {
            let error = cut.unwrap_err().to_string();
            assert!(error.contains(why), "{error}");
            continue;
        }
        let cut = cut.unwrap_or_else(|e| panic!("{name}: {e}"));
        let (there, all) = (cut.channels[0].len(), whole.channels[0].len());
        assert!(there < all && there > all / 3, "{name}: {there} of {all}");
        assert_eq!(
            cut.channels[0][..there * 9 / 10],
            whole.channels[0][..there * 9 / 10],
            "{name}"
        );
        // A Matroska may end anywhere: browsers leave it so.
        assert!(
            is_matroska(name) || cut.warnings.iter().any(|w| w.contains("cut")),
            "{name}: {:?}",
            cut.warnings
        );
    }
}

#[test]
fn a_change_of_format_ends_it_with_a_warning() {
    let both = [bytes("drop-plain.mp3"), bytes("drop-stereo-vbr.mp3")].concat();
    let (first, read) = (
        read(&bytes("drop-plain.mp3")).unwrap(),
        read(&both).unwrap(),
    );
    assert_eq!(first.channels, read.channels);
    assert!(read.warnings[0].contains("channels"), "{:?}", read.warnings);
}

#[test]
fn streams_of_an_ogg_that_follow_each_other_are_one_recording() {
    for name in ["drop.ogg", "drop.opus"] {
        let one = bytes(name);
        let alone = read(&one).unwrap();
        let both = read(&[one.clone(), one.clone()].concat()).unwrap();
        assert!(both.warnings.is_empty(), "{:?}", both.warnings);
        let (alone, both) = (&alone.channels[0], &both.channels[0]);
        assert_eq!(both.len(), 2 * alone.len());
        let differs = (alone.iter().chain(alone))
            .zip(both)
            .position(|(a, b)| a.to_bits() != b.to_bits());
        assert_eq!(differs, None, "{name}");
    }
}

#[test]
fn what_is_not_read_says_what_converts_it() {
    for (name, what, command) in [
        (
            "refused-six-channels.opus",
            "Opus of another kind than with 1 or 2 channels",
            "ffmpeg -i IN.opus OUT.wav",
        ),
        ("refused.amr", "AMR", "ffmpeg -i IN.amr OUT.wav"),
        (
            "refused-amr.3gp",
            "it may hold AMR",
            "ffmpeg -i IN.mp4 OUT.wav",
        ),
        ("refused.wma", "Windows Media", "ffmpeg -i IN.wma OUT.wav"),
        (
            "refused-six-channels.m4a",
            "AAC of another kind",
            "ffmpeg -i IN.mp4 OUT.wav",
        ),
        ("refused.mp2", "layer II", "ffmpeg -i IN.mp2 OUT.wav"),
        ("refused-ac3.mp4", "AC-3", "ffmpeg -i IN.mp4 OUT.wav"),
        ("refused.w64", "Wave64", "ffmpeg -i IN.w64 OUT.wav"),
        ("refused.avi", "AVI", "ffmpeg -i IN.avi OUT.wav"),
    ] {
        let error = audio::read_file(&path(name)).unwrap_err().to_string();
        assert!(
            error.contains(what) && error.contains(command),
            "{name}: {error}"
        );
    }
}

#[test]
fn a_mistake_of_a_decoder_is_one_sentence() {
    // In it symphonia asserts something that does not hold; found by `tests/fuzz`.
    let file = "../crashes/compressed/mp4-overflow-90194350993";
    let output = piped(&path(""), &["analyze", file], &[]);
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.lines().count() == 1 && said.contains("none of its sound"),
        "{said}"
    );
}

/// A new folder with some of the files, under other names.
fn folder(name: &str, files: &[(&str, &str)]) -> PathBuf {
    let folder = empty_folder("compressed", name);
    for (from, to) in files {
        fs::copy(path(from), folder.join(to)).unwrap();
    }
    folder
}

#[test]
fn commands_take_them_by_content_and_say_what_is_lossy() {
    let files = [
        ("drop.m4a", "a.wav"),
        ("drop.mp3", "b.mp3"),
        ("drop.flac", "c"),
        ("refused.amr", "d.amr"),
    ];
    let folder = folder("commands", &files);
    let output = piped(
        &folder,
        &["analyze", "a.wav", "--format", "json", "--plot", "a.svg"],
        &[],
    );
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["recording"]["encoding"], "AAC");
    assert_eq!(document["warnings"][0]["code"], "lossy");
    assert!(folder.join("a.svg").is_file());
    let mut from_pipe = piped(
        &folder,
        &["analyze", "-", "--format", "json"],
        &bytes("drop.m4a"),
    );
    from_pipe.stdout = String::from_utf8(from_pipe.stdout)
        .unwrap()
        .replace("\"-\"", "\"a.wav\"")
        .into_bytes();
    assert_eq!(
        serde_json::from_slice::<Value>(&from_pipe.stdout).unwrap(),
        document
    );

    let output = piped(&folder, &["analyze", "c"], &[]);
    assert!(!String::from_utf8_lossy(&output.stdout).contains("with loss"));
    let rows = piped(&folder, &["batch", "b.mp3", "c"], &[]);
    let rows = String::from_utf8(rows.stdout).unwrap();
    let is_lossy: Vec<bool> = rows.lines().map(|row| row.contains("lossy")).collect();
    assert_eq!(is_lossy, [false, true, false], "{rows}");
    let output = piped(&folder, &["batch", ".", "--format", "ndjson"], &[]);
    let lines = String::from_utf8(output.stdout).unwrap();
    let lines: Vec<Value> = lines
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    let names: Vec<&str> = lines
        .iter()
        .map(|line| line["file"].as_str().unwrap())
        .collect();
    assert_eq!(names, ["./a.wav", "./b.mp3", "./c", "./d.amr"]);
    assert!(
        lines[3]["error"]
            .as_str()
            .unwrap()
            .contains("ffmpeg -i IN.amr OUT.wav")
    );
    assert_eq!(output.status.code(), Some(1));
}
