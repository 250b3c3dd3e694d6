//! Time walk: slow impacts have longer contacts, so their sounds match the common template late; their leading edges do not.

use super::align::Aligned;
use super::alternate::{Joint, Rivals};
use super::curve::{Curve, greatest_in_std};
use super::start::Started;
use super::walk_by_edges::walk_by_edges;

/// The correction of the positions for time walk, so that they stand at the touch and not at a constant share of the
/// contact: `c₁·u + c₂·u²` samples for a contact stretch u. A longer contact makes c₁; where components were learnt in u and
/// u², the positions are undetermined by as much of both, and the leading edges determine that too.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct TimeWalk {
    pub terms: [f64; 2],
    pub covariance: [[f64; 2]; 2],
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

    /// From a curve without its level; its slope has another standard error besides, in samples.
    pub(super) fn of(curve: &Curve, slope_std: f64) -> Self {
        let [_, slope, bend] = curve.coefficients;
        let [_, [_, a, b], [_, _, c]] = curve.covariance;
        Self {
            terms: [slope, bend],
            covariance: [[a + slope_std * slope_std, b], [b, c]],
        }
    }

    /// Greatest distance of its terms from those of another, in its own standard errors.
    pub(super) fn moved_from(&self, other: &Self) -> f64 {
        greatest_in_std((0..2).map(|k| {
            let moved = self.terms[k] - other.terms[k];
            (moved, self.covariance[k][k].sqrt())
        }))
    }

    /// From the fastest to the slowest impact: the shift and its standard error.
    fn whole(&self, (fast, slow): (f64, f64)) -> (f64, f64) {
        let shift = self.shift(slow) - self.shift(fast);
        (shift, self.std_of([slow - fast, slow * slow - fast * fast]))
    }
}

/// Fewest impacts that a time walk is fitted to, and that one or two more components are learnt from.
pub(super) const FEWEST: usize = 5;
const FEWEST_LINEAR: usize = 8;
const FEWEST_SQUARE: usize = 12;
/// Standard errors by which a time walk differs from 0 at least …
const SIGNIFICANT: f64 = 4.0;
/// … and by which one is hinted at where all sounds were taken to be alike, so that the dearer template is tried.
const HINT: f64 = 2.0;

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
    if let Some(early) = early {
        return early;
    }
    let ambiguities = joint.search_and_settle();
    let late = (!hinted && walk(&joint, HINT).is_some()).then(|| with_walk(started, aligned));
    late.flatten().unwrap_or_else(|| Corrected {
        joint,
        walk: TimeWalk::default(),
        ambiguities,
    })
}

/// The impacts refined by a template that depends on the contact stretch, and their time walk; none if it is not significant.
fn with_walk<'a>(started: &'a Started, aligned: &Aligned) -> Option<Corrected<'a>> {
    let count = aligned.places.len();
    if count < FEWEST {
        return None;
    }
    let more = [FEWEST_LINEAR, FEWEST_SQUARE];
    let components = 1 + more.iter().filter(|&&n| count >= n).count();
    let mut joint = Joint::of(started, aligned.clone(), components);
    // Without jumps: they would go to where a wrong shape fits, before impacts of all speeds have taught it. And no longer than
    // the walk is hinted at: rings that overlap look like one at first, and wander for long.
    joint.settle_while(|joint| walk(joint, HINT).is_some());
    walk(&joint, SIGNIFICANT)?;
    let ambiguities = joint.jump_and_settle(Rivals::of(count));
    let walk = walk(&joint, SIGNIFICANT)?;
    Some(Corrected {
        joint,
        walk,
        ambiguities,
    })
}

/// The time walk, if slow impacts match late by so many standard errors by their leading edges.
fn walk(joint: &Joint<'_>, significant: f64) -> Option<TimeWalk> {
    let walk = walk_by_edges(joint)?;
    let stretches = joint.started.contact_stretches.iter();
    let range = stretches.fold((0.0_f64, 0.0_f64), |(a, b), &u| (a.min(u), b.max(u)));
    let (shift, std) = walk.whole(range);
    (shift < -significant * std).then_some(walk)
}
