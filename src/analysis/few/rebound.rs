//! e of a drop of two or three impacts: by its height and first flight, or by its one ratio.

use super::super::first_rebound::FirstRebound;
use super::super::model::{self, Modelled};
use super::super::{Settings, warnings};
use crate::Error;
use crate::fit::Estimate;
use crate::fit::flights::Flights;
use crate::fit::total_time::{Missing, TimedDrop, missing};
use crate::impact::Impact;
use crate::physics::priors::{ONE_BOUNCE, UNKNOWN_CONTACT_STD_S};
use crate::report::{
    self, Bounce, Method, Model, Parameters, Rebound, Restitution, Warning, WarningCode, counted,
};

/// What few impacts say.
#[derive(Debug, Clone)]
pub(crate) struct Answer {
    pub modelled: Modelled,
    /// e of the first impact by the height.
    pub estimate: Option<Estimate>,
    /// The first rebound, likewise.
    pub first_rebound: Option<Rebound>,
    /// Speeds at the first impact, where the height tells that of arrival.
    pub first_bounce: Option<Bounce>,
    pub warnings: Vec<Warning>,
}

/// The answer of a drop of which two impacts or three were heard.
///
/// # Errors
/// [`Error::Argument`] for a setting out of range.
pub(crate) fn answer(
    timed: &[Impact],
    modelled: Modelled,
    settings: &Settings,
) -> Result<Answer, Error> {
    let flights = Flights::between(timed);
    let mut answer = Answer {
        modelled: of_one_ratio(modelled),
        estimate: None,
        first_rebound: None,
        first_bounce: None,
        warnings: Vec::new(),
    };
    if let (Some(height_m), Some(flight_s)) = (settings.height_m, flights.after(0)) {
        let drop = TimedDrop {
            impacts: timed,
            flights: &flights,
            restitution: 0.0,
            height_m,
            height_std_m: settings.height_std_m,
            gravity_m_per_s2: settings.gravity_m_per_s2,
        };
        match unfit(&drop)? {
            Some(unfit) => answer.warnings.extend(warnings::of_total_time(&Err(unfit))),
            None => {
                // Three impacts tell nothing of contact and drag.
                let nothing = Modelled::default();
                if let Some(rebound) = FirstRebound::of(timed, flight_s, &nothing, settings)? {
                    answer = of_rebound(&rebound, settings)?;
                }
            }
        }
    }
    answer.warnings.push(note(timed, &answer, settings));
    Ok(answer)
}

/// Why the first flight is not that after the fall from the height.
fn unfit(drop: &TimedDrop<'_>) -> Result<Option<Missing>, Error> {
    let missing = missing(drop)?;
    Ok(missing.filter(|m| !matches!(m, Missing::End { .. })))
}

/// e of one ratio: nothing but what balls at large do tells by how much one bounce is off.
///
/// # Formula
/// `ln e = ln(T₂/T₁) ± 0.022`, 95 % within ±0.053: [`ONE_BOUNCE`].
fn of_one_ratio(mut modelled: Modelled) -> Modelled {
    // One ratio tells no model from another.
    modelled.model.candidates.clear();
    modelled.model.alike = None;
    if let Some(restitution) = modelled
        .restitution
        .as_mut()
        .filter(|r| r.estimate.std_error.is_none())
    {
        let value = restitution.estimate.value;
        let (std, reach) = ONE_BOUNCE;
        restitution.estimate = Estimate {
            value,
            std_error: Some(value * std),
            interval95: Some([value * (-reach).exp(), (value * reach.exp()).min(1.0)]),
        };
    }
    modelled
}

/// The answer of a first rebound.
fn of_rebound(rebound: &FirstRebound, settings: &Settings) -> Result<Answer, Error> {
    let estimate = rebound.restitution();
    // No ball gains.
    let estimate = Estimate {
        interval95: estimate.interval95.map(|[low, high]| [low, high.min(1.0)]),
        ..estimate
    };
    let drag_per_s2 = model::law(settings)?.map(|law| law.drag_per_s2());
    let of_law = drag_per_s2.map(|_| report::Given::Drag);
    let of_contact = settings.contact_time_s.map(|_| report::Given::ContactTime);
    let modelled = Modelled {
        restitution: Some(Restitution {
            estimate,
            at_speed_m_per_s: Some(rebound.arrival_m_per_s),
            method: Method::FirstRebound,
        }),
        model: Model {
            given: of_contact.into_iter().chain(of_law).collect(),
            parameters: Parameters {
                contact_time_s: settings.contact_time_s.map(Estimate::bare),
                drag_per_s2: drag_per_s2.map(Estimate::bare),
                restitution: Some(estimate.value),
                ..Parameters::default()
            },
            ..Model::default()
        },
        ..Modelled::default()
    };
    Ok(Answer {
        modelled,
        estimate: Some(estimate),
        first_rebound: Some(rebound.rebound()),
        first_bounce: Some(rebound.bounce()),
        warnings: Vec::new(),
    })
}

/// What the answer rests on.
fn note(timed: &[Impact], answer: &Answer, settings: &Settings) -> Warning {
    let heard = timed.iter().filter(|i| i.is_heard()).count();
    let method = answer.modelled.restitution.as_ref().map(|r| r.method);
    let rests = match method {
        Some(Method::FirstRebound)
            if settings.mass_kg.is_some() && settings.diameter_m.is_some() =>
        {
            "e is that of the first impact, by the height and the flight after it"
        }
        Some(Method::FirstRebound) => {
            "e is that of the first impact, by the height and the flight after it. Without the ball's mass and diameter, speed lost to \
             the air counts as lost in the bounce, and how much lighter the ball is in air is not known"
        }
        Some(_) if settings.height_m.is_some() => {
            "e is the ratio of two flights. Its error is not measured but that of single bounces of many balls. The first flight does not \
             fit the height"
        }
        Some(_) => {
            "e is the ratio of two flights. Its error is not measured but that of single bounces of many balls. The height of release would \
             give e of the first impact"
        }
        None if settings.height_m.is_some() => {
            "their flight does not fit the height, so there is no e"
        }
        None => "one flight has no ratio, so there is no e. The height of release would give it",
    };
    let doubt = if heard == 2 && timed.iter().all(|i| i.nats.is_finite()) {
        ", which two knocks of one thing may be too"
    } else {
        ""
    };
    Warning::new(
        WarningCode::FewBounces,
        format!("only {}{doubt}: {rests}", counted(heard, "impact")),
    )
}

/// Adds to the impacts the first bounce, and to the errors of the rebound heights that of a contact of which nothing is known.
pub(crate) fn complete(
    impacts: &mut [report::Impact],
    first_bounce: Option<Bounce>,
    settings: &Settings,
) {
    if let (Some(first), Some(bounce)) = (impacts.first_mut(), first_bounce) {
        first.bounce = bounce;
    }
    if settings.contact_time_s.is_none() {
        for impact in impacts {
            let by_contact = impact.interval_s.map_or(0.0, |t| {
                0.25 * settings.gravity_m_per_s2 * t * UNKNOWN_CONTACT_STD_S
            });
            impact.rebound_height_std_m =
                impact.rebound_height_std_m.map(|std| std.hypot(by_contact));
        }
    }
}
