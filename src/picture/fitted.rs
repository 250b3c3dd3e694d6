//! The flights that the model of a drop expects, for the lines in its pictures.

use crate::physics::ends::Ends;
use crate::physics::{LinearContact, Oscillator, Rebound, ReleaseRule, VISCOELASTIC_POWER};
use crate::report::Drop;

/// Rounds in which a line is moved onto the flights.
const ROUNDS: usize = 30;

/// e and the time in contact at every speed, and the drag between.
#[derive(Debug, Clone)]
pub(super) struct Law {
    restitution: f64,
    /// e is `restitution` at this speed in m/s, and goes with this power of how much slower an impact is.
    at_speed_m_per_s: f64,
    exponent: f64,
    /// Whether ln e goes with the fifth root of the speed instead.
    viscoelastic: bool,
    contact_s: f64,
    /// K in s⁻².
    drag_per_s2: f64,
    gravity_m_per_s2: f64,
    /// The linear ball with its weight, where that is the model and its contact is known.
    weighty: Option<LinearContact>,
    /// e over that of the model, for a line beside its own.
    factor: f64,
}

impl Law {
    /// That of the model selected; none for a drop without e.
    pub(super) fn of(drop: &Drop, gravity_m_per_s2: f64) -> Option<Self> {
        let restitution = drop.restitution.as_ref()?;
        let parameter = |name: &str| {
            let entry = drop.model.parameters.get(name)?;
            entry.get("value")?.as_f64()
        };
        let linear = drop.model.selected.starts_with("linear");
        let ball = drop.ball.as_ref().filter(|_| linear);
        let weighty = ball.and_then(|b| {
            let ball = Oscillator::new(b.natural_frequency_rad_per_s, b.damping_ratio).ok()?;
            LinearContact::new(ball, gravity_m_per_s2, ReleaseRule::ZeroDisplacement).ok()
        });
        Some(Self {
            restitution: restitution.estimate.value,
            at_speed_m_per_s: restitution.at_speed_m_per_s?,
            exponent: parameter("speed_exponent").unwrap_or(0.0),
            viscoelastic: drop.model.selected == "viscoelastic",
            contact_s: parameter("contact_time_s").unwrap_or(0.0),
            drag_per_s2: parameter("drag_per_s2").unwrap_or(0.0),
            gravity_m_per_s2,
            weighty,
            factor: 1.0,
        })
    }

    /// The same with another e at its speed.
    pub(super) fn with_restitution(&self, restitution: f64) -> Self {
        Self {
            factor: restitution / self.restitution,
            ..self.clone()
        }
    }

    /// e and the time in contact, in seconds, of an impact at this speed; none where the ball would not leave.
    pub(super) fn contact(&self, speed_m_per_s: f64) -> Option<(f64, f64)> {
        let Some(weighty) = &self.weighty else {
            let slower = self.at_speed_m_per_s / speed_m_per_s;
            let own = if self.viscoelastic {
                self.restitution.powf(slower.powf(-VISCOELASTIC_POWER))
            } else {
                self.restitution * slower.powf(self.exponent)
            };
            return Some((self.factor * own, self.contact_s));
        };
        match weighty.rebound(speed_m_per_s).ok()? {
            Rebound::Leaves(leaving) => Some((
                self.factor * leaving.restitution.value(),
                leaving.contact_time_s,
            )),
            Rebound::Stays => None,
        }
    }

    /// The intervals between impacts, in seconds, of a ball that first arrives at this speed: as many as asked for, or
    /// until it would not leave.
    fn intervals(&self, first_speed_m_per_s: f64, count: usize) -> Vec<f64> {
        let mut speed = first_speed_m_per_s;
        let mut interval = || {
            let (e, contact_s) = self.contact(speed)?;
            let flight_s = self.flight_s(2.0 * e * speed / self.gravity_m_per_s2);
            let ends = Ends::of(flight_s, self.drag_per_s2)?;
            speed = 0.5 * self.gravity_m_per_s2 * ends.ln_landing.exp();
            Some(flight_s + contact_s)
        };
        (0..count).map_while(|_| interval()).collect()
    }

    /// The flight that begins at a speed, given as the flight without air that it makes: the inverse of [`Ends::of`].
    fn flight_s(&self, without_air_s: f64) -> f64 {
        let root = self.drag_per_s2.max(0.0).sqrt();
        let a = 0.5 * root * without_air_s;
        if a < 1e-6 {
            return without_air_s;
        }
        (a.atan() + a.asinh()) / root
    }

    /// The intervals of the model that lie nearest to those observed, by their logarithms and with these weights.
    pub(super) fn nearest(&self, observed: &[Observed]) -> Vec<f64> {
        let Some(first) = observed
            .iter()
            .find_map(|o| Some((o.number, o.interval_s?)))
        else {
            return Vec::new();
        };
        let count = observed.len();
        let flight_s = (first.1 - self.contact_s).max(0.1 * first.1);
        let earlier = self.restitution.powf(-1.0 - crate::units::real(first.0));
        let mut speed = 0.5 * self.gravity_m_per_s2 * flight_s * earlier;
        for _ in 0..ROUNDS {
            let fitted = self.intervals(speed, count);
            let (mut sum, mut weights) = (0.0, 0.0);
            for (o, fitted) in observed.iter().zip(&fitted) {
                let Some(interval_s) = o.interval_s else {
                    continue;
                };
                sum += o.weight * (interval_s / fitted).ln();
                weights += o.weight;
            }
            if weights > 0.0 {
                speed *= (sum / weights).exp();
            }
        }
        self.intervals(speed, count)
    }
}

/// An interval to lay a line through.
#[derive(Debug, Clone, Copy)]
pub(super) struct Observed {
    /// Number of the impact before it, counted from 0.
    pub number: usize,
    /// Seconds; none where an end was not heard.
    pub interval_s: Option<f64>,
    /// How much it counts.
    pub weight: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_of_a_ball_with_drag_contact_and_a_power_of_speed_lies_on_its_flights() {
        let law = Law {
            restitution: 0.9,
            at_speed_m_per_s: 1.0,
            exponent: 0.02,
            viscoelastic: false,
            contact_s: 1e-3,
            drag_per_s2: 1.2,
            gravity_m_per_s2: 9.81,
            weighty: None,
            factor: 1.0,
        };
        let truth = law.intervals(2.4, 20);
        assert!((truth[0] - 1e-3) < 2.0 * 0.9 * 2.4 / 9.81 && truth[1] < truth[0]);
        let observed = truth.iter().enumerate().map(|(number, &t)| Observed {
            number,
            interval_s: (number != 3).then_some(t),
            weight: 1.0,
        });
        let line = law.nearest(&observed.collect::<Vec<_>>());
        let worst = line.iter().zip(&truth).map(|(l, t)| (l / t).ln().abs());
        assert!(worst.fold(0.0, f64::max) < 1e-4);
        let livelier = law.with_restitution(0.91).intervals(2.4, 20);
        assert!(livelier[19] > truth[19]);
    }

    #[test]
    fn a_viscoelastic_ball_loses_as_the_fifth_root_of_its_speed() {
        let law = Law {
            restitution: 0.9,
            at_speed_m_per_s: 1.0,
            exponent: 0.0,
            viscoelastic: true,
            contact_s: 0.0,
            drag_per_s2: 0.0,
            gravity_m_per_s2: 9.81,
            weighty: None,
            factor: 1.0,
        };
        let e = |speed: f64| law.contact(speed).map(|(e, _)| e);
        assert_eq!(e(1.0), Some(0.9));
        let slow = e(1.0 / 32.0).map(|e| e - 0.9_f64.sqrt());
        assert!(slow.is_some_and(|off| off.abs() < 1e-12), "{slow:?}");
    }
}
