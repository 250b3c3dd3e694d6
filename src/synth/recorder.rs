//! The recorder: what happens to sound between the microphone and the file.

use serde::{Deserialize, Serialize};

pub use super::channel::Channel;
use super::decibels;
pub use super::gaps::Gap;
use super::gaps::check_gaps;
use super::scene::within;
use crate::Error;

/// How a scene is recorded.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Recorder {
    /// How samples are stored. Default 16-bit.
    pub encoding: Encoding,
    /// Gain in dB after all noise: above 0 it drives loud impacts into the limits. Default 0.
    pub gain_db: f64,
    /// Constant added to every sample, in full scales. Default 0.
    pub dc_offset: f64,
    /// From this level on, in dB of full scale, loud sound is bent smoothly towards full scale. Default: never.
    pub soft_limit_db: Option<f64>,
    /// Automatic gain, if any.
    pub automatic_gain: Option<AutomaticGain>,
    /// The recording begins this late in the scene, in seconds. Default 0.
    pub start_s: f64,
    /// It ends here in the scene, in seconds. Default: with the scene.
    pub stop_s: Option<f64>,
    /// Its channels. Default one.
    pub channels: Vec<Channel>,
    /// Stretches that are silent in the file, in order of time.
    pub drop_outs: Vec<Gap>,
    /// Stretches that are cut out of the file, in order of time; later sound moves forward.
    pub splices: Vec<Gap>,
}

/// How samples are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Encoding {
    /// 8-bit integers.
    #[serde(rename = "int8")]
    Int8,
    /// 16-bit integers.
    #[serde(rename = "int16")]
    Int16,
    /// 24-bit integers.
    #[serde(rename = "int24")]
    Int24,
    /// 32-bit integers. Samples pass through 32-bit floats, so the last bits of loud ones are 0.
    #[serde(rename = "int32")]
    Int32,
    /// 32-bit floating point. Nothing is clipped.
    #[serde(rename = "float32")]
    Float32,
}

/// Gain that follows the loudness: down fast, up slowly.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AutomaticGain {
    /// The level it aims at, in dB of full scale.
    pub target_db: f64,
    /// The most that it amplifies, in dB.
    pub most_db: f64,
    /// Time constant on loud sound, in seconds.
    pub attack_s: f64,
    /// Time constant after it, in seconds.
    pub release_s: f64,
}

impl Default for Recorder {
    fn default() -> Self {
        Self {
            encoding: Encoding::Int16,
            gain_db: 0.0,
            dc_offset: 0.0,
            soft_limit_db: None,
            automatic_gain: None,
            start_s: 0.0,
            stop_s: None,
            channels: vec![Channel::default()],
            drop_outs: Vec::new(),
            splices: Vec::new(),
        }
    }
}

impl Encoding {
    /// Bits of a sample.
    #[must_use]
    pub const fn bits(self) -> u16 {
        match self {
            Self::Int8 => 8,
            Self::Int16 => 16,
            Self::Int24 => 24,
            Self::Int32 | Self::Float32 => 32,
        }
    }

    /// Steps in one full scale; none for floating point.
    pub(super) fn steps(self) -> Option<f64> {
        match self {
            Self::Float32 => None,
            integer => Some(libm::exp2(f64::from(integer.bits() - 1))),
        }
    }

    /// What the file will hold of a sample.
    fn round(self, x: f64) -> f64 {
        match self.steps() {
            None => x,
            Some(steps) => libm::round(x * steps).clamp(-steps, steps - 1.0) / steps,
        }
    }
}

impl Recorder {
    pub(super) fn check(&self, duration_s: f64) -> Result<(), Error> {
        within("gain_db", self.gain_db, -200.0..=200.0, "-200 to 200")?;
        within("dc_offset", self.dc_offset, -1.0..=1.0, "-1 to 1")?;
        let end = self.stop_s.unwrap_or(duration_s);
        within("stop_s", end, 0.0..=duration_s, "within the scene")?;
        within("start_s", self.start_s, 0.0..=end - 1e-3, "before the end")?;
        if let Some(level) = self.soft_limit_db {
            within("soft_limit_db", level, -60.0..=-0.1, "-60 to -0.1")?;
        }
        if let Some(gain) = self.automatic_gain {
            within("target_db", gain.target_db, -60.0..=0.0, "-60 to 0")?;
            within("most_db", gain.most_db, 0.0..=80.0, "0 to 80")?;
            within("attack_s", gain.attack_s, 1e-5..=10.0, "10 us to 10 s")?;
            within("release_s", gain.release_s, 1e-5..=100.0, "10 us to 100 s")?;
        }
        for channel in &self.channels {
            channel.check()?;
        }
        check_gaps(&self.drop_outs, self.start_s, end)?;
        check_gaps(&self.splices, self.start_s, end)?;
        if self.channels.is_empty() || self.channels.len() > 64 {
            let count = crate::units::real(self.channels.len());
            return Err(Error::argument("channels", count, "1 to 64"));
        }
        Ok(())
    }

    /// The samples of the file from the sound at the microphones. Gain is the same for all channels.
    pub(super) fn record(&self, channels: &[Vec<f64>], rate: f64) -> Vec<Vec<f32>> {
        let gains = self.gains(channels, rate);
        channels
            .iter()
            .map(|sound| {
                let recorded = sound
                    .iter()
                    .zip(&gains)
                    .map(|(x, gain)| self.store(gain * x));
                self.edited(recorded.collect(), rate)
            })
            .collect()
    }

    #[expect(
        clippy::cast_possible_truncation,
        reason = "samples are f32 from here on"
    )]
    fn store(&self, x: f64) -> f32 {
        let bent = match self.soft_limit_db {
            None => x,
            Some(level) => bend(x, decibels(level)),
        };
        self.encoding.round(bent + self.dc_offset) as f32
    }

    fn gains(&self, channels: &[Vec<f64>], rate: f64) -> Vec<f64> {
        let fixed = decibels(self.gain_db);
        let count = channels.first().map_or(0, Vec::len);
        let Some(automatic) = self.automatic_gain else {
            return vec![fixed; count];
        };
        let towards = |time_s: f64| -libm::expm1(-1.0 / (time_s * rate));
        let (attack, release) = (towards(automatic.attack_s), towards(automatic.release_s));
        let (target, most) = (decibels(automatic.target_db), decibels(automatic.most_db));
        let mut level = target / most;
        (0..count)
            .map(|i| {
                let loudest = channels.iter().map(|c| (fixed * c[i]).abs());
                let now = loudest.fold(0.0, f64::max);
                level += (now - level) * if now > level { attack } else { release };
                fixed * (target / level.max(f64::MIN_POSITIVE)).min(most)
            })
            .collect()
    }
}

/// Leaves what is below the threshold and bends what is above it, with no kink, so that it never reaches 1.
fn bend(x: f64, threshold: f64) -> f64 {
    let (size, room) = (x.abs(), 1.0 - threshold);
    if size <= threshold {
        x
    } else {
        (threshold + room * libm::tanh((size - threshold) / room)).copysign(x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_hold_whole_steps_within_full_scale() {
        for encoding in [Encoding::Int8, Encoding::Int16, Encoding::Int24] {
            let steps = encoding.steps().unwrap();
            for x in [-2.0, -1.0, -0.3, 0.0, 0.299_9, 1.0, 7.0] {
                let kept = encoding.round(x) * steps;
                assert_eq!(kept, kept.round());
                assert!((-steps..steps).contains(&kept));
            }
        }
        assert_eq!(Encoding::Float32.round(1.7), 1.7);
    }

    #[test]
    fn the_soft_limit_is_smooth_and_never_full() {
        let bent: Vec<f64> = (0..400).map(|i| bend(0.01 * f64::from(i), 0.5)).collect();
        assert!(
            bent.windows(2)
                .all(|w| w[1] >= w[0] && w[1] - w[0] < 0.010_1)
        );
        assert!(bent.iter().all(|&x| x < 1.0) && bend(-2.0, 0.5) == -bend(2.0, 0.5));
    }

    #[test]
    fn automatic_gain_brings_quiet_sound_up_and_loud_sound_down() {
        let recorder = Recorder {
            automatic_gain: Some(AutomaticGain {
                target_db: -20.0,
                most_db: 30.0,
                attack_s: 1e-3,
                release_s: 0.05,
            }),
            encoding: Encoding::Float32,
            ..Recorder::default()
        };
        let square = |level: f64| (0..9_000).map(move |i| if i % 20 < 10 { level } else { -level });
        let sound: Vec<f64> = square(0.01).chain(square(0.5)).collect();
        let recorded = &recorder.record(&[sound], 9_000.0)[0];
        assert!(
            (recorded[8_990].abs() - 0.1).abs() < 0.01,
            "{}",
            recorded[8_990]
        );
        assert!((recorded[17_990].abs() - 0.1).abs() < 0.01);
    }
}
