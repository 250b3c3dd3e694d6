//! Quantities of the command line: with a unit, or bare in SI where that can be meant.

use crate::Error;
use crate::units::Quantity;

/// A bare number above `most`, and up to ten thousand, is hardly in SI: its user thought of another unit.
struct Hardly {
    most: f64,
    meant: &'static str,
    si: &'static str,
}

/// Beyond this a number is no slip of the unit.
const NO_SLIP: f64 = 1e4;

pub(super) fn height(text: &str) -> Result<f64, Error> {
    // Three metres: higher than a room.
    asked(Quantity::Length, "height", text, &hardly(3.0, "cm", "m"))
}

pub(super) fn diameter(text: &str) -> Result<f64, Error> {
    // Half a metre: twice a basketball.
    asked(Quantity::Length, "diameter", text, &hardly(0.5, "mm", "m"))
}

pub(super) fn length_error(text: &str) -> Result<f64, Error> {
    // Ten centimetres: no ruler is read as badly.
    asked(
        Quantity::Length,
        "height error",
        text,
        &hardly(0.1, "mm", "m"),
    )
}

pub(super) fn mass(text: &str) -> Result<f64, Error> {
    // One kilogram: twice a basketball.
    asked(Quantity::Mass, "mass", text, &hardly(1.0, "g", "kg"))
}

pub(super) fn contact_time(text: &str) -> Result<f64, Error> {
    // A tenth of a second: ten times that of a basketball.
    asked(
        Quantity::Time,
        "contact time",
        text,
        &hardly(0.1, "ms", "s"),
    )
}

pub(super) fn time(text: &str) -> Result<f64, Error> {
    Quantity::Time.parse("time", text)
}

pub(super) fn acceleration(text: &str) -> Result<f64, Error> {
    Quantity::Acceleration.parse("acceleration", text)
}

pub(super) fn share(text: &str) -> Result<f64, Error> {
    Quantity::Share.parse("restitution", text)
}

const fn hardly(most: f64, meant: &'static str, si: &'static str) -> Hardly {
    Hardly { most, meant, si }
}

fn asked(
    quantity: Quantity,
    argument: &'static str,
    text: &str,
    hardly: &Hardly,
) -> Result<f64, Error> {
    let value = quantity.parse(argument, text)?;
    let bare = text.trim().parse::<f64>().is_ok();
    if !bare || value <= hardly.most || value > NO_SLIP {
        return Ok(value);
    }
    let (text, Hardly { meant, si, .. }) = (text.trim(), hardly);
    Err(Error::refused(format!(
        "{argument} is {text} without a unit, which would be {text} {si}: did you mean {text}{meant}? If not, write \
         {text}{si}"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reads what stands behind an option.
    type Read = fn(&str) -> Result<f64, Error>;

    #[test]
    fn a_bare_number_that_is_hardly_in_si_is_asked_about() {
        for (read, text, meant) in [
            (
                height as Read,
                "30.5",
                "did you mean 30.5cm? If not, write 30.5m",
            ),
            (mass, "2.7", "did you mean 2.7g? If not, write 2.7kg"),
            (diameter, " 40", "did you mean 40mm"),
            (contact_time, "1", "did you mean 1ms"),
            (length_error, "0.5", "did you mean 0.5mm"),
        ] {
            let error = read(text).unwrap_err().to_string();
            assert!(error.contains(meant), "{error}");
        }
    }

    #[test]
    fn what_can_be_meant_is_taken() {
        for (read, text, si) in [
            (height as Read, "0.305", 0.305),
            (height, "2", 2.0),
            (height, "30.5m", 30.5),
            (height, "-30", -30.0),
            (mass, "0.6", 0.6),
            (mass, "7kg", 7.0),
            (contact_time, "1e61", 1e61),
            (share, "93 %", 0.93),
        ] {
            assert_eq!(read(text).unwrap(), si, "{text}");
        }
    }
}
