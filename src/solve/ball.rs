//! The ball that restitution and contact time make, with its errors and what it would do when dropped.

use std::f64::consts::TAU;

use serde::Serialize;

use super::Surroundings;
use crate::Error;
use crate::physics::{
    Ball, Bounce, BounceSeries, ContactErrors, DropSetup, FlightLaw, Impact, Oscillator,
    ParameterErrors, ReleaseRule, Restitution, damping_ratio,
};

/// The numbers of a ball; or, in the same fields, their standard errors.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Parameters {
    /// e.
    pub restitution: f64,
    /// ΔT; null where (20) makes it too short for a number.
    pub contact_time_s: Option<f64>,
    /// k by (14); null without a mass.
    pub stiffness_n_per_m: Option<f64>,
    /// c by (15); null without a mass.
    pub damping_n_s_per_m: Option<f64>,
    /// k/m.
    pub stiffness_per_mass_per_s2: Option<f64>,
    /// c/m.
    pub damping_per_mass_per_s: Option<f64>,
    /// `ω_n` by (16).
    pub natural_frequency_rad_per_s: Option<f64>,
    /// `ω_n/2π`.
    pub natural_frequency_hz: Option<f64>,
    /// ζ by (17).
    pub damping_ratio: Option<f64>,
}

/// A ball, its errors, and when it would come to rest.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SolvedBall {
    /// The ball.
    #[serde(flatten)]
    pub values: Parameters,
    /// When contact ends, for k and c belong to a rule: (14) to (17) take the ball to leave at zero displacement.
    pub release_rule: ReleaseRule,
    /// When it would come to rest; null without a height or a contact time.
    pub rest: Option<Rest>,
    /// Standard errors; null where none of the inputs has one.
    pub std_error: Option<Parameters>,
}

/// How many impacts a ball makes until it rests, counted in two ways.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Rest {
    /// By (19): constant e, rest when the rebound is no higher than the rest position is deep.
    pub impacts_by_eq19: usize,
    /// The exact linear ball with this k and c, its weight kept at every impact; null beyond `MOST_IMPACTS`.
    pub impacts_exact: Option<usize>,
    /// Moment of the last of them, from release.
    pub last_impact_exact_s: Option<f64>,
}

/// How many impacts are followed at most. Lively beyond belief: at e = 0.999 a ball of 1 ms rests after 6,400.
const MOST_IMPACTS: usize = 100_000;

impl SolvedBall {
    /// The ball with this restitution and contact time; `series` is the drop it rests from, if there is one.
    pub(super) fn new(
        restitution: Restitution,
        contact_time_s: f64,
        ball: &Surroundings,
        series: Option<&BounceSeries>,
    ) -> Result<Self, Error> {
        // (20) underflows where n·ln e does. What depends on it then has no number.
        let contact_time = Some(contact_time_s).filter(|&time| time >= SHORTEST_CONTACT_S);
        let oscillator = contact_time
            .map(|time| Oscillator::from_contact(restitution, time))
            .transpose()?;
        let with_mass = match (ball.mass_kg, contact_time) {
            (Some(mass), Some(time)) => Some(Ball::from_contact(mass, restitution, time)?),
            _ => None,
        };
        let frequency = oscillator.map(|o| o.natural_frequency_rad_per_s());
        let rest = match (series, contact_time) {
            (Some(series), Some(time)) => Some(Rest::new(series, restitution, time)?),
            _ => None,
        };
        Ok(Self {
            values: Parameters {
                restitution: restitution.value(),
                contact_time_s: contact_time,
                stiffness_n_per_m: with_mass.map(|b| b.stiffness_n_per_m()),
                damping_n_s_per_m: with_mass.map(|b| b.damping_n_s_per_m()),
                stiffness_per_mass_per_s2: oscillator.map(|o| o.stiffness_per_mass_per_s2()),
                damping_per_mass_per_s: oscillator.map(|o| o.damping_per_mass_per_s()),
                natural_frequency_rad_per_s: frequency,
                natural_frequency_hz: frequency.map(|f| f / TAU),
                damping_ratio: Some(damping_ratio(restitution)),
            },
            release_rule: ReleaseRule::ZeroDisplacement,
            rest,
            std_error: None,
        })
    }

    /// The same with errors, to first order: those of e and ΔT through (14) to (17), that of the mass beside.
    pub(super) fn with_errors(
        mut self,
        restitution: Restitution,
        errors: &ContactErrors,
        ball: &Surroundings,
    ) -> Result<Self, Error> {
        let values = self.values;
        let relative = values
            .contact_time_s
            .map(|time| ParameterErrors::new(restitution, time, errors))
            .transpose()?;
        let mass = relative_mass_error(ball)?;
        let scaled = |value: Option<f64>, part: fn(&ParameterErrors) -> f64, beside: f64| {
            Some(value? * libm::hypot(part(relative.as_ref()?), beside))
        };
        self.std_error = Some(Parameters {
            restitution: errors.restitution,
            contact_time_s: values.contact_time_s.map(|_| errors.contact_time_s),
            stiffness_n_per_m: scaled(values.stiffness_n_per_m, |r| r.stiffness, mass),
            damping_n_s_per_m: scaled(values.damping_n_s_per_m, |r| r.damping, mass),
            stiffness_per_mass_per_s2: scaled(
                values.stiffness_per_mass_per_s2,
                |r| r.stiffness,
                0.0,
            ),
            damping_per_mass_per_s: scaled(values.damping_per_mass_per_s, |r| r.damping, 0.0),
            natural_frequency_rad_per_s: scaled(
                values.natural_frequency_rad_per_s,
                |r| r.natural_frequency,
                0.0,
            ),
            natural_frequency_hz: scaled(values.natural_frequency_hz, |r| r.natural_frequency, 0.0),
            damping_ratio: scaled(values.damping_ratio, |r| r.damping_ratio, 0.0),
        });
        Ok(self)
    }
}

/// The shortest contact time that `physics` takes, far below any ball.
const SHORTEST_CONTACT_S: f64 = 1e-60;

fn relative_mass_error(ball: &Surroundings) -> Result<f64, Error> {
    match (ball.std_error.mass_kg, ball.mass_kg) {
        (Some(error), Some(mass)) if error >= 0.0 && error.is_finite() => Ok(error / mass),
        (Some(error), Some(_)) => Err(Error::argument("std_error.mass_kg", error, "a number ≥ 0")),
        _ => Ok(0.0),
    }
}

impl Rest {
    /// Of the ball with this restitution and contact time.
    pub(super) fn new(
        series: &BounceSeries,
        restitution: Restitution,
        contact_time_s: f64,
    ) -> Result<Self, Error> {
        let oscillator = Oscillator::from_contact(restitution, contact_time_s)?;
        let by_eq19 = series.bounces_to_rest(restitution, contact_time_s)?;
        let last = last_impact(series, oscillator)?;
        Ok(Self {
            impacts_by_eq19: count(by_eq19),
            impacts_exact: last.map(|(impacts, _)| impacts),
            last_impact_exact_s: last.map(|(_, impact)| impact.time_s),
        })
    }
}

/// The last impact of the exact linear ball and its number, if it rests within [`MOST_IMPACTS`].
fn last_impact(series: &BounceSeries, ball: Oscillator) -> Result<Option<(usize, Impact)>, Error> {
    let setup = DropSetup {
        most_impacts: Some(MOST_IMPACTS + 1),
        ..DropSetup::new(
            series.height_m(),
            FlightLaw::without_air(series.gravity_m_per_s2())?,
            Bounce::Linear {
                ball,
                release_rule: ReleaseRule::ZeroDisplacement,
            },
        )
    };
    let last = setup.impacts()?.zip(1..).last();
    Ok(last
        .filter(|&(_, impacts)| impacts <= MOST_IMPACTS)
        .map(|(impact, impacts)| (impacts, impact)))
}

/// A number of bounces rounded up. The n that made a ΔT by (20) comes back as n, not as n + 1 by a rounding error.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "never negative, and `as` saturates"
)]
fn count(bounces: f64) -> usize {
    (bounces * (1.0 - 1e-9)).ceil() as usize
}
