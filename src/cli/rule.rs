//! `--rule`: the rebound that a rule book asks for.

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::report::Report;
use crate::report::rule::Outcome;
use crate::rules::{RULES, Rule, rule};

/// Which rule to judge by.
#[derive(Debug, Args)]
#[command(next_help_heading = "Rule books")]
pub(super) struct RuleArguments {
    /// Judge the rebound that a rule book asks for, from its height and with the drag of the air; mass and diameter are
    /// those of the rule where --mass and --diameter do not say
    #[arg(long, value_name = "RULE", value_parser = names())]
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
}

/// 0 for a pass, 3 for a fail, 4 where it is undecided.
pub(super) const fn status(outcome: Outcome) -> u8 {
    match outcome {
        Outcome::Pass => 0,
        Outcome::Fail => 3,
        Outcome::Undecided => 4,
    }
}

/// Names, of which the help says what they stand for and where.
fn names() -> impl TypedValueParser<Value = Rule> {
    let values = RULES
        .iter()
        .map(|rule| PossibleValue::new(rule.name).help(rule.in_words()));
    PossibleValuesParser::new(values).try_map(|name| rule(&name))
}
