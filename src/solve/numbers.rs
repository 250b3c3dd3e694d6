//! Numbers for people: as many digits as they are worth, with their error if they have one.

/// A value to four significant digits.
pub(super) fn plain(value: f64) -> String {
    significant(value, 4)
}

/// A coefficient of restitution: five decimals, or three digits of `1 − e` where the ball is livelier than that.
pub(super) fn restitution(value: f64) -> String {
    let decimals = match 1.0 - value {
        loss if loss > 0.0 => usize::try_from(2 - power_of_ten(loss))
            .unwrap_or(0)
            .clamp(5, 16),
        _ => 5,
    };
    if value < 0.01 {
        plain(value)
    } else {
        format!("{value:.decimals$}")
    }
}

/// A change as a percentage of what it started from: `23 % less`.
pub(super) fn change(from: f64, to: f64) -> String {
    let percent = 100.0 * (to / from - 1.0);
    let word = if percent < 0.0 { "less" } else { "more" };
    let percent = percent.abs();
    let decimals = usize::from(percent < 1.0) * 2;
    format!("{percent:.decimals$} % {word}")
}

/// A number of bounces, in words.
pub(super) fn bounces(count: usize) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} bounce{plural}")
}

/// By how much something is magnified: `70-fold`.
pub(super) fn fold(factor: f64) -> String {
    let decimals = usize::from(factor < 10.0);
    format!("{factor:.decimals$}-fold")
}

/// A time in s, ms or µs.
pub(super) fn time(seconds: f64) -> String {
    match seconds {
        s if s >= 1.0 => format!("{} s", short(s)),
        s if s >= 1e-3 => format!("{} ms", short(1e3 * s)),
        s => format!("{} µs", short(1e6 * s)),
    }
}

/// A value to four significant digits, without the zeros at its end.
pub(super) fn short(value: f64) -> String {
    let digits = plain(value);
    if digits.contains('.') && !digits.contains('e') {
        let trimmed = digits.trim_end_matches('0').trim_end_matches('.');
        trimmed.to_owned()
    } else {
        digits
    }
}

/// A value to some significant digits; with a power of ten where it is very large or very small.
fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let power = power_of_ten(value);
    if (-3..5).contains(&power) {
        let decimals = usize::try_from(digits - 1 - power).unwrap_or(0);
        format!("{value:.decimals$}")
    } else {
        let decimals = usize::try_from(digits - 1).unwrap_or(0);
        format!("{value:.decimals$e}")
    }
}

/// A smaller relative error than this would not show in four digits: it is that of an exact number.
const LEAST_ERROR: f64 = 1e-5;

/// `0.93347 ± 0.00044`, `(4.93 ± 0.26)e5`: an error has two digits, and the value as many as the error leaves.
pub(super) fn with_error(value: f64, error: Option<f64>) -> String {
    let Some(error) = error.filter(|&error| error > LEAST_ERROR * value.abs()) else {
        return plain(value);
    };
    let power = power_of_ten(value);
    let scale = if (-3..5).contains(&power) { 0 } else { power };
    let unit = 10_f64.powi(scale);
    let decimals = usize::try_from(1 - power_of_ten(error / unit)).unwrap_or(0);
    let digits = format!("{:.decimals$} ± {:.decimals$}", value / unit, error / unit);
    if scale == 0 {
        digits
    } else {
        format!("({digits})e{scale}")
    }
}

/// The exponent in scientific notation, as the number is printed: 9.9999 to four digits is 10.00.
#[expect(
    clippy::cast_possible_truncation,
    reason = "exponents of f64 lie within ±324"
)]
fn power_of_ten(value: f64) -> i32 {
    let power = value.abs().log10();
    (power + 1e-12).floor() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_digits_whatever_the_size() {
        for (value, text) in [
            (0.023_091, "0.02309"),
            (4.4738, "4.474"),
            (924.24, "924.2"),
            (98_750.0, "98750"),
            (9.8751e6, "9.875e6"),
            (1.0, "1.000"),
            (1000.0, "1000"),
            (3.2e-7, "3.200e-7"),
            (0.0, "0"),
        ] {
            assert_eq!(plain(value), text);
        }
    }

    #[test]
    fn a_value_has_the_digits_that_its_error_leaves() {
        for (value, error, text) in [
            (0.933_47, Some(0.000_44), "0.93347 ± 0.00044"),
            (4.474, Some(0.151), "4.47 ± 0.15"),
            (4.933e5, Some(2.6e4), "(4.93 ± 0.26)e5"),
            (42.69, Some(12.3), "43 ± 12"),
            (42.69, Some(0.0), "42.69"),
            (42.69, None, "42.69"),
        ] {
            assert_eq!(with_error(value, error), text);
        }
    }
}
