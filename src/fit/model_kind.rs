//! The kinds of models that are compared, and the ball that each makes of its parameters.
//!
//! A new kind stands here and among the candidates of [`model_selection`](super::model_selection), and where e or contact
//! depend on the speed in a new way also in `physics::RestitutionLaw` and, for the fit, in `trial_law`.

use crate::Error;
use crate::physics::{BallModel, Bounce, FlightLaw, LinearContact, Restitution, RestitutionLaw};
use crate::words::words;

words! {
    /// A model of the intervals between impacts: constant e, and what is added to it.
    #[derive(Default)]
    #[non_exhaustive]
    pub enum ModelKind {
        /// Constant e.
        #[default]
        Constant = "constant",
        /// Viscoelastic spheres: ln e goes with the fifth root of the impact speed.
        Viscoelastic = "viscoelastic",
        /// The time in contact stands in every interval.
        Contact = "contact",
        /// A linear ball with gravity in contact: slow impacts last longer and lose more.
        Linear = "linear",
        /// The air slows the ball.
        Drag = "drag",
        /// e is a power of the impact speed.
        Speed = "speed",
        /// Contact and drag.
        ContactDrag = "contact+drag",
        /// A linear ball and drag.
        LinearDrag = "linear+drag",
        /// Contact and a power of the impact speed.
        ContactSpeed = "contact+speed",
        /// Contact, drag, and any smooth course of e with the speed.
        Flexible = "flexible",
    }
}

/// The parameters of a model; 0 for what it has not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BallParameters {
    /// e at [`at_speed_m_per_s`](Self::at_speed_m_per_s).
    pub restitution: f64,
    /// The speed at which e is stated, > 0.
    pub at_speed_m_per_s: f64,
    /// Contact time; of fast impacts for a linear ball.
    pub contact_time_s: f64,
    /// `K = (g/v_t)²`.
    pub drag_per_s2: f64,
    /// p of `e ∝ v^(−p)`.
    pub speed_exponent: f64,
    /// Gravity.
    pub gravity_m_per_s2: f64,
}

impl ModelKind {
    /// Whether it fits a contact time.
    #[must_use]
    pub const fn has_contact(self) -> bool {
        matches!(
            self,
            Self::Contact | Self::ContactDrag | Self::ContactSpeed | Self::Flexible
        ) || self.is_linear()
    }

    /// Whether it is a linear ball with gravity in contact.
    #[must_use]
    pub const fn is_linear(self) -> bool {
        matches!(self, Self::Linear | Self::LinearDrag)
    }

    /// Whether it fits the drag of the air.
    #[must_use]
    pub const fn has_drag(self) -> bool {
        matches!(
            self,
            Self::Drag | Self::ContactDrag | Self::LinearDrag | Self::Flexible
        )
    }

    /// Whether it fits the power of the impact speed that e goes with, or comes nearest to.
    #[must_use]
    pub const fn has_exponent(self) -> bool {
        matches!(self, Self::Speed | Self::ContactSpeed | Self::Flexible)
    }

    /// Whether its e depends on the impact speed other than by gravity in contact.
    #[must_use]
    pub const fn is_by_speed(self) -> bool {
        self.has_exponent() || matches!(self, Self::Viscoelastic)
    }

    /// The ball that this model makes of its parameters, exactly. An e of 1 or more is taken to be just below.
    ///
    /// A contact time and a drag that are given are in every model, whatever its name.
    ///
    /// # Errors
    /// [`Error::Argument`] for a parameter out of range.
    pub fn ball(self, parameters: &BallParameters) -> Result<BallModel, Error> {
        let &BallParameters {
            at_speed_m_per_s,
            contact_time_s,
            ..
        } = parameters;
        let gravity = parameters.gravity_m_per_s2;
        let flight = FlightLaw::with_drag(gravity, parameters.drag_per_s2)?;
        let ln = parameters.restitution.ln().min(-f64::EPSILON);
        let restitution = Restitution::from_ln(ln)?;
        // A contact of no duration leaves gravity no time.
        if self.is_linear() && contact_time_s > 0.0 {
            let contact = LinearContact::with_restitution_at(
                restitution,
                at_speed_m_per_s,
                contact_time_s,
                gravity,
            )?;
            let bounce = Bounce::Linear {
                ball: contact.oscillator(),
                release_rule: contact.release_rule(),
            };
            return BallModel::new(flight, bounce);
        }
        let restitution = if self.has_exponent() {
            RestitutionLaw::SpeedPower {
                restitution,
                at_speed_m_per_s,
                exponent: parameters.speed_exponent,
            }
        } else if self == Self::Viscoelastic {
            RestitutionLaw::FifthRoot {
                restitution,
                at_speed_m_per_s,
            }
        } else {
            RestitutionLaw::Constant(restitution)
        };
        let bounce = Bounce::Given {
            restitution,
            contact_time_s,
        };
        BallModel::new(flight, bounce)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::model_selection::{Choice, Inputs, select};
    use crate::impact::Impact;

    const BALL: BallParameters = BallParameters {
        restitution: 0.85,
        at_speed_m_per_s: 1.0,
        contact_time_s: 0.0,
        drag_per_s2: 0.0,
        speed_exponent: 0.0,
        gravity_m_per_s2: 9.81,
    };

    /// The impacts of a ball that first arrives at 3 m/s.
    fn impacts(ball: &BallModel) -> Vec<Impact> {
        let mut time_s = 1.0;
        let intervals = ball.intervals(3.0).take(25);
        let times = std::iter::once(0.0).chain(intervals).map(|interval_s| {
            time_s += interval_s;
            time_s
        });
        times.map(|time_s| Impact::heard(time_s, 1e-6)).collect()
    }

    #[test]
    fn a_ball_that_makes_a_drop_is_the_one_that_is_fitted_to_it() {
        let with = |change: fn(&mut BallParameters)| {
            let mut parameters = BALL;
            change(&mut parameters);
            parameters
        };
        for (kind, choice, parameters) in [
            (ModelKind::Constant, Choice::Constant, BALL),
            (
                ModelKind::Contact,
                Choice::Contact,
                with(|p| p.contact_time_s = 2e-3),
            ),
            (
                ModelKind::Linear,
                Choice::Linear,
                with(|p| p.contact_time_s = 5e-3),
            ),
            (ModelKind::Drag, Choice::Drag, with(|p| p.drag_per_s2 = 1.2)),
            (
                ModelKind::Speed,
                Choice::Speed,
                with(|p| p.speed_exponent = 0.04),
            ),
            (ModelKind::Viscoelastic, Choice::Viscoelastic, BALL),
        ] {
            let made = kind.ball(&parameters).unwrap();
            let selection = select(&impacts(&made), &[], &Inputs::default(), choice).unwrap();
            assert_eq!(selection.selected, kind);
            let fitted = selection.ball(9.81).unwrap();
            for speed in [0.3, 1.0, 2.5] {
                let [made_e, fitted_e] =
                    [&made, &fitted].map(|b| b.restitution(speed).unwrap().value());
                assert!(
                    (made_e - fitted_e).abs() < 1e-3,
                    "{kind} at {speed}: {fitted_e}"
                );
                let [made_s, fitted_s] = [&made, &fitted].map(|b| b.contact_time_s(speed).unwrap());
                assert!(
                    (made_s - fitted_s).abs() < 1e-4,
                    "{kind} at {speed}: {fitted_s}"
                );
            }
        }
    }

    #[test]
    fn no_ball_gains_and_a_linear_one_without_contact_is_one_of_constant_e() {
        let lively = BallParameters {
            restitution: 1.1,
            ..BALL
        };
        let e = |kind: ModelKind, p: &BallParameters| kind.ball(p).unwrap().restitution(0.2);
        assert!(e(ModelKind::Constant, &lively).is_some_and(|e| e.value() < 1.0));
        let linear = e(ModelKind::Linear, &BALL).unwrap();
        assert!((linear.value() - 0.85).abs() < 1e-15);
        let wrong = BallParameters {
            drag_per_s2: -1.0,
            ..BALL
        };
        assert!(ModelKind::Drag.ball(&wrong).is_err());
    }
}
