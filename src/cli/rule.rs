//! `--rule`: the rebound that a rule book asks for.

use std::ffi::OsStr;
use std::slice;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::error::ErrorKind;
use clap::{Arg, Args, Command};

use super::known::Known;
use crate::report::Report;
use crate::report::rule::Outcome;
use crate::report::text::Detail;
use crate::rules::{RULES, Rule, rule};

/// Which rule to judge by.
#[derive(Debug, Args)]
#[command(next_help_heading = "Rule books")]
pub(super) struct RuleArguments {
    /// Judge the rebound that a rule book asks for, from its height and with the drag of the air; mass and diameter are
    /// those of the rule where --mass and --diameter do not say. Limits of your own: e=0.75..0.80@254cm,57.7g,67mm, or
    /// rebound=135..147cm@…, resilience=40..50%@…, with height of release, mass and diameter
    #[arg(long, value_name = "RULE", value_parser = Rules)]
    pub rule: Option<Rule>,
}

impl RuleArguments {
    /// The exit status of a report: that of a verdict, where one was asked for and everything else went well.
    pub(super) fn status(&self, report: &Report, otherwise: u8) -> u8 {
        let outcomes = report.rule.iter().flat_map(|rule| &rule.drops);
        let verdict = outcomes.map(|judged| status(judged.outcome));
        // A drop that fails says more than one that is undecided, and stands first.
        let worst = verdict.filter(|s| *s > 0).min();
        if otherwise > 0 {
            otherwise
        } else {
            worst.unwrap_or(0)
        }
    }

    /// What the text of a report ends with where the ball is the rule's.
    pub(super) fn ball(&self, known: &Known, report: &Report, detail: Detail) -> String {
        if self.rule.is_none() || report.drops.is_empty() || detail == Detail::Answer {
            return String::new();
        }
        ball_of_rule(slice::from_ref(known))
    }
}

/// What of the ball is the rule's, by what is known of each drop: with mass and diameter e is a little another than without, and
/// a user who compares both asks why.
pub(super) fn ball_of_rule(known: &[Known]) -> String {
    let without = |of: fn(&Known) -> Option<f64>| known.iter().filter(|k| of(k).is_none()).count();
    let missing = [without(|k| k.mass), without(|k| k.diameter)];
    let (what, options) = match missing {
        [0, 0] => return String::new(),
        [_, 0] => ("The mass is", "--mass"),
        [0, _] => ("The diameter is", "--diameter"),
        _ => ("Mass and diameter are", "--mass, --diameter"),
    };
    let of_some = missing.iter().any(|m| (1..known.len()).contains(m));
    let unless = if of_some { " where none is given" } else { "" };
    format!("\n{what} the rule's{unless}, for the drag in e too ({options})\n")
}

/// 0 for a pass, 3 for a fail, 4 where it is undecided.
pub(super) const fn status(outcome: Outcome) -> u8 {
    match outcome {
        Outcome::Pass => 0,
        Outcome::Fail => 3,
        Outcome::Undecided => 4,
    }
}

/// Names, of which the help says what they stand for and where, and limits of one's own.
#[derive(Debug, Clone, Copy)]
struct Rules;

impl TypedValueParser for Rules {
    type Value = Rule;

    fn parse_ref(
        &self,
        command: &Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<Rule, clap::Error> {
        let said = |text: String| {
            clap::Error::raw(ErrorKind::ValueValidation, text + "\n").with_cmd(command)
        };
        match value.to_str() {
            Some(limits) if limits.contains(['=', '@']) => {
                Rule::of_limits(limits).map_err(|e| said(e.to_string()))
            }
            Some(name) => rule(name).map_err(|_| said(no_rule(name))),
            None => names().parse_ref(command, argument, value),
        }
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(named()))
    }
}

fn named() -> impl Iterator<Item = PossibleValue> {
    let named = |rule: &Rule| PossibleValue::new(rule.name).help(rule.in_words());
    RULES.iter().map(named)
}

/// That there is no such rule, and those whose words it may stand for: `tabletennis` for `table tennis ball`.
fn no_rule(name: &str) -> String {
    let letters = |text: &str| -> String {
        let letters = text.chars().filter(|c| c.is_alphanumeric());
        letters.flat_map(char::to_lowercase).collect()
    };
    let wanted = letters(name);
    let meant =
        |rule: &&Rule| letters(&format!("{} {}", rule.name, rule.in_words())).contains(&wanted);
    let offered = RULES.iter().filter(meant).map(|rule| rule.name);
    let offered: Vec<&str> = offered.filter(|_| !wanted.is_empty()).collect();
    if offered.is_empty() {
        let all: Vec<&str> = RULES.iter().map(|rule| rule.name).collect();
        format!(
            "no rule is called '{name}'. There are {}; --help says what they ask for. Limits of your own look like \
             e=0.75..0.80@254cm,57.7g,67mm",
            all.join(", ")
        )
    } else {
        format!(
            "no rule is called '{name}'. Do you mean {}?",
            offered.join(" or ")
        )
    }
}

fn names() -> impl TypedValueParser<Value = Rule> {
    PossibleValuesParser::new(named()).try_map(|name| rule(&name))
}
