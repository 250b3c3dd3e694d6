//! Scenes: what is dropped, what it sounds like, and how it is recorded. Written as TOML; every field says its unit.

use serde::{Deserialize, Serialize};

use super::ambience::Noise;
use super::recorder::Recorder;
use super::room::{Echo, Tail};
use crate::Error;
use crate::units::real;

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

/// One drop.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DropScene {
    /// From the ball's lowest point to the surface, in metres.
    pub height_m: f64,
    /// Each seed drops it from another height within this share of `height_m`, up or down. Default 0.
    #[serde(default)]
    pub height_spread: f64,
    /// When it first hits, in seconds from the start of the scene, up to a sample more: elsewhere for every seed.
    pub first_impact_s: f64,
    /// Mass in kilograms.
    pub mass_kg: f64,
    /// Diameter in metres.
    pub diameter_m: f64,
    /// Whether the air slows it. Default no.
    #[serde(default)]
    pub drag: bool,
    /// What happens at an impact.
    pub bounce: BounceScene,
    /// Standard deviation of ln e from bounce to bounce. Default 0.
    #[serde(default)]
    pub bounce_scatter: f64,
    /// The ball is caught after this impact. Default: never.
    #[serde(default)]
    pub most_impacts: Option<usize>,
    /// Distance to the microphone at the first impact, in metres: the sound comes later by 2.9 ms per metre. Its level
    /// is `peak_db` whatever the distance. Default 0.
    #[serde(default)]
    pub microphone_distance_m: f64,
    /// Speed at which the ball rolls away from the microphone, in m/s: the delay grows, the level falls. Default 0.
    #[serde(default)]
    pub leaving_m_per_s: f64,
    /// What rings, ball and surface.
    pub modes: Vec<Mode>,
    /// Standard deviation of ln level of each mode from impact to impact. Default 0.
    #[serde(default)]
    pub level_scatter: f64,
    /// Standard deviation of ln level of whole impacts. Default 0.
    #[serde(default)]
    pub loudness_scatter: f64,
    /// The force lasts as (v/v₁)^this: −0.2 for a solid sphere (Hertz). It changes the sound, not the flights. Default 0.
    #[serde(default)]
    pub contact_exponent: f64,
}

/// What happens at an impact: one of the laws of [`crate::physics`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum BounceScene {
    /// The same e and contact time at every impact; rest by the paper's (19).
    Constant {
        /// e.
        restitution: f64,
        /// ΔT in seconds.
        contact_time_s: f64,
    },
    /// The linear ball with its weight, from e and ΔT of a fast impact.
    Linear {
        /// e without weight.
        restitution: f64,
        /// ΔT without weight, in seconds.
        contact_time_s: f64,
    },
    /// The linear ball with its weight, from k and c.
    Spring {
        /// k.
        stiffness_n_per_m: f64,
        /// c.
        damping_n_s_per_m: f64,
    },
    /// `e = 1 − γ₁v^(1/5) + γ₂v^(2/5)`.
    Viscoelastic {
        /// γ₁.
        gamma1: f64,
        /// γ₂.
        gamma2: f64,
        /// ΔT in seconds.
        contact_time_s: f64,
    },
    /// `e = e_y·(max(v, v_y)/v_y)^(−p)`.
    Power {
        /// e below the yield speed.
        restitution: f64,
        /// `v_y`.
        yield_speed_m_per_s: f64,
        /// p.
        exponent: f64,
        /// ΔT in seconds.
        contact_time_s: f64,
    },
}

/// A damped oscillation that an impact sets off.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Mode {
    /// Frequency in Hz. Above 0.45 of the sample rate it is left out, as a recorder's filter does.
    pub frequency_hz: f64,
    /// Time in which it falls to 1/e, in seconds.
    pub decay_s: f64,
    /// Amplitude for an impact of 1 m/s, in any unit: only the ratios between modes matter.
    pub level: f64,
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

impl DropScene {
    fn check(&self, duration_s: f64) -> Result<(), Error> {
        within(
            "first_impact_s",
            self.first_impact_s,
            0.0..=duration_s,
            "a time within the recording",
        )?;
        within("height_spread", self.height_spread, 0.0..=0.9, "0 to 0.9")?;
        within("level_scatter", self.level_scatter, 0.0..=3.0, "0 to 3")?;
        within(
            "loudness_scatter",
            self.loudness_scatter,
            0.0..=3.0,
            "0 to 3",
        )?;
        within(
            "contact_exponent",
            self.contact_exponent,
            -1.0..=1.0,
            "-1 to 1",
        )?;
        within(
            "microphone_distance_m",
            self.microphone_distance_m,
            0.0..=1e4,
            "0 to 10 km",
        )?;
        within(
            "leaving_m_per_s",
            self.leaving_m_per_s,
            0.0..=30.0,
            "0 to 30 m/s",
        )?;
        for mode in &self.modes {
            within(
                "frequency_hz",
                mode.frequency_hz,
                1e-3..=1e6,
                "0.001 to 1000000 Hz",
            )?;
            within("decay_s", mode.decay_s, 1e-6..=60.0, "1 us to 60 s")?;
            within("level", mode.level, 0.0..=1e30, "0 to 1e30")?;
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
        ] {
            let error = Scene::from_toml(text).unwrap_err().to_string();
            assert!(error.starts_with(name), "{error}");
        }
    }
}
