//! Checks of numbers that come in: each failure names the argument and the range that is accepted.

use crate::Error;

/// Smallest and largest quantity accepted, in SI units.
///
/// Far beyond any ball, and far enough from the ends of `f64` that no product in this module overflows.
const RANGE: std::ops::RangeInclusive<f64> = 1e-60..=1e60;

/// A quantity that must be positive: mass, height, speed, gravity.
pub(super) fn positive(argument: &'static str, value: f64) -> Result<f64, Error> {
    if RANGE.contains(&value) {
        Ok(value)
    } else {
        Err(Error::argument(
            argument,
            value,
            "a number > 0 (1e-60 to 1e60)",
        ))
    }
}

/// A quantity that may also be zero: damping, contact time, standard errors.
pub(super) fn non_negative(argument: &'static str, value: f64) -> Result<f64, Error> {
    if value == 0.0 || RANGE.contains(&value) {
        Ok(value)
    } else {
        Err(Error::argument(
            argument,
            value,
            "a number ≥ 0 (0 or 1e-60 to 1e60)",
        ))
    }
}

/// A number of bounces, as a real number.
pub(super) fn bounces(argument: &'static str, count: usize) -> Result<f64, Error> {
    let count = crate::units::real(count);
    if count >= 1.0 {
        Ok(count)
    } else {
        Err(Error::argument(argument, count, "a whole number ≥ 1"))
    }
}
