//! The first line, a line for each of several drops, and the lines that a shell script reads.

use crate::fit::Estimate;
use crate::report::numbers::{counted, seconds, short, with_error};
use crate::report::{Drop, Report};

/// What stands first: of one drop its e.
pub(super) fn heading(report: &Report) -> String {
    let file = &report.file;
    match report.drops.as_slice() {
        [] => format!("{file}: no drop found"),
        [drop] => format!("{file}: {}", answer(drop)),
        drops => format!("{file}: {}", counted(drops.len(), "drop")),
    }
}

/// `e = 0.929 ± 0.001 (67 bounces in 5.8 s)`.
pub(crate) fn answer(drop: &Drop) -> String {
    format!("{} ({})", restitution(drop), heard(drop))
}

/// The drops below each other, so that their e can be compared.
pub(super) fn list(drops: &[Drop]) -> Vec<String> {
    let answers: Vec<String> = drops.iter().map(restitution).collect();
    let width = answers.iter().map(|a| a.chars().count()).max().unwrap_or(0);
    let line = |(i, (drop, e)): (usize, (&Drop, &String))| {
        let from = drop.impacts.first().map_or(0.0, |first| first.time_s);
        let pad = " ".repeat(width - e.chars().count());
        format!(
            "  {:>3}  {e}{pad}  {}, from {from:.1} s",
            i + 1,
            heard(drop)
        )
    };
    drops.iter().zip(&answers).enumerate().map(line).collect()
}

/// `e = 0.929 ± 0.001`.
pub(crate) fn restitution(drop: &Drop) -> String {
    let Some(e) = drop.restitution.as_ref().map(|r| r.estimate) else {
        return "e not determined".to_owned();
    };
    match e.std_error {
        Some(std) => format!("e = {}", short(e.value, std)),
        None => format!("e = {}", with_error(&e)),
    }
}

/// `mean 0.912 ± 0.015 of 6 drops`, the error being that by their spread or that by their own errors, whichever is larger;
/// none of fewer than two.
pub(crate) fn mean_of(drops: &[Drop]) -> Option<String> {
    let each = drops.iter().filter_map(|d| d.restitution.as_ref());
    let each: Vec<Estimate> = each.map(|e| e.estimate).collect();
    let count: f64 = each.iter().map(|_| 1.0).sum();
    let mean = each.iter().map(|e| e.value).sum::<f64>() / count;
    let square: f64 = each.iter().map(|e| (e.value - mean).powi(2)).sum();
    let claimed: f64 = each.iter().filter_map(|e| e.std_error).map(|s| s * s).sum();
    let std = (square / (count - 1.0)).max(claimed / count).sqrt() / count.sqrt();
    let of = counted(each.len(), "drop");
    (each.len() > 1).then(|| format!("mean {} of {of}", short(mean, std)))
}

/// `67 bounces in 5.8 s`.
pub(crate) fn heard(drop: &Drop) -> String {
    let (bounces, time) = (
        counted(drop.bounces, "bounce"),
        seconds(drop.observed_time_s),
    );
    format!("{bounces} in {time}")
}

/// A line per drop for a shell script: e, its standard error, bounces heard, seconds from the first to the last, codes of
/// the warnings, the outcome of a rule if one was asked for, and the file, which may hold spaces and stands last. What does
/// not exist is `-`.
pub(super) fn for_shell(report: &Report) -> String {
    let mut lines = String::new();
    for (i, drop) in report.drops.iter().enumerate() {
        let e = drop.restitution.as_ref().map(|r| r.estimate);
        let std = e.and_then(|e| e.std_error);
        let digits = std.map_or(3, super::super::numbers::digits_for);
        let shown = |x: Option<f64>| x.map_or_else(|| "-".to_owned(), |x| format!("{x:.digits$}"));
        let mut cells = vec![
            shown(e.map(|e| e.value)),
            shown(std),
            drop.bounces.to_string(),
            format!("{:.4}", drop.observed_time_s),
            codes(report, drop),
        ];
        let judged = report.rule.as_ref().and_then(|rule| rule.drops.get(i));
        cells.extend(judged.map(|judged| judged.outcome.to_string()));
        lines += &format!("{} {}\n", cells.join(" "), report.file);
    }
    lines
}

fn codes(report: &Report, drop: &Drop) -> String {
    let warnings = drop.warnings.iter().chain(&report.warnings);
    let codes: Vec<&str> = warnings.map(|w| w.code.word()).collect();
    if codes.is_empty() {
        "-".to_owned()
    } else {
        codes.join(",")
    }
}
