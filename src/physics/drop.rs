//! A ball to be dropped: height, flight, bounce, scatter and where to stop.

use super::{BallModel, FlightLaw, Impacts, Oscillator, ReleaseRule, RestitutionLaw, check};
use crate::Error;

/// The bounce of a ball at an impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bounce {
    /// The linear ball with its weight, until it no longer leaves. Its weight is that of the flight.
    Linear {
        /// The ball.
        ball: Oscillator,
        /// When its contact ends.
        release_rule: ReleaseRule,
    },
    /// Restitution and contact time as given; the ball rests when it rises no higher than the rest position (5) of the
    /// ball with this restitution and contact time lies deep: the paper's (19), and (20) where the restitution is
    /// constant. Without contact time it never rests.
    Given {
        /// Restitution at each speed.
        restitution: RestitutionLaw,
        /// Contact time of every impact, ≥ 0.
        contact_time_s: f64,
    },
}

/// Scatter of the rebounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scatter {
    /// Standard deviation of ln e from bounce to bounce, independent.
    pub ln_restitution_std: f64,
    /// Seed of the random numbers; the same seed gives the same drop for ever.
    pub seed: u64,
}

/// A ball to be dropped.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DropSetup {
    /// Height of release from rest, from the lowest point of the ball, > 0.
    pub height_m: f64,
    /// The law of its flight.
    pub flight: FlightLaw,
    /// The law of its bounce.
    pub bounce: Bounce,
    /// Scatter of the rebounds, if any.
    pub scatter: Option<Scatter>,
    /// The drop ends at the impact whose flight would be shorter than this.
    pub shortest_flight_s: Option<f64>,
    /// The drop ends at the latest with this impact.
    pub most_impacts: Option<usize>,
}

impl DropSetup {
    /// A drop without scatter or limits.
    #[must_use]
    pub const fn new(height_m: f64, flight: FlightLaw, bounce: Bounce) -> Self {
        Self {
            height_m,
            flight,
            bounce,
            scatter: None,
            shortest_flight_s: None,
            most_impacts: None,
        }
    }

    /// The impacts, one after another, until the ball rests or a limit is reached.
    ///
    /// # Errors
    /// [`Error::Argument`] for a number out of range, and naming `most_impacts` where the ball never rests and neither
    /// limit is given.
    pub fn impacts(&self) -> Result<Impacts, Error> {
        check::positive("height_m", self.height_m)?;
        let speed = self.flight.fall_from(self.height_m).landing_speed_m_per_s;
        check::positive("impact_speed_m_per_s", speed)?;
        let ball = BallModel::new(self.flight, self.bounce)?;
        // The first impact is the fastest.
        ball.check_at(speed)?;
        self.check_limits(ball.comes_to_rest())?;
        if let Some(scatter) = self.scatter {
            check::non_negative("ln_restitution_std", scatter.ln_restitution_std)?;
        }
        Ok(Impacts::new(self, ball))
    }

    fn check_limits(&self, comes_to_rest: bool) -> Result<(), Error> {
        if let Some(shortest) = self.shortest_flight_s {
            check::positive("shortest_flight_s", shortest)?;
        }
        if let Some(most) = self.most_impacts {
            check::bounces("most_impacts", most)?;
        }
        if comes_to_rest || self.shortest_flight_s.is_some() || self.most_impacts.is_some() {
            Ok(())
        } else {
            Err(Error::Argument {
                argument: "most_impacts",
                got: "absent".to_owned(),
                expected: "a number (or shortest_flight_s), for this ball never rests",
            })
        }
    }
}
