//! The first impact by the fall before it and the flight after it.

use super::model::Modelled;
use super::{Settings, model};
use crate::Error;
use crate::fit::Estimate;
use crate::fit::model::Parameter;
use crate::impact::Impact;
use crate::physics::ends::Ends;
use crate::physics::priors::{CONTACT_RELATIVE_STD, UNKNOWN_CONTACT_STD_S};
use crate::physics::{DRAG_RELATIVE_STD, FlightLaw};
use crate::report::{Bounce, Rebound};
use crate::statistics::NORMAL95;

/// A number and its standard deviation.
type Sized = (f64, f64);

/// The first impact of a drop from a known height.
#[derive(Debug, Clone, Copy)]
pub(super) struct FirstRebound {
    pub arrival_m_per_s: f64,
    arrival_std_m_per_s: f64,
    leaving_m_per_s: f64,
    leaving_std_m_per_s: f64,
    /// Relative error of e by the drag, which counts in both speeds.
    drag_std: f64,
    drop_height: Sized,
    rebound_m: f64,
    /// Relative error of the rebound by that of the drag.
    rebound_drag_std: f64,
}

/// What is known of contact and drag.
#[derive(Debug, Clone, Copy)]
pub(super) struct Course {
    pub contact_s: Sized,
    gravity_m_per_s2: f64,
    drag_per_s2: Sized,
}

impl Course {
    /// By what is given, else by what the flights say. Where they say nothing the contact is 0 with
    /// [`UNKNOWN_CONTACT_STD_S`], and the drag counts as the ball's.
    pub(super) fn of(modelled: &Modelled, settings: &Settings) -> Result<Self, Error> {
        let law = model::law(settings)?;
        let given = settings.contact_time_s;
        let given = given.map(|c| (c, CONTACT_RELATIVE_STD * c));
        let contact = given.or_else(|| fitted(modelled.contact));
        let contact = contact.filter(|(_, std)| *std < UNKNOWN_CONTACT_STD_S);
        let drag = law.map(|law| law.drag_per_s2());
        let drag = drag.map(|drag| (drag, DRAG_RELATIVE_STD * drag));
        Ok(Self {
            contact_s: contact.unwrap_or((0.0, UNKNOWN_CONTACT_STD_S)),
            // In air a ball weighs less.
            gravity_m_per_s2: law.map_or(settings.gravity_m_per_s2, |law| law.gravity_m_per_s2()),
            drag_per_s2: drag.or_else(|| fitted(modelled.drag)).unwrap_or((0.0, 0.0)),
        })
    }

    /// The flight with the drag off by so many of its standard deviations.
    pub(super) fn law(&self, off: f64) -> Result<FlightLaw, Error> {
        let (drag, std) = self.drag_per_s2;
        FlightLaw::with_drag(self.gravity_m_per_s2, (drag + off * std).max(0.0))
    }

    /// The start of a flight between two touches, with the drag off likewise; none where the contact fills the flight.
    pub(super) fn ends(&self, flight_s: f64, off: f64) -> Option<Ends> {
        let (drag, std) = self.drag_per_s2;
        Ends::of(flight_s - self.contact_s.0, (drag + off * std).max(0.0))
    }

    pub(super) fn leaving_m_per_s(&self, ends: &Ends) -> f64 {
        0.5 * self.gravity_m_per_s2 * ends.ln_leaving.exp()
    }

    pub(super) fn landing_m_per_s(&self, ends: &Ends) -> f64 {
        0.5 * self.gravity_m_per_s2 * ends.ln_landing.exp()
    }
}

/// A parameter that the flights tell.
fn fitted(parameter: Option<Parameter>) -> Option<Sized> {
    let parameter = parameter?;
    Some((parameter.value.max(0.0), parameter.std?))
}

impl FirstRebound {
    /// Of a drop from the height of the settings; none without one and where the contact fills the flight.
    ///
    /// # Formula
    /// ```text
    /// v = √(2·g·h),   u = g·(T₁ − C)/2   (with drag those of its fall and flight),   e = u/v,   h₁ = u²/2g
    /// (σ/e)² = (σ_T/T₁)² + (σ_h/2h)²,   σ_T² = s₁² + s₂² + σ_C²
    /// ```
    pub(super) fn of(
        timed: &[Impact],
        flight_s: f64,
        modelled: &Modelled,
        settings: &Settings,
    ) -> Result<Option<Self>, Error> {
        let Some(height_m) = settings.height_m else {
            return Ok(None);
        };
        let course = Course::of(modelled, settings)?;
        let ends = |off: f64| course.ends(flight_s, off);
        let (Some(middle), Some(less), Some(more)) = (ends(0.0), ends(-1.0), ends(1.0)) else {
            return Ok(None);
        };
        let arrival = |height_m: f64, off: f64| -> Result<f64, Error> {
            Ok(course.law(off)?.fall(height_m)?.landing_speed_m_per_s)
        };
        let rise = |ends: &Ends, off: f64| -> Result<f64, Error> {
            let leaving = course.leaving_m_per_s(ends);
            Ok(course.law(off)?.rise(leaving)?.height_m)
        };
        let leaving = course.leaving_m_per_s(&middle);
        let std_s = timed[0]
            .std_s
            .hypot(timed[1].std_s)
            .hypot(course.contact_s.1);
        let fall = arrival(height_m, 0.0)?;
        let higher = arrival(height_m + settings.height_std_m, 0.0)?;
        let fell = (arrival(height_m, 1.0)? / arrival(height_m, -1.0)?).ln();
        let rose = (rise(&more, 1.0)? / rise(&less, -1.0)?).ln();
        Ok(Some(Self {
            arrival_m_per_s: fall,
            arrival_std_m_per_s: higher - fall,
            leaving_m_per_s: leaving,
            leaving_std_m_per_s: leaving * (middle.leaving_slope * std_s).hypot(settings.clock_std),
            drag_std: 0.5 * (more.ln_leaving - less.ln_leaving - fell).abs(),
            drop_height: (height_m, settings.height_std_m),
            rebound_m: rise(&middle, 0.0)?,
            rebound_drag_std: 0.5 * rose.abs(),
        }))
    }

    fn leaving_std(&self) -> f64 {
        self.leaving_std_m_per_s / self.leaving_m_per_s
    }

    pub(super) fn restitution(&self) -> Estimate {
        let value = self.leaving_m_per_s / self.arrival_m_per_s;
        let by_height = self.arrival_std_m_per_s / self.arrival_m_per_s;
        with_std(
            value,
            self.leaving_std().hypot(by_height).hypot(self.drag_std),
        )
    }

    /// What standards ask for. A rebound goes with the square of its speed.
    pub(super) fn rebound(&self) -> Rebound {
        let (height_m, height_std_m) = self.drop_height;
        let std = (2.0 * self.leaving_std()).hypot(self.rebound_drag_std);
        let by_height = height_std_m / height_m;
        Rebound {
            drop_height_m: height_m,
            impact_speed_m_per_s: self.arrival_m_per_s,
            height_m: with_std(self.rebound_m, std),
            restitution: self.restitution(),
            resilience: with_std(self.rebound_m / height_m, std.hypot(by_height)),
        }
    }

    /// Speeds and e at the first impact.
    pub(super) fn bounce(&self) -> Bounce {
        let Estimate {
            value: e,
            std_error: std,
            ..
        } = self.restitution();
        Bounce {
            impact_speed_m_per_s: Some(self.arrival_m_per_s),
            impact_speed_std_m_per_s: Some(self.arrival_std_m_per_s),
            rebound_speed_m_per_s: Some(self.leaving_m_per_s),
            rebound_speed_std_m_per_s: Some(self.leaving_std_m_per_s),
            restitution: Some(e),
            restitution_std: std,
            energy_kept: Some(e * e),
            energy_kept_std: std.map(|s| 2.0 * e * s),
        }
    }
}

/// A share or a height with its relative error; no ball gains.
fn with_std(value: f64, relative_std: f64) -> Estimate {
    let std = value * relative_std;
    let reach = NORMAL95 * std;
    Estimate {
        value,
        std_error: Some(std),
        interval95: Some([(value - reach).max(0.0), value + reach]),
    }
}
