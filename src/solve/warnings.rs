//! What the reader of a solution should know: each with its number and what to do about it.

use super::{ContactSolution, SolvedBall, TotalTimeSolution, numbers};
use crate::Error;
use crate::report::{Warning, WarningCode};

/// From here on a relative error of ΔT is no longer small, and k, which goes with its square, is known to a factor only.
const LARGE_ERROR: f64 = 0.3;

/// From this difference of e on, (30) is too rough beside (25): the second digit moves.
const ROUGH_RESTITUTION: f64 = 0.005;

pub(super) fn of_total_time(solution: &TotalTimeSolution, no_root: Option<Error>) -> Vec<Warning> {
    let mut warnings = Vec::new();
    warnings.extend(conditioning(solution));
    warnings.push(lower_bound(solution));
    warnings.extend(rest(solution));
    warnings.extend(large_error(&solution.eq25));
    warnings.extend(rough_eq30(solution));
    warnings.extend(no_root.map(|reason| does_not_fit(solution.inputs.bounces, &reason)));
    warnings.extend(disagreement(solution));
    warnings.push(drag());
    warnings.push(release());
    warnings
}

pub(super) fn of_contact(solution: &ContactSolution) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if let Some((by_eq19, exact)) = rest_counts(&solution.ball)
        && by_eq19 != exact
    {
        let message = format!(
            "(19) has this ball rest after {by_eq19} impacts, but with its weight kept at every impact it rests after \
             {exact}: e falls as the ball slows down."
        );
        warnings.push(Warning::new(WarningCode::RestIsEarlier, message));
    }
    warnings.extend(large_error(&solution.ball));
    warnings.push(release());
    warnings
}

/// How much ΔT by (20) moves with e.
fn conditioning(solution: &TotalTimeSolution) -> Option<Warning> {
    let contact = solution.eq25.values.contact_time_s?;
    let of = &solution.conditioning;
    let mut message = format!(
        "ΔT by (20) grows as eⁿ: a relative error of e counts {} in ΔT, one of T_total {}.",
        numbers::fold(of.contact_time_per_restitution),
        numbers::fold(of.contact_time_per_total_time),
    );
    if let (Some(e), Some(rounded)) = (of.restitution_rounded, of.contact_time_rounded_s) {
        message += &format!(
            " e rounded to {e} would give {} in place of {}, {}.",
            numbers::time(rounded),
            numbers::time(contact),
            numbers::change(contact, rounded)
        );
    }
    if solution.inputs.contact_time_s.is_none() {
        message += " Where k and c matter, measure ΔT and give it as --contact-time.";
    }
    Some(Warning::new(
        WarningCode::ContactTimeIllConditioned,
        message,
    ))
}

fn lower_bound(solution: &TotalTimeSolution) -> Warning {
    let mut message = format!(
        "{} heard is a lower bound: the last ones are quiet and close together, and each one missed makes ΔT by (20) too \
         long and k too small.",
        numbers::bounces(solution.inputs.bounces)
    );
    let more = solution.conditioning.contact_time_one_more_bounce_s;
    if let (Some(contact), Some(more)) = (solution.eq25.values.contact_time_s, more) {
        message += &format!(
            " With one more, ΔT is {}, {}.",
            numbers::time(more),
            numbers::change(contact, more)
        );
    }
    Warning::new(WarningCode::BouncesAreALowerBound, message)
}

fn rest_counts(ball: &SolvedBall) -> Option<(usize, usize)> {
    let rest = ball.rest?;
    Some((rest.impacts_by_eq19, rest.impacts_exact?))
}

/// (19), on which (20) and (25) stand, is not when the ball of (3) comes to rest.
fn rest(solution: &TotalTimeSolution) -> Option<Warning> {
    let n = solution.inputs.bounces;
    let (_, exact) = rest_counts(&solution.eq25)?;
    let message = format!(
        "(20) and (25) assume that the ball rests after bounce {n}, by (19). With its weight kept at every impact, the \
         ball of (25) rests after {exact}."
    );
    Some(Warning::new(WarningCode::RestIsAssumed, message))
}

fn large_error(ball: &SolvedBall) -> Option<Warning> {
    let relative = ball.std_error?.contact_time_s? / ball.values.contact_time_s?;
    let message = format!(
        "the standard error of ΔT is {:.0} % of it: take k and c as orders of magnitude. Errors are propagated to first \
         order, which is too narrow here.",
        100.0 * relative
    );
    (relative > LARGE_ERROR).then(|| Warning::new(WarningCode::ContactTimeUncertain, message))
}

fn rough_eq30(solution: &TotalTimeSolution) -> Option<Warning> {
    let [exact, rough] = [&solution.eq25, &solution.eq30].map(|ball| ball.values.restitution);
    let message = format!(
        "(30) leaves out contact and the end of the bouncing: its e is off by {} here. Take that of (25).",
        numbers::plain((rough - exact).abs())
    );
    ((rough - exact).abs() > ROUGH_RESTITUTION)
        .then(|| Warning::new(WarningCode::Eq30IsRough, message))
}

/// Why nothing was solved with the contact time that was given.
fn does_not_fit(bounces: usize, reason: &Error) -> Warning {
    let message = if bounces < 2 {
        "the contact time given is not used: with a single bounce the time in the air does not depend on e.".to_owned()
    } else {
        format!("the contact time given does not fit {bounces} bounces: {reason}.")
    };
    Warning::new(WarningCode::ContactTimeDoesNotFit, message)
}

/// The contact time that was given against that of (20), and the bounces it stands for against those heard.
fn disagreement(solution: &TotalTimeSolution) -> Option<Warning> {
    let given = solution.with_contact_time.as_ref()?.values.contact_time_s?;
    let by_eq20 = solution.eq25.values.contact_time_s?;
    let rest = solution.conditioning.rest_at_given_contact_time?;
    let exact = rest.impacts_exact?;
    let n = solution.inputs.bounces;
    let message = format!(
        "(20) makes ΔT {}, {} times the {} given. With that ΔT and the e of (25), the ball would make {} by (19), \
         and {exact} with its weight kept at every impact; heard: {n}.",
        numbers::time(by_eq20),
        numbers::short(by_eq20 / given),
        numbers::time(given),
        numbers::bounces(rest.impacts_by_eq19),
    );
    (rest.impacts_by_eq19 != n).then(|| Warning::new(WarningCode::ContactTimesDisagree, message))
}

fn drag() -> Warning {
    Warning::new(
        WarningCode::DragIsLeftOut,
        "air drag is left out: speed lost in the air is booked as lost in the bounce, so e reads too low. A ping-pong \
         ball of e = 0.94 from 30 cm reads 0.929; a steel ball is off by less than 0.001.",
    )
}

fn release() -> Warning {
    Warning::new(
        WarningCode::ReleaseRule,
        "k and c belong to a ball that leaves the surface undeformed (x = 0), the rule of the paper. A ball that leaves \
         when the contact force is zero has other k and c at the same e and ΔT.",
    )
}
