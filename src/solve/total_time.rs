//! From bounces, total time and height: (25), (30), and a known contact time beside them.

use serde::Serialize;

use super::{Rest, SolvedBall, Surroundings, warnings};
use crate::Error;
use crate::physics::{
    BounceSeries, ContactErrors, InputErrors, Inversion, Oscillator, Restitution,
};
use crate::report::Warning;

/// A drop from rest, heard to its end.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TotalTimeInputs {
    /// n, the number of impacts, ≥ 1.
    pub bounces: usize,
    /// `T_total`, from release to rest.
    pub total_time_s: f64,
    /// h0, from the ball's lowest point to the surface.
    pub height_m: f64,
    /// ΔT, if it is known from elsewhere.
    pub contact_time_s: Option<f64>,
    /// Gravity, mass and errors.
    #[serde(flatten)]
    pub ball: Surroundings,
}

/// The ball by each equation.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TotalTimeSolution {
    /// What was given.
    pub inputs: TotalTimeInputs,
    /// e by (25), ΔT by (20).
    pub eq25: SolvedBall,
    /// e by (30), ΔT by (20) with that e.
    pub eq30: SolvedBall,
    /// e by (21), (23) and (24) with the contact time that was given; null without one, or without a root.
    pub with_contact_time: Option<SolvedBall>,
    /// How far ΔT by (20) can be trusted.
    pub conditioning: Conditioning,
    /// What the reader should know.
    pub warnings: Vec<Warning>,
}

/// How much the ΔT of (20), with the e of (25), leans on what it was made from.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Conditioning {
    /// `d ln ΔT / d ln e`: about n.
    pub contact_time_per_restitution: f64,
    /// `d ln ΔT / d ln T_total`.
    pub contact_time_per_total_time: f64,
    /// e rounded to two digits, as the paper puts it into (20); null where that is 0 or 1.
    pub restitution_rounded: Option<f64>,
    /// ΔT by (20) from the rounded e.
    pub contact_time_rounded_s: Option<f64>,
    /// When the ball with the e of (25) and the contact time that was given would rest; null without one.
    pub rest_at_given_contact_time: Option<Rest>,
    /// ΔT if the ball made one bounce more in the same time, e by (25) again.
    pub contact_time_one_more_bounce_s: Option<f64>,
}

/// Solves (25) and (30) for e, and makes the ball of each.
///
/// # Errors
/// [`Error::NoRoot`] with the attainable total times where (25) has no root; [`Error::Argument`] naming what is out of
/// range.
pub fn from_total_time(inputs: &TotalTimeInputs) -> Result<TotalTimeSolution, Error> {
    let series = BounceSeries::new(inputs.height_m, inputs.ball.gravity_m_per_s2)?;
    let (n, total) = (inputs.bounces, inputs.total_time_s);
    let exact = series.restitution_from_total_time(n, total)?;
    let endless = series.restitution_from_total_time_approx(total)?;
    let eq25 = at_rest(inputs, &series, &exact)?;
    let eq30 = at_rest(inputs, &series, &endless)?;
    let (with_contact_time, no_root) = match inputs.contact_time_s {
        None => (None, None),
        Some(time) => given_contact(inputs, &series, time, exact.restitution)?,
    };
    let conditioning = Conditioning::new(&series, inputs, &exact)?;
    let mut solution = TotalTimeSolution {
        inputs: *inputs,
        eq25,
        eq30,
        with_contact_time,
        conditioning,
        warnings: Vec::new(),
    };
    solution.warnings = warnings::of_total_time(&solution, no_root);
    Ok(solution)
}

/// The ball that (20) makes of n and an e.
fn at_rest(
    inputs: &TotalTimeInputs,
    series: &BounceSeries,
    found: &Inversion,
) -> Result<SolvedBall, Error> {
    let contact_time = series.rest_contact_time_s(found.restitution, inputs.bounces)?;
    let ball = SolvedBall::new(found.restitution, contact_time, &inputs.ball, Some(series))?;
    if !inputs.ball.std_error.any() {
        return Ok(ball);
    }
    let errors = series.rest_contact_errors(inputs.bounces, found, &input_errors(inputs))?;
    ball.with_errors(found.restitution, &errors, &inputs.ball)
}

/// The ball of a contact time that was given; or, where n contacts of it do not fit, why not.
fn given_contact(
    inputs: &TotalTimeInputs,
    series: &BounceSeries,
    contact_time_s: f64,
    typical: Restitution,
) -> Result<(Option<SolvedBall>, Option<Error>), Error> {
    // A contact time out of range is wrong for every ball; only then is there a question of fitting.
    Oscillator::from_contact(typical, contact_time_s)?;
    let (n, total) = (inputs.bounces, inputs.total_time_s);
    let found = match series.restitution_with_contact_time(n, total, contact_time_s) {
        Ok(found) => found,
        Err(reason) => return Ok((None, Some(reason))),
    };
    let e = found.restitution;
    let ball = SolvedBall::new(e, contact_time_s, &inputs.ball, Some(series))?;
    if !inputs.ball.std_error.any() {
        return Ok((Some(ball), None));
    }
    let errors = input_errors(inputs);
    let restitution = found.std_error(&errors)?;
    // A longer contact leaves less time for flight: the errors of e and ΔT hang together.
    let common = found.per_contact_time_per_s * errors.contact_time_s;
    let errors = ContactErrors {
        restitution,
        contact_time_s: errors.contact_time_s,
        correlation: if restitution > 0.0 {
            (common / restitution).clamp(-1.0, 1.0)
        } else {
            0.0
        },
    };
    Ok((Some(ball.with_errors(e, &errors, &inputs.ball)?), None))
}

fn input_errors(inputs: &TotalTimeInputs) -> InputErrors {
    let given = inputs.ball.std_error;
    InputErrors {
        total_time_s: given.total_time_s.unwrap_or(0.0),
        height_m: given.height_m.unwrap_or(0.0),
        gravity_m_per_s2: given.gravity_m_per_s2.unwrap_or(0.0),
        contact_time_s: given.contact_time_s.unwrap_or(0.0),
    }
}

impl Conditioning {
    fn new(
        series: &BounceSeries,
        inputs: &TotalTimeInputs,
        found: &Inversion,
    ) -> Result<Self, Error> {
        let (n, total) = (inputs.bounces, inputs.total_time_s);
        let e = found.restitution;
        let per_restitution = BounceSeries::contact_time_amplification(e, n)?;
        let rounded = Restitution::new((100.0 * e.value()).round() / 100.0).ok();
        let from_rounded = rounded
            .map(|e| series.rest_contact_time_s(e, n))
            .transpose()?;
        let more = n.saturating_add(1);
        let e_more = series.restitution_from_total_time(more, total)?.restitution;
        let from_more = series.rest_contact_time_s(e_more, more)?;
        Ok(Self {
            contact_time_per_restitution: per_restitution,
            contact_time_per_total_time: per_restitution * found.per_total_time_per_s * total
                / e.value(),
            restitution_rounded: rounded.map(Restitution::value),
            contact_time_rounded_s: from_rounded.filter(|&time| time > 0.0),
            rest_at_given_contact_time: inputs
                .contact_time_s
                .map(|time| Rest::new(series, e, time))
                .transpose()?,
            contact_time_one_more_bounce_s: Some(from_more).filter(|&time| time > 0.0),
        })
    }
}
