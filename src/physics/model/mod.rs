//! The model of a ball: restitution and contact time at every speed of impact, and the flight between impacts.

use super::ends::Ends;
use super::{
    Bounce, FlightLaw, Hop, Leaving, LinearContact, Oscillator, Rebound, ReleaseRule, Restitution,
    RestitutionLaw, check,
};
use crate::Error;

/// A ball on a surface, in air or without: everything that decides when it hits next.
///
/// This one type is fitted to a recording, judged by a rule, drawn as a line and dropped by
/// [`DropSetup`](super::DropSetup). All of it is exact: the linear ball by [`LinearContact`], the flight by [`FlightLaw`].
///
/// ```
/// use bounce_audio::physics::{BallModel, Bounce, FlightLaw, Restitution, RestitutionLaw};
///
/// // e is 0.9 at 1 m/s and falls with the speed to the power of 0.05; 1 ms of contact; drag of a ping-pong ball.
/// let restitution = RestitutionLaw::SpeedPower {
///     restitution: Restitution::new(0.9)?,
///     at_speed_m_per_s: 1.0,
///     exponent: 0.05,
/// };
/// let flight = FlightLaw::with_drag(9.81, 1.4)?;
/// let ball = BallModel::new(flight, Bounce::Given { restitution, contact_time_s: 1e-3 })?;
/// let e = ball.restitution(2.0).map(|e| e.value());
/// assert!((e.unwrap_or(0.0) - 0.9 * 2.0_f64.powf(-0.05)).abs() < 1e-15);
/// # Ok::<(), bounce_audio::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BallModel {
    flight: FlightLaw,
    surface: Surface,
}

/// Rounds in which the contact of a linear ball converges within an interval; each leaves a hundredth or less.
const CONTACT_ROUNDS: usize = 30;

/// A bounce whose parameters were checked.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Surface {
    Linear(LinearContact),
    Given {
        restitution: RestitutionLaw,
        contact_time: f64,
    },
}

impl BallModel {
    /// A flight and a bounce. The weight of a linear ball is that of the flight.
    ///
    /// # Errors
    /// [`Error::Argument`] for a linear ball without a rebound ([`LinearContact::new`]), and naming `contact_time_s` where it
    /// is negative or not finite.
    pub fn new(flight: FlightLaw, bounce: Bounce) -> Result<Self, Error> {
        let surface = match bounce {
            Bounce::Linear { ball, release_rule } => Surface::Linear(LinearContact::new(
                ball,
                flight.gravity_m_per_s2(),
                release_rule,
            )?),
            Bounce::Given {
                restitution,
                contact_time_s,
            } => Surface::Given {
                restitution,
                contact_time: check::non_negative("contact_time_s", contact_time_s)?,
            },
        };
        Ok(Self { flight, surface })
    }

    /// The flight between impacts.
    #[must_use]
    pub const fn flight(&self) -> &FlightLaw {
        &self.flight
    }

    /// Spring and damper of a linear ball; none where restitution and contact time are given.
    #[must_use]
    pub const fn oscillator(&self) -> Option<Oscillator> {
        match &self.surface {
            Surface::Linear(contact) => Some(contact.oscillator()),
            Surface::Given { .. } => None,
        }
    }

    /// The outcome of an impact at this speed.
    ///
    /// With restitution and contact time as given the ball always leaves, undeformed.
    ///
    /// # Errors
    /// [`Error::Argument`] where the speed is not positive and finite, or the law of restitution leaves 0 < e < 1 at this
    /// or a lower speed.
    pub fn rebound(&self, speed_m_per_s: f64) -> Result<Rebound, Error> {
        let speed = check::positive("speed_m_per_s", speed_m_per_s)?;
        self.check_at(speed)?;
        Ok(self.rebound_at(speed))
    }

    /// Restitution of an impact at this speed; none where the ball does not leave, or [`rebound`](Self::rebound) fails.
    #[must_use]
    pub fn restitution(&self, speed_m_per_s: f64) -> Option<Restitution> {
        self.leaving(speed_m_per_s)
            .map(|leaving| leaving.restitution)
    }

    /// Contact time of an impact at this speed, in seconds: 0 for a model without one, none as for
    /// [`restitution`](Self::restitution).
    #[must_use]
    pub fn contact_time_s(&self, speed_m_per_s: f64) -> Option<f64> {
        self.leaving(speed_m_per_s)
            .map(|leaving| leaving.contact_time_s)
    }

    /// The times from impact to impact, in seconds, of a ball that first arrives at this speed, until it does not leave.
    pub fn intervals(&self, speed_m_per_s: f64) -> impl Iterator<Item = f64> + '_ {
        let mut speed = speed_m_per_s;
        std::iter::from_fn(move || {
            let leaving = self.leaving(speed)?;
            let hop = self.hop_after(leaving.speed_m_per_s, -leaving.position_m)?;
            speed = hop.landing_speed_m_per_s;
            Some(leaving.contact_time_s + hop.time_s)
        })
    }

    /// The contact time at the impact that begins an interval between impacts of this length, in seconds.
    ///
    /// That of a linear ball is longer in short intervals; it is found in rounds, for it hardly depends on the speed.
    pub(crate) fn contact_in_s(&self, interval_s: f64) -> f64 {
        let contact = match self.surface {
            Surface::Given { contact_time, .. } => return contact_time,
            Surface::Linear(contact) => contact,
        };
        let leaving_at = |speed: f64| match contact.rebound(speed) {
            Ok(Rebound::Leaves(leaving)) => Some(leaving),
            _ => None,
        };
        // The contact of a fast impact, without weight.
        let mut contact_s = contact.oscillator().contact_time_s().unwrap_or(0.0);
        let mut e = contact
            .oscillator()
            .restitution()
            .map_or(1.0, Restitution::value);
        for _ in 0..CONTACT_ROUNDS {
            let ends = Ends::of(interval_s - contact_s, self.flight.drag_per_s2());
            let speed = |ends: Ends| 0.5 * self.flight.gravity_m_per_s2() * ends.ln_leaving.exp();
            let Some(leaving) = ends.and_then(|ends| leaving_at(speed(ends) / e)) else {
                break;
            };
            let moved_s = (leaving.contact_time_s - contact_s).abs();
            (contact_s, e) = (leaving.contact_time_s, leaving.restitution.value());
            if moved_s < 1e-12 * interval_s {
                break;
            }
        }
        contact_s
    }

    /// Both ends of the flight in an interval between impacts; none where that is no longer than the contact.
    pub(crate) fn ends(&self, interval_s: f64) -> Option<Ends> {
        let flight_s = interval_s - self.contact_in_s(interval_s);
        Ends::of(flight_s, self.flight.drag_per_s2())
    }

    fn leaving(&self, speed_m_per_s: f64) -> Option<Leaving> {
        match self.rebound(speed_m_per_s).ok()? {
            Rebound::Leaves(leaving) => Some(leaving),
            Rebound::Stays => None,
        }
    }

    /// Whether the model holds at this and all lower speeds.
    pub(super) fn check_at(&self, speed: f64) -> Result<(), Error> {
        match self.surface {
            Surface::Linear(_) => Ok(()),
            Surface::Given { restitution, .. } => restitution.at(speed).map(|_| ()),
        }
    }

    /// [`rebound`](Self::rebound) at a speed that was checked.
    pub(super) fn rebound_at(&self, speed: f64) -> Rebound {
        match self.surface {
            Surface::Linear(contact) => contact.rebound_at(speed),
            Surface::Given {
                restitution,
                contact_time,
            } => {
                let restitution = restitution.at_trusted(speed);
                Rebound::Leaves(Leaving {
                    contact_time_s: contact_time,
                    speed_m_per_s: restitution.rebound_speed_m_per_s(speed),
                    position_m: 0.0,
                    restitution,
                    release_rule: ReleaseRule::ZeroDisplacement,
                })
            }
        }
    }

    /// Whether the ball ever stops leaving.
    pub(super) fn comes_to_rest(&self) -> bool {
        match self.surface {
            Surface::Linear(contact) => contact.oscillator().damping_ratio() > 0.0,
            Surface::Given { contact_time, .. } => contact_time > 0.0,
        }
    }

    /// Whether (19) has the ball rest that leaves at this speed: it rises no higher than its rest position (5), with (16),
    /// lies deep. A linear ball that leaves does not rest.
    pub(super) fn rests(&self, leaving: &Leaving, speed: f64) -> bool {
        let Surface::Given { contact_time, .. } = self.surface else {
            return false;
        };
        let frequency = leaving.restitution.pi_norm() / contact_time;
        contact_time > 0.0
            && self.flight.rise_at(speed).height_m
                <= self.flight.gravity_m_per_s2() / frequency / frequency
    }

    /// The flight of a ball that leaves at this speed from so far below the surface at rest; `None` where it does not get
    /// off the surface.
    pub(super) fn hop_after(&self, speed: f64, depth: f64) -> Option<Hop> {
        if depth == 0.0 {
            return Some(self.flight.hop_at(speed));
        }
        let rise = self.flight.rise_at(speed);
        let apex_m = rise.height_m - depth;
        if apex_m <= 0.0 {
            return None;
        }
        let fall = self.flight.fall_from(apex_m);
        Some(Hop {
            time_s: rise.time_s + fall.time_s,
            apex_m,
            landing_speed_m_per_s: fall.landing_speed_m_per_s,
        })
    }
}

#[cfg(test)]
mod tests;
