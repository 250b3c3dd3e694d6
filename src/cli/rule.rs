//! `analyze --rule`: the rebound that a rule book asks for.

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

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

/// Names, of which the help says what they stand for and where.
fn names() -> impl TypedValueParser<Value = Rule> {
    let values = RULES
        .iter()
        .map(|rule| PossibleValue::new(rule.name).help(rule.in_words()));
    PossibleValuesParser::new(values).try_map(|name| rule(&name))
}
