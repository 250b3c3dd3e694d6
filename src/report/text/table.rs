//! The impacts of a drop as a table for a person, at most 80 columns wide.

use crate::report::{Impact, Status, decimals};

/// Two lines of heading, one with the units.
const HEADING: [&str; 2] = [
    "   #       time       ±  level   flight  ratio       e      ±  rebound",
    "            [s]    [µs]   [dB]     [ms]                [10⁻⁶]     [mm]",
];

/// The heading and a row for each impact. A value that does not exist is a dash; an impact that was simply heard has no remark.
pub(super) fn rows(impacts: &[Impact]) -> Vec<String> {
    let heading = HEADING.iter().map(|&line| line.to_owned());
    heading.chain(impacts.iter().enumerate().map(row)).collect()
}

fn row((index, impact): (usize, &Impact)) -> String {
    let bounce = &impact.bounce;
    let status = match impact.status {
        Status::Heard => "",
        status => status.word(),
    };
    let row = format!(
        "{:4} {:10.6}  {:>6} {:>6} {:>8} {:>6}  {:>6} {:>6} {:>8} {status}",
        index + 1,
        impact.time_s,
        two_digits(impact.time_std_s.map(|s| 1e6 * s)),
        fixed(impact.level_db, 1),
        fixed(impact.interval_s.map(|t| 1e3 * t), 3),
        fixed(impact.ratio, 4),
        fixed(bounce.restitution, 4),
        two_digits(bounce.restitution_std.map(|s| 1e6 * s)),
        fixed(impact.rebound_height_m.map(|h| 1e3 * h), 2),
    );
    row.trim_end().to_owned()
}

fn fixed(value: Option<f64>, decimals: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |v| format!("{v:.decimals$}"))
}

/// An error to two digits, or to the units where those are more.
fn two_digits(error: Option<f64>) -> String {
    fixed(error, error.map_or(0, decimals))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Bounce;

    #[test]
    fn an_error_has_two_digits_however_small() {
        for (error, shown) in [
            (0.0213, "0.021"),
            (0.0996, "0.10"),
            (0.96, "0.96"),
            (9.96, "10"),
            (2281.1, "2281"),
        ] {
            assert_eq!(two_digits(Some(error)), shown);
        }
        assert_eq!(two_digits(None), "-");
        assert_eq!(two_digits(Some(0.0)), "0.00000000");
    }

    #[test]
    fn the_widest_row_fits_a_terminal() {
        let impact = Impact {
            time_s: 3_599.123_456,
            time_std_s: Some(2_345e-6),
            level_db: Some(-100.0),
            interval_s: Some(1.234_567_8),
            ratio: Some(0.912_34),
            rebound_height_m: Some(1.868_12),
            rebound_height_std_m: Some(1e-3),
            bounce: Bounce {
                restitution: Some(0.923_45),
                restitution_std: Some(0.012_345),
                ..Bounce::default()
            },
            status: Status::Inferred,
        };
        let rows = rows(&[impact]);
        assert!(rows[2].ends_with("1868.12 inferred"), "{rows:?}");
        let widths = rows.iter().map(|row| row.chars().count());
        assert!(widths.max().unwrap() <= 80, "{rows:#?}");
    }
}
