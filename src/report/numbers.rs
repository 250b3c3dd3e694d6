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

/// `0.9452 ± 0.0006`, to the digits that a person needs: see [`short_decimals`].
pub(crate) fn short(value: f64, std: f64) -> String {
    let digits = short_decimals(std);
    format!("{value:.digits$} ± {std:.digits$}")
}

/// Decimals that show an error with two digits where they are 35 or less, and else with one: the convention of the
/// Particle Data Group, by which no error is rounded by more than a sixth.
pub(crate) fn short_decimals(std: f64) -> usize {
    let two = decimals(std);
    let scaled = (0..two).fold(std, |scaled, _| 10.0 * scaled);
    if scaled < 35.5 {
        two
    } else {
        two.saturating_sub(1)
    }
}

/// A span of time to a tenth of a second, and below one second to a hundredth.
pub(super) fn seconds(span_s: f64) -> String {
    let digits = if span_s < 0.995 { 2 } else { 1 };
    format!("{span_s:.digits$} s")
}

/// `1 bounce`, `2 bounces`.
pub(crate) fn counted(count: usize, one: &str) -> String {
    format!("{count} {one}{}", if count == 1 { "" } else { "s" })
}

/// `2`, `2 and 3`, `2, 3 and 5`.
pub(crate) fn listed(numbers: &[usize]) -> String {
    let words: Vec<String> = numbers.iter().map(ToString::to_string).collect();
    match words.as_slice() {
        [most @ .., last] if !most.is_empty() => format!("{} and {last}", most.join(", ")),
        words => words.concat(),
    }
}

/// Evidence in nats as odds to 1, of which nobody needs more than two digits.
pub(super) fn odds(nats: f64) -> String {
    let odds = nats.exp();
    match odds {
        _ if odds >= 1e9 => "over a billion to 1".to_owned(),
        _ if odds >= 1e6 => format!("{:.0} million to 1", two_digits(1e-6 * odds)),
        _ if odds >= 1e3 => format!(
            "{:.0},{:03.0} to 1",
            (two_digits(odds) / 1e3).floor(),
            two_digits(odds) % 1e3
        ),
        _ if odds >= 10.0 => format!("{:.0} to 1", two_digits(odds)),
        _ => format!("{odds:.1} to 1"),
    }
}

fn two_digits(x: f64) -> f64 {
    let unit = 10.0_f64.powf(x.log10().floor() - 1.0).max(1.0);
    (x / unit).round() * unit
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
    fn an_error_has_one_digit_unless_that_would_round_it_much() {
        for (std, shown) in [
            (0.000_70, "0.9295 ± 0.0007"),
            (0.000_97, "0.9295 ± 0.0010"),
            (0.001_24, "0.9295 ± 0.0012"),
            (0.003_54, "0.9295 ± 0.0035"),
            (0.003_56, "0.930 ± 0.004"),
            (0.082, "0.93 ± 0.08"),
        ] {
            assert_eq!(short(0.929_512, std), shown);
        }
        assert_eq!(short(305.2, 47.0), "305 ± 47");
    }

    #[test]
    fn evidence_is_told_as_odds() {
        for (nats, told) in [
            (1.0, "2.7 to 1"),
            (3.0, "20 to 1"),
            (6.0, "400 to 1"),
            (8.1, "3,300 to 1"),
            (11.5, "99,000 to 1"),
            (13.0, "440,000 to 1"),
            (16.0, "9 million to 1"),
            (40.0, "over a billion to 1"),
        ] {
            assert_eq!(odds(nats), told, "{nats}");
        }
    }

    #[test]
    fn numbers_are_listed_as_a_person_does() {
        for (numbers, told) in [
            (&[2][..], "2"),
            (&[2, 3], "2 and 3"),
            (&[2, 3, 5], "2, 3 and 5"),
        ] {
            assert_eq!(listed(numbers), told);
        }
    }

    #[test]
    fn spans_and_counts_are_said_as_a_person_does() {
        assert_eq!(
            (seconds(0.94), seconds(0.999)),
            ("0.94 s".into(), "1.0 s".into())
        );
        assert_eq!(counted(1, "bounce"), "1 bounce");
        assert_eq!(counted(0, "bounce"), "0 bounces");
    }

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
