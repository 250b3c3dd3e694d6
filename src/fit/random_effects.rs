//! Random effects: the mean of many measurements, their spread beyond the errors that they claim, and outliers by robust
//! statistics.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::student;
use crate::statistics::{MAD_TO_STD, median};
use crate::units::real;

/// Share of batches without outliers in which one is named.
const FALSE_ALARMS: f64 = 0.05;

/// A measurement: a value and its standard error, above 0.
pub type Measurement = (f64, f64);

/// The random-effects mean of measurements, and their spread.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RandomEffects {
    /// Number of measurements.
    pub count: usize,
    /// Their mean, each weighted by its own error and what lies between them.
    pub mean: f64,
    /// Standard error of the mean.
    pub mean_std: f64,
    /// Standard deviation of the values.
    pub spread: f64,
    /// Root mean square of the errors that they claim: the spread by those alone.
    pub claimed: f64,
    /// Standard deviation between measurements beside the claimed errors.
    pub between: f64,
    /// Sum of the squares of their distances from the weighted mean over their errors.
    pub chi_square: f64,
    /// Probability of a greater χ² by chance, if the claimed errors are right.
    pub chance: f64,
    /// √(χ²/(N − 1)), the ratio of Birge: about 1 where they differ as much as they claim.
    pub birge: f64,
}

impl RandomEffects {
    /// Of two measurements or more.
    ///
    /// # Formula
    /// ```text
    /// w = 1/σ²,  m = Σwx/Σw,  χ² = Σw(x − m)²,  R = √(χ²/(N − 1))
    /// τ² = max(0, (χ² − N + 1)/(Σw − Σw²/Σw))          DerSimonian and Laird 1986
    /// v = 1/(σ² + τ²),  mean = Σvx/Σv ± 1/√Σv
    /// ```
    #[must_use]
    pub fn of(measurements: &[Measurement]) -> Option<Self> {
        let count = measurements.len();
        let free = real(count.checked_sub(1).filter(|&n| n > 0)?);
        let sum = |term: &dyn Fn(&Measurement) -> f64| measurements.iter().map(term).sum::<f64>();
        let total = sum(&|(_, s)| s.powi(-2));
        let middle = sum(&|(x, s)| x * s.powi(-2)) / total;
        let chi_square = sum(&|(x, s)| ((x - middle) / s).powi(2));
        let excess = (chi_square - free) / (total - sum(&|(_, s)| s.powi(-4)) / total);
        let variance = excess.max(0.0);
        let weight = |s: &f64| 1.0 / (s * s + variance);
        let weights = sum(&|(_, s)| weight(s));
        let plain = sum(&|(x, _)| *x) / real(count);
        Some(Self {
            count,
            mean: sum(&|(x, s)| x * weight(s)) / weights,
            mean_std: weights.sqrt().recip(),
            spread: (sum(&|(x, _)| (x - plain).powi(2)) / free).sqrt(),
            claimed: (sum(&|(_, s)| s * s) / real(count)).sqrt(),
            between: variance.sqrt(),
            chi_square,
            chance: ChiSquared::new(free).map_or(f64::NAN, |d| d.sf(chi_square)),
            birge: (chi_square / free).sqrt(),
        })
    }
}

/// An outlier: the number of the measurement, and its distance from the median over the spread to be expected.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OutlyingMeasurement {
    /// Its place among the measurements, from 0.
    pub index: usize,
    /// The distance, in standard deviations, above 0 where the value is the greater.
    pub distance: f64,
}

/// The measurements that are too far from the rest for their own error and the spread of the others.
///
/// Median and median deviation are robust against the outliers themselves, so that several do not mask each other.
///
/// # Formula
/// ```text
/// m = median x,  s = 1.4826·median |x − m|,  b² = max(0, s² − median σ²)
/// |x − m|/√(σ² + b²) > t,  t the quantile 1 − 0.025/N of Student's distribution with (N − 1)/2 degrees of freedom
/// ```
/// as s is no more exact than the standard deviation of a third of the measurements. At most one batch in 20 without outliers
/// has one named; among three measurements hardly anything is an outlier.
#[must_use]
pub fn outliers(measurements: &[Measurement]) -> Vec<OutlyingMeasurement> {
    let count = real(measurements.len());
    let (Some(middle), Some(variance)) = (
        median(measurements.iter().map(|(x, _)| *x)),
        median(measurements.iter().map(|(_, s)| s * s)),
    ) else {
        return Vec::new();
    };
    let deviation = median(measurements.iter().map(|(x, _)| (x - middle).abs())).unwrap_or(0.0);
    let between = ((MAD_TO_STD * deviation).powi(2) - variance).max(0.0);
    let far = student(
        1.0 - 0.5 * FALSE_ALARMS / count,
        (0.5 * (count - 1.0)).max(0.5),
    );
    let distances = measurements
        .iter()
        .map(|(x, s)| (x - middle) / (s * s + between).sqrt());
    let named = distances
        .enumerate()
        .filter(|(_, distance)| distance.abs() > far);
    named
        .map(|(index, distance)| OutlyingMeasurement { index, distance })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    /// Measurements of 0.9 with an error of 0.001, and a spread between them.
    fn made(count: usize, between: f64, seed: u64) -> Vec<Measurement> {
        let mut rng = SplitMix64::new(seed);
        let mut one = || (0.9 + between.hypot(1e-3) * rng.normal(), 1e-3);
        (0..count).map(|_| one()).collect()
    }

    #[test]
    fn a_small_case_is_as_by_hand() {
        // Weights 1 and 1/4: m = 0.4, χ² = 0.16 + 2.56/4 = 0.8 for one degree of freedom, and τ = 0.
        let pooled = RandomEffects::of(&[(0.0, 1.0), (2.0, 2.0)]).unwrap();
        assert!((pooled.mean - 0.4).abs() < 1e-12, "{pooled:?}");
        assert!((pooled.mean_std - 1.25_f64.sqrt().recip()).abs() < 1e-12);
        assert!((pooled.chi_square - 0.8).abs() < 1e-12);
        assert!((pooled.chance - 0.3711).abs() < 1e-4);
        assert!((pooled.spread - 2.0_f64.sqrt()).abs() < 1e-12);
        assert!((pooled.claimed - 2.5_f64.sqrt()).abs() < 1e-12);
        assert_eq!(pooled.between, 0.0);
    }

    #[test]
    fn one_measurement_has_no_spread() {
        assert_eq!(RandomEffects::of(&[(0.9, 0.1)]), None);
        assert_eq!(RandomEffects::of(&[]), None);
        assert!(outliers(&[(0.9, 0.1)]).is_empty() && outliers(&[]).is_empty());
    }

    #[test]
    fn a_spread_beyond_the_errors_is_seen_and_measured() {
        let honest = RandomEffects::of(&made(400, 0.0, 1)).unwrap();
        assert!((honest.birge - 1.0).abs() < 0.1 && honest.chance > 0.01);
        let wide = RandomEffects::of(&made(400, 4e-3, 1)).unwrap();
        assert!(wide.birge > 3.5 && wide.chance < 1e-9);
        assert!((wide.between - 4e-3).abs() < 5e-4, "{wide:?}");
        // The error of the mean is that of the spread, not the one claimed.
        assert!((wide.mean_std - wide.spread / 20.0).abs() < 0.05 * wide.mean_std);
    }

    #[test]
    fn two_outliers_do_not_hide_each_other() {
        let mut measurements = made(10, 1e-3, 3);
        measurements[2].0 = 0.95;
        measurements[7].0 = 0.952;
        let named: Vec<usize> = outliers(&measurements).iter().map(|o| o.index).collect();
        assert_eq!(named, [2, 7]);
        // A measurement with a large error is not far away.
        measurements[7].1 = 0.05;
        assert_eq!(outliers(&measurements).len(), 1);
    }

    #[test]
    fn outliers_are_seldom_named_where_there_are_none() {
        for (count, between) in [(4, 5e-3), (8, 5e-3), (30, 5e-3), (30, 0.0)] {
            let alarms = (0..400).filter(|&seed| !outliers(&made(count, between, seed)).is_empty());
            let alarms = alarms.count();
            assert!(alarms <= 28, "{alarms} of 400 with {count}");
        }
    }
}
