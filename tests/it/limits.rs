//! Every limit that docs/limits.md states is met with a sentence that says what was wrong and what is allowed.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// What docs/limits.md calls it, a command just beyond it, and what is said.
const LIMITS: [(&str, &str, &str); 31] = [
    (
        "sample rate",
        "analyze 159.wav",
        "sample rate is 159, expected 160 Hz or more by default, 4 times the lowest frequency that is listened to",
    ),
    (
        "samples a second",
        "analyze fast.wav",
        "sample rate of all channels together is 1536002, expected 1536000 Hz or less: listen to one of them with --channel",
    ),
    (
        "bytes of a frame",
        "analyze wide.wav",
        "its 32768 channels make frames of 65536 bytes, expected at most 65535",
    ),
    (
        "a chunk before the samples",
        "analyze chunk.wav",
        "names a chunk of 268435458 bytes before its samples, expected at most 268435456",
    ),
    (
        "`--channel`",
        "analyze drop.wav --channel 2",
        "--channel is 2 of a recording with 1, expected best or the number of a channel, from 1",
    ),
    (
        "`--track`",
        "analyze drop.wav --track 2",
        "it has one track of sound, and no number 2",
    ),
    (
        "`--start`, `--end`",
        "analyze drop.wav --start 2 --end 1",
        "end is 1, expected after the start",
    ),
    (
        "`--height`",
        "analyze drop.wav --height 10001m",
        "height is 10001, expected 1 µm to 10 km",
    ),
    (
        "`--height-error`",
        "analyze drop.wav --height 1 --height-error -1mm",
        "height error is -0.001, expected 0 to 10 km",
    ),
    (
        "`--gravity`",
        "analyze drop.wav --gravity 0.0009",
        "gravity is 0.0009, expected 0.001 to 1000000 m/s²",
    ),
    (
        "`--mass`",
        "analyze drop.wav --mass 1001000kg",
        "mass is 1001000, expected 1 µg to 1000 t",
    ),
    (
        "`--diameter`",
        "analyze drop.wav --diameter 1001m",
        "diameter is 1001, expected 1 µm to 1 km",
    ),
    (
        "`--contact-time`",
        "analyze drop.wav --contact-time 1.1s",
        "contact time is 1.1, expected 1 ns to 1 s",
    ),
    (
        "`--time-scale`",
        "analyze drop.wav --time-scale 1001",
        "time scale is 1001, expected 0.001 to 1000",
    ),
    (
        "`--clock-error`",
        "analyze drop.wav --clock-error 11%",
        "clock error is 0.11, expected 0 to 0.1, or 0 to 10 %",
    ),
    (
        "`--label-error`",
        "analyze drop.wav --impacts drop.txt --label-error 0s",
        "label error is 0, expected above 0",
    ),
    (
        "`--predict`, `--reach`",
        "analyze drop.wav --predict 10001m",
        "height is 10001, expected 1 µm to 10 km",
    ),
    (
        "`--reach-bounce`",
        "analyze drop.wav --reach 1m --reach-bounce 11",
        "11 is not in 1..=10",
    ),
    (
        "listen: `--rate`",
        "listen - --raw s16le --rate 159",
        "sample rate is 159, expected 160 Hz or more by default, 4 times the lowest frequency that is listened to",
    ),
    (
        "listen: `--channels`",
        "listen - --raw s16le --channels 65536",
        "65536 is not in 1..=65535",
    ),
    (
        "`--jobs`",
        "batch drop.wav --jobs 65536",
        "65536 is not in 1..=65535",
    ),
    (
        "scene: `sample_rate_hz`",
        "synth rate.toml -o x.wav",
        "sample_rate_hz is 768001, expected 1000 to 768000",
    ),
    (
        "scene: `duration_s`",
        "synth day.toml -o x.wav",
        "duration_s is 86401, expected 1 ms to a day",
    ),
    (
        "scene: samples",
        "synth long.toml -o x.wav",
        "the recording is 100000100 samples long, over all channels, expected 100000000 at most",
    ),
    (
        "scene: channels",
        "synth channels.toml -o x.wav",
        "channels is 65, expected 1 to 64",
    ),
    (
        "scene: impacts of a drop",
        "synth lively.toml -o x.wav",
        "bounce is so lively that more than 100000 impacts follow",
    ),
    (
        "scene: contact time",
        "synth contact.toml -o x.wav",
        "contact_time_s is 0, expected 1 ns to 1 s",
    ),
    (
        "solve: `--bounces`",
        "solve --bounces 0 --total-time 7.5s --height 30cm",
        "--bounces is 0, expected a whole number ≥ 1",
    ),
    (
        "solve: `--restitution`",
        "solve --restitution 1 --contact-time 1ms",
        "--restitution is 1, expected 0 < e < 1",
    ),
    (
        "solve: other numbers",
        "solve --restitution 0.9 --contact-time 1e61",
        "--contact-time is 1e61, expected a number > 0 (1e-60 to 1e60)",
    ),
    (
        "sheets of a recording",
        "analyze many.wav --plot many.svg",
        "--plot is for 101 drops, expected 100 drops at most",
    ),
];

/// Every option that takes a number, given one below zero.
const NEGATIVE: [&str; 31] = [
    "analyze drop.wav --height -30cm",
    "analyze drop.wav --height-error -1mm",
    "analyze drop.wav --mass -2.5g",
    "analyze drop.wav --diameter -38mm",
    "analyze drop.wav --contact-time -1ms",
    "analyze drop.wav --gravity -9.81m/s2",
    "analyze drop.wav --start -1s",
    "analyze drop.wav --end -1min",
    "analyze drop.wav --channel -1",
    "analyze drop.wav --track -1",
    "analyze drop.wav --impacts drop.txt --label-error -1ms",
    "analyze drop.wav --predict -1m",
    "analyze drop.wav --reach -1m",
    "listen - --raw s16le --rate -1",
    "listen - --raw s16le --channels -1",
    "batch drop.wav --jobs -2",
    "batch drop.wav --height -30cm",
    "batch drop.wav --contact-time -1ms",
    "synth --preset dead -o x.wav --seed -1",
    "synth --suite x --seeds -3",
    "solve --bounces -70 --total-time 7.5s --height 30.5cm",
    "solve --bounces 70 --total-time -7.5s --height 30.5cm",
    "solve --bounces 70 --total-time 7.5s --height -30.5cm",
    "solve --bounces 70 --total-time 7.5s --height 30.5cm --mass -2g",
    "solve --bounces 70 --total-time 7.5s --height 30.5cm --gravity -9.81m/s2",
    "solve --bounces 70 --total-time 7.5s --height 30.5cm --total-time-error -1ms",
    "solve --bounces 70 --total-time 7.5s --height 30.5cm --height-error -1mm",
    "solve --restitution -0.9 --contact-time 1ms",
    "solve --restitution 0.9 --contact-time -1ms",
    "solve --restitution 0.9 --contact-time 1ms --contact-time-error -1ms",
    "solve --restitution 0.9 --contact-time 1ms --mass 2g --mass-error -1mg",
];

fn run(folder: &Path, line: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_bounce-audio"))
        .current_dir(folder)
        .args(line.split_whitespace())
        .output()
        .unwrap()
}

fn wav(channels: u16, rate_hz: u32, before: &[u8], samples: &[u8]) -> Vec<u8> {
    let frame = channels * 2;
    let mut wav = b"RIFF\0\0\0\0WAVEfmt \x10\0\0\0\x01\0".to_vec();
    wav.extend(channels.to_le_bytes());
    wav.extend(rate_hz.to_le_bytes());
    wav.extend(rate_hz.wrapping_mul(frame.into()).to_le_bytes());
    wav.extend(frame.to_le_bytes());
    wav.extend(16_u16.to_le_bytes());
    wav.extend(before);
    wav.extend(b"data");
    wav.extend(u32::try_from(samples.len()).unwrap().to_le_bytes());
    wav.extend(samples);
    wav
}

/// Drops of clicks, one after the other.
fn drops(count: usize) -> Vec<u8> {
    let mut samples = vec![0_u8; 2 * 8_000 * 5 * count];
    for drop in 0..count {
        let (mut at_s, mut flight_s) = (5.0 * bounce_audio::units::real(drop) + 0.5, 0.3);
        for _ in 0..9 {
            let at = 2 * bounce_audio::units::samples_in(at_s, 8_000.0);
            samples[at..at + 8].copy_from_slice(&[0, 64, 0, 192, 0, 32, 0, 224]);
            at_s += flight_s;
            flight_s *= 0.8;
        }
    }
    wav(1, 8_000, b"", &samples)
}

/// A folder with a recording and its labels.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    // There is none on the first run.
    drop(fs::remove_dir_all(&folder));
    fs::create_dir_all(&folder).unwrap();
    let made = run(&folder, "synth --preset dead -o drop.wav");
    assert!(made.status.success());
    let labels = run(&folder, "analyze drop.wav --labels drop.txt");
    assert!(labels.status.success());
    folder
}

/// What is just beyond a limit.
fn add_recordings(folder: &Path) {
    for (name, bytes) in [
        ("159.wav", wav(1, 159, b"", &[1; 4_000])),
        ("fast.wav", wav(2, 768_001, b"", &[1; 4_000])),
        ("chunk.wav", wav(1, 8_000, b"JUNK\x02\0\0\x10", &[1; 4_000])),
        ("many.wav", drops(101)),
    ] {
        fs::write(folder.join(name), bytes).unwrap();
    }
    let mut wide = wav(1, 8_000, b"", &[1; 4_000]);
    wide[22..24].copy_from_slice(&32_768_u16.to_le_bytes());
    wide[32..34].copy_from_slice(&0_u16.to_le_bytes());
    fs::write(folder.join("wide.wav"), wide).unwrap();
}

fn add_scenes(folder: &Path) {
    let ball = |restitution: &str, contact: &str| {
        format!(
            "duration_s = 1.0\n[[drops]]\nheight_m = 0.15\nfirst_impact_s = 0.05\nmass_kg = 0.03\ndiameter_m = 0.02\n\
             bounce.constant = {{ restitution = {restitution}, contact_time_s = {contact} }}\n\
             modes = [{{ frequency_hz = 5200.0, decay_s = 0.006, level = 1.0 }}]\n"
        )
    };
    let channels = "{}, ".repeat(65);
    for (name, text) in [
        (
            "rate",
            "duration_s = 1.0\nsample_rate_hz = 768001\n".to_owned(),
        ),
        ("day", "duration_s = 86401.0\n".to_owned()),
        (
            "long",
            "duration_s = 50000.05\nsample_rate_hz = 1000\n[recorder]\nchannels = [{}, {}]\n"
                .to_owned(),
        ),
        (
            "channels",
            format!("duration_s = 1.0\n[recorder]\nchannels = [{channels}]\n"),
        ),
        ("lively", ball("0.99999", "1e-5")),
        ("contact", ball("0.9", "0.0")),
    ] {
        let text = format!("name = \"{name}\"\n{text}");
        fs::write(folder.join(format!("{name}.toml")), text).unwrap();
    }
}

#[test]
fn every_limit_that_is_stated_is_met_with_a_sentence() {
    let folder = folder("limits");
    add_recordings(&folder);
    add_scenes(&folder);
    let limits = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/limits.md"));
    let limits = limits.unwrap();
    let stated: Vec<&str> = limits
        .split("| what | limit |")
        .nth(1)
        .unwrap()
        .lines()
        .skip(2)
        .take_while(|line| line.starts_with('|'))
        .filter_map(|line| line.trim_matches('|').split(" | ").next())
        .map(str::trim)
        .collect();
    for (name, line, sentence) in LIMITS {
        assert!(
            stated.contains(&name),
            "{name} is not in docs/limits.md: {stated:?}"
        );
        let output = run(&folder, line);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}: {said}");
        assert!(said.contains(sentence), "{line}: {said}");
    }
    for name in stated {
        assert!(
            LIMITS.iter().any(|limit| limit.0 == name),
            "{name} is not tested"
        );
    }
    assert!(!folder.join("x.wav").exists());
}

#[test]
fn a_number_below_zero_is_taken_as_a_number() {
    let folder = folder("limits-negative");
    for line in NEGATIVE {
        let output = run(&folder, line);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{line}: {said}");
        assert!(!said.contains("unexpected argument"), "{line}: {said}");
        let named = said.contains("expected") || said.contains("invalid");
        assert!(named && said.contains('-'), "{line}: {said}");
    }
}
