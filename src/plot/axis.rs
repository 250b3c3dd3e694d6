//! An axis: its range, its ticks, and how they are written.

use std::ops::Range;

use plotters::coord::ranged1d::{
    KeyPointHint, KeyPointWeight, NoDefaultFormatting, Ranged, ValueFormatter,
};

use crate::Error;

/// How values are spread along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By their logarithm.
    Logarithmic,
}

/// One axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What it shows, with its unit.
    pub label: String,
    /// Left or lower end.
    pub from: f64,
    /// Right or upper end.
    pub to: f64,
    /// Scale.
    pub scale: Scale,
    /// About how many labelled ticks an even axis has at most; 0 for an axis without any.
    pub most_ticks: u8,
    /// Whether it counts: its ticks are whole numbers then.
    pub whole: bool,
    /// Names in place of numbers, each with its value.
    pub names: Vec<(f64, String)>,
}

/// Ticks of an axis that is as long as the picture.
const MOST_TICKS: u8 = 9;

impl Axis {
    /// An even axis.
    #[must_use]
    pub fn linear(label: impl Into<String>, from: f64, to: f64) -> Self {
        Self {
            label: label.into(),
            from,
            to,
            scale: Scale::Linear,
            most_ticks: MOST_TICKS,
            whole: false,
            names: Vec::new(),
        }
    }

    /// An even axis with names in place of numbers, each at its value.
    #[must_use]
    pub fn named(names: Vec<(f64, String)>, from: f64, to: f64) -> Self {
        Self {
            names,
            ..Self::linear("", from, to).with_ticks(0)
        }
    }

    /// An even axis of counts.
    #[must_use]
    pub fn counting(label: impl Into<String>, from: f64, to: f64) -> Self {
        Self {
            whole: true,
            ..Self::linear(label, from, to)
        }
    }

    /// A logarithmic axis, for positive values.
    #[must_use]
    pub fn logarithmic(label: impl Into<String>, from: f64, to: f64) -> Self {
        Self {
            scale: Scale::Logarithmic,
            ..Self::linear(label, from, to)
        }
    }

    /// The axis with another number of ticks: fewer for a small panel.
    #[must_use]
    pub const fn with_ticks(mut self, most: u8) -> Self {
        self.most_ticks = most;
        self
    }

    pub(super) fn check(&self) -> Result<(), Error> {
        let [from, to] = [self.from, self.to].map(|end| self.straight(end));
        if from.is_finite() && to.is_finite() && from < to {
            Ok(())
        } else {
            let problem = format!(
                "the axis '{}' runs from {} to {}",
                self.label, self.from, self.to
            );
            Err(Error::Plot { problem })
        }
    }

    fn straight(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => value,
            Scale::Logarithmic => value.log10(),
        }
    }

    /// The place of a value: 0 at the start of the axis, 1 at its end.
    pub(super) fn place(&self, value: f64) -> f64 {
        let [value, from, to] = [value, self.from, self.to].map(|v| self.straight(v));
        (value - from) / (to - from)
    }

    /// The value at a place.
    pub(super) fn value(&self, place: f64) -> f64 {
        let [from, to] = [self.from, self.to].map(|v| self.straight(v));
        let straight = from + place * (to - from);
        match self.scale {
            Scale::Linear => straight,
            Scale::Logarithmic => 10_f64.powf(straight),
        }
    }

    /// Distance of labelled ticks on an even axis: 1, 2 or 5 times a power of ten, half as many as it may have or more.
    fn step(&self) -> f64 {
        let rough = (self.to - self.from) / f64::from(self.most_ticks.max(1));
        let rough = if self.whole { rough.max(1.0) } else { rough };
        let power = 10_f64.powf(rough.log10().floor());
        let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
        steps
            .into_iter()
            .find(|&step| step >= rough)
            .unwrap_or(10.0 * power)
    }

    /// What is written along the axis.
    pub(super) fn labels(&self) -> Vec<String> {
        self.ticks().iter().map(|v| self.format_ext(v)).collect()
    }

    fn ticks(&self) -> Vec<f64> {
        if self.most_ticks == 0 {
            return self.names.iter().map(|(value, _)| *value).collect();
        }
        match self.scale {
            Scale::Linear => multiples(self.step(), self.from, self.to),
            Scale::Logarithmic => {
                let powers = self.decades(&[1.0]);
                if powers.len() > FEW_POWERS {
                    return powers;
                }
                let finer = self.decades(&[1.0, 2.0, 5.0]);
                if finer.len() > 1 {
                    return finer;
                }
                // Less than an octave is almost even.
                multiples(self.step(), self.from, self.to)
            }
        }
    }

    /// How a tick of a logarithmic axis is written: as a power of ten only where it is one.
    fn logarithmic_label(&self, value: f64) -> String {
        let power = value.log10();
        let powers = self.decades(&[1.0]);
        if powers.len() > FEW_POWERS {
            // One style for all: a single long number makes powers of them.
            if powers.iter().all(|&v| is_short(v)) {
                return format!("{value}");
            }
            power_label(value)
        } else if self.decades(&[1.0, 2.0, 5.0]).len() > 1 {
            let decimals = if value < 1.0 { -power.floor() } else { 0.0 };
            linear_label(value, 10_f64.powf(-decimals))
        } else {
            linear_label(value, self.step())
        }
    }

    fn light_lines(&self) -> Vec<f64> {
        match self.scale {
            Scale::Linear => Vec::new(),
            Scale::Logarithmic => self.decades(&[2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]),
        }
    }

    /// These multiples of every power of ten on the axis.
    fn decades(&self, factors: &[f64]) -> Vec<f64> {
        let powers = multiples(1.0, self.from.log10().floor(), self.to.log10().ceil());
        let values = powers
            .into_iter()
            .flat_map(|power| factors.iter().map(move |f| f * 10_f64.powf(power)));
        // The ends belong to the axis, whatever the rounding of a power.
        values
            .filter(|&value| (-1e-9..=1.0 + 1e-9).contains(&self.place(value)))
            .collect()
    }
}

/// With no more powers of ten than this, a logarithmic axis has ticks between them too.
const FEW_POWERS: usize = 2;

/// The multiples of `step` from one number to another.
fn multiples(step: f64, from: f64, to: f64) -> Vec<f64> {
    let first = (from / step - 1e-9).ceil();
    (0_u32..1000)
        .map(|i| (first + f64::from(i)) * step)
        .take_while(|&value| value <= to + 1e-9 * step)
        .collect()
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    #[expect(
        clippy::cast_possible_truncation,
        reason = "`as` saturates, and what is drawn was clipped to the axis before"
    )]
    fn map(&self, value: &f64, (start, end): (i32, i32)) -> i32 {
        (f64::from(start) + self.place(*value) * f64::from(end - start)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        match hint.weight() {
            KeyPointWeight::Bold => self.ticks(),
            KeyPointWeight::Any => self.light_lines(),
        }
    }

    fn range(&self) -> Range<f64> {
        self.from..self.to
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, value: &f64) -> String {
        let there = |at: f64| (self.place(at) - self.place(*value)).abs() < 1e-9;
        let named = self.names.iter().find(|(at, _)| there(*at));
        if let Some((_, name)) = named {
            return name.clone();
        }
        match self.scale {
            Scale::Linear => linear_label(*value, self.step()),
            Scale::Logarithmic => self.logarithmic_label(*value),
        }
    }
}

/// With the decimals that the distance of the ticks needs, and a true minus sign.
fn linear_label(value: f64, step: f64) -> String {
    let decimals = (0..12_u8)
        .find(|&d| {
            let scaled = step * 10_f64.powi(i32::from(d));
            scaled > 0.5 && (scaled - scaled.round()).abs() < 1e-6
        })
        .map_or(12, usize::from);
    // Adding 0 turns −0 into 0.
    let rounded = if value.abs() < 1e-9 * step {
        0.0
    } else {
        value
    };
    format!("{rounded:.decimals$}").replace('-', "−")
}

/// Whether a power of ten is read more easily as a number.
fn is_short(value: f64) -> bool {
    (-3.0..=4.0).contains(&value.log10().round())
}

/// `10⁵`.
fn power_label(value: f64) -> String {
    let power = value.log10().round();
    let exponent = format!("{power}");
    let raised = exponent.chars().map(|c| match c {
        '-' => '⁻',
        digit => "⁰¹²³⁴⁵⁶⁷⁸⁹"
            .chars()
            .nth(digit.to_digit(10).unwrap_or(0) as usize)
            .unwrap_or(digit),
    });
    "10".chars().chain(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<String> {
        axis.labels()
    }

    #[test]
    fn ticks_are_round_numbers() {
        assert_eq!(
            labels(&Axis::linear("", 0.4, 0.95)),
            ["0.4", "0.5", "0.6", "0.7", "0.8", "0.9"]
        );
        assert_eq!(
            labels(&Axis::linear("", -1.0, 0.5)),
            ["−1.0", "−0.8", "−0.6", "−0.4", "−0.2", "0.0", "0.2", "0.4"]
        );
        assert_eq!(
            labels(&Axis::logarithmic("", 1e-4, 10.0)),
            ["10⁻⁴", "10⁻³", "10⁻²", "10⁻¹", "10⁰", "10¹"]
        );
        assert_eq!(
            labels(&Axis::logarithmic("", 1e-3, 1.0)),
            ["0.001", "0.01", "0.1", "1"]
        );
        assert_eq!(Axis::logarithmic("", 10.0, 100.0).light_lines().len(), 8);
    }

    #[test]
    fn short_logarithmic_axes_and_counts_have_ticks_too() {
        assert_eq!(
            labels(&Axis::logarithmic("", 0.03, 2.5)),
            ["0.05", "0.1", "0.2", "0.5", "1", "2"]
        );
        assert_eq!(
            labels(&Axis::logarithmic("", 310.0, 390.0).with_ticks(4)),
            ["320", "340", "360", "380"]
        );
        assert_eq!(
            labels(&Axis::linear("", 1e-7, 4e-7).with_ticks(3)),
            ["0.0000001", "0.0000002", "0.0000003", "0.0000004"]
        );
        assert_eq!(labels(&Axis::counting("", 0.5, 2.5)), ["1", "2"]);
        assert!(labels(&Axis::linear("", 0.0, 1.0).with_ticks(0)).is_empty());
        let names = vec![(2.0, "first".to_owned()), (1.0, "second".to_owned())];
        assert_eq!(labels(&Axis::named(names, 0.0, 3.0)), ["first", "second"]);
    }

    #[test]
    fn an_axis_without_extent_is_refused() {
        for axis in [
            Axis::linear("a", 1.0, 1.0),
            Axis::linear("a", 0.0, f64::NAN),
            Axis::logarithmic("a", 0.0, 1.0),
        ] {
            assert!(axis.check().is_err(), "{axis:?}");
        }
    }
}
