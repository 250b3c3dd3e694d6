//! The whole suite, made and analyzed: nothing that was once reached may be lost.
//!
//! The thresholds are what `bounce-audio synth --suite DIR --seeds 2` and `bounce-audio evaluate DIR --tighten
//! fixtures/suite-thresholds.toml` found, less a margin; with `--found` and fixtures/found-thresholds.toml for the second suite.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a failing test should panic"
)]

use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use bounce_audio::evaluate::reference::Reference;
use bounce_audio::evaluate::rows::{Evaluation, Tier};
use bounce_audio::evaluate::scores::{FileScore, score};
use bounce_audio::evaluate::thresholds::Thresholds;
use bounce_audio::synth::presets::{found_names, names, preset, seed};
use bounce_audio::synth::render;
use bounce_audio::{Settings, analyze_clearest};

/// Recordings of each scene.
const NUMBERS: [u64; 2] = [1, 2];

fn analyzed(name: &str, number: u64) -> FileScore {
    let made = render(&preset(name).unwrap(), seed(name, number)).unwrap();
    let truth = serde_json::to_string(&made.truth).unwrap();
    let reference = Reference::from_json(&truth).unwrap();
    let mut channels = vec![made.samples];
    channels.extend(made.more_channels);
    let rate = f64::from(made.truth.sample_rate_hz);
    let (_, analysis) = analyze_clearest(&channels, rate, &Settings::default()).unwrap();
    score(&analysis, &reference, made.truth.duration_s, 0.0)
}

/// The next job and its index, each to one thread only.
fn take<'a, T>(next: &AtomicUsize, jobs: &'a [T]) -> Option<(usize, &'a T)> {
    let index = next.fetch_add(1, Ordering::Relaxed);
    jobs.get(index).map(|job| (index, job))
}

/// All scores in the order of the jobs, whatever the threads do.
fn all(jobs: &[(&str, u64)]) -> Vec<FileScore> {
    let next = AtomicUsize::new(0);
    let scores = Mutex::new(vec![FileScore::default(); jobs.len()]);
    let threads = thread::available_parallelism().map_or(1, usize::from);
    thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some((index, (name, number))) = take(&next, jobs) {
                    let score = analyzed(name, *number);
                    scores.lock().unwrap()[index] = score;
                }
            });
        }
    });
    scores.into_inner().unwrap()
}

fn evaluated(names: impl Iterator<Item = &'static str>) -> Evaluation {
    let jobs: Vec<(&str, u64)> = names
        .flat_map(|name| NUMBERS.map(|number| (name, number)))
        .collect();
    let tier = Tier {
        timing: "correlation".to_owned(),
        model: "auto".to_owned(),
        files: all(&jobs),
    };
    Evaluation::of(&[tier], None)
}

/// Figures that were once better and are owed: the threshold of the scene stays, and until it is met again this holds.
/// What repays one takes it out here.
const OWED: [(&str, &str, f64); 3] = [
    // An impact that an ideal listener would not hear, near the end, is off by more than is counted as it.
    ("basketball", "precision", 0.968),
    // Three impacts more are followed in one recording, inaudible but for one, off by 2 ms.
    ("footsteps", "precision", 0.896),
    ("hum", "timing_error_median_s", 4.05e-6),
];

/// The same of the second suite: words and taps that quicken and fade, all of one sound, are taken for a ball, and oftener since
/// sounds of another kind no longer speak against one: it is a ball by its times, its loudness and its likeness, and what
/// held it down held down real balls under voices.
const OWED_OF_FOUND: [(&str, &str, f64); 4] = [
    ("all", "false_drops", 12.0),
    ("quick-taps", "false_drops", 2.0),
    ("words", "false_drops", 6.0),
    ("words-and-tennis", "false_drops", 4.0),
];

fn assert_reached(evaluation: &Evaluation, thresholds: &str, owed: &[(&str, &str, f64)]) {
    let thresholds = Thresholds::from_toml(thresholds).unwrap();
    let rows = evaluation.rows.iter().chain(&evaluation.scenes);
    let mut complaints = thresholds.complaints(rows);
    for (scene, figure, bound) in owed {
        let about = format!("{scene}: {figure} is ");
        let place = complaints.iter().position(|c| c.starts_with(&about));
        let complaint =
            complaints.remove(place.unwrap_or_else(|| panic!("{about}what was owed, and is paid")));
        let value = complaint[about.len()..].split(',').next().unwrap();
        // Where nothing was found no precision is known.
        let value: f64 = if value == "absent" {
            0.0
        } else {
            value.parse().unwrap()
        };
        let holds = if matches!(*figure, "coverage95" | "precision" | "recall") {
            value >= *bound
        } else {
            value <= *bound
        };
        assert!(holds, "{complaint}, and {bound:e} is owed");
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn drops_that_are_hard_to_find_are_found_as_they_were() {
    let thresholds = include_str!("../fixtures/found-thresholds.toml");
    assert_reached(&evaluated(found_names()), thresholds, &OWED_OF_FOUND);
}

#[test]
fn the_suite_reaches_what_it_reached() {
    let evaluation = evaluated(names());
    assert_reached(
        &evaluation,
        include_str!("../fixtures/suite-thresholds.toml"),
        &OWED,
    );
    assert!(
        evaluation.rows[0].audible > 1_000,
        "hardly anything was there to hear"
    );
}
