//! What is true about a recording that was made.

use serde::Serialize;

use super::scene::DropScene;
use crate::physics::Impact;

/// What is true about a recording.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Truth {
    /// Name of the scene.
    pub scene: String,
    /// The seed it was made with.
    pub seed: u64,
    /// Samples per second.
    pub sample_rate_hz: u32,
    /// The drops in order of the scene.
    pub drops: Vec<DropTruth>,
}

/// What is true about a drop.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DropTruth {
    /// When the ball touched, in seconds from the first sample.
    pub impacts_s: Vec<f64>,
    /// Whether each impact can be heard: matched-filter energy 15 dB over the white noise, and 4 ms and a contact after the
    /// one before.
    pub audible: Vec<bool>,
    /// e before scatter.
    pub restitution: f64,
    /// e of each impact.
    pub restitution_each: Vec<f64>,
    /// Speed of each impact in m/s.
    pub speeds_m_per_s: Vec<f64>,
    /// Height of release in metres.
    pub height_m: f64,
    /// Contact time in seconds.
    pub contact_time_s: f64,
    /// Sum of the squares of each impact's samples.
    #[serde(skip)]
    pub(super) energies: Vec<f64>,
}

/// Energy over noise power from which an impact can be heard: 15 dB.
const AUDIBLE_RATIO: f64 = 31.6;
/// Two impacts nearer than this are one sound.
const SHORTEST_S: f64 = 4e-3;

impl DropTruth {
    pub(super) fn new(drop: &DropScene, impacts: &[Impact], shift_s: f64) -> Self {
        Self {
            impacts_s: impacts.iter().map(|i| i.time_s + shift_s).collect(),
            audible: Vec::new(),
            restitution: drop.restitution,
            restitution_each: impacts.iter().map(Impact::restitution).collect(),
            speeds_m_per_s: impacts.iter().map(|i| i.impact_speed_m_per_s).collect(),
            height_m: drop.height_m,
            contact_time_s: drop.contact_time_s,
            energies: Vec::new(),
        }
    }

    /// Says which impacts are audible once the level is known: matched-filter energy 15 dB over the white noise, and
    /// at least 4 ms, and a contact, after the one before.
    pub(super) fn scale(&mut self, gain: f64, noise_rms: f64) {
        let apart = SHORTEST_S.max(self.contact_time_s);
        self.audible = (0..self.impacts_s.len())
            .map(|i| {
                let loud = gain * gain * self.energies[i] >= AUDIBLE_RATIO * noise_rms * noise_rms;
                loud && (i == 0 || self.impacts_s[i] - self.impacts_s[i - 1] >= apart)
            })
            .collect();
    }
}
