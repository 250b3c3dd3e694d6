//! Real recordings and what is known of them. They are not part of the project: this runs with
//! `cargo test --features recordings` where `BOUNCE_AUDIO_RECORDINGS` names their folder.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::expect_used,
    clippy::cast_precision_loss,
    reason = "a failing test should panic; shifts are small"
)]

#[path = "../examples/invariance/compare.rs"]
mod compare;
#[path = "../examples/invariance/recording.rs"]
#[expect(dead_code, reason = "no quiet is sought here")]
mod recording;
#[path = "../examples/invariance/variants.rs"]
mod variants;

use std::path::PathBuf;

use bounce_audio::audio;
use bounce_audio::report::{Analysis, Drop, Status};
use bounce_audio::{Settings, analyze_clearest};

fn folder() -> PathBuf {
    let folder = std::env::var_os("BOUNCE_AUDIO_RECORDINGS")
        .expect("BOUNCE_AUDIO_RECORDINGS names their folder");
    PathBuf::from(folder)
}

fn listen(name: &str, settings: &Settings) -> Analysis {
    let recording = audio::read_file(&folder().join(name)).unwrap();
    analyze_clearest(
        &recording.channels,
        f64::from(recording.sample_rate_hz),
        settings,
    )
    .unwrap()
    .1
}

fn one_drop(name: &str) -> Drop {
    let mut analysis = listen(name, &Settings::default());
    assert_eq!(analysis.drops.len(), 1, "{name}");
    analysis.drops.remove(0)
}

fn heard_s(drop: &Drop) -> Vec<f64> {
    drop.impacts
        .iter()
        .filter(|i| i.status != Status::Inferred)
        .map(|i| i.time_s)
        .collect()
}

fn check_flights_shrink(drop: &Drop) {
    let flights: Vec<f64> = drop
        .impacts
        .windows(2)
        .map(|w| w[1].time_s - w[0].time_s)
        .collect();
    for pair in flights.windows(2) {
        assert!(
            pair[1] < 1.25 * pair[0],
            "a flight of {} s after one of {} s",
            pair[1],
            pair[0]
        );
    }
}

/// Impacts read by hand on a grid of 1 ms, in ms; they mark a peak, about 2 ms after the onset.
const ERICKSON_MS: [f64; 30] = [
    129.0, 315.0, 492.0, 658.0, 815.0, 963.0, 1104.0, 1234.0, 1358.0, 1475.0, 1586.0, 1693.0,
    1791.0, 1886.0, 1975.0, 2060.0, 2138.0, 2212.0, 2282.0, 2349.0, 2412.0, 2472.0, 2527.0, 2581.0,
    2631.0, 2680.0, 2727.0, 2771.0, 2810.0, 2849.0,
];

#[test]
fn ericksons_ball_is_followed_past_what_was_read_by_hand() {
    let drop = one_drop("erickson-pingpong.wav");
    let times = heard_s(&drop);
    assert!(times.len() >= 54, "{} impacts", times.len());
    check_flights_shrink(&drop);
    let nearest = |t: f64| {
        times
            .iter()
            .map(|x| t - x)
            .min_by(|a, b| a.abs().total_cmp(&b.abs()))
            .unwrap()
    };
    let mut offsets: Vec<f64> = ERICKSON_MS.iter().map(|ms| nearest(1e-3 * ms)).collect();
    offsets.sort_by(f64::total_cmp);
    let common = offsets[offsets.len() / 2];
    assert!(
        common.abs() < 5e-3 && offsets.iter().all(|o| (o - common).abs() < 5e-3),
        "{offsets:?}"
    );
    let e = drop.estimates.flight_ratio.unwrap().value;
    assert!((0.9435..0.9485).contains(&e), "{e}");
}

#[test]
fn the_ball_from_90_cm_is_found_between_the_handling_noises() {
    let drop = one_drop("pfe-0.9m.wav");
    let times = heard_s(&drop);
    assert!(
        (50..=54).contains(&drop.impacts.len()),
        "{} impacts",
        drop.impacts.len()
    );
    assert!(
        (times[0] - 3.137).abs() < 3e-3 && (times[times.len() - 1] - 11.1).abs() < 0.03,
        "{times:?}"
    );
    check_flights_shrink(&drop);
    let e = drop.estimates.flight_ratio.unwrap().value;
    assert!((0.918..0.932).contains(&e), "{e}");
}

#[test]
fn the_ball_from_50_cm_is_cut_off_and_that_is_said() {
    let settings = Settings::default().height_m(0.5);
    let analysis = listen("pfe-0.5m.wav", &settings);
    assert_eq!(analysis.drops.len(), 1);
    let drop = &analysis.drops[0];
    assert!(
        (13..=15).contains(&drop.bounces),
        "{} impacts",
        drop.bounces
    );
    assert!((drop.impacts[0].time_s - 4.469).abs() < 3e-3);
    assert!(
        drop.warnings
            .iter()
            .any(|w| w.message.contains("ends before the ball rests")),
        "{:?}",
        drop.warnings
    );
    assert!(drop.total_time_s.is_none() && drop.estimates.eq25.is_none());
    let first = drop.estimates.first_rebound.unwrap().value;
    assert!((first - 0.892).abs() < 0.003, "{first}");
}

/// Recordings of the list that are not read whole yet: the tennis ball among rustle has 5 nats where 12 are asked. The onsets
/// of the four hits were read without the edit list, which moves them by 39.6 ms, as ffmpeg does.
const OWED: [&str; 1] = ["phone-four-hits.mov"];
/// Percent of the onsets that have an impact.
const FOUND: usize = 85;
/// A reader's onsets may all be late or early by this much, in seconds.
const COMMON_S: f64 = 0.015;

#[test]
fn every_recording_of_the_list_is_read_whole_but_for_those_owed() {
    let folder = std::env::var_os("BOUNCE_AUDIO_RECORDINGS")
        .expect("BOUNCE_AUDIO_RECORDINGS names their folder");
    let text = std::fs::read_to_string(PathBuf::from(folder).join("truth.json")).unwrap();
    let list: Vec<serde_json::Value> = serde_json::from_str(&text).unwrap();
    assert!(list.len() >= 12, "{} recordings", list.len());
    for truth in &list {
        let name = truth["file"].as_str().unwrap();
        let complaint = complaint(truth, &listen(name, &Settings::default()));
        assert_eq!(
            complaint.is_some(),
            OWED.contains(&name),
            "{name}: {complaint:?}"
        );
    }
}

/// What is not as the truth says.
fn complaint(truth: &serde_json::Value, analysis: &Analysis) -> Option<String> {
    let numbers = |key: &str| -> Vec<f64> {
        let list = truth[key].as_array().map(Vec::as_slice).unwrap_or_default();
        list.iter().filter_map(serde_json::Value::as_f64).collect()
    };
    let (drops, expected) = (analysis.drops.len(), truth["drops"].as_u64().unwrap());
    if drops as u64 != expected {
        return Some(format!("{drops} drops, expected {expected}"));
    }
    let longest = analysis.drops.iter().max_by_key(|d| d.impacts.len())?;
    let impacts = analysis.drops.iter().flat_map(|d| &d.impacts);
    let times: Vec<f64> = impacts.map(|i| i.time_s).collect();
    let least = truth["min_impacts"].as_u64().unwrap();
    let (onsets, within) = (numbers("onsets_s"), truth["tolerance_s"].as_f64().unwrap());
    let hits = (-60..=60)
        .map(|step| COMMON_S / 60.0 * f64::from(step))
        .map(|common| {
            let is_hit = |o: &&f64| times.iter().any(|t| (t - common - **o).abs() < within);
            onsets.iter().filter(is_hit).count()
        })
        .max()
        .unwrap_or(0);
    let e = longest.estimates.flight_ratio.map(|e| e.value);
    let range = numbers("e_range");
    let whole = times.len() as u64 >= least
        && 100 * hits >= FOUND * onsets.len()
        && e.is_some_and(|e| (range[0]..=range[1]).contains(&e));
    let count = onsets.len();
    (!whole).then(|| format!("{} impacts, {hits} of {count} onsets, e {e:?}", times.len()))
}

#[test]
fn the_same_sound_gives_the_same_answer_wherever_and_however_loud_it_is() {
    let pauses = variants::Pauses {
        drops: None,
        quiet: None,
    };
    for name in [
        "erickson-pingpong.wav",
        "golf-phone.m4a",
        "pfe-0.5m.wav",
        "pingpong-e-changes.mp3",
        "pingpong-odd-bounces.wav",
        "table-six-drops.wav",
        "thuds-stereo.wav",
    ] {
        let read = audio::read_file(&folder().join(name)).unwrap();
        let original = recording::Recording {
            channels: read.channels,
            rate: f64::from(read.sample_rate_hz),
        };
        let heard = |recording: &recording::Recording| {
            let settings = Settings::default();
            let heard = analyze_clearest(&recording.channels, recording.rate, &settings);
            heard.unwrap().1
        };
        let answer = heard(&original);
        for change in variants::CHANGES {
            let Some(variant) = change.of(&original, &pauses) else {
                continue;
            };
            let other = heard(&variant.recording);
            let shift_s = variant.shift as f64 / original.rate;
            let off = compare::difference(&answer, other.drops.iter(), shift_s);
            let (lost, gained) = (off.impacts_lost, off.impacts_gained);
            assert_eq!((lost, gained), (0, 0), "{name}, {change}");
            assert_eq!(
                (off.drops_lost, off.drops_gained),
                (0, 0),
                "{name}, {change}"
            );
            assert!(off.restitution() < 0.02, "{name}, {change}: {off:?}");
        }
    }
}
