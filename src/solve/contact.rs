//! From restitution and contact time: (14) to (17).

use serde::Serialize;

use super::{SolvedBall, Surroundings, warnings};
use crate::Error;
use crate::physics::{BounceSeries, ContactErrors, Oscillator, Restitution};
use crate::report::Warning;

/// One bounce, seen closely.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ContactInputs {
    /// e, between 0 and 1.
    pub restitution: f64,
    /// ΔT.
    pub contact_time_s: f64,
    /// A height to drop this ball from, to count its bounces.
    pub height_m: Option<f64>,
    /// Gravity, mass and errors.
    #[serde(flatten)]
    pub ball: Surroundings,
}

/// The ball of one bounce.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ContactSolution {
    /// What was given.
    pub inputs: ContactInputs,
    /// The ball.
    pub ball: SolvedBall,
    /// What the reader should know.
    pub warnings: Vec<Warning>,
}

/// The ball with this restitution and contact time.
///
/// # Errors
/// [`Error::Argument`] naming what is out of range.
pub fn from_contact(inputs: &ContactInputs) -> Result<ContactSolution, Error> {
    let restitution = Restitution::new(inputs.restitution)?;
    // A height is looked at only where there is one, gravity always: it is wrong or right by itself.
    let series = BounceSeries::new(inputs.height_m.unwrap_or(1.0), inputs.ball.gravity_m_per_s2)?;
    let series = inputs.height_m.map(|_| series);
    // A ball solved for may have no contact time left; one that is typed in must have it.
    Oscillator::from_contact(restitution, inputs.contact_time_s)?;
    let ball = SolvedBall::new(
        restitution,
        inputs.contact_time_s,
        &inputs.ball,
        series.as_ref(),
    )?;
    let given = inputs.ball.std_error;
    let ball = if given.any() {
        let errors = ContactErrors {
            restitution: given.restitution.unwrap_or(0.0),
            contact_time_s: given.contact_time_s.unwrap_or(0.0),
            correlation: 0.0,
        };
        ball.with_errors(restitution, &errors, &inputs.ball)?
    } else {
        ball
    };
    let mut solution = ContactSolution {
        inputs: *inputs,
        ball,
        warnings: Vec::new(),
    };
    solution.warnings = warnings::of_contact(&solution);
    Ok(solution)
}
