//! What was lost of a recording, and what is said of it.

use crate::units::real;

/// What was lost.
#[derive(Debug, Default)]
pub(super) struct Losses {
    /// How many times.
    pub times: u64,
    /// Frames of silence for it.
    pub frames: u64,
    /// Where the first begins.
    pub first: u64,
    /// Samples that are no numbers.
    pub not_finite: usize,
    /// Whether there was more than what silence can stand for.
    pub too_long: bool,
}

impl Losses {
    /// What is said of it; `is_estimate` if its length is one.
    pub(super) fn warnings(&self, sample_rate_hz: u32, is_estimate: bool) -> Vec<String> {
        let at = |frames: u64| real_s(frames, sample_rate_hz);
        let damaged = (self.times > 0).then(|| {
            format!(
                "sound is missing or damaged in {} at {:.3} s; {:.3} s of it are silence now, so that what follows keeps its time{}",
                match self.times {
                    1 => "one place,".to_owned(),
                    times => format!("{times} places, the first"),
                },
                at(self.first),
                at(self.frames),
                if is_estimate { ", to a frame or so where frames differ in length" } else { "" }
            )
        });
        let not_finite = (self.not_finite > 0).then(|| {
            format!(
                "samples that are not finite numbers were read as zero: {}",
                self.not_finite
            )
        });
        damaged.into_iter().chain(not_finite).collect()
    }
}

/// Frames in seconds.
pub(super) fn real_s(frames: u64, sample_rate_hz: u32) -> f64 {
    usize::try_from(frames).map_or(f64::INFINITY, real) / f64::from(sample_rate_hz)
}
