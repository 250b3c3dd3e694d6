//! Where a round looks: at what was likely in the round before.

use super::bands::Windows;
use super::fusion::{Posterior, SILENT, WIDTHS_S};
use std::ops::Range;

/// Places and trials of less than this share are not looked at until nothing moves.
const LEAST: f64 = 1e-6;
/// Places on either side of the likely ones that are looked at too: nothing moves further in a round (convention).
pub(super) const MARGIN: usize = 3;

/// The places of each impact, and of widths of disagreement and shares of silent bands those that are tried.
#[derive(Debug)]
pub(super) struct Focus {
    pub places: Vec<Range<usize>>,
    trials: Vec<bool>,
}

impl Focus {
    /// All there is.
    pub(super) fn whole(windows: &Windows) -> Self {
        Self {
            places: windows.of.iter().map(|w| 0..2 * w.reach + 1).collect(),
            trials: vec![true; WIDTHS_S.len() * SILENT.len()],
        }
    }

    /// What is likely by the posteriors and the shares of the trials.
    pub(super) fn on(posteriors: &[Posterior], trials: &[f64]) -> Self {
        let likely = |p: &&f64| **p > LEAST;
        let places = posteriors.iter().map(|Posterior { p, .. }| {
            let before = p.iter().take_while(|p| !likely(p)).count();
            let after = p.iter().rev().take_while(|p| !likely(p)).count();
            before.saturating_sub(MARGIN)..(p.len() - after + MARGIN).min(p.len())
        });
        Self {
            places: places.collect(),
            trials: trials.iter().map(|share| *share > LEAST).collect(),
        }
    }

    /// Which shares of silent bands are tried with a width.
    pub(super) fn of_width(&self, width: usize) -> &[bool] {
        &self.trials[width * SILENT.len()..(width + 1) * SILENT.len()]
    }
}
