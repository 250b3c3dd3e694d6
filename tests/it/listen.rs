//! `bounce-audio listen`: from a stream to lines, files and statuses.

use std::fs;
use std::io::Write;
use std::process::{Command, Stdio};

use serde_json::Value;

use bounce_audio::synth::presets::preset;
use bounce_audio::synth::render;

use crate::common::empty_folder;

/// Bare samples of 16 bits: a drop of a ping-pong ball, twice, and its rate.
fn twice() -> (Vec<u8>, u32, f64) {
    let made = render(&preset("pingpong").unwrap(), 1).unwrap();
    let e = made.truth.drops[0].restitution;
    let both = made.samples.iter().chain(&made.samples);
    let bytes = both.flat_map(|x| {
        #[expect(clippy::cast_possible_truncation, reason = "full scale is 1")]
        let step = (x * 32_767.0) as i16;
        step.to_le_bytes()
    });
    (bytes.collect(), made.truth.sample_rate_hz, e)
}

/// What is written, said and the status, of bytes on standard input.
fn listen(words: &[&str], input: &[u8]) -> (String, String, i32) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_bounce-audio"))
        .arg("listen")
        .args(words)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // One that ends early leaves its input.
    child.stdin.take().unwrap().write_all(input).ok();
    let done = child.wait_with_output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (
        text(done.stdout),
        text(done.stderr),
        done.status.code().unwrap(),
    )
}

#[test]
fn each_drop_has_a_line_and_a_file_that_gives_it_again() {
    let folder = empty_folder("listen", "saved");
    let kept = folder.join("drops");
    let (bytes, rate, e) = twice();
    let rate = rate.to_string();
    let words = ["-", "--raw", "s16le", "--rate", &rate, "--save"];
    let (out, err, status) = listen(&[&words[..], &[kept.to_str().unwrap()]].concat(), &bytes);
    assert_eq!((err.as_str(), status), ("", 0));
    let lines: Vec<&str> = out.lines().collect();
    assert!(lines[0].starts_with("  1  e = 0.9"), "{out}");
    assert!(
        lines[1].starts_with("  2  e = 0.9") && lines[1].ends_with(" of 2 drops"),
        "{out}"
    );
    assert!(out.contains("\n  mean e   0.9"), "{out}");
    for number in ["001", "002"] {
        let stem = kept.join(format!("drop-{number}"));
        let read = bounce_audio::audio::read_file(&stem.with_extension("wav")).unwrap();
        let settings = bounce_audio::Settings::default();
        let found =
            bounce_audio::analyze(&read.channels[0], f64::from(read.sample_rate_hz), &settings);
        let drop = &found.unwrap().drops[0];
        let estimate = drop.restitution.as_ref().unwrap().estimate;
        let off = (estimate.value - e).abs();
        assert!(off < 3.0 * estimate.std_error.unwrap(), "{number}: {off}");
        let frames = u32::try_from(read.channels[0].len()).unwrap();
        let held_s = f64::from(frames) / f64::from(read.sample_rate_hz);
        let labels = fs::read_to_string(stem.with_extension("txt")).unwrap();
        let first_s: f64 = labels.split('\t').next().unwrap().parse().unwrap();
        let last = labels.lines().next_back().unwrap();
        let last_s: f64 = last.split('\t').next().unwrap().parse().unwrap();
        assert!((first_s - 0.5).abs() < 0.01, "{number}: {first_s}");
        let after_s = held_s - last_s;
        assert!((after_s - 0.5).abs() < 0.01, "{number}: {after_s} s");
        assert!(
            (first_s - drop.impacts[0].time_s).abs() < 1e-4,
            "{number}: {first_s}"
        );
    }
    // What is there stays: a second time goes on counting.
    listen(&[&words[..], &[kept.to_str().unwrap()]].concat(), &bytes);
    let mut names: Vec<_> = fs::read_dir(&kept)
        .unwrap()
        .map(|e| e.unwrap().file_name())
        .collect();
    names.sort();
    assert_eq!(names.len(), 8, "{names:?}");
    assert_eq!(names[7], "drop-004.wav");
}

#[test]
fn a_line_of_json_for_each_drop_says_its_number() {
    let (bytes, rate, e) = twice();
    let rate = rate.to_string();
    let words = ["-", "--raw", "s16le", "--rate", &rate, "--format", "ndjson"];
    let (out, _, status) = listen(&words, &bytes);
    let lines: Vec<Value> = out
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    let numbers: Vec<u64> = lines
        .iter()
        .map(|l| l["number"].as_u64().unwrap())
        .collect();
    assert_eq!((numbers.as_slice(), status), (&[1, 2][..], 0));
    for line in &lines {
        let value = line["drop"]["restitution"]["value"].as_f64().unwrap();
        assert!((value - e).abs() < 5e-3, "{value}");
    }
}

#[cfg(unix)]
#[test]
fn a_command_is_listened_to_and_its_failure_is_told() {
    let folder = empty_folder("listen", "command");
    let (bytes, rate, _) = twice();
    fs::write(folder.join("sound"), &bytes).unwrap();
    let rate = rate.to_string();
    let play = format!("cat '{}'", folder.join("sound").display());
    let of = |command: &str| listen(&["--from", command, "--raw", "s16le", "--rate", &rate], b"");
    let (out, err, status) = of(&play);
    assert_eq!(
        (out.lines().count() > 2, err.as_str(), status),
        (true, "", 0)
    );
    // What was repaired is told at the end.
    let cut = folder.join("cut.m4a");
    let whole = include_bytes!("../../fixtures/compressed/drop.m4a");
    fs::write(&cut, &whole[..whole.len() * 2 / 3]).unwrap();
    let cat = format!("cat '{}'", cut.display());
    let (_, err, _) = listen(&["--from", &cat], b"");
    assert!(
        err.contains(&format!("the command {cat}: the file is cut")),
        "{err}"
    );
    // The drops that were heard before are told.
    let (out, err, status) = of(&format!("{play}; exit 3"));
    assert!(
        out.contains("  2  e = 0.9") && err.contains("exit status: 3"),
        "{out}{err}"
    );
    assert_eq!(status, 2);
}

#[test]
fn what_holds_no_drop_or_no_sound_is_said() {
    let (out, err, status) = listen(&["-", "--raw", "s16le"], &[0; 200_000]);
    assert_eq!((out.as_str(), status), ("", 1));
    assert!(err.contains("no drop was heard"), "{err}");
    let (_, err, status) = listen(&["-"], b"");
    assert!(
        err.contains("standard input") && err.contains("empty"),
        "{err}"
    );
    assert_eq!(status, 2);
    for words in [
        &["-", "--rate", "48000"][..],
        &["drop.wav"],
        &["-", "--raw", "s16le", "--channels", "0"],
        &["-", "--raw", "s16le", "--rate", "0"],
    ] {
        let (_, err, status) = listen(words, b"");
        assert_eq!(status, 2, "{words:?}: {err}");
    }
    let many = "- --raw s16le --rate 48000 --channels 33";
    for (more, said) in [
        ("", "listen to one of them with --channel"),
        (" --channel 34", "--channel is 34 of a recording with 33"),
    ] {
        let line = format!("{many}{more}");
        let words: Vec<&str> = line.split(' ').collect();
        let (_, err, status) = listen(&words, &[0; 66]);
        assert!(status == 2 && err.contains(said), "{err}");
    }
}

#[test]
fn who_names_a_file_is_told_what_listen_takes_and_what_reads_files() {
    for (given, command) in [
        ("nothere.wav", "bounce-audio analyze nothere.wav\n"),
        ("my drop.m4a", "bounce-audio analyze 'my drop.m4a'\n"),
    ] {
        let (out, err, status) = listen(&[given], b"");
        assert_eq!((out.as_str(), status), ("", 2));
        assert!(err.contains("a recorder, which it starts, or a pipe, which is -"));
        assert!(err.ends_with(command), "{err}");
    }
}
