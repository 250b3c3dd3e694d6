//! What a rule book says of the balls of a batch and of the lot, in words.

use super::super::numbers::{counted, listed_words};
use super::super::rebound::Unit;
use super::super::rule::{BallJudged, LotJudged, Outcome};
use super::super::wrap::wrapped;
use super::visible;

/// The verdict on a lot, then the balls that do not pass. Where no ball is named each recording stands for one; `naming` then
/// says how to name them.
#[must_use]
pub fn verdict(lot: &LotJudged, naming: Option<&str>) -> String {
    let unit = Unit::of(lot.drop_height_m);
    let [low, high] = lot.allowed_m.map(|m| format!("{:.0}", unit.per_m * m));
    let mut lines = vec![format!(
        "Rule {}: {low} to {high} {} from {:.0} {} ({})",
        lot.name,
        unit.name,
        unit.per_m * lot.drop_height_m,
        unit.name,
        lot.source
    )];
    let why = lot
        .why
        .as_ref()
        .map_or_else(String::new, |why| format!(": {why}"));
    lines.push(format!("  lot      {}{why}", lot.outcome));
    lines.push(format!("  balls    {}", counts(&lot.balls, naming)));
    let worst = lot
        .balls
        .iter()
        .filter(|ball| ball.outcome != Outcome::Pass);
    for ball in worst {
        lines.push(format!("  {:<9}{}", word(ball.outcome), one(ball, unit)));
    }
    lines.iter().map(|line| wrapped(line, 11) + "\n").collect()
}

const fn word(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Pass => "passes",
        Outcome::Fail => "fails",
        Outcome::Undecided => "open",
    }
}

fn counts(balls: &[BallJudged], naming: Option<&str>) -> String {
    let of = |outcome: Outcome| balls.iter().filter(|b| b.outcome == outcome).count();
    let kinds = [
        (Outcome::Pass, "pass"),
        (Outcome::Fail, "fail"),
        (Outcome::Undecided, "undecided"),
    ];
    let said = kinds.map(|(outcome, word)| (of(outcome), word));
    let said = said.into_iter().filter(|(count, _)| *count > 0);
    let said: Vec<String> = said
        .map(|(count, word)| format!("{count} {word}"))
        .collect();
    let said = listed_words(&said);
    match naming {
        None => format!("{}: {said}", counted(balls.len(), "ball")),
        Some(naming) => {
            let recordings = counted(balls.len(), "recording");
            format!("{recordings}, a ball each: {said} ({naming})")
        }
    }
}

fn one(ball: &BallJudged, unit: Unit) -> String {
    let name = visible(&ball.name);
    let rebound = match ball.rebound_m {
        Some(mean) => unit.plus_minus(mean.value, mean.std_error.unwrap_or(0.0)),
        None => "no rebound".to_owned(),
    };
    let why = ball
        .why
        .as_ref()
        .map_or_else(String::new, |why| format!(": {why}"));
    format!("{name}: {rebound}, {}{why}", counted(ball.drops, "drop"))
}
