//! What is asked of a recording: settings as a JSON document, a channel, a rule.

use bounce_audio::report::rule::RuleReport;
use bounce_audio::rules::{Rule, judge, rule};
use bounce_audio::{Drop, Error, Settings};
use pyo3::PyResult;

use crate::errors::ArgumentError;

/// Reads settings by the names of the document.
pub(crate) fn settings(document: &str) -> PyResult<Settings> {
    serde_json::from_str(document).map_err(|e| {
        let said = e.to_string();
        // The place in a document that the user did not write.
        let said = said.split(" at line ").next().unwrap_or_default();
        ArgumentError::new_err(format!("settings: {said}"))
    })
}

/// What is asked.
#[derive(Debug, Clone)]
pub(crate) struct Asked {
    pub settings: Settings,
    pub rule: Option<Rule>,
}

impl Asked {
    /// With what the rule says of the ball where the settings do not.
    pub(crate) fn new(document: &str, rule_name: Option<&str>) -> PyResult<Self> {
        let mut settings = settings(document)?;
        let rule = rule_name.map(|name| rule(name).map_err(|_| unknown(name)));
        let rule = rule.transpose()?;
        if let Some(rule) = &rule {
            let ball = rule.ball(settings.mass_kg, settings.diameter_m);
            settings.mass_kg = Some(ball.mass_kg);
            settings.diameter_m = Some(ball.diameter_m);
        }
        Ok(Self { settings, rule })
    }

    /// The verdict of the rule on drops, if one was asked for.
    pub(crate) fn judged(&self, drops: &[Drop]) -> Result<Option<RuleReport>, Error> {
        let settings = &self.settings;
        let verdict = self.rule.map(|rule| {
            let ball = rule.ball(settings.mass_kg, settings.diameter_m);
            judge(&rule, drops, ball, settings.gravity_m_per_s2)
        });
        verdict.transpose()
    }
}

fn unknown(name: &str) -> pyo3::PyErr {
    ArgumentError::new_err(format!(
        "rule is '{name}', expected a name of bounce_audio.rules()"
    ))
}
