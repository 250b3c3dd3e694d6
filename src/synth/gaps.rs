//! Stretches of a recording that are silent or cut out.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::instant_s;
use super::recorder::Recorder;
use super::scene::within;
use crate::Error;
use crate::units::samples_in;

/// A stretch of the scene.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Gap {
    /// Its start in the scene, in seconds.
    pub at_s: f64,
    /// Its length in seconds.
    pub length_s: f64,
}

/// Whether stretches lie in the recording, one after another.
pub(super) fn check_gaps(gaps: &[Gap], start_s: f64, end_s: f64) -> Result<(), Error> {
    let mut from_s = start_s;
    for gap in gaps {
        let expected = "a time in the recording, after the stretch before";
        within("at_s", gap.at_s, from_s..=end_s, expected)?;
        let left_s = end_s - gap.at_s;
        // Rounding may push an end past the last sample.
        within(
            "length_s",
            gap.length_s,
            0.0..=left_s + 1e-9,
            "up to the end",
        )?;
        from_s = gap.at_s + gap.length_s;
    }
    Ok(())
}

impl Recorder {
    /// Silences the drop-outs, then cuts the splices out, from the last to the first so that earlier places stay valid.
    pub(super) fn edited(&self, mut samples: Vec<f32>, rate: f64) -> Vec<f32> {
        for gap in &self.drop_outs {
            let at = self.samples_of(*gap, rate, samples.len());
            samples[at].fill(0.0);
        }
        for gap in self.splices.iter().rev() {
            let at = self.samples_of(*gap, rate, samples.len());
            samples.drain(at);
        }
        samples
    }

    /// The samples of a stretch.
    fn samples_of(&self, gap: Gap, rate: f64, count: usize) -> Range<usize> {
        let from = samples_in(gap.at_s - self.start_s, rate).min(count);
        from..(from + samples_in(gap.length_s, rate)).min(count)
    }

    /// Seconds cut out before an instant, itself in seconds from the first sample; none if the instant is cut out.
    pub(super) fn cut_before_s(&self, time_s: f64, rate: f64) -> Option<f64> {
        let mut cut_s = 0.0;
        for gap in &self.splices {
            let at = self.samples_of(*gap, rate, usize::MAX);
            if instant_s(at.end, rate) <= time_s {
                cut_s += instant_s(at.len(), rate);
            } else if instant_s(at.start, rate) <= time_s {
                return None;
            }
        }
        Some(cut_s)
    }

    /// Whether the sound drops out at an instant, in seconds from the first sample.
    pub(super) fn is_out(&self, time_s: f64, rate: f64) -> bool {
        self.drop_outs.iter().any(|gap| {
            let at = self.samples_of(*gap, rate, usize::MAX);
            (instant_s(at.start, rate)..instant_s(at.end, rate)).contains(&time_s)
        })
    }
}
