//! One drop, made and listened to.

use bounce_audio::report::{Method, Status};
use bounce_audio::synth::scene::{BounceScene, Scene, preset};
use bounce_audio::synth::truth::DropTruth;
use bounce_audio::synth::{Synthetic, render};
use bounce_audio::{Drop, Settings, analyze};

use super::parallel::each;

/// The ball touches first at this time, in seconds.
pub(crate) const FIRST_S: f64 = 0.8;
/// Quiet after the last impact, in seconds.
const AFTER_S: f64 = 0.8;
/// A time is that of an impact if it is no further from it, in seconds.
const SAME_S: f64 = 3e-3;
/// A drop is whole with this share of its impacts, and at most as many more that are none.
const WHOLE: f64 = 0.85;

/// A ball of a preset, with its e and height.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ball {
    pub(crate) preset: &'static str,
    pub(crate) restitution: f64,
    pub(crate) height_m: f64,
}

/// Balls as they are, dead to lively.
pub(crate) const BALLS: [Ball; 4] = [
    Ball::new("tennis", 0.78, 1.0),
    Ball::new("golf", 0.88, 0.5),
    Ball::new("steel", 0.90, 0.15),
    Ball::new("pingpong", 0.93, 0.305),
];

impl Ball {
    pub(crate) const fn new(preset: &'static str, restitution: f64, height_m: f64) -> Self {
        Self {
            preset,
            restitution,
            height_m,
        }
    }

    /// A scene in which it is dropped, and caught after so many impacts. Impacts differ as real ones do.
    pub(crate) fn scene(self, most_impacts: Option<usize>) -> Scene {
        let mut scene = preset(self.preset).unwrap();
        let drop = &mut scene.drops[0];
        let contact_time_s = match drop.bounce {
            BounceScene::Constant { contact_time_s, .. }
            | BounceScene::Power { contact_time_s, .. } => contact_time_s,
            _ => 1e-3,
        };
        drop.bounce = BounceScene::Constant {
            restitution: self.restitution,
            contact_time_s,
        };
        drop.drag = false;
        drop.height_m = self.height_m;
        drop.height_spread = 0.1;
        drop.first_impact_s = FIRST_S;
        // The sound of a contact that grows longer shifts the times, which is another matter.
        drop.contact_exponent = 0.0;
        drop.level_scatter = 0.3;
        drop.frequency_scatter = 0.01;
        drop.loudness_scatter = 0.1;
        drop.most_impacts = most_impacts;
        scene.noise.white_db = -62.0;
        scene.duration_s = FIRST_S + AFTER_S + 1.1 * self.flights_s(most_impacts);
        scene
    }

    /// Time from the first impact to the last, of so many, in seconds: T₁ (1 − eⁿ⁻¹)/(1 − e), T₁ = 2e √(2h/g).
    fn flights_s(self, most_impacts: Option<usize>) -> f64 {
        let e = self.restitution;
        let first_s = 2.0 * e * (2.0 * self.height_m / 9.81).sqrt();
        let left = most_impacts.map_or(0.0, |n| e.powf(n as f64 - 1.0));
        first_s * (1.0 - left) / (1.0 - e)
    }
}

/// What was heard of a drop.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Heard {
    /// Drops found.
    pub(crate) drops: usize,
    /// Impacts that can be heard.
    pub(crate) there: usize,
    /// Those of them that are in one drop.
    pub(crate) found: usize,
    /// Impacts of this drop that are none.
    pub(crate) made_up: usize,
    /// Whether its first impact is the true one.
    pub(crate) first: bool,
    /// Its evidence in nats.
    pub(crate) evidence_nats: Option<f64>,
    /// Its e.
    pub(crate) restitution: Option<f64>,
    /// Whether its 95 % interval holds the true e: the ball's, or that of the first impact where it is this that is told.
    pub(crate) held: bool,
}

impl Heard {
    /// Whether the ball is one drop, and most of its impacts are in it.
    pub(crate) fn is_whole(&self) -> bool {
        let there = self.there as f64;
        self.drops == 1
            && self.found as f64 >= WHOLE * there
            && self.made_up as f64 <= (1.0 - WHOLE) * there
    }
}

/// Makes a scene with a seed and listens.
pub(crate) fn heard(scene: &Scene, seed: u64) -> Heard {
    heard_with(scene, seed, &Settings::default())
}

/// The same with settings.
pub(crate) fn heard_with(scene: &Scene, seed: u64, settings: &Settings) -> Heard {
    let made = render(scene, seed).unwrap();
    compare(&made, settings)
}

fn compare(made: &Synthetic, settings: &Settings) -> Heard {
    let rate = f64::from(made.truth.sample_rate_hz);
    let analysis = analyze(&made.samples, rate, settings).unwrap();
    let truth = &made.truth.drops[0];
    let onsets = audible(truth);
    let best = analysis.drops.iter().max_by_key(|d| matched(d, &onsets));
    let none = Heard {
        drops: analysis.drops.len(),
        there: onsets.len(),
        ..Heard::default()
    };
    let Some(drop) = best else { return none };
    let times = times(drop);
    let estimate = drop.restitution.as_ref().map(|r| r.estimate);
    let interval = estimate.and_then(|e| e.interval95);
    let method = drop.restitution.as_ref().map(|r| r.method);
    let e = match method {
        // That of the first impact, from which the ball's own strays as every bounce does.
        Some(Method::FirstRebound) => truth.restitution_each[0],
        _ => regular(truth),
    };
    Heard {
        found: matched(drop, &onsets),
        made_up: times
            .iter()
            .filter(|t| !is_near(**t, &truth.onsets_s))
            .count(),
        first: times
            .first()
            .zip(onsets.first())
            .is_some_and(|(a, b)| (a - b).abs() < SAME_S),
        evidence_nats: Some(drop.evidence_nats),
        restitution: estimate.map(|e| e.value),
        held: interval.is_some_and(|[low, high]| (low..=high).contains(&e)),
        ..none
    }
}

/// When impacts can be heard.
pub(crate) fn audible(truth: &DropTruth) -> Vec<f64> {
    let onsets = truth.onsets_s.iter().zip(&truth.audible);
    onsets
        .filter(|(_, audible)| **audible)
        .map(|(t, _)| *t)
        .collect()
}

/// e of most bounces.
fn regular(truth: &DropTruth) -> f64 {
    let each = truth.restitution_nominal_each.iter().zip(&truth.audible);
    let mut each: Vec<f64> = each
        .filter(|(_, audible)| **audible)
        .map(|(e, _)| *e)
        .collect();
    each.sort_by(f64::total_cmp);
    each.get(each.len() / 2).copied().unwrap_or_default()
}

fn times(drop: &Drop) -> Vec<f64> {
    let heard = drop.impacts.iter().filter(|i| i.status == Status::Heard);
    heard.map(|i| i.time_s).collect()
}

fn matched(drop: &Drop, onsets: &[f64]) -> usize {
    let times = times(drop);
    onsets.iter().filter(|t| is_near(**t, &times)).count()
}

fn is_near(time_s: f64, others: &[f64]) -> bool {
    others.iter().any(|other| (other - time_s).abs() < SAME_S)
}

/// The sum of trials of one kind, as a row.
pub(crate) const HEAD: &str =
    "kind                     | whole  | none | several | first | impacts found | made up | e held";

/// A row of the table for scenes of one kind.
pub(crate) fn row(kind: &str, trials: &[(Scene, u64)]) -> Vec<Heard> {
    let heard = each(trials, |(scene, seed)| heard(scene, *seed));
    println!("{}", line(kind, &heard));
    heard
}

/// What was heard in trials of one kind.
pub(crate) fn line(kind: &str, heard: &[Heard]) -> String {
    let count = |of: fn(&Heard) -> bool| heard.iter().filter(|h| of(h)).count();
    let sum = |of: fn(&Heard) -> usize| heard.iter().map(of).sum::<usize>();
    format!(
        "{kind:<24} | {:>2}/{:<3} | {:>4} | {:>7} | {:>5} | {:>6}/{:<6} | {:>7} | {:>6}",
        count(Heard::is_whole),
        heard.len(),
        count(|h| h.drops == 0),
        count(|h| h.drops > 1),
        count(|h| h.first),
        sum(|h| h.found),
        sum(|h| h.there),
        sum(|h| h.made_up),
        count(|h| h.held),
    )
}
