//! Bounces that do not go by the e of the others, from the recording to the report.

use std::path::Path;

use serde_json::Value;

use crate::common::{empty_folder, json, only_drop, run, synthesized, text};

/// A ball of e = 0.88 from half a metre with what else the scene says of its bounces.
fn bounced(folder: &Path, name: &str, bounces: &str) -> String {
    let scene = format!(
        "name = '{name}'\nsample_rate_hz = 44100\nduration_s = 6.5\npeak_db = -3.0\nnoise.white_db = -62.0\n\
         [[drops]]\nheight_m = 0.5\nmass_kg = 0.046\ndiameter_m = 0.0427\ndrag = false\nfirst_impact_s = 0.8\n\
         bounce.constant = {{ restitution = 0.88, contact_time_s = 5e-4 }}\n{bounces}\n\
         modes = [{{ frequency_hz = 2200.0, decay_s = 3e-3, level = 1.0 }}]\n"
    );
    synthesized(folder, name, &scene)
}

fn warns(of: &Value, code: &str) -> bool {
    let warnings = of["warnings"].as_array().unwrap();
    warnings.iter().any(|w| w["code"] == code)
}

fn near(value: &Value, expected: f64) -> bool {
    (value.as_f64().unwrap() - expected).abs() < 5e-3
}

#[test]
fn an_odd_bounce_is_named_and_e_is_that_of_the_others() {
    let folder = empty_folder("irregular", "odd");
    let change = "changes = [{ impact = 8, restitution_factor = 0.8, lasting = false }]";
    let wav = bounced(&folder, "odd", change);
    let document = json(&["analyze", &wav]);
    let drop = only_drop(&document);
    let named = drop["irregular"].as_array().unwrap();
    assert_eq!(named.len(), 1, "{named:?}");
    assert_eq!(
        (&named[0]["impact"], &named[0]["kind"]),
        (&8.into(), &"odd".into())
    );
    assert!(near(&named[0]["ratio"], 0.8 * 0.88) && near(&named[0]["expected_ratio"], 0.88));
    assert!(
        near(&drop["restitution"]["value"], 0.88),
        "{}",
        drop["restitution"]
    );
    assert!(warns(drop, "irregular_bounces"));
    let said = text(&run(&["analyze", &wav]).stdout);
    assert!(
        said.contains("Bounce 8 at ") && said.contains("lost more than the others"),
        "{said}"
    );
}

#[test]
fn where_e_changes_both_parts_have_theirs() {
    let folder = empty_folder("irregular", "changed");
    let change = "changes = [{ impact = 10, restitution_factor = 0.94, lasting = true }]";
    let document = json(&["analyze", &bounced(&folder, "changed", change)]);
    let drop = only_drop(&document);
    let named = &drop["irregular"][0];
    assert_eq!(
        (&named["impact"], &named["kind"]),
        (&10.into(), &"changed".into())
    );
    // The ten flights before are the longer part by time.
    assert!(
        near(&drop["restitution"]["value"], 0.88),
        "{}",
        drop["restitution"]
    );
    assert!(
        near(&named["other_restitution"]["value"], 0.94 * 0.88),
        "{named}"
    );
    assert!(named["other_restitution"]["std_error"].as_f64().unwrap() < 5e-3);
}

#[test]
fn bounces_by_turns_are_regular_and_have_a_warning() {
    let folder = empty_folder("irregular", "turns");
    let document = json(&["analyze", &bounced(&folder, "turns", "alternation = 0.08")]);
    let drop = only_drop(&document);
    assert!(drop["irregular"].as_array().unwrap().is_empty());
    assert!(warns(drop, "bounces_alternate") && !warns(drop, "irregular_bounces"));
}
