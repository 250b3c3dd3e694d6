//! The rebound that a drop predicts for a rule, with its interval.

use super::Rule;
use super::decide::{Causes, closer, would_decide};
use crate::Error;
use crate::fit::Estimate;
use crate::physics::priors::SPEED_EXPONENT_BEYOND;
use crate::physics::{Air, DRAG_RELATIVE_STD, FlightLaw, Restitution, Sphere};
use crate::report::Drop;
use crate::report::rule::{Evidence, Judged, Outcome};
use crate::statistics::NORMAL95;

/// A drop is from the rule's height if its impact is as fast within this, the logarithm of the ratio: 10 % of the height.
const NEAR: f64 = 0.05;
/// Fewest impacts that give an e beside that of the first rebound.
const FEWEST_FITTED: usize = 4;

/// A rule's drop of a ball.
#[derive(Debug, Clone, Copy)]
pub(super) struct Test<'a> {
    rule: &'a Rule,
    gravity_m_per_s2: f64,
    flight: FlightLaw,
    /// The flight in air that drags more and less than it should, by one standard deviation.
    off: [FlightLaw; 2],
    /// Speed at the rule's impact.
    speed: f64,
}

/// e at the speed of a rule.
#[derive(Debug, Clone, Copy)]
struct AtSpeed {
    ln: f64,
    /// What the way to that speed adds to the error of ln e.
    std: f64,
    extrapolated: bool,
}

impl<'a> Test<'a> {
    pub(super) fn new(rule: &'a Rule, ball: Sphere, gravity_m_per_s2: f64) -> Result<Self, Error> {
        let law = |factor: f64| {
            let usual = Air::default();
            let air = Air {
                drag_coefficient: factor * usual.drag_coefficient,
                ..usual
            };
            FlightLaw::in_air(gravity_m_per_s2, ball, air)
        };
        let flight = law(1.0)?;
        Ok(Self {
            rule,
            gravity_m_per_s2,
            flight,
            off: [law(1.0 - DRAG_RELATIVE_STD)?, law(1.0 + DRAG_RELATIVE_STD)?],
            speed: flight.fall(rule.drop_height_m)?.landing_speed_m_per_s,
        })
    }

    /// Height of the rebound for this e.
    ///
    /// # Formula
    /// ```text
    /// v = v_t·√(1 − exp(−2gh₀/v_t²)),   h = (v_t²/2g)·ln(1 + (e·v/v_t)²)      without air h = e²·h₀
    /// ```
    fn rebound_m(&self, flight: &FlightLaw, ln_e: f64) -> Result<f64, Error> {
        let speed = flight.fall(self.rule.drop_height_m)?.landing_speed_m_per_s;
        Ok(flight.rise(ln_e.exp() * speed)?.height_m)
    }

    /// By the drop's own first rebound if it fell from about the rule's height, else by e at the rule's speed.
    pub(super) fn judge(&self, drop: &Drop) -> Result<Judged, Error> {
        let fitted = self.fitted(drop)?;
        let Some(own) = self.own(drop)? else {
            return Ok(fitted);
        };
        let outcome = outcome(own, self.rule.allowed_m);
        let undecided = outcome == Outcome::Undecided;
        Ok(Judged {
            outcome,
            evidence: Evidence::FirstRebound,
            rebound_m: Some(own),
            // Of two impacts e is that of the first rebound too.
            fitted_rebound_m: fitted.rebound_m.filter(|_| drop.bounces >= FEWEST_FITTED),
            would_decide: undecided.then(|| closer(own, self.rule.allowed_m)),
            ..fitted
        })
    }

    /// The rebound from the rule's height by that from one near it; none where the drop was made from another.
    ///
    /// # Formula
    /// `h = R·h₀·c`, with R the share of its height that the ball came back to, h₀ the rule's height and c what drag makes of R
    /// between both heights; its relative error is that of R and that of e by the way between the speeds.
    fn own(&self, drop: &Drop) -> Result<Option<Estimate>, Error> {
        let Some(first) = &drop.first_rebound else {
            return Ok(None);
        };
        let way = (self.speed / first.impact_speed_m_per_s).ln().abs();
        if way > NEAR {
            return Ok(None);
        }
        let ln_e = first.restitution.value.ln();
        let at = |height_m: f64| -> Result<f64, Error> {
            let speed = self.flight.fall(height_m)?.landing_speed_m_per_s;
            Ok(self.flight.rise(ln_e.exp() * speed)?.height_m / height_m)
        };
        let (drop_m, rule_m) = (first.drop_height_m, self.rule.drop_height_m);
        let value = first.resilience.value * rule_m * at(rule_m)? / at(drop_m)?;
        let share = first.resilience.std_error.unwrap_or(0.0) / first.resilience.value;
        let std = value * share.hypot(2.0 * SPEED_EXPONENT_BEYOND * way);
        let reach = NORMAL95 * std;
        Ok(Some(Estimate {
            value,
            std_error: Some(std),
            interval95: Some([value - reach, value + reach]),
        }))
    }

    fn fitted(&self, drop: &Drop) -> Result<Judged, Error> {
        let mut judged = Judged {
            outcome: Outcome::Undecided,
            evidence: Evidence::Restitution,
            fitted_rebound_m: None,
            rebound_m: None,
            single_rebound_std_m: None,
            impact_speed_m_per_s: self.speed,
            restitution: None,
            measured_speeds_m_per_s: measured_speeds(drop),
            extrapolated: false,
            would_decide: Some("four impacts or more give e an error, and a verdict".to_owned()),
        };
        let Some(e) = drop.restitution.as_ref().map(|r| r.estimate) else {
            return Ok(judged);
        };
        let at = self.at_speed(drop, e.value, judged.measured_speeds_m_per_s);
        let value = self.rebound_m(&self.flight, at.ln)?;
        judged.restitution = Some(at.ln.exp());
        judged.extrapolated = at.extrapolated;
        judged.rebound_m = Some(Estimate::bare(value));
        let (Some(std), Some(ends)) = (e.std_error, e.interval95) else {
            return Ok(judged);
        };
        let (drag, slope) = (self.drag_std_m(at.ln)?, self.slope_m(at.ln)?);
        let end = |end: f64| -> Result<f64, Error> {
            let ln = (end / e.value).ln();
            let reach = ln.hypot(NORMAL95 * at.std).copysign(ln);
            let off = self.rebound_m(&self.flight, at.ln + reach)? - value;
            Ok(value + off.hypot(NORMAL95 * drag).copysign(off))
        };
        let rebound = Estimate {
            value,
            std_error: Some((slope * (std / e.value).hypot(at.std)).hypot(drag)),
            interval95: Some([end(ends[0])?, end(ends[1])?]),
        };
        judged.rebound_m = Some(rebound);
        judged.single_rebound_std_m = drop.scatter.bounce_std.map(|s| slope * s);
        judged.outcome = outcome(rebound, self.rule.allowed_m);
        let causes = Causes {
            e_std_m: slope * std / e.value,
            speed_std_m: slope * at.std,
            drag_std_m: drag,
        };
        let undecided = judged.outcome == Outcome::Undecided;
        judged.would_decide = undecided.then(|| would_decide(self.rule, drop, rebound, causes));
        Ok(judged)
    }

    /// Derivative of the rebound by ln e.
    fn slope_m(&self, ln_e: f64) -> Result<f64, Error> {
        const STEP: f64 = 1e-5;
        let at = |ln| self.rebound_m(&self.flight, ln);
        Ok((at(ln_e + STEP)? - at(ln_e - STEP)?) / (2.0 * STEP))
    }

    /// Error of the rebound by that of the drag.
    fn drag_std_m(&self, ln_e: f64) -> Result<f64, Error> {
        let [less, more] = &self.off;
        Ok(0.5 * (self.rebound_m(less, ln_e)? - self.rebound_m(more, ln_e)?).abs())
    }

    /// ln e at the rule's speed under the selected model.
    fn at_speed(&self, drop: &Drop, e: f64, measured: Option<[f64; 2]>) -> AtSpeed {
        let mean = drop.restitution.as_ref().and_then(|r| r.at_speed_m_per_s);
        let beyond = measured.map_or(0.0, |[slowest, fastest]| {
            (self.speed / fastest)
                .ln()
                .max((slowest / self.speed).ln())
                .max(0.0)
        });
        // A fitted exponent has its own error out there.
        let std = match (drop.model.parameters.speed_exponent, mean) {
            (Some(p), Some(mean)) => p.std_error.unwrap_or(0.0) * (self.speed / mean).ln(),
            _ => SPEED_EXPONENT_BEYOND * beyond,
        };
        let ball = drop.ball_model(self.gravity_m_per_s2);
        let there = ball.and_then(|ball| ball.restitution(self.speed));
        AtSpeed {
            ln: there.map_or_else(|| e.ln().min(-f64::EPSILON), Restitution::ln),
            std: std.abs(),
            extrapolated: beyond > 0.0,
        }
    }
}

/// By its interval.
pub(super) fn outcome(rebound: Estimate, [least, most]: [f64; 2]) -> Outcome {
    match rebound.interval95 {
        Some([low, high]) if low >= least && high <= most => Outcome::Pass,
        Some([low, high]) if high < least || low > most => Outcome::Fail,
        _ => Outcome::Undecided,
    }
}

/// Speeds of the impacts of which e was measured.
fn speeds(drop: &Drop) -> impl Iterator<Item = f64> + '_ {
    let bounces = drop.impacts.iter().map(|i| &i.bounce);
    bounces
        .filter(|b| b.restitution.is_some())
        .filter_map(|b| b.impact_speed_m_per_s)
}

fn measured_speeds(drop: &Drop) -> Option<[f64; 2]> {
    let slowest = speeds(drop).fold(f64::INFINITY, f64::min);
    let fastest = speeds(drop).fold(0.0, f64::max);
    (fastest > 0.0).then_some([slowest, fastest])
}
