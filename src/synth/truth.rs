//! What is true about a recording that was made.

use serde::Serialize;

use super::scene::Scene;

/// What is true about a recording. Written beside it as `NAME.truth.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Truth {
    /// Name of the scene.
    pub scene: String,
    /// The seed it was made with.
    pub seed: u64,
    /// Samples per second.
    pub sample_rate_hz: u32,
    /// Length of the recording in seconds.
    pub duration_s: f64,
    /// The drops in order of the scene.
    pub drops: Vec<DropTruth>,
    /// The whole scene; what is absent there (minus infinity in dB) is null here.
    pub parameters: Scene,
}

/// What is true about a drop. Lists hold one number for each impact within the recording.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct DropTruth {
    /// When the ball touched, in seconds from the first sample.
    pub impacts_s: Vec<f64>,
    /// When its sound reached the first channel's microphone, in seconds from the first sample.
    pub onsets_s: Vec<f64>,
    /// Whether each impact can be heard: see [`super::hearing`].
    pub audible: Vec<bool>,
    /// Energy of the sound over the noise in its window after the best filter, in dB, in the clearest channel.
    pub energy_to_noise_db: Vec<f64>,
    /// Least standard error of its time that any method can reach, in seconds: see [`super::hearing`].
    pub timing_limit_s: Vec<f64>,
    /// Standard error that a match with the mean sound reaches at best, in seconds: see [`super::hearing`].
    pub timing_floor_s: Vec<f64>,
    /// e before scatter, at the geometric mean of the audible impacts' speeds.
    pub restitution: f64,
    /// e of each impact before scatter.
    pub restitution_nominal_each: Vec<f64>,
    /// e of each impact as it happened; 0 where the ball stayed.
    pub restitution_each: Vec<f64>,
    /// Speed of each impact in m/s.
    pub speeds_m_per_s: Vec<f64>,
    /// Impacts before the recorder started.
    pub impacts_before: usize,
    /// Impacts after the recorder stopped.
    pub impacts_after: usize,
    /// Height of release in metres.
    pub height_m: f64,
    /// Time from touch to leaving of the first impact, in seconds.
    pub contact_time_s: f64,
    /// Period of the sound of the first impact, in seconds: an error of a whole period is a cycle slip.
    pub period_s: f64,
}
