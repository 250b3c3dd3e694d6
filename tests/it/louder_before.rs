//! Sounds like the first impacts that stand before a drop, from the recording to the warning.

use serde_json::Value;

use crate::common::{empty_folder, json, run, text};

/// Makes the recording of a preset.
fn made(name: &str) -> String {
    let folder = empty_folder("louder-before", name);
    let wav = folder.join("made.wav").display().to_string();
    let made = run(&["synth", "--preset", name, "-o", &wav]);
    assert!(made.status.success(), "{}", text(&made.stderr));
    wav
}

/// The message of the warning of each drop that has it.
fn said(document: &Value) -> Vec<&str> {
    let drops = document["drops"].as_array().unwrap().iter();
    let warnings = drops.flat_map(|d| d["warnings"].as_array().unwrap());
    let said = warnings.filter(|w| w["code"] == "louder_before");
    said.map(|w| w["message"].as_str().unwrap()).collect()
}

#[test]
fn knocks_before_a_drop_are_named_until_they_are_left_out() {
    let wav = made("knocked-before");
    let document = json(&["analyze", &wav]);
    let said_of_all = said(&document);
    assert_eq!(said_of_all.len(), 1, "{document}");
    assert!(
        said_of_all[0].contains("0.600 s") && said_of_all[0].contains("listen from 1.60 s on"),
        "{}",
        said_of_all[0]
    );
    let later = json(&["analyze", &wav, "--start", "1.60"]);
    assert_eq!(later["drops"].as_array().unwrap().len(), 1, "{later}");
    assert!(said(&later).is_empty());
}

#[test]
fn a_drop_before_a_drop_is_no_sound_before_it() {
    let document = json(&["analyze", &made("copies")]);
    assert!(document["drops"].as_array().unwrap().len() > 1);
    assert!(said(&document).is_empty(), "{:?}", said(&document));
}
