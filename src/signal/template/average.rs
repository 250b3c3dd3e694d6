//! Weighted sums of sounds, sample by sample.

use super::Sample;

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

/// `Σ w·x/a / Σ w` at each sample.
pub(super) fn weighted_mean(impacts: &[Sample], weights: &[Vec<f64>], mean: &mut [f64]) {
    mean.fill(0.0);
    for (s, weights) in impacts.iter().zip(weights) {
        let scale = 1.0 / s.amplitude;
        for ((m, w), x) in mean.iter_mut().zip(weights).zip(&s.sound) {
            *m += w * scale * x;
        }
    }
    for (m, w) in mean.iter_mut().zip(sums(weights)) {
        *m /= w;
    }
}

/// The components at each sample: up to three normal equations. Their sums grow sound by sound, over all samples, for
/// the machine's vectors.
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
            power *= s.slowness;
        }
    }
    for t in 0..length {
        let at = |of: &[Vec<f64>], k: usize| of.get(k).map_or(0.0, |values| values[t]);
        let moments = std::array::from_fn(|k| at(&moments, k));
        let mut values = std::array::from_fn(|k| at(&right, k));
        solve(&moments, &mut values, size);
        for (component, value) in components.iter_mut().zip(values) {
            component[t] = value;
        }
    }
}

/// Solves `Σ_c moments[r + c]·y_c = right_r` in place, by elimination; the matrix is positive definite.
pub(crate) fn solve(moments: &[f64; 5], right: &mut [f64; 3], size: usize) {
    let ridge = RIDGE * moments[0];
    let mut rows = [[0.0; 3]; 3];
    for (r, row) in rows.iter_mut().enumerate() {
        for (c, cell) in row.iter_mut().enumerate() {
            *cell = moments[r + c] + if r == c && r > 0 { ridge } else { 0.0 };
        }
    }
    for pivot in 0..size {
        for r in pivot + 1..size {
            let factor = rows[r][pivot] / rows[pivot][pivot];
            let above = rows[pivot];
            for (cell, above) in rows[r].iter_mut().zip(above) {
                *cell -= factor * above;
            }
            right[r] -= factor * right[pivot];
        }
    }
    for r in (0..size).rev() {
        let known: f64 = (r + 1..size).map(|c| rows[r][c] * right[c]).sum();
        right[r] = (right[r] - known) / rows[r][r];
    }
}
