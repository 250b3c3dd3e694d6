//! The first template: the mean of aligned impacts.

use super::Template;
use crate::signal::smooth::smoothed;
use crate::units::{real, samples_in};

/// Energy is judged over this time either way, in seconds.
const ENERGY_S: f64 = 4e-3;

/// The sound of one impact, cut where it is aligned with others.
#[derive(Debug, Clone)]
pub(crate) struct Cut {
    /// Size in units of the template.
    pub amplitude: f64,
    /// All of one length.
    pub sound: Vec<f64>,
}

/// The sum of the squares of the amplitudes.
fn power(impacts: &[Cut]) -> f64 {
    impacts.iter().map(|i| i.amplitude * i.amplitude).sum()
}

/// The mean sound for an amplitude of 1, each impact by its size: `Σ aᵢ·xᵢ / Σ aᵢ²`.
pub(crate) fn mean(impacts: &[Cut]) -> Vec<f64> {
    let mut mean = vec![0.0; impacts.first().map_or(0, |i| i.sound.len())];
    for impact in impacts {
        for (m, x) in mean.iter_mut().zip(&impact.sound) {
            *m += impact.amplitude * x;
        }
    }
    let power = power(impacts);
    mean.iter_mut().for_each(|m| *m /= power);
    mean
}

/// The variance of the residuals of two or more impacts at each sample: `Σ (xᵢ − aᵢ·s)² / (n − 1)`.
fn left_over(impacts: &[Cut], mean: &[f64]) -> Vec<f64> {
    let mut left = vec![0.0; mean.len()];
    for impact in impacts {
        for ((l, x), s) in left.iter_mut().zip(&impact.sound).zip(mean) {
            *l += (x - impact.amplitude * s).powi(2) / real(impacts.len() - 1);
        }
    }
    left
}

impl Template {
    /// The mean of impacts that sound alone, each from `before` samples before its onset on, as far as it stands out of the
    /// noise; none where it does not, and of fewer than two.
    pub(crate) fn of_aligned(impacts: &[Cut], before: usize, rate: f64) -> Option<Self> {
        if impacts.len() < 2 {
            return None;
        }
        let mut shape = mean(impacts);
        let power = power(impacts);
        let reach = samples_in(ENERGY_S, rate);
        let noise = smoothed(&left_over(impacts, &shape), reach);
        let squares: Vec<f64> = shape.iter().map(|s| s * s).collect();
        // The mean of pure noise has the power of the residuals over that of all impacts. A mean of n squares scatters by
        // √(2/n); four times that is a sound.
        let loud = 1.0 + 4.0 * (1.0 / real(reach)).sqrt();
        let last = smoothed(&squares, reach)
            .iter()
            .zip(&noise)
            .rposition(|(e, n)| e * power > loud * n)?;
        shape.truncate(last + reach);
        let noise = noise[..shape.len()].iter().map(|n| n / power).collect();
        Some(Self::new(shape, noise, before))
    }
}
