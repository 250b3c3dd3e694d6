//! The table of the trials.

use super::trial::{Played, Trial};

/// A drop is told in time within this, in seconds.
const IN_TIME_S: f64 = 1.0;

pub(crate) fn heading(each: bool) -> &'static str {
    if each {
        "| room | drop | bounces | told after (s) | e, true | e, told | ± | e, saved | off by (±) |\n|---|---|---|---|---|---|---|---|---|"
    } else {
        "| room | told | within 1 s | once | corrected | twice or false | told after, median and longest (s) | e within its error of `analyze` on the saved WAV | holds the true e (95 %) | of a core |\n|---|---|---|---|---|---|---|---|---|---|"
    }
}

pub(crate) fn row(room: &str, trial: &Trial) -> String {
    let drops = &trial.drops;
    let count = |of: &dyn Fn(&Played) -> bool| drops.iter().filter(|d| of(d)).count();
    let mut after: Vec<f64> = drops.iter().filter_map(first_after_s).collect();
    after.sort_by(f64::total_cmp);
    let median = after.get(after.len() / 2).copied().unwrap_or(f64::NAN);
    let longest = after.last().copied().unwrap_or(f64::NAN);
    let extra: usize = drops.iter().map(|d| numbers(d).saturating_sub(1)).sum();
    let cost = trial
        .cost
        .map_or("?".to_owned(), |c| format!("{:.0} %", 100.0 * c));
    format!(
        "| {room} | {} of {} | {} | {} | {} | {} | {median:.2}, {longest:.2} | {} | {} | {cost} |",
        count(&|d| !d.told.is_empty()),
        drops.len(),
        count(&|d| first_after_s(d).is_some_and(|s| s <= IN_TIME_S)),
        count(&|d| d.told.len() == 1),
        count(&|d| d.told.len() > 1 && numbers(d) == 1),
        extra + trial.false_drops,
        count(&|d| off(d).is_some_and(|off| off <= 1.0)),
        count(&holds),
    )
}

pub(crate) fn drops(room: &str, trial: &Trial) -> String {
    let mut text = String::new();
    for (i, played) in trial.drops.iter().enumerate() {
        let Some((e, std)) = told_e(played) else {
            text += &format!(
                "| {room} | {} | – | – | {:.4} | – | – | – | – |\n",
                i + 1,
                played.truth
            );
            continue;
        };
        let after: Vec<String> = played.told.iter().map(|(s, _)| format!("{s:.2}")).collect();
        text += &format!(
            "| {room} | {} | {} | {} | {:.4} | {e:.4} | {std:.4} | {:.4} | {:.2} |\n",
            i + 1,
            played.told[played.told.len() - 1].1.drop.bounces,
            after.join(", "),
            played.truth,
            saved_e(played).unwrap_or(f64::NAN),
            off(played).unwrap_or(f64::NAN),
        );
    }
    text + &format!("| {room} | false: {} | | | | | | | |\n", trial.false_drops)
}

fn first_after_s(played: &Played) -> Option<f64> {
    played.told.first().map(|(after_s, _)| *after_s)
}

/// How many numbers it was told by.
fn numbers(played: &Played) -> usize {
    let mut numbers: Vec<usize> = played.told.iter().map(|(_, t)| t.number).collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers.len()
}

/// e and its standard error as told last.
fn told_e(played: &Played) -> Option<(f64, f64)> {
    let (_, told) = played.told.last()?;
    let e = told.drop.restitution.as_ref()?.estimate;
    Some((e.value, e.std_error?))
}

fn saved_e(played: &Played) -> Option<f64> {
    let e = played.saved.as_ref()?.restitution.as_ref()?;
    Some(e.estimate.value)
}

/// Distance of e as told from that of the saved sound, in standard errors.
fn off(played: &Played) -> Option<f64> {
    let (e, std) = told_e(played)?;
    Some((e - saved_e(played)?).abs() / std)
}

fn holds(played: &Played) -> bool {
    let told = played
        .told
        .last()
        .and_then(|(_, t)| t.drop.restitution.as_ref());
    let interval = told.and_then(|e| e.estimate.interval95);
    interval.is_some_and(|[low, high]| (low..=high).contains(&played.truth))
}
