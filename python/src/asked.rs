//! What is asked of a recording: settings as a JSON document, a channel, a rule, what to predict.

use bounce_audio::analysis::{Question, predict};
use bounce_audio::report::rule::RuleReport;
use bounce_audio::rules::{Rule, judge, rule};
use bounce_audio::{Drop, Error, Settings};
use pyo3::{PyErr, PyResult};
use serde_json::{Map, Value};

use crate::errors::{ArgumentError, raised};

/// What is asked.
#[derive(Debug, Clone)]
pub(crate) struct Asked {
    pub settings: Settings,
    pub rule: Option<Rule>,
    question: Option<Question>,
}

impl Asked {
    /// By a document of settings and predictions, with what the rule says of the ball where the settings do not.
    pub(crate) fn new(document: &str, rule_name: Option<&str>) -> PyResult<Self> {
        let mut document = serde_json::from_str(document).map_err(|e| no_settings(&e))?;
        let question = question(&mut document)?;
        let settings = serde_json::from_value(document.into());
        let mut settings: Settings = settings.map_err(|e| no_settings(&e))?;
        let rule = rule_name.map(|name| rule(name).map_err(|_| unknown(name)));
        let rule = rule.transpose()?;
        if let Some(rule) = &rule {
            let ball = rule.ball(settings.mass_kg, settings.diameter_m);
            settings.mass_kg = Some(ball.mass_kg);
            settings.diameter_m = Some(ball.diameter_m);
        }
        Ok(Self {
            settings,
            rule,
            question,
        })
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

    /// Adds to a drop what it predicts, if that was asked.
    pub(crate) fn predict(&self, drop: &mut Drop) {
        if let Some(question) = &self.question {
            drop.prediction = predict(drop, &self.settings, question);
        }
    }
}

/// Takes out of a document what is to be predicted.
fn question(document: &mut Map<String, Value>) -> PyResult<Option<Question>> {
    let from_m = height(document, "predict_from_m")?;
    let reach_m = height(document, "reach_m")?;
    let reach_bounce = number(document, "reach_bounce")?;
    if let (Some(bounce), None) = (reach_bounce, reach_m) {
        let said = format!("reach_bounce is {bounce} without reach_m, the height that it reaches");
        return Err(ArgumentError::new_err(said));
    }
    let bounce = bounce(reach_bounce)?;
    let question = Question {
        from_m,
        reach: reach_m.map(|height_m| (bounce, height_m)),
    };
    Ok((question != Question::default()).then_some(question))
}

/// A height that a ball can be dropped from.
fn height(document: &mut Map<String, Value>, name: &'static str) -> PyResult<Option<f64>> {
    let Some(height_m) = number(document, name)? else {
        return Ok(None);
    };
    let checked = Settings::default().height_m(height_m).check();
    let named = checked.map_err(|error| match error {
        Error::Argument { got, expected, .. } => Error::Argument {
            argument: name,
            got,
            expected,
        },
        other => other,
    });
    named.map_err(raised)?;
    Ok(Some(height_m))
}

/// The number of a bounce, which is 2 where none is given.
fn bounce(number: Option<f64>) -> PyResult<usize> {
    let asked = number.unwrap_or(2.0);
    let bounce = (1..=10_u8).find(|&n| f64::from(n) == asked);
    bounce
        .map(usize::from)
        .ok_or_else(|| ArgumentError::new_err(format!("reach_bounce is {asked}, expected 1 to 10")))
}

fn number(document: &mut Map<String, Value>, name: &str) -> PyResult<Option<f64>> {
    match document.remove(name) {
        None | Some(Value::Null) => Ok(None),
        Some(value) => value
            .as_f64()
            .map(Some)
            .ok_or_else(|| ArgumentError::new_err(format!("{name} is {value}, expected a number"))),
    }
}

fn no_settings(error: &serde_json::Error) -> PyErr {
    let said = error.to_string();
    // The place in a document that the user did not write.
    let said = said.split(" at line ").next().unwrap_or_default();
    ArgumentError::new_err(format!("settings: {said}"))
}

fn unknown(name: &str) -> PyErr {
    ArgumentError::new_err(format!(
        "rule is '{name}', expected a name of bounce_audio.rules()"
    ))
}
