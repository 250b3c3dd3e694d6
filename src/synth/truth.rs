//! What is true about a recording that was made.

use serde::Serialize;

use super::Stage;
use super::channel::Channel;
use super::drops::{Dropped, Strike};
use super::hearing::Heard;
use super::scene::Scene;
use crate::units::real;

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
    /// The same for each other channel, in their order.
    pub more_onsets_s: Vec<Vec<f64>>,
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
    /// Indices from 0 of impacts whose next flight is irregular: by an odd bounce, or a splice before the next impact.
    pub irregular: Vec<usize>,
    /// Indices from 0 of impacts at which e changes for good.
    pub changes: Vec<usize>,
    /// Number of impacts that a splice cut out.
    pub impacts_cut: usize,
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

/// An impact that is in the recording.
struct Kept<'a> {
    strike: &'a Strike,
    heard: Heard,
    /// Seconds from the first sample.
    touch_s: f64,
    onset_s: f64,
    /// Seconds cut out of the recording before it.
    cut_s: f64,
}

impl Stage<'_> {
    /// What is true of a drop, given its impacts as they were heard.
    pub(super) fn truth(&self, dropped: &Dropped, own: &[(&Strike, Heard)]) -> DropTruth {
        let end_s = real(self.count) / self.rate;
        let onset_s = |s: &Strike| s.onset_s(self.first());
        let before = own.iter().filter(|(s, _)| onset_s(s) < 0.0).count();
        let after = own.iter().filter(|(s, _)| onset_s(s) >= end_s).count();
        let within = &own[before..own.len() - after];
        let kept = within.iter().filter_map(|(s, heard)| self.kept(s, *heard));
        let kept: Vec<Kept<'_>> = kept.collect();
        let list = |of: fn(&Kept<'_>) -> f64| kept.iter().map(of).collect::<Vec<_>>();
        let which = |of: &dyn Fn(usize) -> bool| (0..kept.len()).filter(|&i| of(i)).collect();
        let audible = self.audible(&kept, dropped.contact_time_s);
        let nominal = list(|k| k.strike.nominal);
        let first = own
            .first()
            .map(|(s, _)| s.sound.render(self.rate, s.arrival_s, 1.0));
        DropTruth {
            impacts_s: list(|k| k.touch_s),
            onsets_s: list(|k| k.onset_s),
            more_onsets_s: self.more_onsets_s(&kept),
            energy_to_noise_db: list(|k| k.heard.energy_to_noise_db),
            timing_limit_s: list(|k| k.heard.timing_limit_s),
            timing_floor_s: list(|k| k.heard.timing_floor_s),
            restitution: typical(&nominal, &audible),
            audible,
            restitution_nominal_each: nominal,
            restitution_each: list(|k| k.strike.impact.restitution()),
            speeds_m_per_s: list(|k| k.strike.impact.impact_speed_m_per_s),
            irregular: which(&|i| {
                let next = kept.get(i + 1);
                kept[i].strike.odd || next.is_some_and(|next| next.cut_s > kept[i].cut_s)
            }),
            changes: which(&|i| kept[i].strike.changed),
            impacts_cut: within.len() - kept.len(),
            impacts_before: before,
            impacts_after: after,
            height_m: dropped.height_m,
            contact_time_s: dropped.contact_time_s,
            period_s: first.map_or(0.0, |sound| 1.0 / sound.frequency_hz()),
        }
    }

    /// The first channel.
    fn first(&self) -> Channel {
        let channels = self.scene.recorder.channels.first();
        channels.copied().unwrap_or_default()
    }

    /// When impacts are heard in each channel but the first.
    fn more_onsets_s(&self, kept: &[Kept<'_>]) -> Vec<Vec<f64>> {
        let others = self.scene.recorder.channels.iter().skip(1);
        let onsets_s = |channel: &Channel| {
            let onsets_s = kept.iter().map(|k| k.strike.onset_s(*channel) - k.cut_s);
            onsets_s.collect()
        };
        others.map(onsets_s).collect()
    }

    /// An impact in the times of the file; none if it is cut out.
    fn kept<'a>(&self, strike: &'a Strike, heard: Heard) -> Option<Kept<'a>> {
        let onset_s = strike.onset_s(self.first());
        let cut_s = self.scene.recorder.cut_before_s(onset_s, self.rate)?;
        Some(Kept {
            strike,
            heard,
            touch_s: strike.touch_s - cut_s,
            onset_s: onset_s - cut_s,
            cut_s,
        })
    }

    /// Which impacts can be heard.
    fn audible(&self, kept: &[Kept<'_>], contact_time_s: f64) -> Vec<bool> {
        let last_s = kept.iter().map(|k| k.touch_s);
        let last_s = std::iter::once(f64::NEG_INFINITY).chain(last_s);
        let is_audible = |(k, last_s): (&Kept<'_>, f64)| {
            let out = self.scene.recorder.is_out(k.onset_s + k.cut_s, self.rate);
            !out && k.heard.is_audible(k.touch_s - last_s, contact_time_s)
        };
        kept.iter().zip(last_s).map(is_audible).collect()
    }
}

/// Geometric mean of what is audible; of everything, if nothing is.
fn typical(values: &[f64], audible: &[bool]) -> f64 {
    let any = audible.contains(&true);
    let all = values.iter().zip(audible);
    let chosen: Vec<f64> = all
        .filter(|(v, audible)| **v > 0.0 && (**audible || !any))
        .map(|(v, _)| *v)
        .collect();
    let Some(&first) = chosen.first() else {
        return 0.0;
    };
    // Relative to the first, so that a constant comes out as it went in.
    let logs = chosen.iter().map(|v| libm::log(v / first));
    first * libm::exp(logs.sum::<f64>() / real(chosen.len()))
}
