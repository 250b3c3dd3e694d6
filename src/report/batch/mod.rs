//! Many recordings in short: a line for each, and the mean of their drops.

use super::numbers::{digits_for, plus_minus};
use super::wrap::wrapped;
use super::{Drop, Report};
use crate::fit::Estimate;
use crate::fit::random_effects::{Measurement, OutlyingMeasurement, RandomEffects, outliers};

/// χ² as great as theirs by chance is rarer than this: they differ by more than they claim.
const RARE: f64 = 0.01;

/// One recording in short.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Digest {
    /// Its name.
    pub file: String,
    /// Its result.
    pub found: Found,
}

impl Digest {
    /// A recording that could not be analyzed, with the reason.
    #[must_use]
    pub const fn failed(file: String, reason: String) -> Self {
        let found = Found::Failed(reason);
        Self { file, found }
    }
}

/// The result of one recording.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Found {
    /// Its drops; one at least.
    Drops(Vec<DropDigest>),
    /// It has no drop, with the reason.
    Nothing(String),
    /// It could not be analyzed, with the reason.
    Failed(String),
}

/// One drop in short.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct DropDigest {
    /// Impacts heard.
    pub bounces: usize,
    /// e of the selected model.
    pub restitution: Option<Estimate>,
}

impl From<&Drop> for DropDigest {
    fn from(drop: &Drop) -> Self {
        Self {
            bounces: drop.bounces,
            restitution: drop.restitution.as_ref().map(|r| r.estimate),
        }
    }
}

impl From<&Report> for Digest {
    fn from(report: &Report) -> Self {
        let drops = &report.drops;
        Self {
            file: report.file.clone(),
            found: if drops.is_empty() {
                Found::Nothing(report.why_none().to_owned())
            } else {
                Found::Drops(drops.iter().map(DropDigest::from).collect())
            },
        }
    }
}

/// A line per drop, file by file, then what they say together: mean e, the spread between drops against that which they
/// claim, and the outliers by name. See `RandomEffects` and `outliers` for the formulas.
#[must_use]
pub fn summary(digests: &[Digest]) -> String {
    let mut out = String::new();
    let mut named: Vec<(String, Measurement)> = Vec::new();
    for digest in digests {
        let file = visible(&digest.file);
        match &digest.found {
            Found::Drops(drops) => {
                for (i, drop) in drops.iter().enumerate() {
                    let name = match drops.len() {
                        1 => file.clone(),
                        _ => format!("{file} drop {}", i + 1),
                    };
                    out += &line_of("", &name, &one(drop), 4);
                    named.extend(measurement(drop).map(|m| (name, m)));
                }
            }
            Found::Nothing(reason) => out += &line_of("", &file, &visible(reason), 4),
            Found::Failed(reason) => {
                out += &line_of("", &file, &format!("failed: {}", visible(reason)), 4);
            }
        }
    }
    out + "\n" + &counts(digests) + &together(&named)
}

/// The text on a name, in lines no wider than a terminal. The name stays whole, with the spaces in it.
fn line_of(head: &str, name: &str, told: &str, indent: usize) -> String {
    let as_wide = "x".repeat(name.chars().count());
    let line = wrapped(&format!("{head}{as_wide}: {told}"), indent);
    line.replacen(&as_wide, name, 1) + "\n"
}

/// A name that stays in its line and leaves the terminal alone.
fn visible(text: &str) -> String {
    let escaped = |c: char| {
        if c.is_control() {
            c.escape_default().to_string()
        } else {
            c.into()
        }
    };
    text.chars().map(escaped).collect()
}

fn one(drop: &DropDigest) -> String {
    let bounces = match drop.bounces {
        1 => "1 bounce".to_owned(),
        n => format!("{n} bounces"),
    };
    match drop.restitution {
        None => format!("e not determined, {bounces}"),
        Some(Estimate {
            value,
            std_error: None,
            ..
        }) => {
            format!("e {value:.3} (no error: a single ratio), {bounces}")
        }
        Some(Estimate {
            value,
            std_error: Some(std),
            ..
        }) => {
            format!("e {}, {bounces}", plus_minus(value, std))
        }
    }
}

/// e with an error to weigh it by.
fn measurement(drop: &DropDigest) -> Option<Measurement> {
    let e = drop.restitution?;
    let std = e.std_error.filter(|std| std.is_finite() && *std > 0.0)?;
    Some((e.value, std))
}

fn counts(digests: &[Digest]) -> String {
    let (mut drops, mut without, mut failed) = (0, 0, 0);
    for digest in digests {
        match &digest.found {
            Found::Drops(found) => drops += found.len(),
            Found::Nothing(_) => without += 1,
            Found::Failed(_) => failed += 1,
        }
    }
    let plural = |n: usize, one: &str| format!("{n} {one}{}", if n == 1 { "" } else { "s" });
    let mut line = plural(digests.len(), "recording") + ", " + &plural(drops, "drop");
    if without > 0 {
        line += &format!("; without a drop: {without}");
    }
    if failed > 0 {
        line += &format!("; failed: {failed}");
    }
    line + "\n"
}

/// The mean of the drops, and that without the outliers if there are any.
fn together(named: &[(String, Measurement)]) -> String {
    let measurements: Vec<Measurement> = named.iter().map(|(_, m)| *m).collect();
    let Some(pooled) = RandomEffects::of(&measurements) else {
        return String::new();
    };
    let mut out = described(&pooled);
    let far = outliers(&measurements);
    for (i, OutlyingMeasurement { index, distance }) in far.iter().enumerate() {
        let (name, (value, std)) = &named[*index];
        let label = if i == 0 { "outliers" } else { "" };
        let told = format!(
            "e {}, {:.1} standard deviations {} the median",
            plus_minus(*value, *std),
            distance.abs(),
            if *distance > 0.0 { "above" } else { "below" }
        );
        out += &line_of(&format!("  {label:<8} "), name, &told, 11);
    }
    let kept = measurements.iter().enumerate();
    let kept: Vec<Measurement> = kept
        .filter(|(i, _)| far.iter().all(|o| o.index != *i))
        .map(|(_, m)| *m)
        .collect();
    match RandomEffects::of(&kept) {
        Some(rest) if !far.is_empty() => out + "Without them:\n" + &described(&rest),
        _ => out,
    }
}

fn described(pooled: &RandomEffects) -> String {
    let judged = if pooled.chance >= RARE {
        "no more than they claim".to_owned()
    } else {
        let digits = digits_for(pooled.between);
        format!(
            "more than they claim: ball, height, surface or what was heard makes them differ by {:.digits$} more \
             (one standard deviation)",
            pooled.between
        )
    };
    let digits = digits_for(pooled.spread.min(pooled.claimed));
    let spread = format!(
        "  spread   {:.digits$} between drops, where their errors claim {:.digits$}",
        pooled.spread, pooled.claimed
    );
    let chance = match pooled.chance {
        rare if rare < 0.001 => "below 0.001".to_owned(),
        chance => format!("{chance:.3}"),
    };
    let birge = format!(
        "  Birge    {:.2} (χ² {:.1} for {} degrees of freedom, chance {chance}): the drops differ {judged}",
        pooled.birge,
        pooled.chi_square,
        pooled.count - 1,
    );
    format!(
        "  mean e   {} of {} drops\n{}\n{}\n",
        plus_minus(pooled.mean, pooled.mean_std),
        pooled.count,
        wrapped(&spread, 11),
        wrapped(&birge, 11)
    )
}

#[cfg(test)]
mod tests;
