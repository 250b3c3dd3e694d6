//! `bounce-audio analyze` with one thread and with several, as a user runs it.

use crate::common::{empty_folder, run, synthesized, text};
use serde_json::Value;

/// A drop of a steel ball on two microphones.
fn drop_at(first_impact_s: f64) -> String {
    format!(
        "[[drops]]
height_m = 0.15
first_impact_s = {first_impact_s}
mass_kg = 0.0327
diameter_m = 0.02
bounce.constant = {{ restitution = 0.8, contact_time_s = 8e-5 }}
bounce_scatter = 0.003
modes = [
    {{ frequency_hz = 5200.0, decay_s = 0.006, level = 1.0 }},
    {{ frequency_hz = 9700.0, decay_s = 0.004, level = 0.8 }},
]
"
    )
}

/// Three scenes: two balls at once, one alone, one after another.
fn scene() -> String {
    let drops: String = [0.6, 0.93, 10.0, 18.0, 20.5].map(drop_at).concat();
    format!(
        "name = \"scenes\"
about = \"Drops at once, alone, and one after another.\"
sample_rate_hz = 44100
duration_s = 24.0
peak_db = -3.0

{drops}
[noise]
white_db = -70.0

[recorder]
channels = [{{ delay_s = -2.5e-4 }}, {{ delay_s = 2.5e-4, level_db = -4.0 }}]
"
    )
}

#[test]
fn documents_are_the_same_for_any_number_of_threads() {
    let wav = synthesized(&empty_folder("side_by_side", "same"), "scenes", &scene());
    let of = |jobs: &str| run(&["analyze", &wav, "--format", "json", "--jobs", jobs]);
    let one = of("1");
    let document: Value = serde_json::from_slice(&one.stdout).unwrap();
    let drops = document["drops"].as_array().unwrap();
    assert_eq!(drops.len(), 5, "{}", text(&one.stdout));
    for jobs in ["2", "5"] {
        let many = of(jobs);
        assert_eq!(
            (many.stdout, many.stderr),
            (one.stdout.clone(), one.stderr.clone()),
            "{jobs}"
        );
    }
    let usual = run(&["analyze", &wav, "--format", "json"]);
    assert_eq!(text(&usual.stdout), text(&one.stdout));
}
