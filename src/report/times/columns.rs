//! Which column holds the numbers, which the drop, and what the heading says of them.

use super::table::Table;
use super::{Kind, Unit, at_line};
use crate::Error;

/// Columns by their index, and what the heading of the numbers says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Columns {
    pub numbers: usize,
    pub drops: Option<usize>,
    pub kind: Option<Kind>,
    pub unit: Option<Unit>,
}

const TIMES: [&str; 5] = ["time", "times", "t", "at", "impact"];
const INTERVALS: [&str; 8] = [
    "interval",
    "intervals",
    "flight",
    "flights",
    "dt",
    "δt",
    "gap",
    "duration",
];
const DROPS: [&str; 8] = [
    "drop", "ball", "run", "trial", "throw", "sample", "series", "group",
];

impl Columns {
    pub(super) fn of(table: &Table<'_>) -> Result<Self, Error> {
        let heading = table.heading.clone().unwrap_or_default();
        let words: Vec<Vec<String>> = heading.iter().map(|field| words(field)).collect();
        let named = |names: &[&str]| {
            let is_named = |words: &Vec<String>| {
                words
                    .first()
                    .is_some_and(|first| names.contains(&first.as_str()))
            };
            words.iter().position(is_named)
        };
        let (times, intervals) = (named(&TIMES), named(&INTERVALS));
        let numbers = match times.or(intervals) {
            Some(column) => column,
            None => numeric(table)?,
        };
        let kind = match (times, intervals) {
            (Some(_), _) => Some(Kind::Times),
            (None, Some(_)) => Some(Kind::Intervals),
            (None, None) => None,
        };
        let drops = match named(&DROPS).filter(|column| *column != numbers) {
            Some(column) => Some(column),
            None => other(table, numbers)?,
        };
        let unit = words.get(numbers).and_then(|words| unit(words.last()?));
        Ok(Self {
            numbers,
            drops,
            kind,
            unit,
        })
    }
}

/// `Time [ms]` as `time` and `ms`.
fn words(field: &str) -> Vec<String> {
    let parts = field.split(|c: char| !c.is_alphanumeric());
    parts
        .filter(|word| !word.is_empty())
        .map(str::to_lowercase)
        .collect()
}

fn unit(word: &str) -> Option<Unit> {
    match word {
        "s" | "sec" | "second" | "seconds" => Some(Unit::Seconds),
        "ms" | "millisecond" | "milliseconds" => Some(Unit::Milliseconds),
        "us" | "µs" | "μs" | "microsecond" | "microseconds" => Some(Unit::Microseconds),
        _ => None,
    }
}

/// The first column that holds nothing but numbers.
fn numeric(table: &Table<'_>) -> Result<usize, Error> {
    let Some((line, first)) = table.rows.first() else {
        return Err(at_line(1, "there are no times in it"));
    };
    let is_numeric = |column: &usize| {
        let fields = table
            .rows
            .iter()
            .filter_map(|(_, fields)| fields.get(*column));
        fields
            .filter(|f| !f.is_empty())
            .all(|f| table.number(f).is_some())
    };
    let found = (0..first.len()).find(is_numeric);
    // Of a column with a slip in it that line says what is wrong.
    let leading = (0..first.len()).find(|column| table.number(first[*column]).is_some());
    found.or(leading).ok_or_else(|| {
        at_line(
            *line,
            "no number in it, expected a time and, in a second column, its drop",
        )
    })
}

/// The other of two columns.
fn other(table: &Table<'_>, numbers: usize) -> Result<Option<usize>, Error> {
    let widest = table.rows.iter().max_by_key(|(_, fields)| fields.len());
    match widest {
        Some((_, fields)) if fields.len() == 2 => Ok(Some(1 - numbers.min(1))),
        Some((line, fields)) if fields.len() > 2 && table.heading.is_none() => Err(at_line(
            *line,
            format!(
                "{} columns, expected a time and its drop, or a heading that names two columns 'time' (or 'interval') and 'drop'",
                fields.len()
            ),
        )),
        _ => Ok(None),
    }
}
