//! Recordings put several times into one: every copy of a drop is as good as the first.

use std::fs;
use std::path::{Path, PathBuf};

use bounce_audio::audio::read_file;
use bounce_audio::{Drop, Settings, analyze, analyze_clearest};

use super::parallel::each;

/// How many copies, and the pause after each in seconds.
const ARRANGEMENTS: [(usize, f64); 4] = [(2, 0.5), (2, 2.0), (5, 0.5), (5, 2.0)];
/// The quietest stretch of this length fills the pauses, in seconds.
const QUIET_S: f64 = 0.1;
/// A copy is whole with this share of the impacts that are found alone.
const WHOLE: f64 = 0.85;

/// A recording with one drop.
struct Alone {
    name: String,
    samples: Vec<f32>,
    rate: f64,
    impacts: usize,
    evidence_nats: f64,
    /// e and its standard error.
    restitution: Option<(f64, f64)>,
}

/// What was found of an arrangement.
struct Arranged {
    drops: usize,
    /// Drops with most of the impacts.
    whole: usize,
    /// Drops whose e is within a standard error of that alone.
    alike: usize,
}

pub(crate) fn table(folder: &Path) {
    let silent = without_a_ball(folder);
    let mut paths: Vec<PathBuf> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.is_file() && !silent.contains(&name(path)))
        .collect();
    paths.sort();
    let alone: Vec<Alone> = each(&paths, |path| alone(path))
        .into_iter()
        .flatten()
        .collect();
    let jobs = alone
        .iter()
        .flat_map(|one| ARRANGEMENTS.map(|arrangement| (one, arrangement)));
    let jobs: Vec<(&Alone, (usize, f64))> = jobs.collect();
    let found = each(&jobs, |(one, (copies, pause_s))| {
        arranged(one, *copies, *pause_s)
    });
    println!(
        "recording                        | nats | impacts | e       | ± std   | copies x pause | drops | whole | same e |"
    );
    let (mut good, mut right, mut whole) = (0, 0, 0);
    for ((one, (copies, pause_s)), found) in jobs.iter().zip(&found) {
        let is_right = found.drops == *copies;
        let is_whole = is_right && found.whole == *copies;
        let is_good = is_whole && found.alike == *copies;
        right += usize::from(is_right);
        whole += usize::from(is_whole);
        good += usize::from(is_good);
        let (e, std) = one.restitution.unwrap_or((f64::NAN, f64::NAN));
        println!(
            "{:<32} | {:>4.0} | {:>7} | {e:.5} | {std:.5} | {copies} x {pause_s:<10.1} | {:>5} | {:>5} | {:>6} | {}",
            one.name,
            one.evidence_nats,
            one.impacts,
            found.drops,
            found.whole,
            found.alike,
            if is_good { "" } else { "MISS" },
        );
    }
    println!(
        "{} arrangements: {right} with the right number of drops, {whole} of them with most impacts, {good} of these with the same e",
        jobs.len()
    );
}

/// The recordings of a folder that hold no ball, if a `truth.json` says so: a list of `{"file": …, "drops": 0}`.
fn without_a_ball(folder: &Path) -> Vec<String> {
    let text = fs::read_to_string(folder.join("truth.json")).unwrap_or_default();
    let truth: Vec<serde_json::Value> = serde_json::from_str(&text).unwrap_or_default();
    let without = truth.iter().filter(|row| row["drops"] == 0);
    without
        .filter_map(|row| Some(row["file"].as_str()?.to_owned()))
        .collect()
}

fn name(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}

/// A recording in which one drop is found.
fn alone(path: &Path) -> Option<Alone> {
    let recording = read_file(path).ok()?;
    let rate = f64::from(recording.sample_rate_hz);
    let (channel, _) = analyze_clearest(&recording.channels, rate, &Settings::default()).ok()?;
    let samples = recording.channels.into_iter().nth(channel)?;
    let drops = analyze(&samples, rate, &Settings::default()).ok()?.drops;
    let [drop] = drops.as_slice() else {
        return None;
    };
    Some(Alone {
        name: name(path),
        rate,
        impacts: drop.impacts.len(),
        evidence_nats: drop.evidence_nats,
        restitution: restitution(drop),
        samples,
    })
}

fn restitution(drop: &Drop) -> Option<(f64, f64)> {
    let e = drop.restitution.as_ref()?.estimate;
    Some((e.value, e.std_error?))
}

fn arranged(one: &Alone, copies: usize, pause_s: f64) -> Arranged {
    let pause = quiet(one, pause_s);
    let samples: Vec<f32> = (0..copies)
        .flat_map(|_| one.samples.iter().chain(&pause).copied())
        .collect();
    let drops = analyze(&samples, one.rate, &Settings::default())
        .unwrap()
        .drops;
    let whole = |drop: &&Drop| drop.impacts.len() as f64 >= WHOLE * one.impacts as f64;
    let alike = |drop: &&Drop| match (restitution(drop), one.restitution) {
        (Some((e, _)), Some((alone, std))) => (e - alone).abs() <= std,
        (_, alone) => alone.is_none(),
    };
    Arranged {
        drops: drops.len(),
        whole: drops.iter().filter(whole).count(),
        alike: drops.iter().filter(alike).count(),
    }
}

/// So many seconds of the recording's own quiet: its quietest stretch, forward and backward in turn so that it has no edges.
fn quiet(one: &Alone, seconds: f64) -> Vec<f32> {
    let length = ((QUIET_S * one.rate) as usize).min(one.samples.len());
    let energy = |stretch: &[f32]| stretch.iter().map(|x| f64::from(x * x)).sum::<f64>();
    let stretches = one.samples.windows(length).step_by((length / 4).max(1));
    // A stretch of zeros is a drop-out and no quiet of the room.
    let heard = stretches.filter(|s| s.iter().filter(|x| **x != 0.0).count() > length / 4);
    let quietest = heard
        .min_by(|a, b| energy(a).total_cmp(&energy(b)))
        .unwrap_or(&[0.0]);
    let there = quietest.iter().chain(quietest.iter().rev());
    there
        .cycle()
        .take((seconds * one.rate) as usize)
        .copied()
        .collect()
}
