//! The two forms of the rows: written here, and read back to go on after an interruption.

use std::io::{BufRead, BufReader, Read};
use std::ops::Range;

use clap::ValueEnum;
use serde_json::{Value, json};

use crate::Error;
use crate::fit::Estimate;
use crate::report::batch::{Digest, DropDigest, Found, JudgedDigest};
use crate::report::csv::with_decimal_commas;
use crate::report::drops::{self, COLUMNS, RowStatus};
use crate::report::rule::Outcome;
use crate::report::{Report, doubt_height, json};

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// One row per drop
    Csv,
    /// One document of analyze --format json per line
    Ndjson,
    /// One row per drop, with semicolons between fields and commas in numbers: by --decimal comma
    #[value(skip)]
    CsvComma,
}

/// Whole files found in what an interrupted batch left.
#[derive(Debug, Default)]
pub(super) struct ReadBack {
    /// Where the last whole file ends, in bytes; what follows is torn.
    pub end: u64,
    /// The files.
    pub digests: Vec<Digest>,
    /// The number of the last file with a drop, and where its rows are.
    pub sample: Option<(usize, Range<u64>)>,
}

impl ReadBack {
    fn add(&mut self, digest: Digest, end: u64) {
        if matches!(digest.found, Found::Drops(_)) {
            self.sample = Some((self.digests.len(), self.end..end));
        }
        self.digests.push(digest);
        self.end = end;
    }
}

impl Format {
    pub(super) fn header(self) -> String {
        match self {
            Self::Csv => drops::header(),
            Self::CsvComma => with_decimal_commas(&drops::header()),
            Self::Ndjson => String::new(),
        }
    }

    pub(super) fn rows(self, report: &Report) -> Result<String, Error> {
        match self {
            Self::Csv => Ok(drops::rows(report)),
            Self::CsvComma => Ok(with_decimal_commas(&drops::rows(report))),
            Self::Ndjson => Ok(json::to_line(report).map_err(std::io::Error::from)?),
        }
    }

    pub(super) fn failure(self, file: &str, reason: &str) -> String {
        match self {
            Self::Csv => drops::failure(file, reason),
            Self::CsvComma => with_decimal_commas(&drops::failure(file, reason)),
            Self::Ndjson => json!({"file": file, "error": reason}).to_string() + "\n",
        }
    }

    /// Reads rows back, of which the last may be torn. Nothing where they are none of this form.
    pub(super) fn read_back(self, source: impl Read) -> Result<Option<ReadBack>, Error> {
        match self {
            Self::Csv => table(source),
            // Not to be gone on with.
            Self::CsvComma => Ok(None),
            Self::Ndjson => lines(source),
        }
    }
}

fn lines(source: impl Read) -> Result<Option<ReadBack>, Error> {
    let (mut source, mut back, mut line) =
        (BufReader::new(source), ReadBack::default(), Vec::new());
    loop {
        line.clear();
        let read = source.read_until(b'\n', &mut line)?;
        if !line.ends_with(b"\n") {
            let ours = line.is_empty() || line.starts_with(b"{");
            return Ok(ours.then_some(back));
        }
        let Some(digest) = serde_json::from_slice(&line)
            .ok()
            .and_then(|v| document(&v))
        else {
            return Ok(None);
        };
        let end = back.end + read as u64;
        back.add(digest, end);
    }
}

fn document(document: &Value) -> Option<Digest> {
    let file = document.get("file")?.as_str()?.to_owned();
    if let Some(reason) = document.get("error") {
        let found = Found::Failed(reason.as_str()?.to_owned());
        return Some(Digest { file, found });
    }
    let drops = document.get("drops")?.as_array()?;
    let judged = |i: usize| {
        document
            .pointer(&format!("/rule/drops/{i}"))
            .and_then(judged_document)
    };
    let found = if drops.is_empty() {
        let reason = document.pointer("/warnings/0/message")?.as_str()?;
        Found::Nothing(reason.to_owned())
    } else {
        let drop = |(i, drop): (usize, &Value)| {
            Some(DropDigest {
                judged: judged(i),
                ..drop_document(drop)?
            })
        };
        Found::Drops(drops.iter().enumerate().map(drop).collect::<Option<_>>()?)
    };
    Some(Digest { file, found })
}

fn drop_document(drop: &Value) -> Option<DropDigest> {
    let e = drop.get("restitution")?;
    let number = |at: &str| e.pointer(at).and_then(Value::as_f64);
    let share = |at: &str| {
        drop.pointer(&format!("/first_rebound/resilience/{at}"))?
            .as_f64()
    };
    let warnings = drop.get("warnings").and_then(Value::as_array);
    let codes = warnings.into_iter().flatten().filter_map(|w| w.get("code"));
    Some(DropDigest {
        at_speed_m_per_s: number("/at_speed_m_per_s"),
        resilience: share("value").zip(share("std_error")),
        judged: None,
        is_height_unfit: doubt_height(codes.filter_map(|code| code.as_str())),
        bounces: usize::try_from(drop.get("bounces")?.as_u64()?).ok()?,
        restitution: number("/value").map(|value| Estimate {
            value,
            std_error: number("/std_error"),
            interval95: number("/interval95/0")
                .zip(number("/interval95/1"))
                .map(<[f64; 2]>::from),
        }),
    })
}

fn judged_document(judged: &Value) -> Option<JudgedDigest> {
    let number = |at: &str| judged.pointer(at).and_then(Value::as_f64);
    Some(JudgedDigest {
        outcome: serde_json::from_value(judged.get("outcome")?.clone()).ok()?,
        rebound_m: number("/rebound_m/value").map(|value| (value, number("/rebound_m/std_error"))),
    })
}

/// Passes a source on and remembers its last byte.
struct Watched<R> {
    source: R,
    last: Option<u8>,
}

impl<R: Read> Read for Watched<R> {
    fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
        let read = self.source.read(buffer)?;
        self.last = buffer[..read].last().copied().or(self.last);
        Ok(read)
    }
}

fn table(source: impl Read) -> Result<Option<ReadBack>, Error> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .terminator(csv::Terminator::Any(b'\n'))
        .from_reader(Watched { source, last: None });
    let mut rows = Rows::default();
    let mut record = csv::ByteRecord::new();
    // A row is taken when the next one shows that it was whole.
    let mut held: Option<(csv::ByteRecord, u64)> = None;
    while reader
        .read_byte_record(&mut record)
        .map_err(std::io::Error::from)?
    {
        if let Some((row, end)) = held.replace((record.clone(), reader.position().byte()))
            && rows.add(&row, end).is_none()
        {
            return Ok(None);
        }
    }
    let Some((row, end)) = held else {
        return Ok(Some(rows.back));
    };
    // One that was cut off within quotes may end with the line feed of a name, but has too few fields.
    if reader.get_ref().last == Some(b'\n') && row.len() == COLUMNS.len() {
        return Ok(rows.add(&row, end).map(|()| rows.back));
    }
    let heading = drops::header();
    let torn =
        reader.get_ref().last != Some(b'\n') && heading.as_bytes().starts_with(&joined(&row));
    let ours = rows.heading_read || torn;
    Ok(ours.then_some(rows.back))
}

fn joined(row: &csv::ByteRecord) -> Vec<u8> {
    row.iter().collect::<Vec<_>>().join(&b","[..])
}

/// The rows so far.
#[derive(Debug, Default)]
struct Rows {
    back: ReadBack,
    heading_read: bool,
    /// The file whose drops are not all there yet, and those that are.
    file: String,
    drops: Vec<DropDigest>,
}

impl Rows {
    /// Takes a row that ends at a byte; none if it is not of this program.
    fn add(&mut self, row: &csv::ByteRecord, end: u64) -> Option<()> {
        if !self.heading_read {
            self.heading_read = true;
            self.back.end = end;
            return (*row == COLUMNS[..]).then_some(());
        }
        if row.len() != COLUMNS.len() {
            return None;
        }
        let text = |column: &str| {
            let at = COLUMNS.iter().position(|c| *c == column)?;
            std::str::from_utf8(row.get(at)?).ok()
        };
        let (file, reason) = (text("file")?.to_owned(), text("reason")?.to_owned());
        let found = match RowStatus::of_word(text("status")?)? {
            RowStatus::None if self.drops.is_empty() => Found::Nothing(reason),
            RowStatus::Error if self.drops.is_empty() => Found::Failed(reason),
            RowStatus::Drop => {
                if self.drops.is_empty() {
                    self.file.clone_from(&file);
                }
                self.drops.push(drop_row(text)?);
                let number: usize = text("drop")?.parse().ok()?;
                if number != self.drops.len() || file != self.file {
                    return None;
                }
                if number < text("drops")?.parse().ok()? {
                    return Some(());
                }
                Found::Drops(std::mem::take(&mut self.drops))
            }
            RowStatus::None | RowStatus::Error => return None,
        };
        self.back.add(Digest { file, found }, end);
        Some(())
    }
}

fn outcome(word: &str) -> Option<Outcome> {
    let all = [Outcome::Pass, Outcome::Fail, Outcome::Undecided];
    all.into_iter().find(|outcome| outcome.word() == word)
}

fn drop_row<'a>(text: impl Fn(&str) -> Option<&'a str>) -> Option<DropDigest> {
    let number = |column: &str| text(column).and_then(|t| t.parse::<f64>().ok());
    let outcome = text("rule_outcome").and_then(outcome);
    let rebound_m = number("rule_rebound_m").map(|value| (value, number("rule_rebound_std_m")));
    Some(DropDigest {
        at_speed_m_per_s: number("at_speed_m_per_s"),
        resilience: number("resilience").zip(number("resilience_std")),
        judged: outcome.map(|outcome| JudgedDigest { outcome, rebound_m }),
        is_height_unfit: doubt_height(text("warnings").unwrap_or_default().split_whitespace()),
        bounces: text("bounces")?.parse().ok()?,
        restitution: number("restitution").map(|value| Estimate {
            value,
            std_error: number("restitution_std"),
            interval95: number("restitution_low95")
                .zip(number("restitution_high95"))
                .map(<[f64; 2]>::from),
        }),
    })
}

#[cfg(test)]
mod tests;
