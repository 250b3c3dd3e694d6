//! One microphone: when it hears an impact and how loud.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};

use super::drops::Strike;
use super::place::{Point, distance_m};
use super::room::travel_s;
use super::scene::within;
use super::sound::Sound;
use super::{decibels, voices};
use crate::Error;
use crate::random::SplitMix64;

/// One microphone.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Channel {
    /// Impacts are heard this much later than in the scene, in seconds. May be negative.
    pub delay_s: f64,
    /// Level of impacts in dB.
    pub level_db: f64,
    /// Whether its sign is turned.
    pub inverted: bool,
    /// Where it stands, in metres from the place of the first impact: x and y along the surface, z up from it, at least 1 cm.
    /// Sound then comes later by its way from the place of each impact, and its level falls as one over that way; at the first
    /// place it is `level_db`. Default: nowhere, so that the place of an impact changes nothing.
    pub at_m: Option<Point>,
    /// How much otherwise than in the scene each impact sounds here, from 0 to 1, as modes radiate to each side otherwise: every
    /// mode with a phase and a level of its own, as far as `unlike` of a drop says. Default 0.
    pub unlike: f64,
}

impl Channel {
    pub(super) fn check(&self) -> Result<(), Error> {
        within("delay_s", self.delay_s, -1.0..=1.0, "-1 to 1 s")?;
        within("level_db", self.level_db, -200.0..=40.0, "-200 to 40")?;
        within("unlike", self.unlike, 0.0..=1.0, "0 to 1")?;
        let [x, y, z] = self.at_m.unwrap_or([0.0, 0.0, 1.0]);
        within("at_m", x, -1e3..=1e3, "-1 to 1 km along the surface")?;
        within("at_m", y, -1e3..=1e3, "-1 to 1 km along the surface")?;
        within("at_m", z, 0.01..=1e3, "1 cm to 1 km above the surface")
    }

    /// The sounds of impacts as they are heard here.
    pub(super) fn sounds<'a>(
        &self,
        strikes: &[&'a Strike],
        mut rng: SplitMix64,
    ) -> Vec<Cow<'a, Sound>> {
        let mut heard = |sound: &'a Sound| match self.unlike {
            0.0 => Cow::Borrowed(sound),
            unlike => Cow::Owned(sound.unlike(|| voices::unlike(unlike, &mut rng))),
        };
        strikes.iter().map(|s| heard(&s.sound)).collect()
    }

    /// Factor on the pressure of an impact at a place.
    pub(super) fn gain(&self, place: Point) -> f64 {
        let sign = if self.inverted { -1.0 } else { 1.0 };
        sign * decibels(self.level_db) * self.fading(place)
    }

    /// Pressure of an impact at a place, over that of one at the first.
    pub(super) fn fading(&self, place: Point) -> f64 {
        let ratio = |at| distance_m(at, [0.0; 3]) / distance_m(at, place);
        self.at_m.map_or(1.0, ratio)
    }

    /// Seconds by which an impact at a place is heard later than in the scene.
    pub(super) fn later_s(&self, place: Point) -> f64 {
        let way_m = self.at_m.map_or(0.0, |at| distance_m(at, place));
        self.delay_s + travel_s(way_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_microphone_twice_as_near_hears_twice_the_pressure_and_earlier() {
        let near = Channel {
            at_m: Some([0.3, 0.0, 0.4]),
            ..Channel::default()
        };
        let place = [0.3, 0.0, 0.15];
        assert!((near.gain(place) - 2.0).abs() < 1e-12);
        assert!((near.later_s([0.0; 3]) - 0.5 / 343.0).abs() < 1e-12);
        assert!((near.later_s(place) - 0.25 / 343.0).abs() < 1e-12);
        let nowhere = Channel::default();
        assert_eq!((nowhere.gain(place), nowhere.later_s(place)), (1.0, 0.0));
    }
}
