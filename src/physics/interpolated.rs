//! The exact contact of a linear ball at a few speeds, interpolated: a fast form of [`LinearContact`] with derivatives.
//!
//! By gravity in contact slow impacts of such a ball last longer and lose more. Both depend on `s = ΔT/T` alone, ΔT the contact time
//! of a fast impact and `T = 2v/g` the flight that has its speed, and on e of a fast impact: to first order
//! `ln e(s) = ln e₀ − s·4ζ√(1 − ζ²)·(1 + e₀)/(π·e₀)`.

use super::{LinearContact, Oscillator, Rebound, ReleaseRule, Restitution};
use crate::units::real;

/// Places at which the contact is solved: up to `s = ½` the rest is below 1e-6 of ln e.
const NODES: usize = 8;
/// The range of s is at least this long.
const LEAST_SHARE: f64 = 0.01;

/// The effect of the weight on one impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct WeightEffect {
    /// `ln(e/e₀)`, and its derivative by s.
    pub loss: (f64, f64),
    /// Contact time over that of a fast impact, and its derivative by s.
    pub longer: (f64, f64),
}

/// The effect of the weight on the impacts of a ball.
#[derive(Debug, Clone)]
pub(crate) struct InterpolatedContact {
    nodes: [f64; NODES],
    /// Divided differences of `ln(e/e₀)/s` and of `(ΔT(s)/ΔT − 1)/s`.
    loss: [f64; NODES],
    longer: [f64; NODES],
}

impl InterpolatedContact {
    /// For a ball of `ln e₀` and s from 0 to `greatest`. None if e₀ is not between 0 and 1, or the ball does not leave at
    /// the greatest s.
    pub(crate) fn of(ln_restitution: f64, greatest: f64) -> Option<Self> {
        let restitution = Restitution::from_ln(ln_restitution).ok()?;
        // A unit of time is ΔT, and g = 2: then v = T.
        let ball = Oscillator::from_contact(restitution, 1.0).ok()?;
        let contact = LinearContact::new(ball, 2.0, ReleaseRule::ZeroDisplacement).ok()?;
        let greatest = greatest.max(LEAST_SHARE);
        let (mut nodes, mut loss, mut longer) = ([0.0; NODES], [0.0; NODES], [0.0; NODES]);
        for k in 0..NODES {
            let angle = std::f64::consts::PI * (real(k) + 0.5) / real(NODES);
            let s = 0.5 * greatest * (1.0 + angle.cos());
            let Rebound::Leaves(leaving) = contact.rebound(1.0 / s).ok()? else {
                return None;
            };
            nodes[k] = s;
            loss[k] = (leaving.restitution.ln() - ln_restitution) / s;
            longer[k] = (leaving.contact_time_s - 1.0) / s;
        }
        Some(Self {
            loss: differences(&nodes, loss),
            longer: differences(&nodes, longer),
            nodes,
        })
    }

    /// The effect on an impact of this s.
    pub(crate) fn at(&self, s: f64) -> WeightEffect {
        let times_s = |differences: &[f64; NODES]| {
            let (value, slope) = newton(&self.nodes, differences, s);
            (s * value, value + s * slope)
        };
        let (longer, slope) = times_s(&self.longer);
        WeightEffect {
            loss: times_s(&self.loss),
            longer: (1.0 + longer, slope),
        }
    }
}

/// Newton's divided differences of values at the nodes.
fn differences(nodes: &[f64; NODES], mut values: [f64; NODES]) -> [f64; NODES] {
    for order in 1..NODES {
        for k in (order..NODES).rev() {
            values[k] = (values[k] - values[k - 1]) / (nodes[k] - nodes[k - order]);
        }
    }
    values
}

/// Value and derivative of Newton's polynomial.
fn newton(nodes: &[f64; NODES], differences: &[f64; NODES], x: f64) -> (f64, f64) {
    let pairs = nodes.iter().zip(differences).rev();
    pairs.fold((0.0, 0.0), |(value, slope), (node, difference)| {
        (value * (x - node) + difference, slope * (x - node) + value)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_the_nodes_it_is_the_exact_contact() {
        for (e, greatest) in [(0.5_f64, 0.3), (0.75, 0.4), (0.93, 0.5), (0.99, 0.02)] {
            let weight = InterpolatedContact::of(e.ln(), greatest).unwrap();
            let ball = Oscillator::from_contact(Restitution::new(e).unwrap(), 2e-3).unwrap();
            let contact = LinearContact::new(ball, 9.81, ReleaseRule::ZeroDisplacement).unwrap();
            for share in [0.01, 0.1, 0.37, 0.8, 0.99] {
                let s = share * greatest;
                let speed = 0.5 * 9.81 * 2e-3 / s;
                let Rebound::Leaves(exact) = contact.rebound(speed).unwrap() else {
                    panic!("it leaves");
                };
                let effect = weight.at(s);
                let loss = exact.restitution.ln() - e.ln();
                assert!((effect.loss.0 - loss).abs() < 1e-5, "e = {e}, s = {s}");
                let longer = exact.contact_time_s / 2e-3;
                assert!((effect.longer.0 - longer).abs() < 1e-5, "e = {e}, s = {s}");
                let by_s = (weight.at(s * 1.0001).loss.0 - effect.loss.0) / (s * 1e-4);
                assert!((effect.loss.1 - by_s).abs() < 1e-3 * by_s.abs());
            }
        }
    }

    #[test]
    fn slow_impacts_lose_what_the_first_order_says() {
        let e = 0.9_f64;
        let zeta = -e.ln() / std::f64::consts::PI.hypot(e.ln());
        let first =
            4.0 * zeta * (1.0 - zeta * zeta).sqrt() * (1.0 + e) / (std::f64::consts::PI * e);
        let loss = InterpolatedContact::of(e.ln(), 0.1)
            .unwrap()
            .at(1e-4)
            .loss
            .0;
        assert!((loss / (-1e-4 * first) - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_ball_that_does_not_leave_has_no_such_effect() {
        assert!(InterpolatedContact::of(0.5_f64.ln(), 2.0).is_none());
        assert!(InterpolatedContact::of(0.1, 0.1).is_none());
    }
}
