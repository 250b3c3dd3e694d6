//! The report for a person: the answer first, then what it means in words, then what to do.

mod details;
mod heading;
mod models;
mod table;
mod words;

pub(crate) use super::batch::together_of;
use super::numbers::listed;
use super::wrap::wrapped;
use super::{Drop, Impact, Irregular, Rejected, Report, Warning, WarningCode, rule};
use crate::order::sort_by_number;
use crate::units::real;
use details::{basis, ways};
pub(crate) use heading::{answer, heard, mean_of, restitution};
pub(crate) use models::model_name;
use models::models;
pub(crate) use words::range;

/// The level of detail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Detail {
    /// A line per drop for a shell script: e, its standard error, bounces, seconds, warnings and the file.
    Answer,
    /// The answer, what it means in words, and the warnings.
    Usual,
    /// Beside them the plain formulas, the impacts, the models that were compared, and each sound that was rejected.
    Everything,
}

/// How a program whose user can do something about a warning says so: `--height`.
pub type Advice<'a> = &'a dyn Fn(WarningCode) -> Option<&'static str>;

/// The answer, what it means, then the warnings; see [`Detail`] for what else there is.
#[must_use]
pub fn to_text(report: &Report, detail: Detail) -> String {
    to_text_with(report, detail, &|_| None)
}

/// The same with advice behind the warnings.
#[must_use]
pub fn to_text_with(report: &Report, detail: Detail, advice: Advice<'_>) -> String {
    if detail == Detail::Answer {
        return heading::for_shell(report);
    }
    let mut out = String::new();
    line(&mut out, &heading::heading(report));
    match report.drops.as_slice() {
        [] => {}
        [drop] => one(&mut out, report, (0, drop), detail),
        drops => several(&mut out, report, drops, detail),
    }
    if detail == Detail::Everything {
        let place = if report.drops.is_empty() {
            "in the recording"
        } else {
            "outside the drops"
        };
        rejects(&mut out, &report.rejected, place);
    }
    if let Some(spread) = rule::spread(report) {
        line(&mut out, &format!("\n{}", wrapped(&spread, 2)));
    }
    warnings(&mut out, report, advice);
    out
}

/// What is said of a drop below its answer.
fn one(out: &mut String, report: &Report, (index, drop): (usize, &Drop), detail: Detail) {
    words::words(out, report, drop, &judged(report, index));
    irregular(out, &drop.irregular);
    if detail == Detail::Everything {
        basis(out, drop);
        ways(out, &drop.estimates);
        table(out, &drop.impacts);
        models(out, &drop.model);
        rejects(out, &drop.rejected, "between the impacts");
    }
}

/// The drops below each other, their mean and spread, and in detail each by itself.
fn several(out: &mut String, report: &Report, drops: &[Drop], detail: Detail) {
    for (i, answer) in heading::list(drops).iter().enumerate() {
        line(out, answer);
        for said in judged(report, i) {
            line(out, &wrapped(&format!("       {said}"), 9));
        }
    }
    let together = together_of(drops);
    if !together.is_empty() {
        out.push('\n');
        out.push_str(&together);
    }
    if detail == Detail::Everything {
        for (i, drop) in drops.iter().enumerate() {
            line(out, &format!("\nDrop {}: {}", i + 1, answer(drop)));
            one(out, report, (i, drop), detail);
        }
    }
}

fn judged(report: &Report, index: usize) -> Vec<String> {
    let judged = report.rule.as_ref();
    judged.map_or_else(Vec::new, |judged| judged.in_words(index))
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

/// What was rejected, like by like, with all their times.
fn rejects(out: &mut String, rejected: &[Rejected], place: &str) {
    if rejected.is_empty() {
        return;
    }
    line(out, &format!("\nRejected {place}: {}", rejected.len()));
    let mut kinds: Vec<(&str, Vec<String>)> = Vec::new();
    for r in rejected {
        let time = format!("{:.4}", r.time_s);
        match kinds.iter_mut().find(|(detail, _)| *detail == r.detail) {
            Some((_, times)) => times.push(time),
            None => kinds.push((&r.detail, vec![time])),
        }
    }
    sort_by_number(&mut kinds, |(_, times)| -real(times.len()));
    for (detail, times) in kinds {
        let told = format!("  {detail}: {} s", times.join(", "));
        line(out, &wrapped(&told, 4));
    }
}

/// Each warning once, with the numbers of the drops that have it where there are several.
fn warnings(out: &mut String, report: &Report, advice: Advice<'_>) {
    let mut told: Vec<(&Warning, Vec<usize>)> = Vec::new();
    for (i, drop) in report.drops.iter().enumerate() {
        for warning in &drop.warnings {
            match told.iter_mut().find(|(known, _)| *known == warning) {
                Some((_, drops)) => drops.push(i + 1),
                None => told.push((warning, vec![i + 1])),
            }
        }
    }
    told.extend(report.warnings.iter().map(|w| (w, Vec::new())));
    if !told.is_empty() {
        line(out, "");
    }
    for (warning, drops) in told {
        let of = if report.drops.len() > 1 {
            of_drops(&drops)
        } else {
            String::new()
        };
        let advice = advice(warning.code).map_or_else(String::new, |a| format!(" ({a})"));
        let said = format!("Warning: {of}{}{advice}", warning.message);
        line(out, &wrapped(&said, 2));
    }
}

/// `drop 2: `, `drops 2, 3 and 5: `; nothing for the whole recording.
fn of_drops(numbers: &[usize]) -> String {
    match numbers.len() {
        0 => String::new(),
        1 => format!("drop {}: ", listed(numbers)),
        _ => format!("drops {}: ", listed(numbers)),
    }
}

#[cfg(test)]
mod tests;
