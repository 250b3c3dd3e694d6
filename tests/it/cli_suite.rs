//! `synth` and `evaluate` as a user runs them.

use std::fs;
use std::path::{Path, PathBuf};

use bounce_audio::audio;
use bounce_audio::synth::recorder::{Channel, Encoding};
use bounce_audio::synth::{render, scene::Scene};
use serde_json::Value;

use crate::common::{empty_folder, run, text};

const SCENE: &str = r"
name = 'small'
duration_s = 1.5
[[drops]]
height_m = 0.05
first_impact_s = 0.2
mass_kg = 0.03
diameter_m = 0.02
bounce.constant = { restitution = 0.8, contact_time_s = 1e-4 }
modes = [{ frequency_hz = 3000.0, decay_s = 4e-3, level = 1.0 }]
";

fn folder(name: &str) -> PathBuf {
    empty_folder("suite", name)
}

/// A recording of [`SCENE`] with more lines, made by the command.
fn made(folder: &Path, more: &str) -> PathBuf {
    let (scene, wav) = (folder.join("small.toml"), folder.join("small.wav"));
    fs::write(&scene, format!("{SCENE}\n{more}")).unwrap();
    let output = run(&[
        "synth",
        &scene.display().to_string(),
        "-o",
        &wav.display().to_string(),
    ]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    wav
}

#[test]
fn every_encoding_and_channel_is_written_as_it_was_made() {
    let folder = folder("encodings");
    for (name, encoding) in [
        ("int8", Encoding::Int8),
        ("int16", Encoding::Int16),
        ("int24", Encoding::Int24),
        ("int32", Encoding::Int32),
        ("float32", Encoding::Float32),
    ] {
        let more = format!(
            "[recorder]\nencoding = '{name}'\nchannels = [{{}}, {{ delay_s = 1e-3, inverted = true }}]"
        );
        let read = audio::read_file(&made(&folder, &more)).unwrap();
        let mut scene = Scene::from_toml(SCENE).unwrap();
        scene.recorder.encoding = encoding;
        scene.recorder.channels.push(Channel {
            delay_s: 1e-3,
            inverted: true,
            ..Channel::default()
        });
        let expected = render(&scene, 1).unwrap();
        assert_eq!(read.channels.len(), 2);
        assert!(read.channels[0] == expected.samples, "{name}");
        assert!(read.channels[1] == expected.more_channels[0], "{name}");
    }
}

#[test]
fn presets_are_listed_with_what_they_show() {
    let output = run(&["synth", "--list"]);
    let lines = text(&output.stdout);
    assert!(
        lines.lines().count() >= 24 && lines.contains("pingpong "),
        "{lines}"
    );
    assert!(lines.contains("odd-bounce "), "{lines}");
}

#[test]
fn the_second_suite_is_asked_for_with_a_folder() {
    for (arguments, named) in [
        (vec!["--found"], "--suite"),
        (vec!["--preset", "steel", "--found"], "cannot be used with"),
    ] {
        let output = run(&[&["synth"], arguments.as_slice()].concat());
        assert_eq!(output.status.code(), Some(2));
        assert!(text(&output.stderr).contains(named), "{arguments:?}");
    }
}

#[test]
fn a_scene_that_is_none_is_refused_in_one_message_that_names_the_file() {
    let folder = folder("bad-scene");
    let scene = folder.join("bad.toml");
    fs::write(&scene, SCENE.replace("height_m", "hieght_m")).unwrap();
    let scene = scene.display().to_string();
    for arguments in [
        vec!["synth", &scene, "-o", "x.wav"],
        vec!["synth", "--preset", "no-such", "-o", "x.wav"],
        vec!["synth", "--preset", "steel"],
        vec!["synth", "missing.toml", "-o", "x.wav"],
    ] {
        let output = run(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(
            text(&output.stderr).starts_with("bounce-audio: "),
            "{arguments:?}"
        );
    }
    let message = text(&run(&["synth", &scene, "-o", "x.wav"]).stderr);
    assert!(
        message.contains("bad.toml") && message.contains("hieght_m"),
        "{message}"
    );
}

#[test]
fn evaluation_says_how_well_and_how_fast() {
    let folder = folder("evaluate");
    made(&folder, "");
    let path = folder.display().to_string();
    let output = run(&["evaluate", &path, "--format", "json"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(document["limit_audio_s_per_s"].as_f64().unwrap() > 0.0);
    for (row, timing) in ["envelope", "fraction", "correlation"].iter().enumerate() {
        let row = &document["rows"][row];
        assert_eq!(row["timing"], *timing);
        assert!(row["recall"].as_f64().unwrap() > 0.9, "{row}");
        assert!(row["of_limit"].as_f64().unwrap() > 0.0, "{row}");
    }
    assert_eq!(document["scenes"][0]["scene"], "small");
    assert!(text(&run(&["evaluate", &path]).stdout).contains("correlation"));
}

#[test]
fn labels_serve_as_truth() {
    let folder = folder("labels");
    let wav = made(&folder, "");
    let truth_path = wav.with_extension("truth.json");
    let truth: Value = serde_json::from_slice(&fs::read(&truth_path).unwrap()).unwrap();
    fs::remove_file(truth_path).unwrap();
    let onsets = truth["drops"][0]["onsets_s"].as_array().unwrap();
    let labels = onsets.iter().take(9).map(|t| format!("{t}\t{t}\thit\n"));
    fs::write(wav.with_extension("txt"), labels.collect::<String>()).unwrap();
    let path = folder.display().to_string();
    let output = run(&["evaluate", &path, "--format", "json"]);
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["rows"][2]["audible"], 9);
    assert!(document["rows"][2]["recall"].as_f64().unwrap() > 0.8);
    assert!(document["rows"][2]["efficiency"].is_null());
}

#[test]
fn a_missed_threshold_is_status_1_and_nothing_to_evaluate_is_2() {
    let folder = folder("thresholds");
    let path = folder.display().to_string();
    let nothing = run(&["evaluate", &path]);
    assert_eq!(nothing.status.code(), Some(2));
    assert!(text(&nothing.stderr).contains("truth"));
    made(&folder, "");
    let file = folder.join("thresholds.toml");
    let thresholds = file.display().to_string();
    assert!(
        run(&["evaluate", &path, "--tighten", &thresholds])
            .status
            .success()
    );
    assert_eq!(
        run(&["evaluate", &path, "--check", &thresholds])
            .status
            .code(),
        Some(0)
    );
    let strict = fs::read_to_string(&file).unwrap() + "\n[other]\nrecall = 1.0\n";
    fs::write(&file, strict).unwrap();
    let missed = run(&["evaluate", &path, "--check", &thresholds]);
    assert_eq!(missed.status.code(), Some(1));
    assert!(text(&missed.stdout).contains("missed: other: not evaluated"));
}
