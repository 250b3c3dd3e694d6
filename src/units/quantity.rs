//! Quantities with units as a person writes them.

use crate::Error;

/// What a number with a unit measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Metres: `m`, `cm`, `mm`, `in`, `ft`, and their names in full.
    Length,
    /// Kilograms: `kg`, `g`, `mg`, `oz`, `lb`, and their names in full.
    Mass,
    /// Seconds: `s`, `ms`, `us`, `µs`, `min`, and `1:30` for minutes and seconds.
    Time,
    /// Metres per second squared: `m/s2`, `m/s^2`, `m/s²`.
    Acceleration,
    /// A share: `0.93` or `93%`.
    Share,
}

/// A unit by its names: `whole·10^power` in SI. Both are exact, so that `45.9g` is 0.0459 kg and not a neighbour of it.
struct Unit {
    names: &'static [&'static str],
    whole: f64,
    power: i32,
}

const fn unit(names: &'static [&'static str], whole: f64, power: i32) -> Unit {
    Unit {
        names,
        whole,
        power,
    }
}

const LENGTHS: [Unit; 5] = [
    unit(
        &[
            "mm",
            "millimetre",
            "millimetres",
            "millimeter",
            "millimeters",
        ],
        1.0,
        -3,
    ),
    unit(
        &[
            "cm",
            "centimetre",
            "centimetres",
            "centimeter",
            "centimeters",
        ],
        1.0,
        -2,
    ),
    unit(&["m", "metre", "metres", "meter", "meters"], 1.0, 0),
    unit(&["in", "inch", "inches", "\"", "″"], 254.0, -4),
    unit(&["ft", "foot", "feet", "'", "′"], 3_048.0, -4),
];
const MASSES: [Unit; 5] = [
    unit(&["mg", "milligram", "milligrams"], 1.0, -6),
    unit(&["g", "gram", "grams", "gramme", "grammes"], 1.0, -3),
    unit(&["kg", "kilogram", "kilograms"], 1.0, 0),
    unit(&["oz", "ounce", "ounces"], 28_349_523_125.0, -12),
    unit(&["lb", "lbs", "pound", "pounds"], 45_359_237.0, -8),
];
const TIMES: [Unit; 4] = [
    unit(&["us", "µs", "μs", "microsecond", "microseconds"], 1.0, -6),
    unit(&["ms", "millisecond", "milliseconds"], 1.0, -3),
    unit(&["s", "sec", "second", "seconds"], 1.0, 0),
    unit(&["min", "minute", "minutes"], 60.0, 0),
];
const ACCELERATIONS: [Unit; 1] = [unit(&["m/s^2", "m/s2", "m/s²"], 1.0, 0)];
const SHARES: [Unit; 1] = [unit(&["%", "percent"], 1.0, -2)];

impl Quantity {
    const fn units(self) -> &'static [Unit] {
        match self {
            Self::Length => &LENGTHS,
            Self::Mass => &MASSES,
            Self::Time => &TIMES,
            Self::Acceleration => &ACCELERATIONS,
            Self::Share => &SHARES,
        }
    }

    const fn expected(self) -> &'static str {
        match self {
            Self::Length => "a length such as 30.5cm, 12in or 0.305 (in m)",
            Self::Mass => "a mass such as 2.5g, 0.1oz or 0.0025 (in kg)",
            Self::Time => "a time such as 1ms, 7.5s, 1:30 or 7.5 (in s)",
            Self::Acceleration => "an acceleration such as 9.81 or 9.81m/s2",
            Self::Share => "a share such as 0.93 or 93%",
        }
    }

    /// Reads a number with an optional unit, as in `30.5cm`, and gives it in SI. A bare number is SI already.
    ///
    /// # Errors
    /// [`Error::Argument`] naming `argument` if the text is no finite number with a unit of this quantity.
    pub fn parse(self, argument: &'static str, text: &str) -> Result<f64, Error> {
        let (number, unit) = self.split(text.trim());
        let value = match unit {
            None if self == Self::Time && number.contains(':') => clock(number),
            None => number.parse().ok(),
            Some(unit) => scaled(number, unit),
        };
        value.filter(|v: &f64| v.is_finite()).ok_or_else(|| {
            let comma = number.contains(',') && number.replace(',', ".").parse::<f64>().is_ok();
            Error::Argument {
                argument,
                got: format!("'{text}'"),
                expected: if comma {
                    "a decimal point and no comma, such as 30.5 with its unit"
                } else {
                    self.expected()
                },
            }
        })
    }

    /// The number, and the unit behind it by the longest of its names that fits.
    fn split(self, text: &str) -> (&str, Option<&'static Unit>) {
        let named = self.units().iter().flat_map(|unit| {
            let ends = unit.names.iter().filter(|name| text.ends_with(**name));
            ends.map(move |name| (name.len(), unit))
        });
        match named.max_by_key(|(length, _)| *length) {
            Some((length, unit)) => (text[..text.len() - length].trim_end(), Some(unit)),
            None => (text, None),
        }
    }
}

/// The number in SI. Where the unit is a power of ten its decimals move and nothing is rounded but once.
fn scaled(number: &str, unit: &Unit) -> Option<f64> {
    let value: f64 = number.parse().ok()?;
    let decimal = !number.contains(['e', 'E']) && value.is_finite();
    if decimal && unit.whole.total_cmp(&1.0).is_eq() {
        return format!("{number}e{}", unit.power).parse().ok();
    }
    Some(value * unit.whole / 10.0_f64.powi(-unit.power))
}

/// `1:30` or `00:01:30.5` in seconds.
fn clock(text: &str) -> Option<f64> {
    let parts: Vec<&str> = text.split(':').collect();
    let (last, whole) = parts.split_last()?;
    let digits = |part: &str| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit());
    if whole.len() > 2 || !last.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let seconds: f64 = last.parse().ok().filter(|s| *s < 60.0)?;
    whole
        .iter()
        .try_fold(0.0, |sum, part| {
            let count: f64 = part.parse().ok().filter(|_| digits(part))?;
            Some(60.0 * sum + count)
        })
        .map(|minutes| 60.0 * minutes + seconds)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_exact_and_have_names_in_full() {
        for (quantity, text, si) in [
            (Quantity::Mass, "45.9g", 0.0459),
            (Quantity::Mass, "45.93 grams", 0.045_93),
            (Quantity::Length, "12 inches", 0.3048),
            (Quantity::Length, "12\"", 0.3048),
            (Quantity::Length, "1ft", 0.3048),
            (Quantity::Length, "30.5 centimetres", 0.305),
            (Quantity::Length, "1e3mm", 1.0),
            (Quantity::Mass, "1lb", 0.453_592_37),
            (Quantity::Share, "93 %", 0.93),
            (Quantity::Share, "0.93", 0.93),
            (Quantity::Time, "00:02", 2.0),
            (Quantity::Time, "1:30.5", 90.5),
            (Quantity::Time, "1:00:02", 3_602.0),
            (Quantity::Time, "2 minutes", 120.0),
        ] {
            assert_eq!(quantity.parse("x", text).unwrap(), si, "{text}");
        }
        for text in ["1:90", ":30", "1:", "-1:30", "1:2:3:4", "1:+2", "1:nan"] {
            let error = Quantity::Time.parse("x", text).unwrap_err().to_string();
            assert!(error.contains("1:30"), "{text}: {error}");
        }
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
