//! Slow impacts last longer than fast ones, and their sound with them; its beginning does not.

use super::settle::Normal;
use super::{Impact, Joint};
use crate::signal::interpolate::{KERNEL, shifted, slope};
use crate::signal::template::aligned::{Aligned, mean};
use crate::signal::template::average::factors;
use crate::statistics::{MAD_TO_STD, upper_median};
use crate::units::{real, samples_in};

/// What is added to the positions so that they stand at the touch and not at a constant share of the contact:
/// `c₁·u + c₂·u²` samples for a slowness u. A longer contact makes c₁; where components were learnt in u and u², the
/// positions are free by as much of both, and the beginnings settle that too.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Late {
    terms: [f64; 2],
    covariance: [[f64; 2]; 2],
}

impl Late {
    /// Samples to add at a slowness.
    pub(super) fn shift(&self, slowness: f64) -> f64 {
        self.terms[0] * slowness + self.terms[1] * slowness * slowness
    }

    /// Standard error of that, against a slowness of 0.
    pub(super) fn std(&self, slowness: f64) -> f64 {
        self.std_of([slowness, slowness * slowness])
    }

    fn std_of(&self, by: [f64; 2]) -> f64 {
        let [[a, b], [_, c]] = self.covariance;
        (a * by[0] * by[0] + 2.0 * b * by[0] * by[1] + c * by[1] * by[1])
            .max(0.0)
            .sqrt()
    }

    /// From the fastest to the slowest impact: the shift and its standard error.
    fn whole(&self, (fast, slow): (f64, f64)) -> (f64, f64) {
        let shift = self.shift(slow) - self.shift(fast);
        (shift, self.std_of([slow - fast, slow * slow - fast * fast]))
    }
}

/// Contact of a solid sphere: `ΔT ∝ v^(−1/5)` (Hertz).
const EXPONENT: f64 = -0.2;
/// Fewest impacts that a drift is seen in, and that one or two more components are learnt from.
const FEWEST: usize = 5;
const FEWEST_LINEAR: usize = 8;
const FEWEST_SQUARE: usize = 12;
/// The beginning ends where the sound first reaches one of these shares of its greatest value. Two that follow one another
/// have to agree: the longest tells most, but the crests of loud impacts may be cut off.
const SHARES: [f64; 3] = [1.0, 0.8, 0.6];
/// All impacts are asked first, then those alone whose beginning stands out by so many standard deviations: faint ones may
/// match at a wrong crest.
const CLEAR: [f64; 2] = [f64::NEG_INFINITY, 10.0];
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

/// The drift, if it is one: slow impacts match late, and two beginnings say so, of all impacts or of the clear ones.
fn late(joint: &Joint) -> Option<Late> {
    let by = |clear| {
        let mut pairs = SHARES.windows(2);
        pairs.find_map(|pair| late_by(joint, clear, pair))
    };
    CLEAR.into_iter().find_map(by)
}

/// The same by two beginnings, of the impacts that are so clear.
fn late_by(joint: &Joint, clear: f64, shares: &[f64]) -> Option<Late> {
    let &[longer, shorter] = shares else {
        return None;
    };
    let mut begins = Beginnings::of(joint, longer, clear)?;
    let longer = drift(joint, &begins.settled())?;
    // From where the longer beginnings stand, the shorter ones cannot be missed.
    begins.length = beginning(joint, shorter)?;
    let places = begins.settled();
    let shorter = drift(joint, &places)?;
    let known = joint
        .impacts
        .iter()
        .zip(&places)
        .filter(|(_, place)| place.is_some());
    let slownesses = known.map(|(impact, _)| impact.slowness);
    let range = slownesses.fold((0.0_f64, 0.0_f64), |(a, b), u| (a.min(u), b.max(u)));
    let ((long, long_std), (short, short_std)) = (longer.whole(range), shorter.whole(range));
    let agree = (short - long).abs() < AGREEING * short_std.hypot(long_std);
    (agree && short < -SIGNIFICANT * short_std).then_some(shorter)
}

/// "Begins" less "matches" as a function of slowness, by least squares that forgive what lies far off.
fn drift(joint: &Joint, begins: &[Option<(f64, f64)>]) -> Option<Late> {
    let known = begins.iter().zip(&joint.impacts);
    let values: Vec<Value> = known
        .filter_map(|(begin, impact)| {
            let (position, std) = (*begin)?;
            Some(Value {
                slowness: impact.slowness,
                late: position - impact.position,
                std: std.hypot(SCATTER_S * joint.rate),
            })
        })
        .collect();
    if values.len() < FEWEST {
        return None;
    }
    let terms = joint.template.components.len().max(2);
    let mut weights: Vec<f64> = values.iter().map(|v| 1.0 / (v.std * v.std)).collect();
    let mut drift = None;
    for _ in 0..AVERAGINGS {
        let curve = Curve::through(&values, &weights, terms)?;
        let off = |v: &Value| (v.late - curve.at(v.slowness)) / v.std;
        let scale = (MAD_TO_STD * upper_median(values.iter().map(|v| off(v).abs()))?).max(1.0);
        drift = Some(curve.late(scale));
        for (w, v) in weights.iter_mut().zip(&values) {
            *w = 1.0 / (v.std * v.std * (1.0 + (off(v) / (3.0 * scale)).powi(2)));
        }
    }
    drift
}

/// How much later than it begins an impact matches.
struct Value {
    slowness: f64,
    late: f64,
    std: f64,
}

/// A weighted line or parabola, with the covariance of its three coefficients.
struct Curve {
    coefficients: [f64; 3],
    covariance: [[f64; 3]; 3],
}

impl Curve {
    fn through(values: &[Value], weights: &[f64], terms: usize) -> Option<Self> {
        let (mut moments, mut right) = ([0.0; 5], [0.0; 3]);
        for (v, weight) in values.iter().zip(weights) {
            let mut power = *weight;
            for (k, moment) in moments.iter_mut().enumerate() {
                *moment += power;
                if k < terms {
                    right[k] += power * v.late;
                }
                power *= v.slowness;
            }
        }
        let factors = factors(&moments, terms)?;
        Some(Self {
            coefficients: factors.solve(&right),
            covariance: factors.inverse(),
        })
    }

    fn at(&self, slowness: f64) -> f64 {
        let [level, slope, bend] = self.coefficients;
        level + slowness * (slope + slowness * bend)
    }

    /// All but its level; errors are larger than weights say by a factor.
    fn late(&self, scale: f64) -> Late {
        let c = |i: usize, j: usize| self.covariance[i][j] * scale * scale;
        Late {
            terms: [self.coefficients[1], self.coefficients[2]],
            covariance: [[c(1, 1), c(1, 2)], [c(2, 1), c(2, 2)]],
        }
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
    /// Standard deviations of the noise by which a beginning has to stand out.
    clear: f64,
}

impl Beginnings {
    fn of(joint: &Joint, share: f64, clear: f64) -> Option<Self> {
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
            clear,
        })
    }

    /// Positions in the stretch and their standard errors, in samples, of those that are clear.
    fn settled(&mut self) -> Vec<Option<(f64, f64)>> {
        let noise = vec![1.0; self.length];
        let mut stds = vec![f64::INFINITY; self.sounds.len()];
        for _ in 0..ROUNDS {
            let cuts = self.cuts();
            let shape = mean(&cuts);
            let slopes = slope(&shape);
            let mut moves = Vec::with_capacity(cuts.len());
            for (i, cut) in cuts.iter().enumerate() {
                let normal = Normal::of(&cut.sound, &noise, &shape, &slopes);
                let (amplitude, moved, std) = normal.solve(self.amplitudes[i]);
                self.amplitudes[i] = amplitude.max(0.3 * self.amplitudes[i]);
                let is_clear = normal.clearness(amplitude) >= self.clear;
                stds[i] = if is_clear { std } else { f64::INFINITY };
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
        let moved = self.positions.iter().map(|p| p - self.first);
        let places = self.origins.iter().zip(moved).map(|(o, m)| o + m);
        let clear = |(place, std): (f64, f64)| std.is_finite().then_some((place, std));
        places.zip(stds).map(clear).collect()
    }

    /// The beginnings where they stand.
    fn cuts(&self) -> Vec<Aligned> {
        let places = self.sounds.iter().zip(&self.positions);
        let cuts = places
            .zip(&self.amplitudes)
            .map(|((s, p), &amplitude)| Aligned {
                amplitude,
                sound: shifted(s, p - real(self.lead), self.length + KERNEL),
            });
        cuts.collect()
    }
}
