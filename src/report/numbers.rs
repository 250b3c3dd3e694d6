//! Numbers to the digits that their errors leave.

use crate::fit::Estimate;

/// `0.9452 ± 0.0006 (95 %: 0.9440 to 0.9464)`, to the digits that the error leaves.
pub(crate) fn with_error(estimate: &Estimate) -> String {
    let (Some(std), Some([low, high])) = (estimate.std_error, estimate.interval95) else {
        return format!("{:.3} (no error: a single ratio)", estimate.value);
    };
    let digits = digits_for(std);
    let value = plus_minus(estimate.value, std);
    format!("{value} (95 %: {low:.digits$} to {high:.digits$})")
}

/// `0.9452 ± 0.0006`, to the digits that the error leaves.
pub(super) fn plus_minus(value: f64, std: f64) -> String {
    let digits = digits_for(std);
    format!("{value:.digits$} ± {std:.digits$}")
}

/// Decimals that show an error with two digits, one at least.
pub(super) fn digits_for(std: f64) -> usize {
    decimals(std).max(1)
}

/// Decimals that show a positive number with two digits, at most eight.
pub(crate) fn decimals(value: f64) -> usize {
    let mut scaled = value;
    // A value that rounds to 10 at this many decimals has its two digits.
    (0..8)
        .find(|_| {
            let enough = scaled >= 9.95;
            scaled *= 10.0;
            enough
        })
        .unwrap_or(8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_written_to_the_digits_that_their_error_leaves() {
        let estimate = Estimate {
            value: 0.945_231,
            std_error: Some(0.000_61),
            interval95: Some([0.944, 0.9465]),
        };
        assert_eq!(
            with_error(&estimate),
            "0.94523 ± 0.00061 (95 %: 0.94400 to 0.94650)"
        );
        assert!(with_error(&Estimate::bare(0.8)).starts_with("0.800 (no error"));
    }
}
