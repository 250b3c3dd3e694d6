//! The report: results as data. Formats are pure functions of it.
//!
//! Field names are those of the JSON document and a contract: more may be added, none renamed.

mod ball;
pub mod batch;
mod candidate;
pub mod csv;
pub mod curve;
pub mod drops;
mod estimates;
pub mod html;
mod impact;
mod irregular;
pub mod json;
pub mod labels;
mod model;
mod numbers;
mod prediction;
mod rebound;
mod rejected;
mod release;
pub mod rule;
mod settings;
pub mod text;
pub mod times;
mod warning;
mod wrap;

pub use crate::impact::Status;
pub use ball::{Ball, ContactSource};
pub use candidate::{Candidate, Lack};
pub use estimates::{Estimates, Method, Restitution, Scatter};
pub use impact::{Bounce, Impact};
pub use irregular::{Irregular, Kind as IrregularKind};
pub use model::{Given, Model, Parameters};
pub(crate) use numbers::{counted, decimals, listed, short, short_decimals};
pub(crate) use prediction::HIGHEST;
pub use prediction::{Prediction, Reach, Rebounds};
pub use rebound::Rebound;
pub use rejected::{RejectReason, Rejected};
pub use release::Release;
pub use settings::Settings;
pub(crate) use text::{heard, model_name, range, restitution};
pub(crate) use warning::{GIVE_HEIGHT, LISTEN_TO_PART, doubt_height};
pub use warning::{Warning, WarningCode};
pub(crate) use wrap::wrapped_to;

use serde::{Deserialize, Deserializer, Serialize};

use crate::fit::model::Budget;

/// Version of the JSON document.
pub const SCHEMA_VERSION: u32 = 1;

/// Everything about one recording.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Report {
    /// Version of the document's form.
    pub schema_version: u32,
    /// Name of the file as it was given.
    pub file: String,
    /// The recording itself.
    pub recording: RecordingInfo,
    /// The settings asked for.
    pub settings: Settings,
    /// The drops in order of time.
    pub drops: Vec<Drop>,
    /// What comes nearest to a drop where there is none; null if nothing does.
    #[serde(default)]
    pub candidate: Option<Candidate>,
    /// Strong events outside any drop.
    pub rejected: Vec<Rejected>,
    /// How many weaker events were left out without being listed.
    pub rejected_weak: usize,
    /// The verdict of a rule book on the drops; null unless that was asked for.
    pub rule: Option<rule::RuleReport>,
    /// Warnings about the recording.
    pub warnings: Vec<Warning>,
}

impl Report {
    /// The report on a recording of this name with these settings, and what a rule book says of it if one was asked.
    #[must_use]
    pub fn new(
        file: String,
        recording: RecordingInfo,
        settings: Settings,
        analysis: Analysis,
        rule: Option<rule::RuleReport>,
    ) -> Self {
        Self {
            schema_version: SCHEMA_VERSION,
            file,
            recording,
            settings,
            drops: analysis.drops,
            candidate: analysis.candidate,
            rejected: analysis.rejected,
            rejected_weak: analysis.rejected_weak,
            rule,
            warnings: analysis.warnings,
        }
    }

    /// The impacts to put labels at: those of each drop, or of what comes nearest to one.
    #[must_use]
    pub fn to_be_labelled(&self) -> Vec<&[Impact]> {
        let drops = self.drops.iter().map(|drop| drop.impacts.as_slice());
        let candidate = self.candidate.iter().map(|c| c.impacts.as_slice());
        drops.chain(candidate).collect()
    }

    /// Why there is no drop, in a sentence.
    #[must_use]
    pub(crate) fn why_none(&self) -> &str {
        let reason = self.warnings.first();
        reason.map_or("no drop found", |warning| &warning.message)
    }
}

/// The recording as it was read.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RecordingInfo {
    /// Samples per second.
    pub sample_rate_hz: f64,
    /// How many channels there are.
    pub channels: usize,
    /// The one that most drops were heard on, counted from 1.
    pub channel: usize,
    /// Seconds.
    pub duration_s: f64,
    /// How samples are stored.
    pub encoding: String,
}

impl RecordingInfo {
    /// A recording of one channel, of this length at this rate, whose samples are stored so.
    #[must_use]
    pub fn new(sample_rate_hz: f64, duration_s: f64, encoding: impl Into<String>) -> Self {
        Self {
            sample_rate_hz,
            channels: 1,
            channel: 1,
            duration_s,
            encoding: encoding.into(),
        }
    }

    /// The same with the number of the channel that most drops were heard on, from 1, of so many.
    #[must_use]
    pub fn with_channel(self, channel: usize, channels: usize) -> Self {
        Self {
            channels,
            channel,
            ..self
        }
    }
}

/// The drops and events of a recording.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Analysis {
    /// The drops in order of time.
    pub drops: Vec<Drop>,
    /// What comes nearest to a drop where there is none.
    pub candidate: Option<Candidate>,
    /// Strong events outside any drop.
    pub rejected: Vec<Rejected>,
    /// How many weaker events were left out without being listed.
    pub rejected_weak: usize,
    /// Warnings about the recording.
    pub warnings: Vec<Warning>,
}

/// One drop.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Drop {
    /// The channel it was heard on, counted from 1: the one in which impacts stood out most then.
    pub channel: usize,
    /// The impacts in order of time.
    pub impacts: Vec<Impact>,
    /// How many were heard, doubtful ones included.
    pub bounces: usize,
    /// From the first impact to the last, in seconds.
    pub observed_time_s: f64,
    /// From release to rest, in seconds; null without a height, a first impact or an end.
    pub total_time_s: Option<f64>,
    /// The answer.
    pub restitution: Option<Restitution>,
    /// Several ways to it, side by side.
    pub estimates: Estimates,
    /// The rebound after the first impact; null without a height, or where the first flight does not fit it.
    #[serde(default)]
    pub first_rebound: Option<Rebound>,
    /// The release by the first flights; null where they do not tell.
    #[serde(default)]
    pub release: Option<Release>,
    /// What another drop of the ball would do; left out unless that was asked.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub prediction: Option<Prediction>,
    /// How much times and bounces scatter.
    pub scatter: Scatter,
    /// Which model the answer rests on.
    pub model: Model,
    /// The ball as spring and damper; null unless its contact time is known within a factor of 3.
    pub ball: Option<Ball>,
    /// Where the error of e comes from, as shares that make 1; null where e has none.
    pub budget: Option<Budget>,
    /// Evidence that this is a drop and no chance, in nats; infinite, null in JSON, where a person set the impacts.
    #[serde(deserialize_with = "infinite_where_null")]
    pub evidence_nats: f64,
    /// Bounces that do not go by the e of the others, in order of time.
    #[serde(default)]
    pub irregular: Vec<Irregular>,
    /// Strong events between the impacts that are none.
    pub rejected: Vec<Rejected>,
    /// Warnings about this drop.
    pub warnings: Vec<Warning>,
}

#[cfg(test)]
impl Drop {
    /// A drop of which nothing is known.
    pub(crate) fn empty() -> Self {
        Self {
            channel: 1,
            impacts: Vec::new(),
            bounces: 0,
            observed_time_s: 0.0,
            total_time_s: None,
            restitution: None,
            estimates: Estimates {
                flight_ratio: None,
                eq25: None,
                eq30: None,
                first_rebound: None,
            },
            first_rebound: None,
            release: None,
            prediction: None,
            scatter: Scatter {
                timing_std_s: None,
                bounce_std: None,
            },
            model: Model::default(),
            ball: None,
            budget: None,
            evidence_nats: 0.0,
            irregular: Vec::new(),
            rejected: Vec::new(),
            warnings: Vec::new(),
        }
    }
}

fn infinite_where_null<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Option::deserialize(deserializer).map(|number| number.unwrap_or(f64::INFINITY))
}

#[cfg(all(test, feature = "lab"))]
mod tests;
