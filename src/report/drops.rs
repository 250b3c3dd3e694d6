//! Many reports as one CSV: a row per drop, and one for a recording that has none.

use super::csv::{cell, quoted};
use super::rule::Judged;
use super::{Drop, Report, Warning};
use crate::fit::Estimate;
use crate::words::words;

/// The columns, in order.
///
/// `drop` counts from 1 to `drops`, the number of drops in the file. The last column holds a number or nothing: a row
/// that was cut off, even in the middle of a quoted field, has fewer fields.
pub const COLUMNS: [&str; 45] = [
    "file",
    "drop",
    "drops",
    "status",
    "reason",
    "restitution",
    "restitution_std",
    "restitution_low95",
    "restitution_high95",
    "at_speed_m_per_s",
    "model",
    "bounces",
    "first_impact_s",
    "observed_time_s",
    "total_time_s",
    "flight_ratio",
    "flight_ratio_std",
    "eq25",
    "eq25_std",
    "eq30",
    "eq30_std",
    "first_rebound",
    "first_rebound_std",
    "timing_std_s",
    "bounce_std",
    "contact_time_s",
    "contact_time_std_s",
    "stiffness_n_per_m",
    "damping_n_s_per_m",
    "natural_frequency_rad_per_s",
    "damping_ratio",
    "warnings",
    "height_m",
    "mass_kg",
    "diameter_m",
    "channel",
    "sample_rate_hz",
    "duration_s",
    // Columns that came later stand behind, so that those before keep their places.
    "rebound_height_m",
    "rebound_height_std_m",
    "resilience",
    "resilience_std",
    "rule_outcome",
    "rule_rebound_m",
    "rule_rebound_std_m",
];

words! {
    /// The kind of a row, by its column `status`.
    #[non_exhaustive]
    pub enum RowStatus {
        /// A drop.
        Drop = "drop",
        /// A file without one.
        None = "none",
        /// A file that could not be analyzed.
        Error = "error",
    }
}

impl RowStatus {
    /// The status of this word.
    #[must_use]
    pub fn of_word(word: &str) -> Option<Self> {
        let all = [Self::Drop, Self::None, Self::Error];
        all.into_iter().find(|status| status.word() == word)
    }
}

/// Columns before those of the drop, and behind them.
const HEAD: usize = 5;
const TAIL: usize = 13;
const REBOUND: usize = 7;

/// The line of names above the rows.
#[must_use]
pub fn header() -> String {
    COLUMNS.join(",") + "\n"
}

/// A row per drop; for a recording without drops one with the reason. Values that do not exist are empty.
#[must_use]
pub fn rows(report: &Report) -> String {
    let (info, settings) = (&report.recording, &report.settings);
    let tail = |channel: usize| {
        [
            cell(settings.height_m),
            cell(settings.mass_kg),
            cell(settings.diameter_m),
            channel.to_string(),
            info.sample_rate_hz.to_string(),
            info.duration_s.to_string(),
        ]
    };
    let drops = &report.drops;
    if drops.is_empty() {
        let reason = report.why_none();
        let head = head(&report.file, "", 0, RowStatus::None, reason);
        let nothing = [const { String::new() }; REBOUND];
        return joined(&[&head[..], &empty(), &tail(info.channel), &nothing]);
    }
    let row = |(i, drop): (usize, &Drop)| {
        let number = (i + 1).to_string();
        let head = head(&report.file, &number, drops.len(), RowStatus::Drop, "");
        let measured = measured(drop, &report.warnings);
        let judged = report.rule.as_ref().and_then(|rule| rule.drops.get(i));
        joined(&[
            &head[..],
            &measured,
            &tail(drop.channel),
            &rebound(drop, judged),
        ])
    };
    drops.iter().enumerate().map(row).collect()
}

/// The row of a file that could not be analyzed.
#[must_use]
pub fn failure(file: &str, reason: &str) -> String {
    let head = head(file, "", 0, RowStatus::Error, reason);
    joined(&[&head[..], &empty(), &[const { String::new() }; TAIL]])
}

fn head(file: &str, number: &str, drops: usize, status: RowStatus, reason: &str) -> [String; HEAD] {
    [
        quoted(file),
        number.to_owned(),
        drops.to_string(),
        status.to_string(),
        quoted(reason),
    ]
}

fn empty() -> Vec<String> {
    vec![String::new(); COLUMNS.len() - HEAD - TAIL]
}

fn joined(parts: &[&[String]]) -> String {
    parts.concat().join(",") + "\n"
}

/// The measured columns of a drop, with the warnings of it and of its whole recording.
fn measured(drop: &Drop, of_recording: &[Warning]) -> Vec<String> {
    let e = drop.restitution.as_ref();
    let interval = e.and_then(|e| e.estimate.interval95);
    let estimates = &drop.estimates;
    let ball = drop.ball.as_ref();
    let warnings = drop.warnings.iter().chain(of_recording);
    let warnings: Vec<&str> = warnings.map(|w| w.code.word()).collect();
    let mut cells = Vec::from(with_std(e.map(|e| e.estimate)));
    cells.extend([
        cell(interval.map(|i| i[0])),
        cell(interval.map(|i| i[1])),
        cell(e.and_then(|e| e.at_speed_m_per_s)),
        drop.model.selected.to_string(),
        drop.bounces.to_string(),
        cell(drop.impacts.first().map(|i| i.time_s)),
        drop.observed_time_s.to_string(),
        cell(drop.total_time_s),
    ]);
    let ways = [
        estimates.flight_ratio,
        estimates.eq25,
        estimates.eq30,
        estimates.first_rebound,
    ];
    cells.extend(ways.into_iter().flat_map(with_std));
    cells.extend([
        cell(drop.scatter.timing_std_s),
        cell(drop.scatter.bounce_std),
        cell(ball.map(|b| b.contact_time_s)),
        cell(ball.map(|b| b.contact_time_std_s)),
        cell(ball.and_then(|b| b.stiffness_n_per_m)),
        cell(ball.and_then(|b| b.damping_n_s_per_m)),
        cell(ball.map(|b| b.natural_frequency_rad_per_s)),
        cell(ball.map(|b| b.damping_ratio)),
        warnings.join(" "),
    ]);
    cells
}

/// The first rebound, and what a rule says of it.
fn rebound(drop: &Drop, judged: Option<&Judged>) -> Vec<String> {
    let first = drop.first_rebound.as_ref();
    let mut cells = Vec::from(with_std(first.map(|r| r.height_m)));
    cells.extend(with_std(first.map(|r| r.resilience)));
    cells.push(judged.map_or_else(String::new, |j| j.outcome.to_string()));
    cells.extend(with_std(judged.and_then(|j| j.rebound_m)));
    cells
}

/// A value and its standard error.
fn with_std(estimate: Option<Estimate>) -> [String; 2] {
    [
        cell(estimate.map(|e| e.value)),
        cell(estimate.and_then(|e| e.std_error)),
    ]
}

#[cfg(all(test, feature = "cli"))]
mod tests {
    use super::*;

    #[test]
    fn a_failure_has_every_column_and_ends_with_an_empty_one() {
        let row = failure("a, b.wav", "it is \"empty\"");
        assert!(row.starts_with("\"a, b.wav\",,0,error,\"it is \"\"empty\"\"\",,"));
        assert!(row.ends_with(",\n"));
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .from_reader(row.as_bytes());
        let record = reader.records().next().unwrap().unwrap();
        assert_eq!(record.len(), COLUMNS.len());
        assert_eq!(header().split(',').count(), COLUMNS.len());
    }
}
