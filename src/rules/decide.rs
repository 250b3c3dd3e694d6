//! What would decide an undecided verdict.

use super::Rule;
use crate::fit::Estimate;
use crate::report::Drop;
use crate::units::real;

/// More bounces than this no one records.
const MOST_BOUNCES: f64 = 2_000.0;
/// To hear the rule's speed, the ball has to be dropped from higher by this factor than its rebound demands.
const HIGHER: f64 = 1.1;

/// Standard errors of the rebound in metres, by their causes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Causes {
    /// By that of e.
    pub e_std_m: f64,
    /// By what e may be at the rule's speed, which was not heard.
    pub speed_std_m: f64,
    /// By the drag of the air.
    pub drag_std_m: f64,
}

/// The greatest part of the error, and how much smaller it would have to be.
pub(super) fn would_decide(rule: &Rule, drop: &Drop, rebound: Estimate, causes: Causes) -> String {
    let Some(shrink) = shrink(rebound, rule.allowed_m) else {
        return "nothing would decide it: the rebound lies on the limit itself".to_owned();
    };
    let needed = format!("an error {shrink:.1} times smaller would decide it");
    let e = drop.restitution.as_ref().map_or(1.0, |r| r.estimate.value);
    if causes.speed_std_m > causes.e_std_m.max(causes.drag_std_m) {
        let height_cm = 100.0 * HIGHER * rule.drop_height_m / (e * e);
        return format!(
            "{needed}; most of it is that impacts as fast were not heard: drop the ball from {height_cm:.0} cm"
        );
    }
    if causes.drag_std_m > causes.e_std_m {
        return format!("{needed}; most of it is the drag of the air: measure the rebound itself");
    }
    format!("{needed}: {}", by_budget(drop, shrink))
}

/// What would decide a drop from the rule's own height.
pub(super) fn closer(rebound: Estimate, allowed_m: [f64; 2]) -> String {
    match shrink(rebound, allowed_m) {
        None => "nothing would decide it: the rebound lies on the limit itself".to_owned(),
        Some(shrink) => format!(
            "an error {shrink:.1} times smaller would decide it: measure the height, the mass and diameter of the ball and its \
             contact time, or drop it several times"
        ),
    }
}

/// By how much the error has to shrink for the interval to leave the nearer limit; none if the value is at the limit.
fn shrink(rebound: Estimate, allowed_m: [f64; 2]) -> Option<f64> {
    let [low, high] = rebound.interval95?;
    let off = |limit: f64| {
        let reach = if limit > rebound.value {
            high - rebound.value
        } else {
            rebound.value - low
        };
        reach / (limit - rebound.value).abs()
    };
    let shrink = allowed_m.into_iter().map(off).fold(0.0, f64::max);
    (shrink < MOST_BOUNCES.sqrt()).then_some(shrink)
}

/// What makes the error of e smaller, by its greatest cause.
fn by_budget(drop: &Drop, shrink: f64) -> String {
    let Some(budget) = &drop.budget else {
        return "record a longer drop".to_owned();
    };
    let bounces = budget.bounce + budget.noise_sizes;
    let greatest = bounces
        .max(budget.timing)
        .max(budget.inputs)
        .max(budget.model);
    if bounces >= greatest {
        let more = real(drop.bounces) * shrink * shrink;
        format!(
            "record about {more:.0} bounces in place of {}, in several drops",
            drop.bounces
        )
    } else if budget.timing >= greatest {
        "make the times of the impacts that much more exact, by a nearer microphone or a quieter room".to_owned()
    } else if budget.inputs >= greatest {
        "measure the mass, the diameter and the contact time, and give them".to_owned()
    } else {
        "record longer or more clearly, which tells the models apart".to_owned()
    }
}
