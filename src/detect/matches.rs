//! The match of a stretch of sound with a pattern, kept right while the pattern is taken out of the sound.

use crate::linalg::dot;
use crate::signal::correlate::Correlator;
use crate::signal::interpolate::shifted;
use crate::units::{narrow, real, whole};

/// The match with the first part of a pattern at every sample, in standard deviations of white noise of variance 1.
///
/// # Formula
/// `z(k) = Σ_j x(k + j)·s(j) / ‖s‖` over the part. Taking `a·s` out of x at p changes it by `−a·R(k − p)`, R being the match of the
/// whole pattern. An `f32` holds the loudest impact to a hundredth of a standard deviation.
pub(super) struct Matches {
    pub values: Vec<f32>,
    /// R from a little more than ½ a sample earlier to as much later, in [`STEPS`] to a sample; all from one lag on.
    phases: Vec<Vec<f32>>,
    /// The index of lag 0.
    centre: usize,
    /// ‖s‖ of the part.
    length: f64,
}

/// Steps between two samples at which R is known. Between them a parabola is laid through three, which is wrong by at
/// most (π/16)³/16 = 0.05 % where R changes as fast as it can: the vertex of the match is farther off.
const STEPS: usize = 16;

impl Matches {
    /// The first `count` matches of a sound, which has `part` more samples at least, with the first samples of a pattern.
    pub(super) fn of(
        sound: &[f64],
        pattern: &[f64],
        part: usize,
        count: usize,
        correlator: &mut Correlator,
    ) -> Option<Self> {
        let first = &pattern[..part];
        let length = dot(first, first).sqrt();
        let scaled = |products: Vec<f64>| products.into_iter().map(|p| p / length);
        let mut own = vec![0.0; part - 1];
        own.extend(pattern);
        own.resize(own.len() + part, 0.0);
        let own: Vec<f64> = scaled(correlator.correlate(&own, first)?).collect();
        let phase = |step: usize| {
            let later = (real(step) - 1.0) / real(STEPS) - 0.5;
            let moved = shifted(&own, -1.0 - later, pattern.len() + part + 1);
            moved.into_iter().map(narrow).collect()
        };
        Some(Self {
            values: scaled(correlator.correlate(sound.get(..count + part)?, first)?)
                .map(narrow)
                .take(count)
                .collect(),
            phases: (0..STEPS + 3).map(phase).collect(),
            // The first value of `own` belongs to a lag of 1 − part, and one stands before it.
            centre: part,
            length,
        })
    }

    /// The size of the pattern that a match speaks for.
    pub(super) fn amplitude(&self, at: usize) -> f64 {
        f64::from(self.values[at]) / self.length
    }

    /// Takes the pattern out at an index and `later` in (−½, ½) of a sample; gives the range that changed.
    pub(super) fn take_out(&mut self, at: usize, later: f64, amplitude: f64) -> (usize, usize) {
        let place = (later + 0.5) * real(STEPS);
        let nearest = whole(place).min(STEPS);
        let (a, off) = (narrow(amplitude), narrow(place - real(nearest)));
        let weights = [
            0.5 * a * off * (off - 1.0),
            a * (1.0 - off * off),
            0.5 * a * off * (off + 1.0),
        ];
        let skip = self.centre.saturating_sub(at);
        let from = at.saturating_sub(self.centre);
        let [before, own, after] = [0, 1, 2].map(|beside| &self.phases[nearest + beside][skip..]);
        let end = (from + own.len()).min(self.values.len());
        let values = self.values[from..end].iter_mut();
        for (((value, before), own), after) in values.zip(before).zip(own).zip(after) {
            *value -= weights[0] * before + weights[1] * own + weights[2] * after;
        }
        (from, end)
    }
}
