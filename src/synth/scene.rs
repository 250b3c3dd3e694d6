//! Scenes: what is dropped, what it sounds like, and how it is recorded.

use crate::Error;

/// A whole recording to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Its name.
    pub name: String,
    /// Samples per second.
    pub sample_rate_hz: u32,
    /// Length in seconds.
    pub duration_s: f64,
    /// The loudest impact's peak in dB below full scale.
    pub peak_db: f64,
    /// The drops; none for recordings that hold none.
    pub drops: Vec<DropScene>,
    /// Reflections of every impact.
    pub echoes: Vec<Echo>,
    /// What else is heard.
    pub noise: Noise,
}

/// One drop.
#[derive(Debug, Clone, PartialEq)]
pub struct DropScene {
    /// From the ball's lowest point to the surface, in metres.
    pub height_m: f64,
    /// When it first hits, in seconds from the start of the recording.
    pub first_impact_s: f64,
    /// Mass in kilograms.
    pub mass_kg: f64,
    /// Diameter in metres.
    pub diameter_m: f64,
    /// Whether the air slows it.
    pub drag: bool,
    /// e of every impact, before scatter.
    pub restitution: f64,
    /// Standard deviation of ln e from bounce to bounce.
    pub bounce_scatter: f64,
    /// Contact time in seconds, of every impact.
    pub contact_time_s: f64,
    /// What rings.
    pub modes: Vec<Mode>,
    /// Standard deviation of ln level of each mode from impact to impact.
    pub level_scatter: f64,
}

/// A damped oscillation that an impact sets off.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mode {
    /// Frequency in Hz.
    pub frequency_hz: f64,
    /// Time in which it falls to 1/e, in seconds.
    pub decay_s: f64,
    /// Amplitude for an impact of 1 m/s, in any unit: only the ratios between modes matter.
    pub level: f64,
}

/// A reflection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Echo {
    /// Seconds after the direct sound.
    pub delay_s: f64,
    /// dB relative to the direct sound.
    pub level_db: f64,
}

/// What is heard besides impacts. Levels in dB of full scale; minus infinity is none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Noise {
    /// White noise, rms.
    pub white_db: f64,
    /// A steady tone, rms, and its frequency in Hz.
    pub tone_db: f64,
    /// Frequency of the tone.
    pub tone_hz: f64,
    /// Speech-like bursts, rms of a syllable.
    pub babble_db: f64,
}

/// Names of the presets.
pub const PRESETS: [&str; 8] = [
    "steel", "pingpong", "rubber", "dead", "silence", "noise", "tone", "babble",
];

const NONE: f64 = f64::NEG_INFINITY;
const QUIET: Noise = Noise {
    white_db: -70.0,
    tone_db: NONE,
    tone_hz: 1_000.0,
    babble_db: NONE,
};

/// The scene of this name.
///
/// # Errors
/// [`Error::Argument`] if there is none, with the names that there are.
pub fn preset(name: &str) -> Result<Scene, Error> {
    match name {
        "steel" => Ok(with_drop(name, steel(), 4.0, &[])),
        "pingpong" => Ok(with_drop(
            name,
            ping_pong(),
            7.0,
            &[Echo {
                delay_s: 10.3e-3,
                level_db: -10.0,
            }],
        )),
        "rubber" => Ok(with_drop(name, rubber(), 4.0, &[])),
        "dead" => Ok(with_drop(name, dead(), 3.0, &[])),
        "silence" => Ok(without_drop(
            name,
            Noise {
                white_db: NONE,
                ..QUIET
            },
        )),
        "noise" => Ok(without_drop(
            name,
            Noise {
                white_db: -30.0,
                ..QUIET
            },
        )),
        "tone" => Ok(without_drop(
            name,
            Noise {
                tone_db: -12.0,
                ..QUIET
            },
        )),
        "babble" => Ok(without_drop(
            name,
            Noise {
                babble_db: -20.0,
                ..QUIET
            },
        )),
        _ => Err(Error::Argument {
            argument: "--preset",
            got: format!("'{name}'"),
            expected: "steel, pingpong, rubber, dead, silence, noise, tone or babble",
        }),
    }
}

fn with_drop(name: &str, drop: DropScene, duration_s: f64, echoes: &[Echo]) -> Scene {
    Scene {
        name: name.to_owned(),
        sample_rate_hz: 44_100,
        duration_s,
        peak_db: -3.0,
        drops: vec![drop],
        echoes: echoes.to_vec(),
        noise: QUIET,
    }
}

fn without_drop(name: &str, noise: Noise) -> Scene {
    Scene {
        name: name.to_owned(),
        sample_rate_hz: 44_100,
        duration_s: 10.0,
        peak_db: -3.0,
        drops: Vec::new(),
        echoes: Vec::new(),
        noise,
    }
}

const fn mode(frequency_hz: f64, decay_s: f64, level: f64) -> Mode {
    Mode {
        frequency_hz,
        decay_s,
        level,
    }
}

/// A 20 mm ball bearing on a thick plate.
fn steel() -> DropScene {
    DropScene {
        height_m: 0.15,
        first_impact_s: 0.6,
        mass_kg: 0.0327,
        diameter_m: 0.020,
        drag: false,
        restitution: 0.90,
        bounce_scatter: 0.003,
        contact_time_s: 0.08e-3,
        modes: vec![
            mode(5_200.0, 6e-3, 1.0),
            mode(9_700.0, 4e-3, 0.8),
            mode(14_300.0, 2e-3, 0.6),
        ],
        level_scatter: 0.1,
    }
}

/// A table-tennis ball of today on a table.
fn ping_pong() -> DropScene {
    DropScene {
        height_m: 0.305,
        first_impact_s: 0.7,
        mass_kg: 0.0027,
        diameter_m: 0.040,
        drag: true,
        restitution: 0.93,
        bounce_scatter: 0.004,
        contact_time_s: 0.7e-3,
        modes: vec![
            mode(1_300.0, 8e-3, 1.0),
            mode(6_800.0, 3e-3, 0.5),
            mode(9_400.0, 4e-3, 0.5),
        ],
        level_scatter: 0.15,
    }
}

/// A solid rubber ball on a floor.
fn rubber() -> DropScene {
    DropScene {
        height_m: 0.5,
        first_impact_s: 0.8,
        mass_kg: 0.060,
        diameter_m: 0.045,
        drag: false,
        restitution: 0.75,
        bounce_scatter: 0.006,
        contact_time_s: 1.5e-3,
        modes: vec![
            mode(320.0, 12e-3, 1.0),
            mode(780.0, 7e-3, 0.7),
            mode(2_100.0, 3e-3, 0.5),
        ],
        level_scatter: 0.1,
    }
}

/// A ball that hardly bounces: five impacts can be told apart.
fn dead() -> DropScene {
    DropScene {
        height_m: 0.1,
        first_impact_s: 1.0,
        mass_kg: 0.050,
        diameter_m: 0.040,
        drag: false,
        restitution: 0.40,
        bounce_scatter: 0.005,
        contact_time_s: 1e-3,
        modes: vec![
            mode(380.0, 6e-3, 1.0),
            mode(1_100.0, 4e-3, 0.7),
            mode(2_600.0, 2e-3, 0.5),
        ],
        level_scatter: 0.1,
    }
}

impl Scene {
    /// Whether all numbers are in range.
    pub(super) fn check(&self) -> Result<(), Error> {
        if self.sample_rate_hz < 1_000 {
            return Err(Error::argument(
                "sample_rate_hz",
                f64::from(self.sample_rate_hz),
                "1000 or more",
            ));
        }
        if !(self.duration_s.is_finite() && self.duration_s > 0.0 && self.duration_s < 86_400.0) {
            return Err(Error::argument(
                "duration_s",
                self.duration_s,
                "above 0 s and below a day",
            ));
        }
        for drop in &self.drops {
            if !(drop.first_impact_s >= 0.0 && drop.first_impact_s < self.duration_s) {
                return Err(Error::argument(
                    "first_impact_s",
                    drop.first_impact_s,
                    "a time within the recording",
                ));
            }
        }
        Ok(())
    }
}
