//! Medians and quantiles, for all that need them. What does not exist is `None`.

use crate::units::{real, whole};

/// The standard deviation of a normal distribution over its median absolute deviation, `1/Φ⁻¹(¾)`.
pub const MAD_TO_STD: f64 = 1.482_602_218_505_602;

/// The 0.975 quantile of the standard normal distribution, `Φ⁻¹(0.975)`: 95 % lie within as many standard deviations.
pub const NORMAL95: f64 = 1.959_963_984_540_054;

/// The middle value; the mean of the two in the middle of an even number.
#[must_use]
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let sorted = sorted(values);
    let upper = sorted.get(sorted.len() / 2)?;
    let lower = sorted.get((sorted.len() - 1) / 2)?;
    Some(0.5 * (lower + upper))
}

/// The middle value; the upper of the two in the middle of an even number, so that it is always one that occurs.
#[must_use]
pub fn upper_median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let sorted = sorted(values);
    sorted.get(sorted.len() / 2).copied()
}

/// The smallest value that at least this share of the values does not exceed.
#[must_use]
pub fn quantile(values: impl IntoIterator<Item = f64>, share: f64) -> Option<f64> {
    let sorted = sorted(values);
    let rank = whole((share * real(sorted.len())).ceil()).max(1);
    sorted.get(rank - 1).copied()
}

/// The values, ascending.
pub(crate) fn sorted(values: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let mut sorted: Vec<f64> = values.into_iter().collect();
    sorted.sort_by(f64::total_cmp);
    sorted
}

/// Where a function that grows between two ends passes a value, `is_below` saying on which side of it a place is: the range is
/// halved so often.
pub(crate) fn bisected(
    (mut low, mut high): (f64, f64),
    halvings: usize,
    is_below: impl Fn(f64) -> bool,
) -> f64 {
    for _ in 0..halvings {
        let middle = 0.5 * (low + high);
        if is_below(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_middle_of_an_even_number_is_between_two_or_the_upper_one() {
        assert_eq!(median([3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median([4.0, 1.0, 3.0, 2.0]), Some(2.5));
        assert_eq!(upper_median([3.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(upper_median([4.0, 1.0, 3.0, 2.0]), Some(3.0));
        assert_eq!(median([]), None);
        assert_eq!(upper_median([]), None);
    }

    #[test]
    fn constants_of_the_normal_distribution_are_its_quantiles() {
        use statrs::distribution::{ContinuousCDF, Normal};
        let normal = Normal::standard();
        assert!((normal.inverse_cdf(0.75) * MAD_TO_STD - 1.0).abs() < 1e-12);
        assert!((normal.inverse_cdf(0.975) - NORMAL95).abs() < 1e-12);
    }

    #[test]
    fn a_quantile_is_a_value_that_occurs() {
        let tenths = || (1..=10).map(f64::from);
        for (share, value) in [(0.0, 1.0), (0.1, 1.0), (0.11, 2.0), (0.9, 9.0), (1.0, 10.0)] {
            assert_eq!(quantile(tenths(), share), Some(value), "{share}");
        }
        assert_eq!(quantile([], 0.5), None);
    }
}
