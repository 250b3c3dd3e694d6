//! Balls that are caught after two impacts or three, from the recording to the answer and back from labels.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::{empty_folder, json, only_drop, run, synthesized, text};

/// A ball of e = 0.78 from 1 m that is caught after so many impacts, at 44.1 kHz.
fn caught(folder: &Path, impacts: usize) -> String {
    caught_with(folder, impacts, 4e-3)
}

/// Such a ball whose sound fades to 1/e in so many seconds.
fn caught_with(folder: &Path, impacts: usize, decay_s: f64) -> String {
    let scene = format!(
        "name = 'caught'\nsample_rate_hz = 44100\nduration_s = 4.0\npeak_db = -3.0\nnoise.white_db = -62.0\n\
         [[drops]]\nheight_m = 1.0\nmass_kg = 0.05\ndiameter_m = 0.04\ndrag = false\nfirst_impact_s = 1.2\n\
         bounce.constant = {{ restitution = 0.78, contact_time_s = 1e-3 }}\nmost_impacts = {impacts}\n\
         modes = [{{ frequency_hz = 1200.0, decay_s = {decay_s}, level = 1.0 }}]\n"
    );
    synthesized(folder, &format!("caught-{impacts}"), &scene)
}

fn codes(of: &Value) -> Vec<&str> {
    let warnings = of["warnings"].as_array().unwrap();
    warnings
        .iter()
        .map(|w| w["code"].as_str().unwrap())
        .collect()
}

/// e is held by its interval, and that is no wider than a twentieth.
fn assert_holds(restitution: &Value, method: &str) {
    assert_eq!(restitution["method"], method, "{restitution}");
    let end = |i: usize| restitution["interval95"][i].as_f64().unwrap();
    let held = (end(0)..=end(1)).contains(&0.78) && end(1) - end(0) < 0.1;
    assert!(held, "{restitution}");
}

#[test]
fn two_impacts_and_a_height_give_e_of_the_first_and_the_rebound() {
    let folder = empty_folder("few", "two");
    let document = json(&["analyze", &caught(&folder, 2), "--height", "1m"]);
    let drop = only_drop(&document);
    assert_eq!(
        (drop["bounces"].as_u64(), codes(drop)),
        (Some(2), vec!["few_bounces"])
    );
    assert_holds(&drop["restitution"], "first_rebound");
    assert_eq!(
        drop["estimates"]["first_rebound"]["value"],
        drop["restitution"]["value"]
    );
    let first = &drop["impacts"][0];
    assert_eq!(first["restitution"], drop["restitution"]["value"]);
    let off = first["rebound_height_m"].as_f64().unwrap() - 0.78 * 0.78;
    let std = first["rebound_height_std_m"].as_f64().unwrap();
    assert!(off.abs() < 3.0 * std && std < 0.01, "{off} {std}");
    // What is an impact is not rejected too.
    let time_s = |of: &Value| of["time_s"].as_f64().unwrap();
    let impacts: Vec<f64> = drop["impacts"]
        .as_array()
        .unwrap()
        .iter()
        .map(time_s)
        .collect();
    let rejected = document["rejected"].as_array().unwrap().iter().map(time_s);
    let mut both = rejected.filter(|t| impacts.iter().any(|i| (i - t).abs() < 2e-3));
    assert_eq!(both.next(), None);
}

#[test]
fn an_error_of_the_height_is_one_of_e() {
    let folder = empty_folder("few", "height");
    let wav = caught(&folder, 2);
    let std = |error: &str| {
        let document = json(&["analyze", &wav, "--height", "1m", "--height-error", error]);
        only_drop(&document)["restitution"]["std_error"]
            .as_f64()
            .unwrap()
    };
    // σ_e = e·σ_h/2h where the height rules.
    let by_height = 0.78 * 0.05 / 2.0;
    assert!((std("5cm") / by_height - 1.0).abs() < 0.1 && std("1mm") < 0.3 * by_height);
}

#[test]
fn two_impacts_without_a_height_have_a_rebound_and_no_e() {
    let folder = empty_folder("few", "bare");
    let document = json(&["analyze", &caught(&folder, 2)]);
    let drop = only_drop(&document);
    assert!(drop["restitution"].is_null() && codes(drop).contains(&"few_bounces"));
    assert!(drop["impacts"][0]["rebound_height_m"].as_f64().unwrap() > 0.5);
}

#[test]
fn three_impacts_give_one_ratio_with_the_error_of_a_single_bounce() {
    let folder = empty_folder("few", "three");
    let wav = caught(&folder, 3);
    assert_holds(
        &only_drop(&json(&["analyze", &wav]))["restitution"],
        "single_ratio",
    );
    let with_height = json(&["analyze", &wav, "--height", "1m"]);
    assert_holds(&only_drop(&with_height)["restitution"], "first_rebound");
}

#[test]
fn a_height_that_does_not_allow_the_flight_gives_no_drop_and_one_impact_says_why() {
    let folder = empty_folder("few", "none");
    let wav = caught(&folder, 2);
    for height in ["0.4m", "30m"] {
        let document = json(&["analyze", &wav, "--height", height]);
        assert_eq!(document["drops"].as_array().unwrap().len(), 0, "{document}");
    }
    let one = json(&["analyze", &caught(&folder, 1), "--height", "1m"]);
    let message = one["warnings"][0]["message"].as_str().unwrap();
    assert!(
        message.starts_with("one sharp sound, which is no flight"),
        "{message}"
    );
}

#[test]
fn labels_of_two_impacts_are_fitted() {
    let folder = empty_folder("few", "labels");
    let wav = caught(&folder, 2);
    let labels = folder.join("two.txt").display().to_string();
    let written = run(&["analyze", &wav, "--height", "1m", "--labels", &labels]);
    assert!(written.status.success(), "{}", text(&written.stderr));
    assert_eq!(fs::read_to_string(&labels).unwrap().lines().count(), 2);
    let heard = json(&["analyze", &wav, "--height", "1m"]);
    let fitted = json(&["analyze", &wav, "--height", "1m", "--impacts", &labels]);
    assert_eq!(
        only_drop(&heard)["restitution"],
        only_drop(&fitted)["restitution"]
    );
}

#[test]
fn what_comes_nearest_to_a_drop_is_said_written_as_labels_and_can_be_fitted() {
    let folder = empty_folder("few", "candidate");
    let wav = folder.join("knocks.wav").display().to_string();
    let scene = folder.join("knocks.toml");
    // A drop of two impacts among two other sounds like it.
    let content = "name = 'knocks'\nduration_s = 6.0\nsample_rate_hz = 44100\nnoise.white_db = -62.0\n\
                   [[noise.taps]]\nfirst_s = 1.0\ncount = 2\ninterval_s = 0.7\nlevel_db = -6.0\ncontact_time_s = 5e-4\n\
                   modes = [{ frequency_hz = 1200.0, decay_s = 4e-3, level = 1.0 }]\n\
                   [[noise.taps]]\nfirst_s = 3.1\ncount = 1\ninterval_s = 1.0\nlevel_db = -8.0\ncontact_time_s = 5e-4\n\
                   modes = [{ frequency_hz = 1200.0, decay_s = 4e-3, level = 1.0 }]\n";
    fs::write(&scene, content).unwrap();
    let made = run(&["synth", &scene.display().to_string(), "-o", &wav]);
    assert!(made.status.success(), "{}", text(&made.stderr));
    let document = json(&["analyze", &wav, "--height", "1m"]);
    let candidate = &document["candidate"];
    let (nats, needed) = (&candidate["evidence_nats"], &candidate["needed_nats"]);
    assert!(
        nats.as_f64().unwrap() < needed.as_f64().unwrap(),
        "{document}"
    );
    let message = document["warnings"][0]["message"].as_str().unwrap();
    assert!(
        message.contains(" to 1 are needed") && message.contains("as labels"),
        "{message}"
    );
    let said = text(&run(&["analyze", &wav, "--height", "1m"]).stdout);
    assert!(said.contains("(--labels and --impacts)"), "{said}");
    let labels = folder.join("candidate.txt").display().to_string();
    let none = run(&["analyze", &wav, "--height", "1m", "--labels", &labels]);
    assert_eq!(none.status.code(), Some(1));
    let fitted = json(&["analyze", &wav, "--height", "1m", "--impacts", &labels]);
    let (taken, offered) = (&only_drop(&fitted)["impacts"], &candidate["impacts"]);
    assert_eq!(
        taken.as_array().unwrap().len(),
        offered.as_array().unwrap().len()
    );
    assert_eq!(taken[0]["time_s"], offered[0]["time_s"]);
}

#[test]
fn two_sounds_that_last_are_no_drop() {
    let folder = empty_folder("few", "long");
    let document = json(&["analyze", &caught_with(&folder, 2, 0.15), "--height", "1m"]);
    assert!(document["drops"].as_array().unwrap().is_empty());
}
