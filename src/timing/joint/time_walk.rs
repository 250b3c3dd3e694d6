//! Time walk: slow impacts have longer contacts, so their sounds match the common template late; their leading edges do not.

use super::align::Aligned;
use super::alternate::Joint;
use super::leading_edge::{LeadingEdges, edge_length};
use super::start::Started;
use crate::signal::template::average::factors;
use crate::statistics::{MAD_TO_STD, upper_median};

/// The correction of the positions for time walk, so that they stand at the touch and not at a constant share of the
/// contact: `c₁·u + c₂·u²` samples for a contact stretch u. A longer contact makes c₁; where components were learnt in u and
/// u², the positions are undetermined by as much of both, and the leading edges determine that too.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct TimeWalk {
    terms: [f64; 2],
    covariance: [[f64; 2]; 2],
}

impl TimeWalk {
    /// Samples to add at a contact stretch.
    pub(super) fn shift(&self, contact_stretch: f64) -> f64 {
        self.terms[0] * contact_stretch + self.terms[1] * contact_stretch * contact_stretch
    }

    /// Standard error of that, against a contact stretch of 0.
    pub(super) fn std(&self, contact_stretch: f64) -> f64 {
        self.std_of([contact_stretch, contact_stretch * contact_stretch])
    }

    fn std_of(&self, by: [f64; 2]) -> f64 {
        let [[a, b], [_, c]] = self.covariance;
        (a * by[0] * by[0] + 2.0 * b * by[0] * by[1] + c * by[1] * by[1])
            .max(0.0)
            .sqrt()
    }

    /// Greatest distance of its terms from those of another, in its own standard errors.
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

/// Fewest impacts that a time walk is fitted to, and that one or two more components are learnt from.
const FEWEST: usize = 5;
const FEWEST_LINEAR: usize = 8;
const FEWEST_SQUARE: usize = 12;
/// Shares of the greatest value at which a leading edge ends. Each is matched from the places of the one before: the longest
/// edge has the most information, but the crests of loud impacts may be clipped.
const SHARES: [f64; 3] = [1.0, 0.8, 0.6];
/// Standard deviations by which the edges used stand out: those of all impacts first, then the clear ones alone, as faint
/// ones may match at a wrong crest.
const CLEAR: [f64; 2] = [f64::NEG_INFINITY, 10.0];
/// Standard errors by which a time walk differs from 0 at least …
const SIGNIFICANT: f64 = 4.0;
/// … and by which one is hinted at where all sounds were taken to be alike, so that the dearer template is tried.
const HINT: f64 = 2.0;
/// Least scatter of the edges of single impacts, in seconds: modes do not begin quite alike.
const SCATTER_S: f64 = 3e-6;
/// Robust averaging ends once the curve moves by no more than this share of its own standard error (convention) …
const REST: f64 = 0.05;
/// … or after this number of rounds: five times the most seen, on the suite and on real recordings.
const LIMIT: usize = 100;

/// The impacts refined, with their correction for time walk.
#[derive(Debug)]
pub(super) struct Corrected<'a> {
    pub joint: Joint<'a>,
    /// The correction, to be added to the positions.
    pub walk: TimeWalk,
    /// Standard error of each position by rival places, in samples; 0 where none were sought.
    pub ambiguities: Vec<f64>,
}

impl<'a> Corrected<'a> {
    /// The impacts as they are.
    pub(super) fn without_walk(joint: Joint<'a>) -> Self {
        Self {
            ambiguities: vec![0.0; joint.places.len()],
            walk: TimeWalk::default(),
            joint,
        }
    }
}

/// Refines the times of impacts as they are aligned, and corrects them for time walk if they have any. It is hinted at by their
/// alignment, or once they rest.
pub(super) fn correct<'a>(mut joint: Joint<'a>, aligned: &Aligned) -> Corrected<'a> {
    let started = joint.started;
    let hinted = walk(&joint, HINT).is_some();
    let early = hinted.then(|| with_walk(started, aligned)).flatten();
    let corrected = |(joint, walk): (Joint<'a>, TimeWalk)| Corrected {
        walk,
        ..Corrected::without_walk(joint)
    };
    if let Some(early) = early {
        return corrected(early);
    }
    let ambiguities = joint.search_and_settle();
    let late = (!hinted && walk(&joint, HINT).is_some()).then(|| with_walk(started, aligned));
    late.flatten().map_or_else(
        || Corrected {
            joint,
            walk: TimeWalk::default(),
            ambiguities,
        },
        corrected,
    )
}

/// The impacts refined by a template that depends on the contact stretch, and their time walk; none if it is not significant.
fn with_walk<'a>(started: &'a Started, aligned: &Aligned) -> Option<(Joint<'a>, TimeWalk)> {
    let count = aligned.places.len();
    if count < FEWEST {
        return None;
    }
    let more = [FEWEST_LINEAR, FEWEST_SQUARE];
    let components = 1 + more.iter().filter(|&&n| count >= n).count();
    let mut joint = Joint::of(started, aligned.clone(), components);
    // Without jumps: they would go to where a wrong shape fits, before impacts of all speeds have taught it. A round shows
    // whether more is worth its time.
    let mut heads = joint.heads();
    if !joint.round(&mut heads) {
        walk(&joint, HINT)?;
        joint.settle();
    }
    let walk = walk(&joint, SIGNIFICANT)?;
    Some((joint, walk))
}

/// The time walk, if slow impacts match late by so many standard errors by a leading edge, of all impacts or of the clear
/// ones.
fn walk(joint: &Joint<'_>, significant: f64) -> Option<TimeWalk> {
    let by = |clear| {
        let mut pairs = SHARES.windows(2);
        pairs.find_map(|pair| walk_by_edges(joint, clear, pair, significant))
    };
    CLEAR.into_iter().find_map(by)
}

/// The time walk by the edges that end at the shorter of two shares, of impacts that stand out by `clear`; none where it is
/// not significant.
fn walk_by_edges(
    joint: &Joint<'_>,
    clear: f64,
    shares: &[f64],
    significant: f64,
) -> Option<TimeWalk> {
    let &[longer, shorter] = shares else {
        return None;
    };
    let mut begins = LeadingEdges::of(joint, longer, clear)?;
    // The longer edges give positions from which the shorter ones cannot match at another crest.
    begins.aligned();
    begins.length = edge_length(joint, shorter)?;
    let places = begins.aligned();
    let walk = fitted(joint, &places)?;
    let known = joint.started.contact_stretches.iter().zip(&places);
    let stretches = known.filter_map(|(&u, place)| place.map(|_| u));
    let range = stretches.fold((0.0_f64, 0.0_f64), |(a, b), u| (a.min(u), b.max(u)));
    let (shift, std) = walk.whole(range);
    (shift < -significant * std).then_some(walk)
}

/// Position of the leading edge less that of the match, as a function of contact stretch, by robust least squares.
fn fitted(joint: &Joint<'_>, begins: &[Option<(f64, f64)>]) -> Option<TimeWalk> {
    let matched = joint.places.iter().zip(&joint.started.contact_stretches);
    let offsets: Vec<EdgeOffset> = begins
        .iter()
        .zip(matched)
        .filter_map(|(begin, (place, &contact_stretch))| {
            let (position, std) = (*begin)?;
            Some(EdgeOffset {
                contact_stretch,
                offset: position - place.position,
                std: std.hypot(SCATTER_S * joint.started.rate),
            })
        })
        .collect();
    if offsets.len() < FEWEST {
        return None;
    }
    let terms = joint.template.components.len().max(2);
    robust_fit(&offsets, terms, LIMIT)
}

/// The curve through all values by iteratively reweighted least squares, until it converges: Cauchy's weights, for three
/// robust standard deviations.
fn robust_fit(values: &[EdgeOffset], terms: usize, limit: usize) -> Option<TimeWalk> {
    let mut weights: Vec<f64> = values.iter().map(|v| 1.0 / (v.std * v.std)).collect();
    let mut walk: Option<TimeWalk> = None;
    for _ in 0..limit {
        let curve = Curve::through(values, &weights, terms)?;
        let off = |v: &EdgeOffset| (v.offset - curve.at(v.contact_stretch)) / v.std;
        let scale = (MAD_TO_STD * upper_median(values.iter().map(|v| off(v).abs()))?).max(1.0);
        let fitted = curve.walk(scale);
        let rests = walk.is_some_and(|before| fitted.moved_from(&before) < REST);
        walk = Some(fitted);
        if rests {
            break;
        }
        for (w, v) in weights.iter_mut().zip(values) {
            *w = 1.0 / (v.std * v.std * (1.0 + (off(v) / (3.0 * scale)).powi(2)));
        }
    }
    walk
}

/// Position of an impact's leading edge less that of its match, in samples: below 0 where it matches late.
struct EdgeOffset {
    contact_stretch: f64,
    offset: f64,
    std: f64,
}

/// A weighted line or parabola, with the covariance of its three coefficients.
struct Curve {
    coefficients: [f64; 3],
    covariance: [[f64; 3]; 3],
}

impl Curve {
    fn through(values: &[EdgeOffset], weights: &[f64], terms: usize) -> Option<Self> {
        let (mut moments, mut right) = ([0.0; 5], [0.0; 3]);
        for (v, weight) in values.iter().zip(weights) {
            let mut power = *weight;
            for (k, moment) in moments.iter_mut().enumerate() {
                *moment += power;
                if k < terms {
                    right[k] += power * v.offset;
                }
                power *= v.contact_stretch;
            }
        }
        let factors = factors(&moments, terms)?;
        Some(Self {
            coefficients: factors.solve(&right),
            covariance: factors.inverse(),
        })
    }

    fn at(&self, contact_stretch: f64) -> f64 {
        let [level, slope, bend] = self.coefficients;
        level + contact_stretch * (slope + contact_stretch * bend)
    }

    /// The curve without its level; `scale` is the ratio of the errors to those that the weights state.
    fn walk(&self, scale: f64) -> TimeWalk {
        let c = |i: usize, j: usize| self.covariance[i][j] * scale * scale;
        TimeWalk {
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
                let contact_stretch = 0.02 * real(i) - 0.4;
                let off = if i % 8 == 0 { 60.0 } else { 0.0 };
                let offset = 2.0 - 9.0 * contact_stretch + 0.5 * rng.normal() + off;
                EdgeOffset {
                    contact_stretch,
                    offset,
                    std: 0.5,
                }
            });
            let offsets: Vec<EdgeOffset> = values.collect();
            let walk = robust_fit(&offsets, terms, LIMIT).unwrap();
            let (slope, std) = (walk.terms[0], walk.covariance[0][0].sqrt());
            assert!((slope + 9.0).abs() < 3.0 * std, "{slope} ± {std}");
            let longer = robust_fit(&offsets, terms, 2 * LIMIT).unwrap();
            assert_eq!(walk.terms, longer.terms);
        }
    }
}
