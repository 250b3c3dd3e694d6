//! Counts as numbers, spans in seconds as counts of samples, and quantities with units as a person writes them.
//!
//! Times of a recording become samples of a stretch in [`Sound`](crate::signal::sound::Sound).

use crate::Error;

/// A count as a real number.
///
/// Counts here are samples, impacts and files: far below 2⁵³, so nothing is rounded.
#[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
#[must_use]
pub const fn real(count: usize) -> f64 {
    count as f64
}

/// The single-precision number nearest to a double: 24 bits are enough for energies, evidence and matches.
#[expect(clippy::cast_possible_truncation, reason = "as is said above")]
#[must_use]
pub const fn narrow(x: f64) -> f32 {
    x as f32
}

/// The whole number nearest to a real one, halves away from zero: below 0 it is 0, beyond what a count holds the greatest
/// count, and 0 for NaN.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "`as` saturates, as is said above"
)]
#[must_use]
pub fn whole(x: f64) -> usize {
    x.round() as usize
}

/// Number of whole samples in a span, rounded to nearest; a negative span or NaN is empty.
#[must_use]
pub fn samples_in(span_s: f64, sample_rate_hz: f64) -> usize {
    whole(span_s * sample_rate_hz)
}

/// The frame of a stream that is nearest to a time in seconds from its start; 0 for earlier times and NaN.
///
/// Frames of a stream are counted in 64 bits: 32 end after a day at 48 kHz, and a length in memory may have no more.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "`as` saturates, as is said above"
)]
#[must_use]
pub fn frame_at(time_s: f64, sample_rate_hz: f64) -> u64 {
    (time_s * sample_rate_hz).round() as u64
}

/// The time of a frame of a stream, in seconds from its start.
#[expect(clippy::cast_precision_loss, reason = "counts stay far below 2^53")]
#[must_use]
pub const fn frame_time_s(frame: u64, sample_rate_hz: f64) -> f64 {
    frame as f64 / sample_rate_hz
}

/// The frames of a stream that stand in a buffer of this length.
#[must_use]
pub const fn frames(length: usize) -> u64 {
    length as u64
}

/// The length of a buffer for frames of a stream; the greatest there is, where it would be longer.
#[must_use]
pub fn length(frames: u64) -> usize {
    usize::try_from(frames).unwrap_or(usize::MAX)
}

/// What a number with a unit measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Metres: `m`, `cm`, `mm`, `in`, `ft`.
    Length,
    /// Kilograms: `kg`, `g`, `mg`, `oz`, `lb`.
    Mass,
    /// Seconds: `s`, `ms`, `us`, `µs`, `min`.
    Time,
    /// Metres per second squared: `m/s2`, `m/s^2`, `m/s²`.
    Acceleration,
}

impl Quantity {
    /// Units and their size in SI, longest suffix first where one ends with another.
    const fn units(self) -> &'static [(&'static str, f64)] {
        match self {
            Self::Length => &[
                ("mm", 1e-3),
                ("cm", 1e-2),
                ("in", 0.0254),
                ("ft", 0.3048),
                ("m", 1.0),
            ],
            Self::Mass => &[
                ("mg", 1e-6),
                ("kg", 1.0),
                ("oz", 0.028_349_523_125),
                ("lb", 0.453_592_37),
                ("g", 1e-3),
            ],
            Self::Time => &[
                ("ms", 1e-3),
                ("us", 1e-6),
                ("µs", 1e-6),
                ("μs", 1e-6),
                ("min", 60.0),
                ("s", 1.0),
            ],
            Self::Acceleration => &[("m/s^2", 1.0), ("m/s2", 1.0), ("m/s²", 1.0)],
        }
    }

    const fn expected(self) -> &'static str {
        match self {
            Self::Length => "a length such as 30.5cm, 12in or 0.305 (in m)",
            Self::Mass => "a mass such as 2.5g, 0.1oz or 0.0025 (in kg)",
            Self::Time => "a time such as 1ms, 7.5s or 7.5 (in s)",
            Self::Acceleration => "an acceleration such as 9.81 or 9.81m/s2",
        }
    }

    /// Reads a number with an optional unit, as in `30.5cm`, and gives it in SI. A bare number is SI already.
    ///
    /// # Errors
    /// [`Error::Argument`] naming `argument` if the text is no finite number with a unit of this quantity.
    pub fn parse(self, argument: &'static str, text: &str) -> Result<f64, Error> {
        let trimmed = text.trim();
        let (number, scale) = self
            .units()
            .iter()
            .find_map(|&(unit, scale)| Some((trimmed.strip_suffix(unit)?.trim_end(), scale)))
            .unwrap_or((trimmed, 1.0));
        match number.parse::<f64>() {
            Ok(value) if (value * scale).is_finite() => Ok(value * scale),
            _ => Err(Error::Argument {
                argument,
                got: format!("'{text}'"),
                expected: if number.contains(',') && number.replace(',', ".").parse::<f64>().is_ok()
                {
                    "a decimal point and no comma, such as 30.5"
                } else {
                    self.expected()
                },
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_are_the_nearest_and_end_where_counts_do() {
        for (x, count) in [
            (2.4, 2),
            (2.5, 3),
            (-0.4, 0),
            (-7.0, 0),
            (f64::NAN, 0),
            (1e30, usize::MAX),
        ] {
            assert_eq!(whole(x), count, "{x}");
        }
    }

    #[test]
    fn frames_of_a_stream_are_counted_beyond_32_bits() {
        let day_s = 86_400.0 * 1.25;
        assert_eq!(frame_at(day_s, 48_000.0), 5_184_000_000);
        assert_eq!(frame_time_s(5_184_000_000, 48_000.0), day_s);
        assert_eq!(
            (frame_at(-1.0, 48_000.0), frame_at(1e30, 48_000.0)),
            (0, u64::MAX)
        );
        assert_eq!(length(frames(7)), 7);
    }

    #[test]
    fn numbers_with_units_become_si() {
        for (quantity, text, si) in [
            (Quantity::Length, "30.5cm", 0.305),
            (Quantity::Length, "12in", 0.3048),
            (Quantity::Length, " 0.3 m ", 0.3),
            (Quantity::Length, "0.305", 0.305),
            (Quantity::Mass, "2.5g", 0.0025),
            (Quantity::Mass, "1 kg", 1.0),
            (Quantity::Time, "1ms", 0.001),
            (Quantity::Time, "250µs", 0.000_25),
            (Quantity::Time, "2min", 120.0),
            (Quantity::Acceleration, "9.81m/s2", 9.81),
        ] {
            let got = quantity.parse("x", text).unwrap();
            assert!((got - si).abs() <= 1e-15 * si, "{text}: {got}");
        }
    }

    #[test]
    fn a_decimal_comma_is_told_to_be_one() {
        let said = |text| {
            Quantity::Length
                .parse("height", text)
                .unwrap_err()
                .to_string()
        };
        assert!(said("1,5m").contains("a decimal point and no comma"));
        for text in ["1e400", "inf", "3,0,5cm", "cm"] {
            assert!(said(text).contains("a length such as"), "{}", said(text));
        }
    }

    #[test]
    fn what_is_no_quantity_is_refused_by_name() {
        for text in [
            "", "cm", "30.5kg", "nan", "inf", "1e400", "1,5,0m", "--", "3 0cm",
        ] {
            let error = Quantity::Length
                .parse("--height", text)
                .unwrap_err()
                .to_string();
            assert!(
                error.contains("--height") && error.contains("30.5cm"),
                "{text}: {error}"
            );
        }
    }
}
