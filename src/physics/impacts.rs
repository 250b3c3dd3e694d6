//! A whole drop, impact by impact, from the closed forms of flight and contact: no time stepping.

use super::{BallModel, DropSetup, Rebound, Scatter};
use crate::random::SplitMix64;

/// One impact and the flight that follows.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Impact {
    /// Moment of touching, from release.
    pub time_s: f64,
    /// Speed on touching.
    pub impact_speed_m_per_s: f64,
    /// Speed on leaving; 0 if the ball does not leave, or rests by (19).
    pub rebound_speed_m_per_s: f64,
    /// From touching to leaving; `None` if the ball does not leave.
    pub contact_time_s: Option<f64>,
    /// Greatest height after this impact; 0 if the ball does not get off the surface.
    pub apex_m: f64,
    /// From leaving to the next touch; 0 after the last impact of a ball at rest.
    pub flight_time_s: f64,
}

impl Impact {
    /// Ratio of rebound speed to impact speed, 0 where the ball does not leave.
    #[must_use]
    pub fn restitution(&self) -> f64 {
        self.rebound_speed_m_per_s / self.impact_speed_m_per_s
    }
}

/// The moment and speed of the next touch.
#[derive(Debug, Clone, Copy)]
struct Touch {
    time: Clock,
    speed: f64,
}

/// How a ball leaves: speed, contact time and how deep below zero displacement.
struct Departure {
    speed: f64,
    contact_time: f64,
    depth: f64,
}

/// Iterator over the impacts of a drop, made by [`DropSetup::impacts`].
#[derive(Debug, Clone)]
pub struct Impacts {
    ball: BallModel,
    scatter: Option<(Scatter, SplitMix64)>,
    shortest_flight: f64,
    left: usize,
    next: Option<Touch>,
}

impl Iterator for Impacts {
    type Item = Impact;

    fn next(&mut self) -> Option<Impact> {
        self.next_with(1.0)
    }
}

impl Impacts {
    /// The next impact, with the speed after it multiplied by a positive factor: a joint of tiles, a seam, another surface.
    ///
    /// The factor comes on top of the ball's own scatter. However great, the ball never leaves faster than it hit.
    pub fn next_with(&mut self, factor: f64) -> Option<Impact> {
        let touch = self.next.take()?;
        self.left -= 1;
        let departure = self.depart(touch.speed, factor);
        let mut impact = Impact {
            time_s: touch.time.s(),
            impact_speed_m_per_s: touch.speed,
            rebound_speed_m_per_s: 0.0,
            contact_time_s: departure.as_ref().map(|leaving| leaving.contact_time),
            apex_m: 0.0,
            flight_time_s: 0.0,
        };
        let Some(leaving) = departure.filter(|leaving| leaving.speed > 0.0) else {
            return Some(impact);
        };
        impact.rebound_speed_m_per_s = leaving.speed;
        if let Some(hop) = self.ball.hop_after(leaving.speed, leaving.depth) {
            (impact.apex_m, impact.flight_time_s) = (hop.apex_m, hop.time_s);
            if self.left > 0 && impact.flight_time_s >= self.shortest_flight {
                let time = touch.time.plus(leaving.contact_time);
                self.next = Some(Touch {
                    time: time.plus(impact.flight_time_s),
                    speed: hop.landing_speed_m_per_s,
                });
            }
        }
        Some(impact)
    }

    /// Starts with the fall. Everything in the setup was checked.
    pub(super) fn new(setup: &DropSetup, ball: BallModel) -> Self {
        let fall = setup.flight.fall_from(setup.height_m);
        let with_stream = |scatter: Scatter| (scatter, SplitMix64::new(scatter.seed));
        Self {
            ball,
            scatter: setup.scatter.map(with_stream),
            shortest_flight: setup.shortest_flight_s.unwrap_or(0.0),
            left: setup.most_impacts.unwrap_or(usize::MAX),
            next: Some(Touch {
                time: Clock::at(fall.time_s),
                speed: fall.landing_speed_m_per_s,
            }),
        }
    }

    /// How the ball leaves after touching at this speed; `None` if it stays.
    fn depart(&mut self, speed: f64, factor: f64) -> Option<Departure> {
        let Rebound::Leaves(leaving) = self.ball.rebound_at(speed) else {
            return None;
        };
        let mut rebound = self.scattered(leaving.speed_m_per_s, speed) * factor;
        if factor > 1.0 {
            rebound = rebound.min(speed);
        }
        let rests = self.ball.rests(&leaving, rebound);
        Some(Departure {
            speed: if rests { 0.0 } else { rebound },
            contact_time: leaving.contact_time_s,
            depth: -leaving.position_m,
        })
    }

    /// A rebound speed with the scatter of one bounce; never faster than the impact, so no bounce makes energy.
    fn scattered(&mut self, rebound: f64, impact: f64) -> f64 {
        match &mut self.scatter {
            None => rebound,
            Some((scatter, random)) => {
                let change = scatter.ln_restitution_std * random.normal();
                (rebound * libm::exp(change)).min(impact)
            }
        }
    }
}

/// A sum of durations that carries its rounding error along (Neumaier), so that a drop of a million bounces ends on
/// time.
#[derive(Debug, Clone, Copy)]
struct Clock {
    sum: f64,
    rest: f64,
}

impl Clock {
    const fn at(time: f64) -> Self {
        Self {
            sum: time,
            rest: 0.0,
        }
    }

    fn plus(self, duration: f64) -> Self {
        let sum = self.sum + duration;
        let lost = if self.sum >= duration {
            (self.sum - sum) + duration
        } else {
            (duration - sum) + self.sum
        };
        Self {
            sum,
            rest: self.rest + lost,
        }
    }

    fn s(self) -> f64 {
        self.sum + self.rest
    }
}
