//! The report for a person: the answer first, then the impacts, then what to know.

mod answer;
mod models;
mod table;

use super::wrap::wrapped;
use super::{Impact, Irregular, Rejected, Report, Warning, rule};
use answer::{answer, ways};
pub(crate) use models::model_name;
use models::models;

/// The level of detail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Detail {
    /// The answer and the warnings.
    Answer,
    /// Beside them the ways to e, the impacts, and what was rejected, like by like.
    Usual,
    /// Beside them the models that were compared, and each sound that was rejected.
    Everything,
}

/// Lines that answer first (e, n, total time), then a table of impacts, then what was rejected, then warnings.
#[must_use]
pub fn to_text(report: &Report, detail: Detail) -> String {
    let mut out = String::new();
    let drops = &report.drops;
    let count = drops.len();
    line(
        &mut out,
        &match count {
            0 => format!("{}: no drop found", report.file),
            1 => format!("{}: one drop", report.file),
            _ => format!("{}: {count} drops", report.file),
        },
    );
    let judged = |i| {
        let judged = report.rule.as_ref();
        judged.map_or_else(Vec::new, |judged| rule::entries(judged, i))
    };
    for (i, drop) in drops.iter().enumerate() {
        if count > 1 {
            line(&mut out, &format!("\nDrop {}", i + 1));
        }
        answer(&mut out, drop, &judged(i));
        if detail != Detail::Answer {
            ways(&mut out, &drop.estimates);
            table(&mut out, &drop.impacts);
            irregular(&mut out, &drop.irregular);
            if detail == Detail::Everything {
                models(&mut out, &drop.model);
            }
            rejects(&mut out, &drop.rejected, "between the impacts", detail);
        }
        warnings(&mut out, &drop.warnings);
    }
    if detail == Detail::Everything || detail == Detail::Usual && count == 0 {
        let place = if count == 0 {
            "in the recording"
        } else {
            "outside the drops"
        };
        rejects(&mut out, &report.rejected, place, detail);
    }
    if let Some(spread) = rule::spread(report) {
        line(&mut out, &format!("\n{}", wrapped(&spread, 2)));
    }
    warnings(&mut out, &report.warnings);
    out
}

fn line(out: &mut String, text: &str) {
    out.push_str(text);
    out.push('\n');
}

/// A line of the answer: what it says begins in the twelfth column.
fn entry(out: &mut String, text: &str) {
    line(out, &wrapped(text, 11));
}

fn table(out: &mut String, impacts: &[Impact]) {
    line(out, "");
    for row in table::rows(impacts) {
        line(out, &row);
    }
}

fn irregular(out: &mut String, irregular: &[Irregular]) {
    if !irregular.is_empty() {
        line(out, "");
    }
    for bounce in irregular {
        line(out, &wrapped(&bounce.in_words(), 2));
    }
}

/// Rejected events that are written out; the JSON document has them all.
const SHOWN: usize = 8;

fn rejects(out: &mut String, rejected: &[Rejected], place: &str, detail: Detail) {
    if rejected.is_empty() {
        return;
    }
    line(out, &format!("\nRejected {place}: {}", rejected.len()));
    if detail == Detail::Everything {
        for r in rejected {
            line(
                out,
                &wrapped(&format!("  {:.4} s: {}", r.time_s, r.detail), 4),
            );
        }
        return;
    }
    let mut kinds: Vec<(&str, usize, &Rejected)> = Vec::new();
    for r in rejected {
        match kinds.iter_mut().find(|(detail, ..)| *detail == r.detail) {
            Some((_, count, _)) => *count += 1,
            None => kinds.push((&r.detail, 1, r)),
        }
    }
    kinds.sort_by_key(|&(_, count, _)| std::cmp::Reverse(count));
    for (detail, count, first) in kinds.iter().take(SHOWN) {
        let told = match count {
            1 => format!("  {:.4} s: {detail}", first.time_s),
            _ => format!("  {count} times, first at {:.4} s: {detail}", first.time_s),
        };
        line(out, &wrapped(&told, 4));
    }
}

fn warnings(out: &mut String, warnings: &[Warning]) {
    if !warnings.is_empty() {
        line(out, "");
    }
    for warning in warnings {
        line(out, &wrapped(&format!("Warning: {}", warning.message), 2));
    }
}
