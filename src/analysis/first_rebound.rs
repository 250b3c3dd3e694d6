//! The first impact by the fall before it and the flight after it.

use super::Settings;
use super::course::{Course, Sized};
use super::model::Modelled;
use crate::Error;
use crate::fit::Estimate;
use crate::impact::Impact;
use crate::physics::ends::Ends;
use crate::report::{Bounce, Rebound};
use crate::statistics::NORMAL95;

/// The first impact of a drop from a known height.
#[derive(Debug, Clone, Copy)]
pub(super) struct FirstRebound {
    pub arrival_m_per_s: f64,
    arrival_std_m_per_s: f64,
    leaving_m_per_s: f64,
    /// Relative error of the leaving speed by the flight's time.
    leaving_std: f64,
    /// Relative error of gravity: by the air that the ball displaces.
    gravity_std: f64,
    /// Relative error of e by the drag, which counts in both speeds.
    drag_std: f64,
    drop_height: Sized,
    rebound_m: f64,
    /// Relative error of the rebound by that of the drag.
    rebound_drag_std: f64,
}

impl FirstRebound {
    /// Of a drop from the height of the settings; none without one and where the contact fills the flight.
    ///
    /// # Formula
    /// ```text
    /// v = √(2·g·h),   u = g·(T₁ − C)/2   (with drag those of its fall and flight),   e = u/v,   h₁ = u²/2g
    /// (σ/e)² = (σ_T/T₁)² + (σ_h/2h)² + (σ_g/2g)²,   σ_T² = s₁² + s₂² + σ_C²
    /// ```
    /// g is that in air: without mass and diameter `σ_g/g` is 3/2 of the error of β, the displaced air's share of the mass.
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
            let leaving = course.leaving_m_per_s(ends, off);
            Ok(course.law(off)?.rise(leaving)?.height_m)
        };
        let leaving = course.leaving_m_per_s(&middle, 0.0);
        let left = course.leaving_m_per_s(&more, 1.0) / course.leaving_m_per_s(&less, -1.0);
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
            leaving_std: (middle.leaving_slope * std_s).hypot(settings.clock_std),
            gravity_std: course.gravity_std(),
            drag_std: 0.5 * (left.ln() - fell).abs(),
            drop_height: (height_m, settings.height_std_m),
            rebound_m: rise(&middle, 0.0)?,
            rebound_drag_std: 0.5 * rose.abs(),
        }))
    }

    pub(super) fn restitution(&self) -> Estimate {
        let value = self.leaving_m_per_s / self.arrival_m_per_s;
        let by_height = self.arrival_std_m_per_s / self.arrival_m_per_s;
        // The speed of arrival goes with the root of g, so half of it is left.
        let by_air = self.drag_std.hypot(0.5 * self.gravity_std);
        with_std(value, self.leaving_std.hypot(by_height).hypot(by_air))
    }

    /// What standards ask for. A rebound goes with the square of its speed.
    pub(super) fn rebound(&self) -> Rebound {
        let (height_m, height_std_m) = self.drop_height;
        let by_air = self.rebound_drag_std.hypot(self.gravity_std);
        let std = (2.0 * self.leaving_std).hypot(by_air);
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
            impact_speed_std_m_per_s: Some(
                (0.5 * self.gravity_std * self.arrival_m_per_s).hypot(self.arrival_std_m_per_s),
            ),
            rebound_speed_m_per_s: Some(self.leaving_m_per_s),
            rebound_speed_std_m_per_s: Some(
                self.leaving_std.hypot(self.gravity_std) * self.leaving_m_per_s,
            ),
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
