//! e of a drop of two or three impacts: by its height and first flight, or by its one ratio.

use super::super::model::{self, Modelled};
use super::super::{Settings, warnings};
use crate::Error;
use crate::fit::Estimate;
use crate::fit::flights::Flights;
use crate::fit::total_time::{Missing, TimedDrop, missing};
use crate::impact::Impact;
use crate::physics::ends::Ends;
use crate::physics::priors::{CONTACT_RELATIVE_STD, ONE_BOUNCE, UNKNOWN_CONTACT_STD_S};
use crate::physics::{DRAG_RELATIVE_STD, FlightLaw};
use crate::report::{
    self, Bounce, Method, Model, Parameters, Restitution, Warning, WarningCode, counted,
};
use crate::statistics::NORMAL95;

/// What few impacts say.
#[derive(Debug, Clone)]
pub(crate) struct Answer {
    pub modelled: Modelled,
    /// e of the first impact by the height.
    pub first_rebound: Option<Estimate>,
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
                let rebound = Rebound::of(timed, flight_s, height_m, settings)?;
                answer = rebound.map_or_else(|| answer.clone(), |rebound| rebound.answer(settings));
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

/// The first impact by the fall before it and the flight after it.
#[derive(Debug, Clone, Copy)]
struct Rebound {
    arrival_m_per_s: f64,
    arrival_std_m_per_s: f64,
    leaving_m_per_s: f64,
    leaving_std_m_per_s: f64,
    /// Relative error of e by the drag, which counts in both speeds.
    drag_std: f64,
    drag_per_s2: Option<f64>,
}

impl Rebound {
    /// None where the contact fills the flight.
    ///
    /// # Formula
    /// ```text
    /// v = √(2·g·h),   u = g·(T₁ − C)/2   (with drag those of its fall and flight),   e = u/v
    /// (σ/e)² = (σ_T/T₁)² + (σ_h/2h)²,   σ_T² = s₁² + s₂² + σ_C²
    /// ```
    /// C is 0 with [`UNKNOWN_CONTACT_STD_S`] where it is not given. Without mass and diameter the drag counts as the ball's.
    fn of(
        timed: &[Impact],
        flight_s: f64,
        height_m: f64,
        settings: &Settings,
    ) -> Result<Option<Self>, Error> {
        let law = model::law(settings)?;
        // In air a ball weighs less.
        let gravity = law.map_or(settings.gravity_m_per_s2, |law| law.gravity_m_per_s2());
        let drag = law.map_or(0.0, |law| law.drag_per_s2());
        let arrival = |height_m: f64, drag: f64| -> Result<f64, Error> {
            Ok(FlightLaw::with_drag(gravity, drag)?
                .fall(height_m)?
                .landing_speed_m_per_s)
        };
        let (contact_s, contact_std_s) = settings
            .contact_time_s
            .map_or((0.0, UNKNOWN_CONTACT_STD_S), |c| {
                (c, CONTACT_RELATIVE_STD * c)
            });
        let leaving = |drag: f64| Ends::of(flight_s - contact_s, drag);
        let off = DRAG_RELATIVE_STD * drag;
        let (Some(ends), Some(less), Some(more)) =
            (leaving(drag), leaving(drag - off), leaving(drag + off))
        else {
            return Ok(None);
        };
        let speed = 0.5 * gravity * ends.ln_leaving.exp();
        let std_s = timed[0].std_s.hypot(timed[1].std_s).hypot(contact_std_s);
        let fall = arrival(height_m, drag)?;
        let higher = arrival(height_m + settings.height_std_m, drag)?;
        let fell = (arrival(height_m, drag + off)? / arrival(height_m, drag - off)?).ln();
        Ok(Some(Self {
            arrival_m_per_s: fall,
            arrival_std_m_per_s: higher - fall,
            leaving_m_per_s: speed,
            leaving_std_m_per_s: speed * ends.leaving_slope * std_s,
            drag_std: 0.5 * (more.ln_leaving - less.ln_leaving - fell).abs(),
            drag_per_s2: law.map(|_| drag),
        }))
    }

    fn restitution(&self) -> Estimate {
        let value = self.leaving_m_per_s / self.arrival_m_per_s;
        let by_speeds = (self.leaving_std_m_per_s / self.leaving_m_per_s)
            .hypot(self.arrival_std_m_per_s / self.arrival_m_per_s);
        let std = value * by_speeds.hypot(self.drag_std);
        let reach = NORMAL95 * std;
        Estimate {
            value,
            std_error: Some(std),
            interval95: Some([(value - reach).max(0.0), (value + reach).min(1.0)]),
        }
    }

    fn answer(&self, settings: &Settings) -> Answer {
        let estimate = self.restitution();
        let (e, std) = (estimate.value, estimate.std_error);
        let of_law = self.drag_per_s2.map(|_| report::Given::Drag);
        let of_contact = settings.contact_time_s.map(|_| report::Given::ContactTime);
        let modelled = Modelled {
            restitution: Some(Restitution {
                estimate,
                at_speed_m_per_s: Some(self.arrival_m_per_s),
                method: Method::FirstRebound,
            }),
            model: Model {
                given: of_contact.into_iter().chain(of_law).collect(),
                parameters: Parameters {
                    contact_time_s: settings.contact_time_s.map(Estimate::bare),
                    drag_per_s2: self.drag_per_s2.map(Estimate::bare),
                    restitution: Some(e),
                    ..Parameters::default()
                },
                ..Model::default()
            },
            ..Modelled::default()
        };
        Answer {
            modelled,
            first_rebound: Some(estimate),
            first_bounce: Some(Bounce {
                impact_speed_m_per_s: Some(self.arrival_m_per_s),
                impact_speed_std_m_per_s: Some(self.arrival_std_m_per_s),
                rebound_speed_m_per_s: Some(self.leaving_m_per_s),
                rebound_speed_std_m_per_s: Some(self.leaving_std_m_per_s),
                restitution: Some(e),
                restitution_std: std,
                energy_kept: Some(e * e),
                energy_kept_std: std.map(|s| 2.0 * e * s),
            }),
            warnings: Vec::new(),
        }
    }
}

/// What the answer rests on.
fn note(timed: &[Impact], answer: &Answer, settings: &Settings) -> Warning {
    let heard = timed.iter().filter(|i| i.is_heard()).count();
    let method = answer.modelled.restitution.as_ref().map(|r| r.method);
    let rests = match method {
        Some(Method::FirstRebound)
            if settings.mass_kg.is_some() && settings.diameter_m.is_some() =>
        {
            "e is that of the first, by the height and the flight after it"
        }
        Some(Method::FirstRebound) => {
            "e is that of the first, by the height and the flight after it; the air's drag counts as the ball's unless \
             mass and diameter are given"
        }
        Some(_) => {
            "e is one ratio of flights, and its error that of single bounces of balls at large. The height of release would give e of the first"
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
