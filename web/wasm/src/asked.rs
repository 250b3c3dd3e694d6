//! What the page asks of a recording: settings, a channel, a rule.

use bounce_audio::recording::{Channel, Request};
use bounce_audio::rules::{RULES, Rule, rule};
use bounce_audio::{Error, Settings};
use serde::Deserialize;
use serde_json::json;
use wasm_bindgen::JsError;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::told;

/// The rules that a drop can be judged by, as JSON.
#[must_use]
#[wasm_bindgen]
pub fn rules() -> String {
    let named =
        |rule: &Rule| json!({ "name": rule.name, "about": rule.about, "words": rule.in_words() });
    serde_json::Value::from_iter(RULES.iter().map(named)).to_string()
}

/// What is asked, as the page writes it.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Asked {
    /// Settings by the names of the document.
    pub(crate) settings: Settings,
    /// Number of a channel; the clearest if none is named.
    channel: Option<usize>,
    /// Name of a rule, or limits as of `--rule`.
    rule: Option<String>,
}

impl Asked {
    pub(crate) fn read(text: &str) -> Result<Self, JsError> {
        Ok(serde_json::from_str(text)?)
    }

    pub(crate) fn request(self) -> Result<Request<'static>, JsError> {
        Ok(Request {
            rule: self.rule.as_deref().map(named).transpose().map_err(told)?,
            channel: self.channel.map_or(Channel::Best, Channel::Number),
            settings: self.settings,
            ..Request::default()
        })
    }
}

fn named(text: &str) -> Result<Rule, Error> {
    if text.contains('@') {
        Rule::of_limits(text)
    } else {
        rule(text)
    }
}

#[cfg(test)]
mod tests {
    use bounce_audio::ModelChoice;
    use bounce_audio::rules::RULES;

    use super::{Asked, named};

    #[test]
    fn a_rule_is_asked_by_its_name_or_by_limits() {
        for known in RULES {
            assert_eq!(named(known.name).unwrap().name, known.name);
        }
        let own = named("rebound=1.35..1.47@2.54m,0.0577kg,0.067m").unwrap();
        assert_eq!(own.allowed_m, [1.35, 1.47]);
        assert!(named("golf").is_err());
    }

    #[test]
    fn what_is_not_asked_has_its_default() {
        let asked: Asked = serde_json::from_str(r#"{"settings": {"model": "drag"}}"#).unwrap();
        assert_eq!(asked.settings.model, ModelChoice::Drag);
        assert_eq!((asked.channel, asked.rule), (None, None));
        assert!(serde_json::from_str::<Asked>(r#"{"chanel": 1}"#).is_err());
    }
}
