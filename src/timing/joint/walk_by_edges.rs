//! The time walk as the leading edges show it.

use super::alternate::Joint;
use super::curve::{Curve, REST, in_std};
use super::damping::Damping;
use super::leading_edge::{Course, LeadingEdges};
use super::time_walk::{FEWEST, TimeWalk};

/// Slowing before anything is heard, and its standard deviation: somewhere between edges that are all alike and edges that
/// are as slow as the contact is long.
const SLOWING: f64 = 0.5;
const SLOWING_STD: f64 = 0.5;
/// Rounds in which walk and slowing are fitted, at most: more than twice the most seen.
const LIMIT: usize = 200;

/// The walk of the leading edges; none where there are too few. Where edges lie is fitted first, and then how slow they are too.
pub(super) fn walk_by_edges(joint: &Joint<'_>) -> Option<TimeWalk> {
    let mut edges = LeadingEdges::of(joint)?;
    let mut course = Course {
        walk: TimeWalk::default(),
        slowing: SLOWING,
    };
    let terms = joint.template.components.len().max(2);
    let mean_contact = joint.started.mean_contact();
    let mut damping = Damping::of(3);
    let mut placed = false;
    for _ in 0..LIMIT {
        let step = edges.step(&course)?;
        if step.times.len() < FEWEST {
            return None;
        }
        let (slowing, std) = slowing(&Curve::robust(&step.slowness, 2)?, mean_contact);
        let found = TimeWalk::of(
            &Curve::robust(&step.times, terms)?,
            (step.late * std).hypot(step.late_std) / mean_contact,
        );
        let slowing = if placed { slowing } else { course.slowing };
        let rests =
            found.moved_from(&course.walk) < REST && in_std(slowing - course.slowing, std) < REST;
        course = damped(
            &course,
            &Course {
                walk: found,
                slowing,
            },
            &mut damping,
        );
        if rests && placed {
            break;
        }
        placed |= rests;
    }
    Some(course.walk)
}

/// Slowing and its standard error, by the slowness of edges and by what was known before.
fn slowing(slowness: &Curve, mean_contact: f64) -> (f64, f64) {
    let of_edges = (slowness.covariance[1][1] * mean_contact * mean_contact).recip();
    let before = (SLOWING_STD * SLOWING_STD).recip();
    let sum = of_edges * slowness.coefficients[1] * mean_contact + before * SLOWING;
    let all = of_edges + before;
    ((sum / all).clamp(0.0, 1.0), all.sqrt().recip())
}

/// The way from one course to another, as much of it as is not known to be too far.
fn damped(from: &Course, to: &Course, damping: &mut Damping) -> Course {
    let unknowns = |c: &Course| [c.walk.terms[0], c.walk.terms[1], c.slowing];
    let (from, wanted) = (unknowns(from), unknowns(to));
    let steps: [f64; 3] = std::array::from_fn(|k| damping.share(k) * (wanted[k] - from[k]));
    damping.learn(steps.into_iter());
    Course {
        walk: TimeWalk {
            terms: [from[0] + steps[0], from[1] + steps[1]],
            ..to.walk
        },
        slowing: from[2] + steps[2],
    }
}
