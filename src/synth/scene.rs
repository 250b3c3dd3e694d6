//! Scenes: what is dropped, what it sounds like, and how it is recorded. Written as TOML; every field says its unit.

use serde::{Deserialize, Serialize};

use super::ambience::Noise;
use super::recorder::Recorder;
use super::room::{Echo, Tail};
use crate::Error;
use crate::units::real;

pub use super::drop_scene::{BounceChange, BounceScene, Copies, DropScene, Mode};
pub use super::place::Wall;
pub use super::presets::preset;

/// Samples that are made at most, as some 20 bytes of memory go with each: 38 minutes of one channel at 44.1 kHz.
const MOST_SAMPLES: f64 = 100e6;

/// A whole recording to be made.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Its name.
    pub name: String,
    /// What it is there to show, in a sentence.
    #[serde(default)]
    pub about: String,
    /// Samples per second, 1,000 to 768,000. Default 44,100.
    #[serde(default = "default_sample_rate_hz")]
    pub sample_rate_hz: u32,
    /// Length in seconds, before a late start or an early stop of the recorder.
    pub duration_s: f64,
    /// The loudest impact's peak at the recorder's input in dB below full scale, alone and before its gain. Default −3.
    #[serde(default = "default_peak_db")]
    pub peak_db: f64,
    /// Gravity in m/s². Default 9.81.
    #[serde(default = "default_gravity")]
    pub gravity_m_per_s2: f64,
    /// The drops; none for recordings that hold none.
    #[serde(default)]
    pub drops: Vec<DropScene>,
    /// Early reflections of every impact.
    #[serde(default)]
    pub echoes: Vec<Echo>,
    /// Walls, whose reflections differ with the place of the impact; every channel needs its own place then.
    #[serde(default)]
    pub walls: Vec<Wall>,
    /// The diffuse end of the room's answer, if it has one.
    #[serde(default)]
    pub tail: Option<Tail>,
    /// What else is heard.
    #[serde(default)]
    pub noise: Noise,
    /// How it is recorded.
    #[serde(default)]
    pub recorder: Recorder,
}

const fn default_sample_rate_hz() -> u32 {
    44_100
}

const fn default_peak_db() -> f64 {
    -3.0
}

const fn default_gravity() -> f64 {
    9.81
}

impl Scene {
    /// Reads a scene.
    ///
    /// # Errors
    /// [`Error::Argument`] saying where the text is not a scene, or which number is out of range.
    pub fn from_toml(text: &str) -> Result<Self, Error> {
        let scene: Self = toml::from_str(text).map_err(|e| Error::Argument {
            argument: "scene",
            got: e.to_string().trim_end().to_owned(),
            expected: "a scene as those in assets/scenes",
        })?;
        scene.check()?;
        Ok(scene)
    }

    /// Whether all numbers are in range. Those of the physics are checked where they are used.
    pub(super) fn check(&self) -> Result<(), Error> {
        let rate = f64::from(self.sample_rate_hz);
        within("sample_rate_hz", rate, 1e3..=768e3, "1000 to 768000")?;
        within(
            "duration_s",
            self.duration_s,
            1e-3..=86_400.0,
            "1 ms to a day",
        )?;
        within("peak_db", self.peak_db, -200.0..=40.0, "-200 to 40")?;
        for drop in &self.drops {
            drop.check(self.duration_s)?;
        }
        for echo in &self.echoes {
            echo.check()?;
        }
        self.check_places()?;
        self.tail.map_or(Ok(()), |tail| tail.check())?;
        self.noise.check()?;
        self.recorder.check(self.duration_s)?;
        let recorder = &self.recorder;
        let recorded_s = recorder.stop_s.unwrap_or(self.duration_s) - recorder.start_s;
        let samples = recorded_s * rate * real(recorder.channels.len());
        if samples > MOST_SAMPLES {
            return Err(Error::Argument {
                argument: "the recording",
                got: format!("{samples:.0} samples long, over all channels"),
                expected: "100000000 at most: a shorter duration_s, a lower sample_rate_hz or fewer channels",
            });
        }
        Ok(())
    }
}

impl Scene {
    /// Whether microphones with a place go with walls and drops.
    fn check_places(&self) -> Result<(), Error> {
        let places = self.recorder.channels.iter().map(|c| c.at_m);
        let places: Vec<_> = places.collect();
        self.walls.iter().try_for_each(|wall| wall.check(&places))?;
        let far = |d: &DropScene| d.microphone_distance_m > 0.0 || d.leaving_m_per_s > 0.0;
        if places.iter().any(Option::is_some) && self.drops.iter().any(far) {
            return Err(Error::Argument {
                argument: "at_m",
                got: "beside a microphone_distance_m or leaving_m_per_s".to_owned(),
                expected: "one of them: each says where the microphone is",
            });
        }
        Ok(())
    }
}

/// An error naming what is out of range, NaN included.
pub(super) fn within(
    argument: &'static str,
    value: f64,
    range: std::ops::RangeInclusive<f64>,
    expected: &'static str,
) -> Result<(), Error> {
    if range.contains(&value) {
        Ok(())
    } else {
        Err(Error::argument(argument, value, expected))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelt_field_is_named() {
        let text = "name = 'x'\nduration_s = 1.0\n[noise]\nwihte_db = -60.0\n";
        let error = Scene::from_toml(text).unwrap_err().to_string();
        assert!(
            error.contains("wihte_db") && error.contains("white_db"),
            "{error}"
        );
    }

    #[test]
    fn a_number_out_of_range_is_named() {
        for (text, name) in [
            ("name = 'x'\nduration_s = -1.0", "duration_s"),
            ("name = 'x'\nduration_s = nan", "duration_s"),
            (
                "name = 'x'\nduration_s = 1.0\nsample_rate_hz = 10",
                "sample_rate_hz",
            ),
            (
                "name = 'x'\nduration_s = 1.0\nechoes = [{ delay_s = -1.0, level_db = 0.0 }]",
                "delay_s",
            ),
            (
                "name = 'x'\nduration_s = 1.0\n[recorder]\nstart_s = 2.0",
                "start_s",
            ),
            (
                "name = 'x'\nduration_s = 1.0\n[recorder]\nsplices = [{ at_s = 0.9, length_s = 0.2 }]",
                "length_s",
            ),
            (
                "name = 'x'\nduration_s = 1.0\n[recorder]\nsplices = [{ at_s = 0.5, length_s = 0.2 }, { at_s = 0.6, length_s = 0.2 }]",
                "at_s",
            ),
            (
                "name = 'x'\nduration_s = 1.0\n[noise]\nwords = { level_db = -20.0, every_s = 0.0 }",
                "every_s",
            ),
            (
                "name = 'x'\nduration_s = 1.0\n[[noise.taps]]\nfirst_s = 0.1\ncount = 3\ninterval_s = 0.0\nlevel_db = -3.0\ncontact_time_s = 1e-3\nmodes = []",
                "interval_s",
            ),
        ] {
            let error = Scene::from_toml(text).unwrap_err().to_string();
            assert!(error.starts_with(name), "{error}");
        }
    }
}
