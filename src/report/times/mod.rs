//! Impact times as people write them down: times or the intervals between them, of one drop or several.
//!
//! A line holds a number and, in a second column, which drop it is of. What separates columns, the decimal mark, the unit and
//! whether they are times or intervals is taken from the heading and the numbers; what can be read in two ways is refused
//! with the question, and [`Reading`] answers it.

mod columns;
mod meaning;
mod table;

use super::{Warning, WarningCode};
use crate::Error;
use crate::words::words;

words! {
    /// What the numbers are.
    pub enum Kind {
        /// When the ball hit.
        Times = "times",
        /// How long it flew from one impact to the next.
        Intervals = "intervals",
    }
}

words! {
    /// The unit of the numbers.
    pub enum Unit {
        /// Seconds.
        Seconds = "s",
        /// Thousandths of a second.
        Milliseconds = "ms",
        /// Millionths of a second.
        Microseconds = "us",
    }
}

words! {
    /// What stands before the decimals.
    pub enum Decimal {
        /// As in 0.5.
        Point = "point",
        /// As in 0,5.
        Comma = "comma",
    }
}

impl Unit {
    /// One of it in seconds.
    #[must_use]
    pub const fn in_s(self) -> f64 {
        match self {
            Self::Seconds => 1.0,
            Self::Milliseconds => 1e-3,
            Self::Microseconds => 1e-6,
        }
    }
}

/// What is known of a text beforehand; the rest is taken from it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Reading {
    /// Times or intervals.
    pub kind: Option<Kind>,
    /// Their unit.
    pub unit: Option<Unit>,
    /// The decimal mark.
    pub decimal: Option<Decimal>,
}

/// The drops of a text.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Typed {
    /// The impact times of each in seconds, the first at 0 where intervals were given.
    pub drops_s: Vec<Vec<f64>>,
    /// Their names, as the second column has them; empty where there is none.
    pub names: Vec<String>,
    /// What the numbers were taken for.
    pub kind: Kind,
    /// And in which unit.
    pub unit: Unit,
    /// And with which mark, where one stood there.
    pub decimal: Option<Decimal>,
    /// Standard error by rounding to the decimals that are written, in seconds: one in the last place over √12.
    pub rounding_std_s: f64,
}

impl Typed {
    /// What the list was taken for: `times in ms, with decimal commas`.
    #[must_use]
    pub fn in_words(&self) -> String {
        let comma = self.decimal.map_or("", |_| ", with decimal commas");
        format!("typed {} in {}{comma}", self.kind, self.unit)
    }

    /// Which drop is which, where the list names them otherwise than by their numbers.
    pub(crate) fn names(&self) -> Option<Warning> {
        let own = |(name, number): (&String, usize)| *name != number.to_string();
        let named = self.names.iter().zip(1..);
        let named = named.clone().any(own).then_some(named)?;
        let said = named.map(|(name, number)| format!("{number} is {name}"));
        let message = format!(
            "the drops of the list: {}",
            said.collect::<Vec<_>>().join(", ")
        );
        Some(Warning::new(WarningCode::ImpactsGiven, message))
    }
}

/// Reads a list in UTF-8 or, with a byte order mark, UTF-16.
///
/// # Errors
/// [`Error::Line`] naming the line that is no list of impacts, or can be one in two ways.
pub fn read(bytes: &[u8], reading: Reading) -> Result<Typed, Error> {
    let text = super::labels::decoded(bytes).ok_or_else(|| {
        at_line(
            1,
            "no text in UTF-8 or UTF-16: save the list as CSV or text",
        )
    })?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    let table = table::Table::read(text, reading.decimal)?;
    let columns = columns::Columns::of(&table)?;
    meaning::typed(&table, &columns, reading)
}

fn at_line(line: usize, problem: impl Into<String>) -> Error {
    Error::Line {
        line,
        problem: problem.into(),
    }
}

#[cfg(test)]
mod tests;
