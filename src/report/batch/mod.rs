//! Many recordings in short: a line for each, and the mean of their drops.

mod digest;
mod groups;
mod json;
mod rebound;
mod rule;

pub use digest::{Digest, DropDigest, Found, JudgedDigest};
pub use groups::{compared, told};
pub use json::summary_json;
pub use rule::verdict;

use super::Drop;
use super::numbers::{counted, digits_for, plus_minus};
use super::wrap::wrapped;
use crate::fit::Estimate;
use crate::fit::groups::{Levelled, Member};
use crate::fit::random_effects::{Measurement, OutlyingMeasurement, RandomEffects, outliers};
use digest::weighed;

/// χ² as great as theirs by chance is rarer than this: they differ by more than they claim.
const RARE: f64 = 0.01;

/// A line per drop, file by file, then what they say together: mean e, the spread between drops against that which they
/// claim, and the outliers by name. See `RandomEffects` and `outliers` for the formulas.
#[must_use]
pub fn summary(digests: &[Digest]) -> String {
    let mut out = String::new();
    for digest in digests {
        let file = visible(&digest.file);
        match &digest.found {
            Found::Drops(drops) => {
                for (name, drop) in named(&file, drops) {
                    out += &line_of("", &name, &one(drop), 4);
                }
            }
            Found::Nothing(reason) => out += &line_of("", &file, &visible(reason), 4),
            Found::Failed(reason) => {
                out += &line_of("", &file, &format!("failed: {}", visible(reason)), 4);
            }
        }
    }
    out + "\n" + &conclusion(digests)
}

/// The answer of a batch in one line: mean e, or why there is none.
#[must_use]
pub fn answer(digests: &[Digest]) -> String {
    let conclusion = conclusion(digests);
    let mean = conclusion
        .lines()
        .find_map(|line| line.strip_prefix("  mean e   "));
    let counts = conclusion.lines().next().unwrap_or_default();
    mean.map_or_else(|| counts.to_owned(), |mean| format!("e = {mean}"))
}

/// What all recordings say together, the last part of [`summary`].
#[must_use]
pub fn conclusion(digests: &[Digest]) -> String {
    let mut all: Vec<(String, DropDigest)> = Vec::new();
    for digest in digests {
        if let Found::Drops(drops) = &digest.found {
            let file = visible(&digest.file);
            all.extend(named(&file, drops).map(|(name, drop)| (name, *drop)));
        }
    }
    counts(digests) + &of_drops(&all)
}

/// Mean e, and the mean of the first rebounds where heights are known.
fn of_drops(named: &[(String, DropDigest)]) -> String {
    let weighed = named.iter().filter(|(_, drop)| measurement(drop).is_some());
    let (names, drops): (Vec<String>, Vec<DropDigest>) = weighed.cloned().unzip();
    let (values, levelled) = levelled(&drops);
    let own = drops.iter().filter_map(measurement);
    let own = own.map(|(e, _)| (!levelled.is_empty()).then_some(e));
    let named_values = names.into_iter().zip(values).zip(own);
    let weighed = |((name, value), own)| Weighed { name, value, own };
    let measured: Vec<Weighed> = named_values.map(weighed).collect();
    let rebounds = rebound::described(named.iter().map(|(_, drop)| drop));
    let (all, without_outliers) = together(&measured);
    all + &levelled + &rebounds + &heights(named) + &without_outliers
}

/// One drop among others.
#[derive(Debug, Clone, PartialEq)]
struct Weighed {
    name: String,
    /// e as it is compared: at the speed of all.
    value: Measurement,
    /// e as it was measured, where that is at another speed.
    own: Option<f64>,
}

/// Of how many drops the height that was given is none; nothing where it fits all.
fn heights(named: &[(String, DropDigest)]) -> String {
    let unfit = named
        .iter()
        .filter(|(_, drop)| drop.is_height_unfit)
        .count();
    if unfit == 0 {
        return String::new();
    }
    let said = format!(
        "  height   does not fit {unfit} of {}: it may be wrong, the ball thrown, or the first impact missing",
        counted(named.len(), "drop")
    );
    wrapped(&said, 11) + "\n"
}

/// e of each drop with its error; where drops from different heights show that e changes with the speed, all at one speed, and
/// a line that says so.
fn levelled(drops: &[DropDigest]) -> (Vec<Measurement>, String) {
    let plain: Vec<Measurement> = drops.iter().filter_map(measurement).collect();
    let members: Vec<Member> = drops
        .iter()
        .filter_map(|drop| groups::member(0, drop))
        .collect();
    let Some(Levelled {
        at_speed_m_per_s,
        slope,
        values,
    }) = Levelled::of(&members)
    else {
        return (plain, String::new());
    };
    let said = format!(
        "  speed    all at {at_speed_m_per_s:.2} m/s: over the drops e changes by {} for a speed greater by a factor of 2.7",
        plus_minus(slope.value, slope.std_error.unwrap_or(0.0))
    );
    let values = values
        .into_iter()
        .zip(plain)
        .map(|(value, (_, std))| (value, std));
    (values.collect(), wrapped(&said, 11) + "\n")
}

/// Drops with their names: that of the file, and of several in it their number.
fn named<'a>(
    file: &'a str,
    drops: &'a [DropDigest],
) -> impl Iterator<Item = (String, &'a DropDigest)> {
    let name = move |i: usize| match drops.len() {
        1 => file.to_owned(),
        _ => format!("{file} drop {}", i + 1),
    };
    drops
        .iter()
        .enumerate()
        .map(move |(i, drop)| (name(i), drop))
}

/// What the drops of one recording say together; nothing of fewer than two with an error.
pub(crate) fn together_of(drops: &[Drop]) -> String {
    let digests = drops.iter().map(DropDigest::from).enumerate();
    let named = digests.map(|(i, drop)| (format!("drop {}", i + 1), drop));
    of_drops(&named.collect::<Vec<_>>())
}

/// The text on a name, in lines no wider than a terminal. The name stays whole, with the spaces in it.
fn line_of(head: &str, name: &str, told: &str, indent: usize) -> String {
    let as_wide = "x".repeat(name.chars().count());
    let line = wrapped(&format!("{head}{as_wide}: {told}"), indent);
    line.replacen(&as_wide, name, 1) + "\n"
}

/// A name that stays in its line and leaves the terminal alone.
pub(crate) fn visible(text: &str) -> String {
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
    let bounces = counted(drop.bounces, "bounce");
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
    weighed(drop.restitution?)
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
    let mut line = counted(digests.len(), "recording") + ", " + &counted(drops, "drop");
    if without > 0 {
        line += &format!("; without a drop: {without}");
    }
    if failed > 0 {
        line += &format!("; failed: {failed}");
    }
    line + "\n"
}

/// What a picture of all drops shows beside each: their mean, and which are far from the rest.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Pooled {
    /// The mean of the drops that have an e with an error, as [`summary`] says it; none of fewer than two.
    pub mean: Option<RandomEffects>,
    /// The outliers among all drops in their order, by their number from 0.
    pub outliers: Vec<usize>,
    /// The mean without them, where there are any and two drops or more are left.
    pub without_outliers: Option<RandomEffects>,
}

impl Pooled {
    /// Of all drops of these recordings.
    #[must_use]
    pub fn of(digests: &[Digest]) -> Self {
        let drops = digests.iter().flat_map(|digest| match &digest.found {
            Found::Drops(drops) => drops.as_slice(),
            _ => &[],
        });
        let weighed = drops.enumerate().filter(|(_, d)| measurement(d).is_some());
        let (numbers, drops): (Vec<usize>, Vec<DropDigest>) = weighed.unzip();
        let (measurements, _) = levelled(&drops);
        let far = outliers(&measurements);
        Self {
            mean: RandomEffects::of(&measurements),
            without_outliers: without(&measurements, &far),
            outliers: far.into_iter().map(|o| numbers[o.index]).collect(),
        }
    }
}

/// The mean without the outliers; none where there are none, or fewer than two drops are left.
fn without(measurements: &[Measurement], far: &[OutlyingMeasurement]) -> Option<RandomEffects> {
    let kept = measurements.iter().enumerate();
    let kept: Vec<Measurement> = kept
        .filter(|(i, _)| far.iter().all(|o| o.index != *i))
        .map(|(_, m)| *m)
        .collect();
    RandomEffects::of(&kept).filter(|_| !far.is_empty())
}

/// The mean of the drops, and that without the outliers if there are any.
fn together(drops: &[Weighed]) -> (String, String) {
    let measurements: Vec<Measurement> = drops.iter().map(|d| d.value).collect();
    let Some(pooled) = RandomEffects::of(&measurements) else {
        return Default::default();
    };
    let mut out = described(&pooled);
    let far = outliers(&measurements);
    for (i, OutlyingMeasurement { index, distance }) in far.iter().enumerate() {
        let Weighed { name, value, own } = &drops[*index];
        let (value, std) = *value;
        let label = match (i, far.len()) {
            (0, 1) => "outlier",
            (0, _) => "outliers",
            _ => "",
        };
        let as_measured = own.map_or_else(
            || plus_minus(value, std),
            |own| {
                let at_speed = format!("{value:.digits$}", digits = digits_for(std));
                format!("{}, at the speed of all {at_speed}", plus_minus(own, std))
            },
        );
        let told = format!(
            "e {as_measured}, {:.1} standard deviations {} the median",
            distance.abs(),
            if *distance > 0.0 { "above" } else { "below" }
        );
        out += &line_of(&format!("  {label:<8} "), name, &told, 11);
    }
    let rest = without(&measurements, &far);
    (
        out,
        rest.as_ref().map_or_else(String::new, |rest| {
            let them = if far.len() == 1 { "it" } else { "them" };
            format!("Without {them}:\n{}", described(rest))
        }),
    )
}

fn degrees(count: usize) -> String {
    let one = if count == 1 { "degree" } else { "degrees" };
    format!("{count} {one} of freedom")
}

fn described(pooled: &RandomEffects) -> String {
    let digits = digits_for(pooled.spread.min(pooled.claimed));
    let spread = format!(
        "  spread   {:.digits$} between drops; their errors alone would make it {:.digits$}",
        pooled.spread, pooled.claimed
    );
    let judged = format!(
        "  compare  the drops differ {} ({})",
        differing(pooled),
        figures(pooled)
    );
    format!(
        "  mean e   {} of {}\n{}\n{}\n",
        plus_minus(pooled.mean, pooled.mean_std),
        counted(pooled.count, "drop"),
        wrapped(&spread, 11),
        wrapped(&judged, 11)
    )
}

/// Whether the drops differ by more than their errors, and by how much.
fn differing(pooled: &RandomEffects) -> String {
    if pooled.chance >= RARE {
        return "no more than their errors explain".to_owned();
    }
    let digits = digits_for(pooled.between);
    format!(
        "more than their errors explain: ball, height, surface or what was heard adds a scatter of {:.digits$}, one standard \
         deviation",
        pooled.between
    )
}

/// What that rests on.
fn figures(pooled: &RandomEffects) -> String {
    let chance = match pooled.chance {
        rare if rare < 0.001 => "below 0.001".to_owned(),
        chance => format!("{chance:.3}"),
    };
    format!(
        "Birge ratio {:.2}, χ² {:.1} for {}, chance {chance}",
        pooled.birge,
        pooled.chi_square,
        degrees(pooled.count - 1)
    )
}

#[cfg(test)]
mod tests;
