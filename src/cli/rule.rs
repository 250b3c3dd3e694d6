//! `analyze --rule`: the rebound that a rule book asks for.

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use crate::Error;
use crate::analysis::Settings;
use crate::report::Report;
use crate::rules::{RULES, Rule, judge, rule};

/// Which rule to judge by.
#[derive(Debug, Args)]
#[command(next_help_heading = "Rule books")]
pub(super) struct RuleArguments {
    /// Judge the rebound that a rule book asks for, from its height and with the drag of the air; mass and diameter are
    /// those of the rule where --mass and --diameter do not say
    #[arg(long, value_name = "RULE", value_parser = names())]
    rule: Option<Rule>,
}

/// Names, of which the help says what they stand for and where.
fn names() -> impl TypedValueParser<Value = Rule> {
    let values = RULES
        .iter()
        .map(|rule| PossibleValue::new(rule.name).help(rule.in_words()));
    PossibleValuesParser::new(values).try_map(|name| rule(&name))
}

impl RuleArguments {
    /// What the rule says of the ball, where the settings do not.
    pub(super) fn complete(&self, settings: &mut Settings) {
        if let Some(rule) = &self.rule {
            let ball = rule.ball(settings.mass_kg, settings.diameter_m);
            settings.mass_kg = Some(ball.mass_kg);
            settings.diameter_m = Some(ball.diameter_m);
        }
    }

    /// A report that was made with these settings, with the verdict.
    pub(super) fn judge(&self, report: Report) -> Result<Report, Error> {
        let judged = self.rule.map(|rule| {
            let settings = &report.settings;
            let ball = rule.ball(settings.mass_kg, settings.diameter_m);
            judge(&rule, &report.drops, ball, settings.gravity_m_per_s2)
        });
        let judged = judged.transpose()?;
        Ok(report.with_rule(judged))
    }
}
