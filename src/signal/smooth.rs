//! Running means.

use crate::units::real;

/// Running mean over `2·reach + 1` values; the first and the last go on beyond the ends.
pub(crate) fn smoothed(values: &[f64], reach: usize) -> Vec<f64> {
    let Some(last) = values.len().checked_sub(1) else {
        return Vec::new();
    };
    let at = |k: usize| values[k.saturating_sub(reach).min(last)];
    let mut sum: f64 = (0..=2 * reach).map(at).sum();
    let scale = 1.0 / real(2 * reach + 1);
    let mut out = Vec::with_capacity(values.len());
    for k in 0..values.len() {
        out.push((scale * sum).max(0.0));
        sum += at(k + 2 * reach + 1) - at(k);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_running_mean_is_that_of_the_definition() {
        let values: Vec<f64> = (0..40).map(|i| real(i * i % 17)).collect();
        for (k, mean) in smoothed(&values, 3).iter().enumerate() {
            let near = (0..7).map(|j| values[(k + j).saturating_sub(3).min(39)]);
            assert!((mean - near.sum::<f64>() / 7.0).abs() < 1e-12, "value {k}");
        }
    }
}
