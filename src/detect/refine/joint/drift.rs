//! Slow impacts last longer than fast ones, and their sound with them; its beginning does not.

use super::settle::Normal;
use super::{Impact, Joint};
use crate::detect::refine::interpolate::{KERNEL, shifted, slope};
use crate::units::{real, samples_in};

/// What is added to the positions so that they stand at the touch and not at a constant share of the contact.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Late {
    /// Samples for a slowness of 1.
    pub shift: f64,
    /// Its standard error.
    pub std: f64,
}

/// Contact of a solid sphere: `ΔT ∝ v^(−1/5)` (Hertz).
const EXPONENT: f64 = -0.2;
/// Fewest impacts that a drift is seen in, and that one or two more components are learnt from.
const FEWEST: usize = 5;
const FEWEST_LINEAR: usize = 8;
const FEWEST_SQUARE: usize = 12;
/// The beginning ends where the sound first reaches these shares of its greatest value. Both have to agree.
const SHORTER: f64 = 0.8;
const LONGER: f64 = 1.0;
/// Standard errors by which a drift has to differ from none, and at most two beginnings from each other.
const SIGNIFICANT: f64 = 4.0;
const AGREEING: f64 = 3.0;
/// Beginnings of single impacts scatter by this at least, in seconds: modes do not begin quite alike.
const SCATTER_S: f64 = 3e-6;
/// The greatest value is sought this long after the onset, in seconds.
const PEAK_WITHIN_S: f64 = 2e-3;
/// A beginning starts so long before the onset, in seconds.
const LEAD_S: f64 = 0.5e-3;
/// Rounds in which beginnings settle.
const ROUNDS: usize = 12;
/// Rounds of robust averaging.
const AVERAGINGS: usize = 10;

/// Rounds of all times before a drift is looked for, and after one is seen.
const FIRST_ROUNDS: usize = 3;
const MORE_ROUNDS: usize = 5;

/// Settles all times, with or without a drift, and gives what is to be added for it.
pub(super) fn follow(joint: &mut Joint) -> Late {
    set_slowness(&mut joint.impacts);
    if joint.impacts.len() >= FEWEST {
        let alike = joint.template.clone();
        let start = joint.impacts.clone();
        joint.add_components();
        joint.settle(0, FIRST_ROUNDS);
        if late(joint).is_some() {
            // Jumps would be to where the wrong shape fits: impacts of all speeds have to teach it first.
            joint.settle(0, MORE_ROUNDS);
            if let Some(late) = late(joint) {
                return late;
            }
        }
        joint.template = alike;
        joint.impacts = start;
    }
    joint.settle_whole();
    Late::default()
}

/// `(v/v₁)^(−1/5)` less its mean: an impact's speed is that of the flight before it.
fn set_slowness(impacts: &mut [Impact]) {
    let mut flights: Vec<f64> = impacts
        .windows(2)
        .map(|w| w[1].coarse - w[0].coarse)
        .collect();
    if let [first, second, ..] = flights[..] {
        flights.insert(0, first * first / second);
        let first = flights[0];
        let slowness = |flight: f64| (flight / first).powf(EXPONENT);
        let mean = flights.iter().map(|&f| slowness(f)).sum::<f64>() / real(flights.len());
        for (impact, flight) in impacts.iter_mut().zip(flights) {
            impact.slowness = slowness(flight) - mean;
        }
    }
}

impl Joint {
    fn add_components(&mut self) {
        let more = [FEWEST_LINEAR, FEWEST_SQUARE];
        let more = more.iter().filter(|&&n| self.impacts.len() >= n).count();
        let none = vec![0.0; self.template.len()];
        self.template.components.resize(1 + more, none);
    }
}

/// The drift, if it is one: slow impacts match late, and both beginnings say so.
fn late(joint: &Joint) -> Option<Late> {
    let mut begins = Beginnings::of(joint, LONGER)?;
    let longer = drift(joint, &begins.settled())?;
    // From where the longer beginnings stand, the shorter ones cannot be missed.
    begins.length = beginning(joint, SHORTER)?;
    let shorter = drift(joint, &begins.settled())?;
    let agree = (shorter.shift - longer.shift).abs() < AGREEING * shorter.std.hypot(longer.std);
    (agree && shorter.shift < -SIGNIFICANT * shorter.std).then_some(shorter)
}

/// The slope of "begins" less "matches" over slowness, by least squares that forgive what lies far off.
fn drift(joint: &Joint, begins: &[(f64, f64)]) -> Option<Late> {
    let values: Vec<(f64, f64, f64)> = begins
        .iter()
        .zip(&joint.impacts)
        .map(|(&(position, std), impact)| {
            let std = std.hypot(SCATTER_S * joint.rate);
            (impact.slowness, position - impact.position, std)
        })
        .collect();
    let mut weights: Vec<f64> = values.iter().map(|(.., std)| 1.0 / (std * std)).collect();
    let mut drift = None;
    for _ in 0..AVERAGINGS {
        let line = Line::through(&values, &weights)?;
        let off = |v: &(f64, f64, f64)| (v.1 - line.level - line.slope * v.0) / v.2;
        let mut sizes: Vec<f64> = values.iter().map(|v| off(v).abs()).collect();
        sizes.sort_by(f64::total_cmp);
        let scale = (1.48 * sizes[sizes.len() / 2]).max(1.0);
        drift = Some(Late {
            shift: line.slope,
            std: line.slope_std * scale,
        });
        for (w, v) in weights.iter_mut().zip(&values) {
            *w = 1.0 / (v.2 * v.2 * (1.0 + (off(v) / (3.0 * scale)).powi(2)));
        }
    }
    drift
}

/// A weighted straight line.
struct Line {
    level: f64,
    slope: f64,
    slope_std: f64,
}

impl Line {
    fn through(values: &[(f64, f64, f64)], weights: &[f64]) -> Option<Self> {
        let (mut w, mut x, mut y, mut xx, mut xy) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (v, weight) in values.iter().zip(weights) {
            w += weight;
            x += weight * v.0;
            y += weight * v.1;
            xx += weight * v.0 * v.0;
            xy += weight * v.0 * v.1;
        }
        let determinant = w * xx - x * x;
        (determinant > 0.0).then(|| Self {
            level: (xx * y - x * xy) / determinant,
            slope: (w * xy - x * y) / determinant,
            slope_std: (w / determinant).sqrt(),
        })
    }
}

/// Samples of a beginning before the onset.
fn lead(joint: &Joint) -> usize {
    samples_in(LEAD_S, joint.rate).min(joint.template.before)
}

/// Samples of a beginning that ends at a share of the greatest value.
fn beginning(joint: &Joint, share: f64) -> Option<usize> {
    let onset = joint.template.before;
    let within = samples_in(PEAK_WITHIN_S, joint.rate);
    let mean = joint.template.mean();
    let near = mean.iter().take(onset + within);
    let peak = near.fold(0.0, |m: f64, s| m.max(s.abs()));
    let end = mean.iter().position(|s| s.abs() >= share * peak)? + 1;
    (end + lead(joint)).checked_sub(onset).filter(|&l| l > 3)
}

/// The beginnings of all impacts, each matched with the mean of them.
struct Beginnings {
    /// Each impact's sound, the others taken out, with a margin on both sides.
    sounds: Vec<Vec<f64>>,
    /// Where each stands in its sound, and its size.
    positions: Vec<f64>,
    amplitudes: Vec<f64>,
    /// Where it stood first, and in the stretch.
    first: f64,
    origins: Vec<f64>,
    /// Samples of a beginning, before the onset and in all.
    lead: usize,
    length: usize,
}

impl Beginnings {
    fn of(joint: &Joint, share: f64) -> Option<Self> {
        let lead = lead(joint);
        let length = beginning(joint, share)?;
        let margin = samples_in(LEAD_S, joint.rate) + KERNEL;
        let first = real(lead + margin);
        let sounds = joint.surroundings(lead + margin, length + 2 * margin + KERNEL);
        Some(Self {
            positions: vec![first; sounds.len()],
            amplitudes: joint.impacts.iter().map(|i| i.amplitude).collect(),
            origins: joint.impacts.iter().map(|i| i.position).collect(),
            sounds,
            first,
            lead,
            length,
        })
    }

    /// Positions in the stretch and their standard errors, in samples.
    fn settled(&mut self) -> Vec<(f64, f64)> {
        let noise = vec![1.0; self.length];
        let mut stds = vec![f64::INFINITY; self.sounds.len()];
        for _ in 0..ROUNDS {
            let cuts: Vec<Vec<f64>> = self
                .sounds
                .iter()
                .zip(&self.positions)
                .map(|(s, p)| shifted(s, p - real(self.lead), self.length + KERNEL))
                .collect();
            let shape = self.mean(&cuts);
            let slopes = slope(&shape);
            let mut moves = Vec::with_capacity(cuts.len());
            for (i, cut) in cuts.iter().enumerate() {
                let normal = Normal::of(cut, &noise, &shape, &slopes);
                let (amplitude, moved, std) = normal.solve(self.amplitudes[i]);
                self.amplitudes[i] = amplitude.max(0.3 * self.amplitudes[i]);
                stds[i] = std;
                moves.push(moved.clamp(-1.0, 1.0));
            }
            let (sum, weight) = moves
                .iter()
                .zip(&stds)
                .fold((0.0, 0.0), |(s, w), (m, std)| {
                    (s + m / (std * std), w + 1.0 / (std * std))
                });
            // What is common to all is not measured by matching one another.
            let common = if weight > 0.0 { sum / weight } else { 0.0 };
            for (p, m) in self.positions.iter_mut().zip(&moves) {
                *p += m - common;
            }
        }
        let first = self.first;
        let moved = self.positions.iter().map(|p| p - first);
        let places = self.origins.iter().zip(moved).map(|(o, m)| o + m);
        places.zip(stds).collect()
    }

    fn mean(&self, cuts: &[Vec<f64>]) -> Vec<f64> {
        let mut shape = vec![0.0; self.length + KERNEL];
        let power: f64 = self.amplitudes.iter().map(|a| a * a).sum();
        for (cut, a) in cuts.iter().zip(&self.amplitudes) {
            for (s, x) in shape.iter_mut().zip(cut) {
                *s += a * x / power;
            }
        }
        shape
    }
}
