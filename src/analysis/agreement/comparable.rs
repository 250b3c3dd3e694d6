//! Ways to e made comparable: contact and drag of the model taken out of the flights and of the first rebound.

use super::Value;
use crate::Error;
use crate::analysis::Settings;
use crate::analysis::bounce::ends;
use crate::analysis::course::Course;
use crate::analysis::model::Modelled;
use crate::fit::flights::Flights;
use crate::fit::model::Parameter;
use crate::impact::Impact;
use crate::units::real;

/// A drag that is fitted may stand for an e that falls with speed: what it changes in the first rebound errs by this
/// share. A tennis ball, which the air hardly slows, has half of its drag from that.
const DRAG_DOUBT: f64 = 1.0 / 3.0;

/// The ratio of the flights, the contact time of the model taken out of the first and the last.
///
/// # Formula
/// ```text
/// ln e′ = ln e + (ln(1 − C/D_b) − ln(1 − C/D_a))/(b − a)
/// ```
pub(super) fn without_contact(
    ratio: Value,
    timed: &[Impact],
    flights: &Flights,
    modelled: &Modelled,
) -> Value {
    let lengths = || (0..timed.len()).filter_map(|i| Some((i, flights.after(i)?)));
    let (Some((ball, contact)), Some((a, first)), Some((b, last))) = (
        modelled.ball_model.zip(modelled.contact),
        lengths().next(),
        lengths().next_back(),
    ) else {
        return ratio;
    };
    if contact.value <= 0.0 || ball.contact_in_s(last) >= last || a == b {
        return ratio;
    }
    let left = |interval_s: f64| (-ball.contact_in_s(interval_s) / interval_s).ln_1p();
    let shift = (left(last) - left(first)) / real(b - a);
    let value = ratio.value * shift.exp();
    let doubt = value * shift * contact.std.unwrap_or(0.0) / contact.value;
    Value {
        value,
        std: ratio.std.hypot(doubt),
    }
}

/// e of the first impact by the height, contact and drag taken out, beside that of the model.
///
/// # Formula
/// ```text
/// e₁ = u(D_1 − C)/w(h0),   w = √(2·g·h0) without drag
/// (σ/e₁)² = (u′·σ_D)² + (u′·σ_C)² + (σ_h/2h0)² + (σ_K·(h0/2g + T²/16))² + σ_bounce²
/// ```
/// and where mass and diameter are not given, what buoyancy and an e that falls with speed may do.
pub(super) fn first(
    timed: &[Impact],
    flights: &Flights,
    modelled: &Modelled,
    settings: &Settings,
) -> Result<Option<(Value, Value)>, Error> {
    let ball = modelled.ball_model.as_ref();
    let ends = flights.after(0).and_then(|d| ends(ball, d));
    let e = modelled
        .restitution
        .as_ref()
        .and_then(|r| Value::of(r.estimate));
    let (Some(ends), Some(e), Some(height_m)) = (ends, e, settings.height_m) else {
        return Ok(None);
    };
    let course = Course::of(modelled, settings)?;
    let law = course.law(0.0)?;
    let gravity = law.gravity_m_per_s2();
    let leaving = 0.5 * gravity * ends.ln_leaving.exp();
    let value = leaving / law.fall(height_m)?.landing_speed_m_per_s;
    let std = |p: Option<Parameter>| p.and_then(|p| p.std).unwrap_or(0.0);
    // d(ln e₁)/dK: what the fall loses, and what the flight after it.
    let by_drag = 0.5 * height_m / gravity + flights.after(0).unwrap_or(0.0).powi(2) / 16.0;
    let unknown = match (settings.mass_kg, settings.diameter_m) {
        (Some(_), Some(_)) => 0.0,
        _ => (0.5 * course.gravity_std()).hypot(DRAG_DOUBT * by_drag * law.drag_per_s2()),
    };
    let parts = [
        ends.leaving_slope * timed[0].std_s.hypot(timed[1].std_s),
        ends.leaving_slope * std(modelled.contact),
        0.5 * settings.height_std_m / height_m,
        by_drag * std(modelled.drag),
        unknown,
        modelled
            .bounce_std
            .or_else(|| flights.scatter())
            .unwrap_or(0.0),
    ];
    let relative = parts.iter().fold(0.0, |sum: f64, part| sum.hypot(*part));
    let first = Value {
        value,
        std: value * relative,
    };
    Ok(Some((first, e)))
}
