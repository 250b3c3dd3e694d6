//! Numbers to impact times: drop by drop, times or intervals, and their unit.

use super::columns::Columns;
use super::table::Table;
use super::{Decimal, Kind, Reading, Typed, Unit, at_line};
use crate::Error;

/// A flight of more seconds than this is one in milliseconds: a ball flies for 10 s after a fall from 120 m.
const LONGEST_S: f64 = 10.0;
/// A flight of more milliseconds than this is one in microseconds.
const LONGEST_MS: f64 = 1e3 * LONGEST_S;

/// A drop of the list: its name, its numbers and their lines.
struct Listed<'a> {
    name: &'a str,
    numbers: Vec<(usize, f64)>,
}

pub(super) fn typed(
    table: &Table<'_>,
    columns: &Columns,
    reading: Reading,
) -> Result<Typed, Error> {
    let drops = listed(table, columns)?;
    let kind = match reading.kind.or(columns.kind) {
        Some(kind) => kind,
        None => kind(&drops)?,
    };
    drops.iter().try_for_each(|drop| check(drop, kind))?;
    let unit = reading
        .unit
        .or(columns.unit)
        .unwrap_or_else(|| unit(&drops, kind));
    let times = |drop: &Listed<'_>| {
        let numbers = drop.numbers.iter().map(|(_, x)| x * unit.in_s());
        match kind {
            Kind::Times => numbers.collect(),
            Kind::Intervals => summed(numbers),
        }
    };
    let has_names = columns.drops.is_some();
    let names = drops.iter().filter(|_| has_names);
    Ok(Typed {
        drops_s: drops.iter().map(times).collect(),
        names: names.map(|drop| drop.name.to_owned()).collect(),
        kind,
        unit,
        decimal: table.has_comma.then_some(Decimal::Comma),
        rounding_std_s: last_place(table, columns) * unit.in_s() / 12.0_f64.sqrt(),
    })
}

/// The drops in the order in which they first appear.
fn listed<'a>(table: &'a Table<'_>, columns: &Columns) -> Result<Vec<Listed<'a>>, Error> {
    let mut drops: Vec<Listed<'a>> = Vec::new();
    for (line, fields) in &table.rows {
        let field = fields.get(columns.numbers).copied().unwrap_or("");
        let Some(number) = table.number(field) else {
            return Err(at_line(*line, format!("'{field}' is no time")));
        };
        let name = columns
            .drops
            .and_then(|c| fields.get(c))
            .copied()
            .unwrap_or("");
        if columns.drops.is_some() && name.is_empty() {
            return Err(at_line(
                *line,
                "the column of the drop is empty, where other lines say it",
            ));
        }
        match drops.iter_mut().find(|drop| drop.name == name) {
            Some(drop) => drop.numbers.push((*line, number)),
            None => drops.push(Listed {
                name,
                numbers: vec![(*line, number)],
            }),
        }
    }
    match drops.is_empty() {
        true => Err(at_line(1, "there are no times in it")),
        false => Ok(drops),
    }
}

/// Times grow; of intervals the last is shorter than the first, and one alone can be nothing else.
fn kind(drops: &[Listed<'_>]) -> Result<Kind, Error> {
    let grow = |drop: &Listed<'_>| drop.numbers.windows(2).all(|pair| pair[0].1 < pair[1].1);
    let shrink = |drop: &Listed<'_>| match drop.numbers.as_slice() {
        [(_, first), .., (_, last)] => last < first,
        _ => true,
    };
    let is_time = |drop: &Listed<'_>| drop.numbers.len() > 1 && grow(drop);
    if drops.iter().all(is_time) {
        return Ok(Kind::Times);
    }
    if drops.iter().all(shrink) {
        return Ok(Kind::Intervals);
    }
    let odd = drops.iter().find(|drop| !is_time(drop));
    let line = odd.and_then(|drop| {
        let back = drop.numbers.windows(2).find(|pair| pair[0].1 >= pair[1].1);
        back.map_or_else(|| drop.numbers.first(), |pair| pair.get(1))
    });
    Err(at_line(
        line.map_or(1, |(line, _)| *line),
        "times grow from line to line and intervals shrink, and these do neither: correct it, or say which they are",
    ))
}

fn check(drop: &Listed<'_>, kind: Kind) -> Result<(), Error> {
    let wrong = match kind {
        Kind::Times if drop.numbers.len() < 2 => Some((
            drop.numbers.first(),
            "one time bounds no flight: a drop takes two, or the interval between them",
        )),
        Kind::Times => {
            let back = drop.numbers.windows(2).find(|pair| pair[0].1 >= pair[1].1);
            back.map(|pair| (pair.get(1), "the time is not after the one before it"))
        }
        Kind::Intervals => {
            let none = drop.numbers.iter().find(|(_, x)| *x <= 0.0);
            none.map(|number| (Some(number), "an interval is above 0"))
        }
    };
    match wrong {
        Some((number, problem)) => Err(at_line(number.map_or(1, |(line, _)| *line), problem)),
        None => Ok(()),
    }
}

/// The unit in which the longest flight is one of a ball.
fn unit(drops: &[Listed<'_>], kind: Kind) -> Unit {
    let flights = drops.iter().flat_map(|drop| {
        let numbers: Vec<f64> = drop.numbers.iter().map(|(_, x)| *x).collect();
        match kind {
            Kind::Intervals => numbers,
            Kind::Times => numbers.windows(2).map(|pair| pair[1] - pair[0]).collect(),
        }
    });
    let longest = flights.fold(0.0, f64::max);
    match longest {
        _ if longest > LONGEST_MS => Unit::Microseconds,
        _ if longest > LONGEST_S => Unit::Milliseconds,
        _ => Unit::Seconds,
    }
}

fn summed(intervals: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut times = vec![0.0];
    let mut at = 0.0;
    times.extend(intervals.map(|interval| {
        at += interval;
        at
    }));
    times
}

/// One in the last decimal place that any number has: a spreadsheet leaves out zeros at the end.
fn last_place(table: &Table<'_>, columns: &Columns) -> f64 {
    let decimals = |field: &&str| {
        let decimals = field.split(['.', ',']).nth(1).unwrap_or("");
        decimals.chars().take_while(char::is_ascii_digit).count()
    };
    let fields = table
        .rows
        .iter()
        .filter_map(|(_, fields)| fields.get(columns.numbers));
    let most = fields.map(decimals).max().unwrap_or(0);
    10.0_f64.powi(-i32::try_from(most).unwrap_or(i32::MAX))
}
