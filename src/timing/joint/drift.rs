//! Slow impacts last longer than fast ones, and their sound with them; its beginning does not.

use super::align::Aligned;
use super::beginnings::{Beginnings, beginning};
use super::settle::Joint;
use super::start::Started;
use crate::signal::template::average::factors;
use crate::statistics::{MAD_TO_STD, upper_median};

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

    /// How far its terms are from those of another at most, in its own standard errors.
    fn moved_from(&self, other: &Self) -> f64 {
        let moved = (0..2).map(|k| {
            let moved = (self.terms[k] - other.terms[k]).abs();
            if moved > 0.0 {
                moved / self.covariance[k][k].sqrt()
            } else {
                0.0
            }
        });
        moved.fold(0.0, f64::max)
    }

    /// From the fastest to the slowest impact: the shift and its standard error.
    fn whole(&self, (fast, slow): (f64, f64)) -> (f64, f64) {
        let shift = self.shift(slow) - self.shift(fast);
        (shift, self.std_of([slow - fast, slow * slow - fast * fast]))
    }
}

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
/// Averaging ends once the curve moves by no more than this share of its own standard error …
const REST: f64 = 0.05;
/// … or after so many rounds: five times as many as were seen, on the suite and on real recordings.
const LIMIT: usize = 100;

/// Rounds of all times before a drift is looked for, and after one is seen.
const FIRST_ROUNDS: usize = 3;
const MORE_ROUNDS: usize = 5;

/// All times settled.
#[derive(Debug)]
pub(super) struct Followed<'a> {
    pub joint: Joint<'a>,
    /// What is to be added for a drift.
    pub late: Late,
    /// Standard error of each position by rival places, in samples; 0 where none were sought.
    pub doubts: Vec<f64>,
}

/// Settles all times, with or without a drift.
pub(super) fn follow(started: &Started, aligned: Aligned) -> Followed<'_> {
    if let Some((joint, late)) = drifting(started, &aligned) {
        return Followed {
            doubts: vec![0.0; joint.places.len()],
            joint,
            late,
        };
    }
    let mut joint = Joint::of(started, aligned, 1);
    let doubts = joint.settle_whole();
    Followed {
        joint,
        late: Late::default(),
        doubts,
    }
}

/// The impacts settled as those that differ by their slowness, and their drift; none if they have none.
fn drifting<'a>(started: &'a Started, aligned: &Aligned) -> Option<(Joint<'a>, Late)> {
    let count = aligned.places.len();
    if count < FEWEST {
        return None;
    }
    let more = [FEWEST_LINEAR, FEWEST_SQUARE];
    let components = 1 + more.iter().filter(|&&n| count >= n).count();
    let mut joint = Joint::of(started, aligned.clone(), components);
    joint.settle(FIRST_ROUNDS);
    late(&joint)?;
    // Jumps would be to where the wrong shape fits: impacts of all speeds have to teach it first.
    joint.settle(MORE_ROUNDS);
    let late = late(&joint)?;
    Some((joint, late))
}

/// The drift, if it is one: slow impacts match late, and two beginnings say so, of all impacts or of the clear ones.
fn late(joint: &Joint<'_>) -> Option<Late> {
    let by = |clear| {
        let mut pairs = SHARES.windows(2);
        pairs.find_map(|pair| late_by(joint, clear, pair))
    };
    CLEAR.into_iter().find_map(by)
}

/// The same by two beginnings, of the impacts that are so clear.
fn late_by(joint: &Joint<'_>, clear: f64, shares: &[f64]) -> Option<Late> {
    let &[longer, shorter] = shares else {
        return None;
    };
    let mut begins = Beginnings::of(joint, longer, clear)?;
    let longer = drift(joint, &begins.settled())?;
    // From where the longer beginnings stand, the shorter ones cannot be missed.
    begins.length = beginning(joint, shorter)?;
    let places = begins.settled();
    let shorter = drift(joint, &places)?;
    let known = joint.started.slownesses.iter().zip(&places);
    let slownesses = known.filter_map(|(&slowness, place)| place.map(|_| slowness));
    let range = slownesses.fold((0.0_f64, 0.0_f64), |(a, b), u| (a.min(u), b.max(u)));
    let ((long, long_std), (short, short_std)) = (longer.whole(range), shorter.whole(range));
    let agree = (short - long).abs() < AGREEING * short_std.hypot(long_std);
    (agree && short < -SIGNIFICANT * short_std).then_some(shorter)
}

/// "Begins" less "matches" as a function of slowness, by least squares that forgive what lies far off.
fn drift(joint: &Joint<'_>, begins: &[Option<(f64, f64)>]) -> Option<Late> {
    let matched = joint.places.iter().zip(&joint.started.slownesses);
    let values: Vec<Value> = begins
        .iter()
        .zip(matched)
        .filter_map(|(begin, (place, &slowness))| {
            let (position, std) = (*begin)?;
            Some(Value {
                slowness,
                late: position - place.position,
                std: std.hypot(SCATTER_S * joint.started.rate),
            })
        })
        .collect();
    if values.len() < FEWEST {
        return None;
    }
    let terms = joint.template.components.len().max(2);
    average(&values, terms, LIMIT)
}

/// The curve through all values, each weighed anew by how far off it lies until the curve rests: Cauchy's weights, for three
/// robust standard deviations.
fn average(values: &[Value], terms: usize, limit: usize) -> Option<Late> {
    let mut weights: Vec<f64> = values.iter().map(|v| 1.0 / (v.std * v.std)).collect();
    let mut drift: Option<Late> = None;
    for _ in 0..limit {
        let curve = Curve::through(values, &weights, terms)?;
        let off = |v: &Value| (v.late - curve.at(v.slowness)) / v.std;
        let scale = (MAD_TO_STD * upper_median(values.iter().map(|v| off(v).abs()))?).max(1.0);
        let late = curve.late(scale);
        let rests = drift.is_some_and(|before| late.moved_from(&before) < REST);
        drift = Some(late);
        if rests {
            break;
        }
        for (w, v) in weights.iter_mut().zip(values) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;
    use crate::units::real;

    #[test]
    fn the_curve_rests_on_the_most_whatever_lies_far_off_and_twice_the_limit_changes_nothing() {
        let mut rng = SplitMix64::new(5);
        for terms in [2, 3] {
            let values = (0..40).map(|i| {
                let slowness = 0.02 * real(i) - 0.4;
                let off = if i % 8 == 0 { 60.0 } else { 0.0 };
                let late = 2.0 - 9.0 * slowness + 0.5 * rng.normal() + off;
                Value {
                    slowness,
                    late,
                    std: 0.5,
                }
            });
            let values: Vec<Value> = values.collect();
            let late = average(&values, terms, LIMIT).unwrap();
            let (slope, std) = (late.terms[0], late.covariance[0][0].sqrt());
            assert!((slope + 9.0).abs() < 3.0 * std, "{slope} ± {std}");
            let longer = average(&values, terms, 2 * LIMIT).unwrap();
            assert_eq!(late.terms, longer.terms);
        }
    }
}
