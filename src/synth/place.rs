//! Where the ball hits, and what of the room depends on that place.

use serde::{Deserialize, Serialize};

use super::decibels;
use super::room::travel_s;
use super::scene::within;
use crate::Error;
use crate::physics::Impact;
use crate::random::SplitMix64;

/// x and y along the surface, z up from it, in metres from where the first impact of a drop is.
pub(super) type Point = [f64; 3];

/// An upright wall, which sends every impact back as its mirror image would sound (Allen and Berkley, "Image method for
/// efficiently simulating small-room acoustics", J. Acoust. Soc. Am. 65, 1979).
///
/// # Formula
/// ```text
/// p' = p + 2(d − n·p)·n      image of the place p in a wall at distance d in direction n
/// later by (|m − p'| − |m − p|)/c,   pressure |m − p|/|m − p'|·10^(level/20)      at the microphone m
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Wall {
    /// Direction of the wall from the place of the first impact, in degrees from x towards y.
    pub bearing_deg: f64,
    /// Its distance from there, in metres.
    pub distance_m: f64,
    /// What it reflects, in dB.
    pub level_db: f64,
}

/// What comes back of a wall, beside the direct sound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Reflection {
    pub(super) later_s: f64,
    pub(super) level: f64,
}

impl Wall {
    pub(super) fn check(&self, microphones: &[Option<Point>]) -> Result<(), Error> {
        within(
            "bearing_deg",
            self.bearing_deg,
            -360.0..=360.0,
            "-360 to 360",
        )?;
        within("distance_m", self.distance_m, 0.01..=1e3, "1 cm to 1 km")?;
        within("level_db", self.level_db, -200.0..=0.0, "-200 to 0")?;
        for at in microphones {
            let Some(at) = at else {
                return Err(Error::Argument {
                    argument: "walls",
                    got: "a channel that is nowhere".to_owned(),
                    expected: "at_m of every channel",
                });
            };
            let before_m = self.before_m(*at);
            within(
                "at_m",
                before_m,
                0.0..=f64::MAX,
                "every channel before every wall",
            )?;
        }
        Ok(())
    }

    /// How far a point is before the wall: negative behind it.
    fn before_m(&self, [x, y, _]: Point) -> f64 {
        let [nx, ny] = self.direction();
        self.distance_m - (nx * x + ny * y)
    }

    fn direction(&self) -> [f64; 2] {
        let bearing = self.bearing_deg.to_radians();
        [libm::cos(bearing), libm::sin(bearing)]
    }

    /// What a microphone hears of an impact by way of the wall; nothing of one behind it.
    pub(super) fn reflection(&self, place: Point, microphone: Point) -> Option<Reflection> {
        let before_m = self.before_m(place);
        if before_m <= 0.0 {
            return None;
        }
        let [nx, ny] = self.direction();
        let [x, y, z] = place;
        let image = [x + 2.0 * before_m * nx, y + 2.0 * before_m * ny, z];
        let (direct_m, way_m) = (distance_m(microphone, place), distance_m(microphone, image));
        Some(Reflection {
            later_s: travel_s(way_m - direct_m),
            level: decibels(self.level_db) * direct_m / way_m,
        })
    }
}

/// The places of the impacts of a drop, whose bounces each add a sideways speed.
///
/// # Formula
/// ```text
/// u_n = u_(n−1) + s·w_n·(N, N'),   p_(n+1) = p_n + u_n·(t_(n+1) − t_n),   p_1 = 0, u_0 = 0
/// ```
/// s is `sideways`, w the speed on leaving, N and N′ normal with variance 1.
pub(super) fn places(impacts: &[Impact], sideways: f64, mut rng: SplitMix64) -> Vec<Point> {
    let (mut place, mut speed) = ([0.0; 3], [0.0; 2]);
    let mut places = Vec::with_capacity(impacts.len());
    for (i, impact) in impacts.iter().enumerate() {
        places.push(place);
        let next_s = impacts.get(i + 1).map_or(impact.time_s, |next| next.time_s);
        for (axis, speed) in speed.iter_mut().enumerate() {
            *speed += sideways * impact.rebound_speed_m_per_s * rng.normal();
            place[axis] += *speed * (next_s - impact.time_s);
        }
    }
    places
}

/// Distance of two points in metres.
pub(super) fn distance_m(a: Point, b: Point) -> f64 {
    let square = |i: usize| (a[i] - b[i]) * (a[i] - b[i]);
    libm::sqrt(square(0) + square(1) + square(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    const WALL: Wall = Wall {
        bearing_deg: 90.0,
        distance_m: 2.0,
        level_db: 0.0,
    };

    #[test]
    fn a_wall_answers_as_the_mirror_image_does() {
        // 3 m there and 1 m beside: the image is 3 m beyond the place and the way to it √(3² + 4²) m.
        let reflection = WALL.reflection([0.0, 0.5, 0.0], [4.0, 0.5, 0.0]).unwrap();
        assert!((reflection.later_s - 1.0 / 343.0).abs() < 1e-12);
        assert!((reflection.level - 0.8).abs() < 1e-12);
        assert_eq!(WALL.reflection([0.0, 2.1, 0.0], [4.0, 0.5, 0.0]), None);
    }

    #[test]
    fn microphones_stand_before_the_walls() {
        assert!(WALL.check(&[Some([9.0, 1.9, 1.0])]).is_ok());
        for (microphone, name) in [(Some([0.0, 2.1, 1.0]), "at_m"), (None, "walls")] {
            let error = WALL.check(&[microphone]).unwrap_err().to_string();
            assert!(error.starts_with(name), "{error}");
        }
    }
}
