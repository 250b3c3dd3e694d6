//! What turns the time of a flight into speeds and heights: contact, drag, and what gravity is for the ball in air.

use super::Settings;
use super::model::{self, Modelled};
use crate::Error;
use crate::fit::model::Parameter;
use crate::physics::ends::Ends;
use crate::physics::priors::{
    CONTACT_RELATIVE_STD, DISPLACED, DISPLACED_PER_DRAG_AND_CONTACT_S, DISPLACED_PER_DRAG_S2,
    UNKNOWN_CONTACT_STD_S,
};
use crate::physics::{DRAG_RELATIVE_STD, FlightLaw, gravity_in_air_m_per_s2};

/// A number and its standard deviation.
pub(super) type Sized = (f64, f64);

/// By what the air that a ball displaces, as a share β of its mass, is known.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Displaced {
    /// By its mass and diameter: gravity is that in air already.
    Given,
    /// By the drag and the contact that its flights show.
    ByDrag,
    /// By nothing but what balls are.
    AtLarge,
}

/// What is known of contact, drag and gravity.
#[derive(Debug, Clone, Copy)]
pub(super) struct Course {
    pub contact_s: Sized,
    gravity_m_per_s2: f64,
    drag_per_s2: Sized,
    displaced: Displaced,
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
        let of_law = law.map(|law| law.drag_per_s2());
        let of_law = of_law.map(|drag| (drag, DRAG_RELATIVE_STD * drag));
        let of_flights = fitted(modelled.drag);
        Ok(Self {
            contact_s: contact.unwrap_or((0.0, UNKNOWN_CONTACT_STD_S)),
            gravity_m_per_s2: model::gravity_m_per_s2(settings)?,
            drag_per_s2: of_law.or(of_flights).unwrap_or((0.0, 0.0)),
            displaced: match (law, of_flights) {
                (Some(_), _) => Displaced::Given,
                (None, Some(_)) => Displaced::ByDrag,
                (None, None) => Displaced::AtLarge,
            },
        })
    }

    /// The drag off by so many of its standard deviations.
    fn drag_per_s2(&self, off: f64) -> f64 {
        let (drag, std) = self.drag_per_s2;
        (drag + off * std).max(0.0)
    }

    /// β with that drag, and its error: the longer the contact may be, the larger the ball.
    fn displaced(&self, off: f64) -> Sized {
        match self.displaced {
            Displaced::Given => (0.0, 0.0),
            Displaced::ByDrag => {
                let (contact_s, std_s) = self.contact_s;
                let soft = DISPLACED_PER_DRAG_AND_CONTACT_S.times(contact_s + 2.0 * std_s);
                let small = DISPLACED_PER_DRAG_S2;
                let drag = self.drag_per_s2(off);
                (
                    drag * (small.value + soft.value),
                    drag * (small.std + soft.std),
                )
            }
            Displaced::AtLarge => (DISPLACED.value, DISPLACED.std),
        }
    }

    /// Gravity as the ball in air feels it, with that drag.
    pub(super) fn gravity_m_per_s2(&self, off: f64) -> f64 {
        gravity_in_air_m_per_s2(self.gravity_m_per_s2, self.displaced(off).0)
    }

    /// Relative error of that gravity, the drag apart: `g_eff ≈ g·(1 − 3β/2)`.
    pub(super) fn gravity_std(&self) -> f64 {
        1.5 * self.displaced(0.0).1
    }

    /// The flight with that drag.
    pub(super) fn law(&self, off: f64) -> Result<FlightLaw, Error> {
        FlightLaw::with_drag(self.gravity_m_per_s2(off), self.drag_per_s2(off))
    }

    /// The start of a flight between two touches, with that drag; none where the contact fills the flight.
    pub(super) fn ends(&self, flight_s: f64, off: f64) -> Option<Ends> {
        Ends::of(flight_s - self.contact_s.0, self.drag_per_s2(off))
    }

    pub(super) fn leaving_m_per_s(&self, ends: &Ends, off: f64) -> f64 {
        0.5 * self.gravity_m_per_s2(off) * ends.ln_leaving.exp()
    }

    pub(super) fn landing_m_per_s(&self, ends: &Ends) -> f64 {
        0.5 * self.gravity_m_per_s2(0.0) * ends.ln_landing.exp()
    }
}

/// A parameter that the flights tell.
fn fitted(parameter: Option<Parameter>) -> Option<Sized> {
    let parameter = parameter?;
    Some((parameter.value.max(0.0), parameter.std?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::fit_times;
    use crate::physics::{Air, Sphere};

    /// Mass in kg, diameter in m, contact in s and e: marble, steel, golf, squash, ping-pong, tennis, volleyball, football,
    /// basketball.
    const BALLS: [(f64, f64, f64, f64); 9] = [
        (5.5e-3, 0.016, 1e-4, 0.85),
        (16.8e-3, 0.016, 8e-5, 0.9),
        (45.9e-3, 0.0427, 4.5e-4, 0.85),
        (24e-3, 0.04, 4e-3, 0.5),
        (2.7e-3, 0.04, 7e-4, 0.9),
        (57.7e-3, 0.067, 5e-3, 0.75),
        (0.27, 0.21, 9e-3, 0.75),
        (0.43, 0.22, 8e-3, 0.78),
        (0.62, 0.243, 1.2e-2, 0.8),
    ];

    /// The height of the first rebound from 1 m of a ball in air, and what is said of it by impacts so many.
    fn rebound_m(ball: (f64, f64, f64, f64), impacts: usize, known: bool) -> (f64, [f64; 2]) {
        let (mass_kg, diameter_m, contact_s, e) = ball;
        let sphere = Sphere {
            mass_kg,
            diameter_m,
        };
        let law = FlightLaw::in_air(9.81, sphere, Air::default()).unwrap();
        let mut speed = law.fall(1.0).unwrap().landing_speed_m_per_s;
        let apex_m = law.hop(e * speed).unwrap().apex_m;
        let mut times = vec![(1.0, 1e-5)];
        for _ in 1..impacts {
            let hop = law.hop(e * speed).unwrap();
            times.push((times[times.len() - 1].0 + hop.time_s + contact_s, 1e-5));
            speed = hop.landing_speed_m_per_s;
        }
        let mut settings = Settings::default().height_m(1.0).contact_time_s(contact_s);
        if known {
            settings = settings.mass_kg(mass_kg).diameter_m(diameter_m);
        }
        let analysis = fit_times(&[times], &settings).unwrap();
        let rebound = analysis.drops[0].first_rebound.clone().unwrap();
        (apex_m, rebound.height_m.interval95.unwrap())
    }

    /// The air that a ping-pong ball or a volleyball displaces makes g 2 to 3 % less, a hundred times what the times err by.
    #[test]
    fn the_rebound_of_an_unknown_ball_holds_its_weight_in_air() {
        for ball in BALLS {
            for impacts in [2, 8] {
                let (truth, [low, high]) = rebound_m(ball, impacts, false);
                assert!(
                    low <= truth && truth <= high,
                    "{ball:?} {impacts}: {truth} {low} {high}"
                );
                let (truth, [low, high]) = rebound_m(ball, impacts, true);
                assert!(low <= truth && truth <= high, "{ball:?} {impacts}");
                assert!(
                    high - low < 8e-3 * truth,
                    "{ball:?} {impacts}: {low} {high}"
                );
            }
        }
    }
}
