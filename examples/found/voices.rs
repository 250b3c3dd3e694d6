//! Real drops with real voices over them, and pieces of the voices alone: no scene of ours says what those are like.

use std::fs;
use std::path::Path;

use bounce_audio::audio::read_file;
use bounce_audio::report::Status;
use bounce_audio::{Analysis, Settings, analyze, analyze_clearest};

use super::parallel::each;

/// Root mean square of a voice below the peak of a drop, in dB: it is heard, it is as loud as late impacts, it hides them.
const LEVELS_DB: [f64; 3] = [-45.0, -35.0, -25.0];
/// A voice begins at this many places, evenly spread over its recording.
const PLACES: usize = 3;
/// Impacts within this time are the same, in seconds.
const SAME_S: f64 = 4e-3;
/// A drop is whole with this share of the impacts that are found alone.
const WHOLE: f64 = 0.85;
/// Lengths of the pieces of a voice, in seconds; each begins a quarter of its length after the one before.
const PIECES_S: [f64; 3] = [2.0, 4.0, 8.0];

/// A channel of a recording.
struct Sound {
    samples: Vec<f32>,
    rate_hz: f64,
    /// What is found in it.
    analysis: Analysis,
}

/// What was found of a drop under a voice.
#[derive(Default)]
struct Covered {
    impacts: usize,
    found: usize,
    /// Impacts that were none alone.
    beside: usize,
    whole: bool,
}

pub(crate) fn table(balls: &Path, voices: &Path) {
    let balls = sounds(balls);
    let voices = sounds(voices);
    let jobs: Vec<(&Sound, &Sound, usize)> = balls
        .iter()
        .filter(|ball| ball.analysis.drops.len() == 1)
        .flat_map(|ball| voices.iter().map(move |voice| (ball, voice)))
        .flat_map(|(ball, voice)| (0..PLACES).map(move |place| (ball, voice, place)))
        .collect();
    println!("voice    | whole  | impacts found | beside them");
    for level_db in LEVELS_DB {
        let found = each(&jobs, |(ball, voice, place)| {
            covered(ball, voice, *place, level_db)
        });
        let sum = |of: fn(&Covered) -> usize| found.iter().map(of).sum::<usize>();
        println!(
            "{level_db:>5} dB | {}/{} | {}/{} | {}",
            sum(|c| usize::from(c.whole)),
            found.len(),
            sum(|c| c.found),
            sum(|c| c.impacts),
            sum(|c| c.beside),
        );
    }
    let pieces: Vec<(&Sound, usize, usize)> = voices.iter().flat_map(pieces).collect();
    let drops = each(&pieces, |(voice, from, until)| {
        let samples = &voice.samples[*from..*until];
        let found = analyze(samples, voice.rate_hz, &Settings::default()).unwrap();
        found.drops.iter().map(|d| d.impacts.len()).max()
    });
    let with = |is: fn(usize) -> bool| drops.iter().flatten().filter(|n| is(**n)).count();
    println!(
        "pieces of voices: {} of {} with a drop of four impacts or more, {} with fewer",
        with(|impacts| impacts > 3),
        drops.len(),
        with(|impacts| impacts < 4),
    );
}

/// What can be read of a folder, each by its clearest channel.
fn sounds(folder: &Path) -> Vec<Sound> {
    let mut paths: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    paths.sort();
    let read = each(&paths, |path| {
        let recording = read_file(path).ok()?;
        let rate_hz = f64::from(recording.sample_rate_hz);
        let settings = Settings::default();
        let (channel, analysis) = analyze_clearest(&recording.channels, rate_hz, &settings).ok()?;
        let samples = recording.channels.into_iter().nth(channel)?;
        Some(Sound {
            samples,
            rate_hz,
            analysis,
        })
    });
    read.into_iter().flatten().collect()
}

fn covered(ball: &Sound, voice: &Sound, place: usize, level_db: f64) -> Covered {
    let both = mixed(ball, voice, place, level_db);
    let found = analyze(&both, ball.rate_hz, &Settings::default()).unwrap();
    let alone = heard_s(&ball.analysis);
    let heard = heard_s(&found);
    let is_same = |a: f64, b: f64| (a - b).abs() < SAME_S;
    let again = alone
        .iter()
        .filter(|a| heard.iter().any(|b| is_same(**a, *b)));
    let again = again.count();
    let beside = heard
        .iter()
        .filter(|b| !alone.iter().any(|a| is_same(*a, **b)));
    Covered {
        impacts: alone.len(),
        found: again,
        beside: beside.count(),
        whole: found.drops.len() == 1 && again as f64 > WHOLE * alone.len() as f64,
    }
}

/// Times of the impacts heard, in seconds.
fn heard_s(analysis: &Analysis) -> Vec<f64> {
    let impacts = analysis.drops.iter().flat_map(|drop| &drop.impacts);
    let heard = impacts.filter(|impact| impact.status != Status::Inferred);
    heard.map(|impact| impact.time_s).collect()
}

/// A drop with a voice over it, which is taken to the drop's rate by straight lines and begins again where it ends.
fn mixed(ball: &Sound, voice: &Sound, place: usize, level_db: f64) -> Vec<f32> {
    let length = voice.samples.len();
    let squares: f64 = voice.samples.iter().map(|s| f64::from(s * s)).sum();
    let root = (squares / length as f64).sqrt().max(f64::MIN_POSITIVE);
    let peak = ball
        .samples
        .iter()
        .fold(0.0_f32, |peak, s| peak.max(s.abs()));
    let gain = (f64::from(peak) * 10.0_f64.powf(level_db / 20.0) / root) as f32;
    let from = place as f64 / PLACES as f64 * length as f64;
    let step = voice.rate_hz / ball.rate_hz;
    let add = |(i, sample): (usize, &f32)| {
        let at = from + i as f64 * step;
        let part = at.fract() as f32;
        let before = voice.samples[at as usize % length];
        let after = voice.samples[(at as usize + 1) % length];
        sample + gain * (before + part * (after - before))
    };
    ball.samples.iter().enumerate().map(add).collect()
}

/// A voice in pieces that overlap: where each begins and ends.
fn pieces(voice: &Sound) -> Vec<(&Sound, usize, usize)> {
    let length = voice.samples.len();
    let of = |piece_s: f64| {
        let piece = (piece_s * voice.rate_hz) as usize;
        let begins = (0..length.saturating_sub(piece * 3 / 4)).step_by((piece / 4).max(1));
        begins.map(move |from| (voice, from, (from + piece).min(length)))
    };
    PIECES_S.into_iter().flat_map(of).collect()
}
