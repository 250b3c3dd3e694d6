//! From the times of a drop to its restitution and its ball, by the model that the recording supports.

use std::ops::Range;

use super::Settings;
use crate::Error;
use crate::fit::Estimate;
use crate::fit::irregular::Regularity;
use crate::fit::model::{Budget, Parameter};
use crate::fit::model_selection::{Inputs, Selection, select};
use crate::impact::Impact;
use crate::physics;
use crate::physics::priors::{CONTACT_RELATIVE_STD, Known};
use crate::physics::{
    Air, BallModel, ContactErrors, DRAG_RELATIVE_STD, FlightLaw, Oscillator, ParameterErrors,
    ReleaseRule, Sphere,
};
use crate::report::{
    Ball, ContactSource, Given, Method, Model, Parameters, Restitution, Warning, WarningCode,
    listed,
};

/// Least ratio of the ends of a contact time's interval at which it counts as undetermined. Convention.
const UNDETERMINED: f64 = 3.0;

/// The known properties of the ball, from the settings.
pub(super) fn inputs(settings: &Settings) -> Result<Inputs, Error> {
    let law = law(settings)?;
    let contact = settings.contact_time_s;
    Ok(Inputs {
        contact_s: contact.map(|t| Known::within(t, CONTACT_RELATIVE_STD)),
        drag_per_s2: law.map(|law| Known::within(law.drag_per_s2(), DRAG_RELATIVE_STD)),
    })
}

/// Gravity as the ball feels it: in air, where its mass and diameter are known.
pub(super) fn gravity_m_per_s2(settings: &Settings) -> Result<f64, Error> {
    let law = law(settings)?;
    Ok(law.map_or(settings.gravity_m_per_s2, |law| law.gravity_m_per_s2()))
}

/// The flight of a ball whose mass and diameter are known.
pub(super) fn law(settings: &Settings) -> Result<Option<FlightLaw>, Error> {
    let (Some(mass_kg), Some(diameter_m)) = (settings.mass_kg, settings.diameter_m) else {
        return Ok(None);
    };
    let sphere = Sphere {
        mass_kg,
        diameter_m,
    };
    FlightLaw::in_air(settings.gravity_m_per_s2, sphere, Air::default()).map(Some)
}

/// The restitution of a drop and what hangs on it.
#[derive(Debug, Clone, Default)]
pub(super) struct Modelled {
    pub restitution: Option<Restitution>,
    pub bounce_std: Option<f64>,
    pub model: Model,
    pub ball: Option<Ball>,
    /// e and contact at every speed, and the flight.
    pub ball_model: Option<BallModel>,
    pub budget: Option<Budget>,
    pub contact: Option<Parameter>,
    pub drag: Option<Parameter>,
    /// Whether e depends on the speed.
    pub by_speed: bool,
    pub warnings: Vec<Warning>,
}

/// Fits a part of a drop without its irregular bounces.
pub(super) fn fitted(
    timed: &[Impact],
    part: &Range<usize>,
    regularity: &Regularity,
    settings: &Settings,
) -> Result<Modelled, Error> {
    let inputs = inputs(settings)?;
    let odd = regularity.odd_in(part).into_iter();
    let odd: Vec<usize> = odd.map(|bounce| bounce - part.start).collect();
    let selected = select(&timed[part.clone()], &odd, &inputs, settings.model);
    let Some(selection) = selected else {
        return Ok(Modelled::default());
    };
    let fit = &selection.fit;
    let ball_model = selection.ball(settings.gravity_m_per_s2)?;
    let estimate = exponential(&fit.ln_restitution);
    let has_error = estimate.std_error.is_some();
    Ok(Modelled {
        restitution: Some(Restitution {
            estimate,
            at_speed_m_per_s: Some(0.5 * settings.gravity_m_per_s2 * fit.mean_speed_s),
            method: if has_error {
                Method::LeastSquares
            } else {
                Method::SingleRatio
            },
        }),
        bounce_std: has_error.then_some(fit.bounce_std),
        ball: ball(&selection, &ball_model, &inputs, settings),
        ball_model: Some(ball_model),
        budget: has_error.then_some(fit.budget),
        contact: fit.contact_s,
        drag: fit.drag_per_s2,
        by_speed: selection.selected.is_by_speed(),
        warnings: warnings(&selection, part.start),
        model: model(&selection, &inputs),
    })
}

/// e from ln e: the median, its standard deviation to first order, and the ends of the interval.
fn exponential(ln: &Parameter) -> Estimate {
    Estimate {
        value: ln.value.exp(),
        std_error: ln.std.map(|s| ln.value.exp() * s),
        interval95: ln.interval95.map(|ends| ends.map(f64::exp)),
    }
}

fn model(selection: &Selection, inputs: &Inputs) -> Model {
    let fit = &selection.fit;
    let given = [
        inputs.contact_s.map(|_| Given::ContactTime),
        inputs.drag_per_s2.map(|_| Given::Drag),
    ];
    Model {
        selected: selection.selected,
        given: given.into_iter().flatten().collect(),
        parameters: Parameters {
            contact_time_s: fit.contact_s.map(estimate),
            drag_per_s2: fit.drag_per_s2.map(estimate),
            restitution: Some(fit.own_ln_restitution.exp()),
            speed_exponent: fit.exponent.map(estimate),
        },
        candidates: selection.candidates.clone(),
        unfitted: selection.unfitted.clone(),
        alike: selection.alike,
    }
}

const fn estimate(parameter: Parameter) -> Estimate {
    Estimate {
        value: parameter.value,
        std_error: parameter.std,
        interval95: parameter.interval95,
    }
}

/// The ball with this restitution and contact time, if the contact time is known well enough.
fn ball(
    selection: &Selection,
    ball_model: &BallModel,
    inputs: &Inputs,
    settings: &Settings,
) -> Option<Ball> {
    let contact = selection.fit.contact_s?;
    let ([low, high], std_s) = (contact.interval95?, contact.std?);
    if low <= 0.0 || high >= UNDETERMINED * low {
        return None;
    }
    // (14) to (17) invert e of fast impacts, which a linear ball's own spring and damper give.
    let (restitution, oscillator) = match ball_model.oscillator() {
        Some(oscillator) => (oscillator.restitution().ok()?, oscillator),
        None => {
            let restitution =
                physics::Restitution::from_ln(selection.fit.own_ln_restitution).ok()?;
            let oscillator = Oscillator::from_contact(restitution, contact.value).ok()?;
            (restitution, oscillator)
        }
    };
    let errors = ContactErrors {
        restitution: restitution.value() * selection.fit.ln_restitution.std?,
        contact_time_s: std_s,
        correlation: 0.0,
    };
    let relative = ParameterErrors::new(restitution, contact.value, &errors).ok()?;
    let stiffness = settings
        .mass_kg
        .map(|m| m * oscillator.stiffness_per_mass_per_s2());
    let damping = settings
        .mass_kg
        .map(|m| m * oscillator.damping_per_mass_per_s());
    Some(Ball {
        contact_time_s: contact.value,
        contact_time_std_s: std_s,
        stiffness_n_per_m: stiffness,
        stiffness_std_n_per_m: stiffness.map(|k| k * relative.stiffness),
        damping_n_s_per_m: damping,
        damping_std_n_s_per_m: damping.map(|c| c * relative.damping),
        natural_frequency_rad_per_s: oscillator.natural_frequency_rad_per_s(),
        natural_frequency_std_rad_per_s: oscillator.natural_frequency_rad_per_s()
            * relative.natural_frequency,
        damping_ratio: oscillator.damping_ratio(),
        damping_ratio_std: oscillator.damping_ratio() * relative.damping_ratio,
        release_rule: ReleaseRule::ZeroDisplacement,
        source: if inputs.contact_s.is_some() {
            ContactSource::Given
        } else {
            ContactSource::Intervals
        },
    })
}

/// Warnings by a fit whose first impact has this number.
fn warnings(selection: &Selection, first: usize) -> Vec<Warning> {
    let mut warnings = Vec::new();
    let outliers = &selection.fit.outliers;
    let numbers = |of: &[usize]| of.iter().map(|i| first + i + 1).collect::<Vec<_>>();
    let (bounces, times) = (numbers(&outliers.bounces), numbers(&outliers.times));
    let message = match bounces.len() {
        0 => None,
        1 => Some(format!(
            "the rebound at impact {} is unlike the others and counts",
            listed(&bounces)
        )),
        _ => Some(format!(
            "the rebounds at impacts {} are unlike the others and count",
            listed(&bounces)
        )),
    };
    warnings.extend(message.map(|message| {
        let message =
            message + " for little: the ball spun, or met a spot of the surface. Try another place";
        Warning::new(WarningCode::WildBounce, message)
    }));
    let message = match times.len() {
        0 => None,
        1 => Some(format!(
            "the time of impact {} fits none of its neighbours and counts",
            listed(&times)
        )),
        _ => Some(format!(
            "the times of impacts {} fit none of their neighbours and count",
            listed(&times)
        )),
    };
    warnings.extend(message.map(|message| {
        let message =
            message + " for little. Look at the sound there, and correct it by hand if it matters";
        Warning::new(WarningCode::StrayTime, message)
    }));
    if let Some(other) = selection.alike {
        let message = format!(
            "the models {} and {other} explain the flights about equally well: the flights do not show how much is due to drag and how \
             much to a change of e with speed. Give the ball's mass and diameter",
            selection.selected
        );
        warnings.push(Warning::new(WarningCode::ModelsAlike, message));
    }
    warnings
}
