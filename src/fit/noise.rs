//! Two kinds of noise: each bounce scatters, and each time is uncertain.

use super::banded::{Banded, Factors};
use super::bounces::Bounces;

/// The covariance of ln e from bounce to bounce, before the noises' sizes are known.
///
/// # Formula
/// ```text
/// Σ = σ_e²·diag(w) + φ²·A·diag(s²)·Aᵀ + diag(f)
/// ```
/// A holds the derivatives of ln e by the times ([`Bounces::slopes`]), s are the stated standard errors of the times, φ is
/// near 1 and scales all of them, w is the variance inflation of a bounce: 1 but for an outlier, and f is 0 but for a bounce that is left out.
#[derive(Debug, Clone)]
pub(super) struct Noise {
    /// `A·diag(s²)·Aᵀ`.
    timing: Banded,
    /// w.
    pub variance_inflation: Vec<f64>,
    /// f, the variance of ln e of a bounce that is left out; 0 of others.
    left_out: Vec<f64>,
}

/// Variance of ln e of a bounce that is left out: so wide that it says nothing of e, nor of the scatter.
const LEFT_OUT_VARIANCE: f64 = 1.0;

/// Sizes of the noises.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sizes {
    /// `σ_e`.
    pub bounce: f64,
    /// φ.
    pub timing: f64,
}

impl Noise {
    /// From the squares of the times' standard errors, one more at each end than there are bounces.
    pub(super) fn new(
        bounces: &Bounces,
        time_variances: &[f64],
        variance_inflation: Vec<f64>,
    ) -> Self {
        let slopes = &bounces.slopes;
        let shared = |i: usize, step: usize| -> f64 {
            (step..3)
                .map(|k| slopes[i][k] * slopes[i + step][k - step] * time_variances[i + k])
                .sum()
        };
        let with = |i: usize, step: usize| i.checked_sub(step).map_or(0.0, |j| shared(j, step));
        let rows = (0..slopes.len()).map(|i| std::array::from_fn(|step| with(i, step)));
        Self {
            timing: Banded {
                rows: rows.collect(),
            },
            left_out: vec![0.0; variance_inflation.len()],
            variance_inflation,
        }
    }

    /// The same with no say for these bounces: the ball leaves each at any speed, and the law holds before and after.
    pub(super) fn leaving_out(mut self, bounces: &[usize]) -> Self {
        for &bounce in bounces {
            self.left_out[bounce] = LEFT_OUT_VARIANCE;
        }
        self
    }

    /// Rows of the timing part, w and f of each bounce.
    fn rows(&self) -> impl ExactSizeIterator<Item = (&[f64; 3], f64, f64)> {
        let rows = self.timing.rows.iter().zip(&self.variance_inflation);
        rows.zip(&self.left_out).map(|((row, w), f)| (row, *w, *f))
    }

    /// The share of the variance of each bounce that is its own and not that of the times.
    pub(super) fn own_shares(&self, sizes: Sizes) -> impl Iterator<Item = f64> + '_ {
        let (own, scale) = (sizes.bounce.powi(2), sizes.timing.powi(2));
        let rows = self.rows();
        rows.map(move |(row, w, f)| own * w / (own * w + scale * row[0] + f))
    }

    /// The factors of Σ; none where it is singular in the precision at hand.
    pub(super) fn factors(&self, sizes: Sizes) -> Option<Factors> {
        let (own, scale) = (sizes.bounce.powi(2), sizes.timing.powi(2));
        Factors::of(self.rows().map(|([main, first, second], w, f)| {
            [scale * main + own * w + f, scale * first, scale * second]
        }))
    }

    /// `aᵀ·A·diag(s²)·Aᵀ·a` and `aᵀ·diag(w)·a`: variances of a weighted sum of ln e by noises of unit size.
    pub(super) fn shares(&self, weights: &[f64]) -> (f64, f64) {
        let row = |(i, row): (usize, &[f64; 3])| -> f64 {
            // Elements beside the main diagonal stand on both sides of it.
            let beside =
                (1..=2).filter_map(|step| Some(2.0 * row[step] * weights[i.checked_sub(step)?]));
            weights[i] * (row[0] * weights[i] + beside.sum::<f64>())
        };
        let timing = self.timing.rows.iter().enumerate().map(row).sum();
        let own = weights
            .iter()
            .zip(&self.variance_inflation)
            .map(|(a, w)| a * a * w);
        (timing, own.sum())
    }
}
