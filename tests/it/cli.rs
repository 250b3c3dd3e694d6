//! The command as a user runs it: output, exit status, and one clear line for every error.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::common::{empty_folder, json, run, text};

fn folder(name: &str) -> PathBuf {
    empty_folder("cli", name)
}

/// A recording of a preset in a folder.
fn recording(folder: &Path, preset: &str) -> String {
    let path = folder.join(format!("{preset}.wav")).display().to_string();
    let made = run(&["synth", "--preset", preset, "-o", &path]);
    assert!(made.status.success(), "{}", text(&made.stderr));
    path
}

#[test]
fn text_answers_first() {
    let file = recording(&folder("text"), "steel");
    let output = run(&["analyze", &file]);
    assert_eq!(output.status.code(), Some(0));
    let lines: Vec<String> = text(&output.stdout).lines().map(str::to_owned).collect();
    let answer = lines[0].strip_prefix(&format!("{file}: e = 0.")).unwrap();
    assert!(
        answer.contains(" ± 0.00")
            && answer.contains(" (4")
            && answer.ends_with(" bounces in 3.1 s)"),
        "{lines:?}"
    );
    assert!(lines[1].starts_with("  range    0.8"), "{lines:?}");
    assert!(lines.len() <= 12, "{lines:?}");
    assert!(output.stderr.is_empty());
}

#[test]
fn text_fits_a_terminal_and_ends_with_one_line_feed() {
    let file = recording(&folder("width"), "pingpong");
    let named = [
        "analyze", &file, "--height", "30.5cm", "--mass", "2.7g", "--table",
    ];
    let named = text(&run(&named).stdout);
    assert!(
        named.contains("\nWarning: ") && named.contains(" N·s/m"),
        "{named}"
    );
    // The first line holds the path.
    for line in named.lines().skip(1) {
        assert!(line.chars().count() <= 80, "{line}");
    }
    assert_eq!(named.trim_end().len() + 1, named.len());
    // Times of a clean recording are exact to hundredths of a microsecond, and say so.
    let table = named.split("Models compared").next().unwrap();
    assert!(
        table.contains(" 0.01") && !table.contains("     0.0 "),
        "{named}"
    );
}

#[test]
fn a_contact_time_that_is_given_is_said_to_be() {
    let file = recording(&folder("given"), "steel");
    let arguments = ["analyze", file.as_str(), "--contact-time", "0.08ms"];
    let said = text(&run(&[&arguments[..], &["--table"]].concat()).stdout);
    assert!(
        said.contains("constant e, with the contact time given"),
        "{said}"
    );
    let model = &json(&arguments)["drops"][0]["model"];
    assert_eq!(model["selected"], "constant");
    assert_eq!(model["given"], serde_json::json!(["contact_time"]));
}

#[test]
fn json_has_the_fields_of_the_contract() {
    let file = recording(&folder("json"), "steel");
    let document = json(&["analyze", &file, "--height", "15cm"]);
    assert_eq!(document["schema_version"], 1);
    assert_eq!(document["recording"]["sample_rate_hz"], 44_100.0);
    assert_eq!(document["settings"]["height_m"], 0.15);
    let drop = &document["drops"][0];
    for field in [
        "channel",
        "impacts",
        "bounces",
        "observed_time_s",
        "total_time_s",
        "restitution",
        "estimates",
        "scatter",
        "model",
        "ball",
        "rejected",
        "warnings",
    ] {
        assert!(drop.get(field).is_some(), "{field} is missing");
    }
    for field in [
        "time_s",
        "time_std_s",
        "level_db",
        "interval_s",
        "status",
        "rebound_height_m",
        "rebound_height_std_m",
        "rebound_speed_m_per_s",
        "rebound_speed_std_m_per_s",
        "impact_speed_m_per_s",
        "impact_speed_std_m_per_s",
        "restitution",
        "restitution_std",
        "energy_kept",
        "energy_kept_std",
    ] {
        let of = |impact: usize| drop["impacts"][impact].get(field);
        assert!(of(0).is_some(), "{field} is missing");
        // The first has no flight before it; the second has all.
        assert!(of(1).is_some_and(|v| !v.is_null()), "{field} is null");
    }
    assert!(drop["impacts"][0]["restitution"].is_null());
    for field in ["flight_ratio", "eq25", "eq30", "first_rebound"] {
        let e = drop["estimates"][field]["value"]
            .as_f64()
            .unwrap_or_else(|| panic!("{field} is null"));
        assert!((e - 0.9).abs() < 0.02, "{field}: {e}");
    }
    let [low, high] = [0, 1].map(|i| drop["restitution"]["interval95"][i].as_f64().unwrap());
    let e = drop["restitution"]["value"].as_f64().unwrap();
    assert!(low < e && e < high && drop["restitution"]["std_error"].as_f64().unwrap() > 0.0);
    assert!(drop["impacts"].as_array().unwrap().last().unwrap()["interval_s"].is_null());
}

#[test]
fn without_a_height_there_is_no_total_time() {
    let file = recording(&folder("no-height"), "steel");
    let drop = &json(&["analyze", &file])["drops"][0];
    assert!(drop["total_time_s"].is_null() && drop["estimates"]["eq25"].is_null());
    assert!(drop["estimates"]["flight_ratio"]["value"].is_number());
}

#[test]
fn csv_has_a_row_per_impact() {
    let file = recording(&folder("csv"), "steel");
    let drop = &json(&["analyze", &file])["drops"][0];
    let output = text(&run(&["analyze", &file, "--format", "csv"]).stdout);
    let rows: Vec<Vec<&str>> = output.lines().map(|l| l.split(',').collect()).collect();
    assert_eq!(rows.len(), 1 + drop["impacts"].as_array().unwrap().len());
    assert_eq!(rows[0][3], "time_s");
    assert_eq!(
        rows[1][3].parse::<f64>().ok(),
        drop["impacts"][0]["time_s"].as_f64()
    );
    assert!(rows.iter().all(|r| r.len() == rows[0].len()), "{output}");
}

#[test]
fn without_a_drop_rows_are_missing_for_a_reason() {
    let file = recording(&folder("no-rows"), "noise");
    for (arguments, rows) in [(&["--format", "csv"][..], 1), (&["-q"], 0)] {
        let output = run(&[&["analyze", file.as_str()], arguments].concat());
        assert_eq!(output.status.code(), Some(1));
        assert_eq!(text(&output.stdout).lines().count(), rows);
        let said = text(&output.stderr);
        assert!(
            said.contains("no drop: no sound stands out clearly"),
            "{said}"
        );
    }
}

#[test]
fn an_error_is_json_where_json_was_asked_for() {
    for (arguments, error, file) in [
        (
            &["analyze", "no.wav"][..],
            "there is no such file",
            Value::from("no.wav"),
        ),
        (
            &["analyze", "no.wav", "--height", "1kg"],
            "a length such as",
            Value::Null,
        ),
        (
            &["solve", "--restitution", "2", "--contact-time", "1ms"],
            "0 < e < 1",
            Value::Null,
        ),
    ] {
        let output = run(&[arguments, &["--format", "json"]].concat());
        assert_eq!(output.status.code(), Some(2));
        let document: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert!(
            document["error"].as_str().unwrap().contains(error),
            "{document}"
        );
        assert_eq!(document["file"], file);
        assert!(
            text(&output.stderr).contains(error),
            "{}",
            text(&output.stderr)
        );
    }
}

#[test]
fn a_mass_in_grams_is_the_decimal_number_that_was_typed() {
    let file = recording(&folder("grams"), "dead");
    let document = json(&["analyze", &file, "--mass", "45.9g", "--height", "12 inches"]);
    assert_eq!(document["settings"]["mass_kg"], 0.0459);
    assert_eq!(document["settings"]["height_m"], 0.3048);
}

#[test]
fn a_cut_recording_says_so() {
    let file = recording(&folder("cut"), "pingpong");
    let codes = |arguments: &[&str]| -> Vec<String> {
        let document = json(&[&["analyze", file.as_str()], arguments].concat());
        let warnings = document["drops"][0]["warnings"].as_array().unwrap().clone();
        warnings
            .iter()
            .map(|w| w["code"].as_str().unwrap().to_owned())
            .collect()
    };
    assert!(
        !codes(&["--height", "30.5cm"])
            .iter()
            .any(|c| c == "cut_end")
    );
    assert!(codes(&["--height", "30.5cm", "--end", "3"]).contains(&"cut_end".to_owned()));
    assert!(
        codes(&["--height", "30.5cm", "--start", "1.5"])
            .contains(&"first_impact_missing".to_owned())
    );
    assert!(codes(&["--height", "10cm"]).contains(&"height_too_small".to_owned()));
}

#[test]
fn start_and_end_leave_times_as_they_are() {
    let file = recording(&folder("window"), "steel");
    let first = |arguments: &[&str]| {
        json(&[&["analyze", file.as_str()], arguments].concat())["drops"][0]["impacts"][1]["time_s"]
            .as_f64()
            .unwrap()
    };
    assert!((first(&[]) - first(&["--start", "0.4s", "--end", "3.5"])).abs() < 1e-6);
}

#[test]
fn a_pipe_gives_what_the_file_gives() {
    let file = recording(&folder("pipe"), "steel");
    let mut child = Command::new(env!("CARGO_BIN_EXE_bounce-audio"))
        .args(["analyze", "-", "--format", "json"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    child
        .stdin
        .take()
        .unwrap()
        .write_all(&fs::read(&file).unwrap())
        .unwrap();
    let mut piped: Value =
        serde_json::from_slice(&child.wait_with_output().unwrap().stdout).unwrap();
    piped["file"] = Value::from(file.as_str());
    assert_eq!(piped["drops"].as_array().unwrap().len(), 1);
    assert_eq!(piped, json(&["analyze", &file]));
}

/// Two channels in one file: the first holds hiss, the second the drop.
fn stereo(folder: &Path) -> String {
    let drop = hound::WavReader::open(recording(folder, "steel"))
        .unwrap()
        .into_samples::<i16>();
    let spec = hound::WavSpec {
        channels: 2,
        sample_rate: 44_100,
        bits_per_sample: 16,
        sample_format: hound::SampleFormat::Int,
    };
    let path = folder.join("stereo.wav");
    let mut writer = hound::WavWriter::create(&path, spec).unwrap();
    let mut rng = bounce_audio::random::SplitMix64::new(1);
    for sample in drop {
        #[expect(
            clippy::cast_possible_truncation,
            reason = "hiss of a few hundred steps"
        )]
        writer.write_sample((300.0 * rng.normal()) as i16).unwrap();
        writer.write_sample(sample.unwrap()).unwrap();
    }
    writer.finalize().unwrap();
    path.display().to_string()
}

#[test]
fn the_clearest_channel_or_the_users_is_listened_to() {
    let file = stereo(&folder("stereo"));
    let best = json(&["analyze", &file]);
    assert_eq!(
        (
            &best["recording"]["channel"],
            best["drops"].as_array().unwrap().len()
        ),
        (&Value::from(2), 1)
    );
    assert_eq!(best["drops"][0]["channel"], 2);
    let second = json(&["analyze", &file, "--channel", "2"]);
    assert_eq!(second, best);
    let first = run(&["analyze", &file, "--channel", "1"]);
    assert_eq!(first.status.code(), Some(1));
    let third = run(&["analyze", &file, "--channel", "3"]);
    assert_eq!(third.status.code(), Some(2));
    assert!(text(&third.stderr).contains("--channel is 3"));
}

#[test]
fn no_drop_is_status_1_with_a_document_and_a_reason() {
    for preset in ["silence", "noise"] {
        let file = recording(&folder("none"), preset);
        let output = run(&["analyze", &file, "--format", "json"]);
        assert_eq!(output.status.code(), Some(1));
        let document: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(document["drops"].as_array().unwrap().len(), 0);
        assert!(document["warnings"][0]["message"].as_str().unwrap().len() > 20);
        let spoken = run(&["analyze", &file]);
        assert!(
            text(&spoken.stdout).contains("no drop found")
                && text(&spoken.stdout).contains("Warning: ")
        );
    }
}

#[test]
fn what_cannot_be_read_is_one_line_and_status_2() {
    let folder = folder("unreadable");
    let empty = folder.join("empty.wav");
    fs::write(&empty, "").unwrap();
    let words = folder.join("words.wav");
    fs::write(
        &words,
        "Dear diary, today I bounced a ball and forgot to press record.\n",
    )
    .unwrap();
    let headless = folder.join("no-samples.wav");
    let spec = hound::WavSpec {
        channels: 1,
        sample_rate: 44_100,
        bits_per_sample: 16,
        sample_format: hound::SampleFormat::Int,
    };
    hound::WavWriter::create(&headless, spec)
        .unwrap()
        .finalize()
        .unwrap();
    for (path, reason) in [
        (
            folder.join("missing.wav"),
            "there is no such file or folder\n",
        ),
        (folder.clone(), "directory"),
        (empty, "empty"),
        (words, "none of WAV, FLAC"),
        (headless, "no audio"),
    ] {
        let output = run(&["analyze", &path.display().to_string()]);
        let error = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{error}");
        assert!(output.stdout.is_empty());
        assert_eq!(error.lines().count(), 1, "{error}");
        assert!(
            error.contains(&path.display().to_string()) && error.contains(reason),
            "{error}"
        );
    }
}

#[test]
fn wrong_arguments_name_themselves() {
    let file = recording(&folder("arguments"), "steel");
    for (arguments, expected) in [
        (&["--height", "30.5kg"][..], "30.5cm"),
        (&["--height", "-1"], "height"),
        (
            &["--height", "30.5"],
            "did you mean 30.5cm? If not, write 30.5m",
        ),
        (&["--mass", "2.7"], "did you mean 2.7g?"),
        (&["--height", "30,5cm"], "a decimal point and no comma"),
        (&["--gravity", "0"], "gravity"),
        (&["--start", "5", "--end", "4"], "end is 4"),
        (&["--start", "1000"], "within the recording"),
        (&["--channel", "zero"], "a number from 1"),
        (&["--format", "xml"], "json"),
    ] {
        let output = run(&[&["analyze", file.as_str()], arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(
            text(&output.stderr).contains(expected),
            "{arguments:?}: {}",
            text(&output.stderr)
        );
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn synth_is_repeatable_to_the_byte_and_names_what_it_wrote() {
    let folder = folder("synth");
    let paths = ["a.wav", "b.wav"].map(|name| folder.join(name));
    for path in &paths {
        let output = run(&[
            "synth",
            "--preset",
            "rubber",
            "--seed",
            "7",
            "-o",
            &path.display().to_string(),
        ]);
        assert!(
            text(&output.stdout).contains("impacts: 22"),
            "{}",
            text(&output.stdout)
        );
    }
    assert_eq!(fs::read(&paths[0]).unwrap(), fs::read(&paths[1]).unwrap());
    let truth: Value =
        serde_json::from_slice(&fs::read(folder.join("a.truth.json")).unwrap()).unwrap();
    assert_eq!(truth["drops"][0]["restitution"], 0.75);
    let bad = run(&["synth", "--preset", "feather", "-o", "x.wav"]);
    assert_eq!(bad.status.code(), Some(2));
    assert!(text(&bad.stderr).contains("steel"), "{}", text(&bad.stderr));
}
