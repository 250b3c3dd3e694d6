//! A row for each recording, and the sum of all.

use bounce_audio::{Analysis, Settings, analyze_clearest};

use super::compare::{Difference, difference};
use super::parallel::each;
use super::recording::Recording;
use super::source::Source;
use super::variants::{CHANGES, Change, Pauses, Variant};

/// What is to be reached: no e moves by more of its standard error, and the median by no more.
const GOAL: (f64, f64) = (0.25, 0.02);

/// Quiet is sought so far from the impacts, in seconds.
const APART_S: f64 = 0.05;

/// What became of one recording.
struct Row {
    name: String,
    drops: usize,
    of_changes: Vec<(Change, Difference)>,
}

pub(crate) fn print(sources: &[Source]) {
    println!(
        "recording                     | variants | drops | e off by std: worst | median | impacts lost | gained | drops lost | gained | t off by std: worst | worst by"
    );
    let rows = each(sources, row);
    for row in &rows {
        println!("{}", line(row));
    }
    println!("{}", sum(&rows));
}

fn analysis(recording: &Recording) -> Analysis {
    let settings = Settings::default();
    let heard = analyze_clearest(&recording.channels, recording.rate, &settings);
    heard.unwrap().1
}

fn row(source: &Source) -> Row {
    let original = source.recording();
    let answer = analysis(&original);
    let pauses = pauses(&original, &answer);
    let variants = CHANGES.iter().filter_map(|&change| {
        let variant = change.of(&original, &pauses)?;
        Some((change, compared(&answer, &variant)))
    });
    Row {
        name: source.name(),
        drops: answer.drops.len(),
        of_changes: variants.collect(),
    }
}

fn compared(answer: &Analysis, variant: &Variant) -> Difference {
    let rate = variant.recording.rate;
    let until_s = variant.until as f64 / rate;
    let other = analysis(&variant.recording);
    let drops = other.drops.iter();
    let drops = drops.filter(|d| d.impacts.first().is_some_and(|i| i.time_s < until_s));
    difference(answer, drops, variant.shift as f64 / rate)
}

fn pauses(original: &Recording, answer: &Analysis) -> Pauses {
    let sample = |time_s: f64| original.samples_in(time_s.max(0.0));
    let spans = answer.drops.iter().filter_map(|drop| {
        let (first, last) = (drop.impacts.first()?, drop.impacts.last()?);
        Some(sample(first.time_s)..sample(last.time_s))
    });
    let spans: Vec<_> = spans.collect();
    let around = |s: &std::ops::Range<usize>| {
        let margin = sample(APART_S);
        s.start.saturating_sub(margin)..s.end + margin
    };
    let sounding: Vec<_> = spans.iter().map(around).collect();
    let first = spans.iter().map(|s| s.start).min();
    let last = spans.iter().map(|s| s.end).max();
    Pauses {
        drops: first.zip(last).map(|(first, last)| first..last),
        quiet: original.quietest(&sounding),
    }
}

fn line(row: &Row) -> String {
    let differences = row.of_changes.iter().map(|(_, d)| d);
    let count = |of: fn(&Difference) -> usize| differences.clone().map(of).sum::<usize>();
    let mut off = off(std::slice::from_ref(row));
    let time = differences.clone().map(|d| d.time).fold(0.0, f64::max);
    let by = row.of_changes.iter().max_by(|(_, a), (_, b)| {
        let key = |d: &Difference| (d.drops_lost + d.drops_gained, d.restitution());
        let (a, b) = (key(a), key(b));
        a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
    });
    format!(
        "{:<29} | {:>8} | {:>5} | {:>19.3} | {:>6.3} | {:>12} | {:>6} | {:>10} | {:>6} | {time:>19.2} | {}",
        row.name,
        row.of_changes.len(),
        row.drops,
        off.iter().copied().fold(0.0, f64::max),
        median(&mut off),
        count(|d| d.impacts_lost),
        count(|d| d.impacts_gained),
        count(|d| d.drops_lost),
        count(|d| d.drops_gained),
        by.map_or_else(String::new, |(change, _)| change.to_string()),
    )
}

/// All differences of e.
fn off(rows: &[Row]) -> Vec<f64> {
    let differences = rows.iter().flat_map(|r| &r.of_changes);
    differences
        .flat_map(|(_, d)| d.restitutions.iter().copied())
        .collect()
}

fn sum(rows: &[Row]) -> String {
    let mut off = off(rows);
    let differences = || rows.iter().flat_map(|r| &r.of_changes).map(|(_, d)| d);
    let count = |of: fn(&Difference) -> usize| differences().map(of).sum::<usize>();
    let (lost, gained) = (count(|d| d.drops_lost), count(|d| d.drops_gained));
    let worst = off.iter().copied().fold(0.0, f64::max);
    let beyond = off.iter().filter(|&&x| x > GOAL.0).count();
    let share = 100.0 * beyond as f64 / off.len().max(1) as f64;
    let recordings = rows.iter().filter(|row| {
        let mut all = row.of_changes.iter();
        all.all(|(_, d)| d.restitution() <= GOAL.0 && d.drops_lost + d.drops_gained == 0)
    });
    let (held, all) = (recordings.count(), rows.len());
    let median = median(&mut off);
    let is_met = worst <= GOAL.0 && median <= GOAL.1 && lost + gained == 0;
    format!(
        "\nof {} variants: e off by {worst:.3} of its standard error at worst, {median:.3} in the median, {share:.1} % by \
         more than {}\nimpacts lost {}, gained {}; drops lost {lost}, gained {gained}\n{held} of {all} recordings keep all \
         drops and e\ngoal (worst {}, median {}, no drop lost or gained): {}",
        differences().count(),
        GOAL.0,
        count(|d| d.impacts_lost),
        count(|d| d.impacts_gained),
        GOAL.0,
        GOAL.1,
        if is_met { "met" } else { "not met" },
    )
}

/// The upper median, 0 of nothing; sorts.
fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or_default()
}
