//! How many independent samples what is left of a match is worth.

use crate::signal::correlate::Correlator;
use crate::signal::smooth::smoothed;
use crate::units::real;

/// The number of independent samples whose energy varies as that of a residual does: few where it is another sound, which is loud
/// for a while and rings.
///
/// # Formula
/// `(tr C)²/tr C²` for a covariance `C_tu = σ_t·σ_u·ρ(t − u)`: `(Σ σ²)²/Σ σ⁴` by the mean power σ² up to `reach` samples around
/// each, over `Σ ρ²`, by the powers P of the N lines of the spectrum `N·Σ P²/(Σ P)² − 1`, where the 1 is what powers scatter by if
/// samples are independent. Of a burst or a ring it is the duration times the bandwidth.
pub(super) fn independent_samples(
    correlator: &mut Correlator,
    residual: &[f64],
    reach: usize,
) -> f64 {
    let squares: Vec<f64> = residual.iter().map(|r| r * r).collect();
    let powers = smoothed(&squares, reach);
    let lines = correlator.powers(residual);
    let correlated = real(lines.len()) / participation(&lines) - 1.0;
    (participation(&powers) / correlated.max(1.0)).max(1.0)
}

/// `(Σ x)²/Σ x²`: how many of some values make up most of their sum.
fn participation(values: &[f64]) -> f64 {
    let (sum, squares) = values
        .iter()
        .fold((0.0, 0.0), |(s, q), x| (s + x, q + x * x));
    sum * sum / f64::max(squares, f64::MIN_POSITIVE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    #[test]
    fn noise_is_all_independent_and_a_ring_hardly() {
        let mut rng = SplitMix64::new(3);
        let mut count = |sound: &dyn Fn(f64, f64) -> f64| {
            let left: Vec<f64> = (0..600).map(|t| sound(real(t), rng.normal())).collect();
            independent_samples(&mut Correlator::default(), &left, 44)
        };
        let noise = count(&|_, noise| noise);
        assert!((400.0..=600.0).contains(&noise), "{noise}");
        let ring = |t: f64| 100.0 * (-t / 60.0).exp() * (0.3 * t).sin();
        let ring = count(&|t, noise| noise + ring(t));
        assert!((1.0..10.0).contains(&ring), "{ring}");
        assert_eq!(
            independent_samples(&mut Correlator::default(), &[0.0; 90], 9),
            1.0
        );
    }
}
