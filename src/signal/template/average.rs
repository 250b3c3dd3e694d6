//! Weighted sums of sounds, sample by sample.

use super::Sample;
use crate::linalg::Cholesky;

/// Share of a weight matrix's trace that is added to its diagonal: where two impacts are alike in speed their
/// components cannot be told apart.
const RIDGE: f64 = 1e-6;

/// The sum of sequences of one length.
pub(crate) fn sums(of: &[Vec<f64>]) -> Vec<f64> {
    let mut sums = vec![0.0; of.first().map_or(0, Vec::len)];
    for values in of {
        for (sum, value) in sums.iter_mut().zip(values) {
            *sum += value;
        }
    }
    sums
}

/// The weights of sounds in their mean: the information of each on it.
pub(crate) fn weights(samples: &[Sample]) -> Vec<Vec<f64>> {
    samples.iter().map(Sample::information).collect()
}

/// Variance of the weighted mean of all sounds at each sample by white noise of variance 1 in each, `Σ w²/a² / (Σ w)²`.
/// Differences between impacts add to it, but as waves as long as their own.
pub(crate) fn mean_variances(samples: &[Sample], weights: &[Vec<f64>]) -> Vec<f64> {
    let all = sums(weights);
    let mut variances = vec![0.0; all.len()];
    for (sample, weights) in samples.iter().zip(weights) {
        let scale = sample.amplitude.powi(-2);
        for ((v, w), all) in variances.iter_mut().zip(weights).zip(&all) {
            *v += scale * (w / all).powi(2);
        }
    }
    variances
}

/// `Σ w·x/a / Σ w` at each sample, of sounds with their weights.
pub(super) fn weighted_mean<'a>(
    of: impl Iterator<Item = (&'a Sample, &'a Vec<f64>)>,
    mean: &mut [f64],
) {
    let mut all = vec![0.0; mean.len()];
    mean.fill(0.0);
    for (s, weights) in of {
        let scale = 1.0 / s.amplitude;
        let each = mean.iter_mut().zip(&mut all);
        for (((m, all), w), x) in each.zip(weights).zip(&s.sound) {
            *m += w * scale * x;
            *all += w;
        }
    }
    for (m, w) in mean.iter_mut().zip(all) {
        *m /= w;
    }
}

/// The means of every other sound, from the first on and from the second: what they have in common is no noise.
pub(super) fn half_means(samples: &[Sample], weights: &[Vec<f64>]) -> [Vec<f64>; 2] {
    let length = weights.first().map_or(0, Vec::len);
    [0, 1].map(|first| {
        let mut mean = vec![0.0; length];
        let every_other = samples.iter().zip(weights).skip(first).step_by(2);
        weighted_mean(every_other, &mut mean);
        mean
    })
}

/// The components at each sample, by up to three normal equations; 0 where nothing was recorded. The sums grow sound by
/// sound, over all samples, for the machine's vectors.
pub(super) fn weighted_fit(impacts: &[Sample], weights: &[Vec<f64>], components: &mut [Vec<f64>]) {
    let (size, length) = (components.len(), weights.first().map_or(0, Vec::len));
    let mut moments = vec![vec![0.0; length]; 2 * size - 1];
    let mut right = vec![vec![0.0; length]; size];
    for (s, weights) in impacts.iter().zip(weights) {
        let mut power = 1.0;
        for (k, moments) in moments.iter_mut().enumerate() {
            for (moment, w) in moments.iter_mut().zip(weights) {
                *moment += power * w;
            }
            let scale = power / s.amplitude;
            for (right, (w, x)) in right
                .iter_mut()
                .skip(k)
                .take(1)
                .flatten()
                .zip(weights.iter().zip(&s.sound))
            {
                *right += scale * w * x;
            }
            power *= s.contact_stretch;
        }
    }
    for t in 0..length {
        let at = |of: &[Vec<f64>], k: usize| of.get(k).map_or(0.0, |values| values[t]);
        let moments = std::array::from_fn(|k| at(&moments, k));
        let right = std::array::from_fn(|k| at(&right, k));
        let values = factors(&moments, size).map_or([0.0; 3], |factors| factors.solve(&right));
        for (component, value) in components.iter_mut().zip(values) {
            component[t] = value;
        }
    }
}

/// The factors of the matrix of the moments, `M_rc = moments[r + c]`, of `size` rows.
pub(crate) fn factors(moments: &[f64; 5], size: usize) -> Option<Cholesky<3>> {
    let mut matrix: [[f64; 3]; 3] =
        std::array::from_fn(|r| std::array::from_fn(|c| moments[r + c]));
    for (r, row) in matrix.iter_mut().enumerate().skip(1) {
        row[r] += RIDGE * moments[0];
    }
    Cholesky::of(&matrix, size)
}
