//! The report: results as data. Formats are pure functions of it.
//!
//! Field names are those of the JSON document and a contract: more may be added, none renamed.

pub mod batch;
pub mod csv;
pub mod drops;
pub mod json;
pub mod labels;
mod model;
pub mod rule;
mod settings;
mod table;
pub mod text;
mod warning;
mod wrap;

pub use crate::impact::Status;
pub use model::{Given, Model, Parameters};
pub use settings::Settings;
pub(crate) use table::decimals;
pub(crate) use text::{model_name, with_error};
pub use warning::{Warning, WarningCode};

use serde::{Deserialize, Deserializer, Serialize};

use crate::fit::Estimate;
use crate::fit::model::Budget;
use crate::physics::ReleaseRule;
use crate::words::words;

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
            rejected: analysis.rejected,
            rejected_weak: analysis.rejected_weak,
            rule,
            warnings: analysis.warnings,
        }
    }

    /// Why there is no drop, in a sentence.
    fn why_none(&self) -> &str {
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
    /// How much times and bounces scatter.
    pub scatter: Scatter,
    /// Which model the answer rests on.
    pub model: Model,
    /// Stiffness and damping; null until a contact time is known.
    pub ball: Option<Ball>,
    /// Where the error of e comes from, as shares that make 1; null where e has none.
    pub budget: Option<Budget>,
    /// Evidence that this is a drop and no chance, in nats; infinite, null in JSON, where a person set the impacts.
    #[serde(deserialize_with = "infinite_where_null")]
    pub evidence_nats: f64,
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
            scatter: Scatter {
                timing_std_s: None,
                bounce_std: None,
            },
            model: Model::default(),
            ball: None,
            budget: None,
            evidence_nats: 0.0,
            rejected: Vec::new(),
            warnings: Vec::new(),
        }
    }
}

/// One impact and the flight after it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Impact {
    /// Seconds from the first sample.
    pub time_s: f64,
    /// Standard error of the time in seconds; null where it is inferred.
    pub time_std_s: Option<f64>,
    /// Peak of its sound below full scale; null where it is inferred or silent.
    pub level_db: Option<f64>,
    /// To the next impact, in seconds; null for the last, and where either end is inferred.
    pub interval_s: Option<f64>,
    /// That interval over the one before.
    pub ratio: Option<f64>,
    /// Height of the rebound, g·T²/8 of the interval T, in metres.
    pub rebound_height_m: Option<f64>,
    /// Its standard error by those of the times, in metres.
    pub rebound_height_std_m: Option<f64>,
    /// Speeds and e of this impact.
    #[serde(flatten)]
    pub bounce: Bounce,
    /// Whether it was heard.
    pub status: Status,
}

/// Speeds, e and the energy kept at one impact, with standard errors by those of the times.
///
/// Speeds are those at the ends of a flight of T less the contact time, under the drag of the selected model if it has
/// them: without, g·T/2. Null where the flight before or after, which a number rests on, was not heard whole.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Bounce {
    /// Speed of arrival.
    pub impact_speed_m_per_s: Option<f64>,
    /// Its standard error.
    pub impact_speed_std_m_per_s: Option<f64>,
    /// Speed of leaving.
    pub rebound_speed_m_per_s: Option<f64>,
    /// Its standard error.
    pub rebound_speed_std_m_per_s: Option<f64>,
    /// e of this impact: the second speed over the first.
    pub restitution: Option<f64>,
    /// Its standard error; neighbouring flights share a time.
    pub restitution_std: Option<f64>,
    /// Share of the energy of arrival that it leaves with, e².
    pub energy_kept: Option<f64>,
    /// Its standard error.
    pub energy_kept_std: Option<f64>,
}

/// The coefficient of restitution of ball and surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Restitution {
    /// e.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// Geometric mean of the impact speeds it was measured at.
    pub at_speed_m_per_s: Option<f64>,
    /// The estimate it comes from.
    pub method: Method,
}

words! {
    /// How e was estimated.
    #[non_exhaustive]
    pub enum Method {
        /// By the model, over all impacts.
        LeastSquares = "least_squares",
        /// By one ratio of flights, which has no error.
        SingleRatio = "single_ratio",
    }
}

/// Ways to e, side by side.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Estimates {
    /// Geometric mean of the ratios of successive flights.
    pub flight_ratio: Option<Estimate>,
    /// Equation (25) of the paper.
    pub eq25: Option<Estimate>,
    /// Equation (30) of the paper.
    pub eq30: Option<Estimate>,
    /// √(h1/h0) of the first impact.
    pub first_rebound: Option<Estimate>,
}

/// How much times and bounces scatter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Scatter {
    /// Median standard error of the times heard, in seconds.
    pub timing_std_s: Option<f64>,
    /// Standard deviation of ln e from bounce to bounce, the times' errors taken out.
    pub bounce_std: Option<f64>,
}

/// The mass-spring-damper ball.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Ball {
    /// Contact time ΔT.
    pub contact_time_s: f64,
    /// Its standard error.
    pub contact_time_std_s: f64,
    /// k; null without a mass.
    pub stiffness_n_per_m: Option<f64>,
    /// Its standard error, the mass being exact.
    pub stiffness_std_n_per_m: Option<f64>,
    /// c; null without a mass.
    pub damping_n_s_per_m: Option<f64>,
    /// Its standard error, the mass being exact.
    pub damping_std_n_s_per_m: Option<f64>,
    /// `ω_n`.
    pub natural_frequency_rad_per_s: f64,
    /// Its standard error.
    pub natural_frequency_std_rad_per_s: f64,
    /// ζ.
    pub damping_ratio: f64,
    /// Its standard error.
    pub damping_ratio_std: f64,
    /// When contact ends.
    pub release_rule: ReleaseRule,
    /// Where the contact time comes from.
    pub source: ContactSource,
}

words! {
    /// Where a contact time comes from.
    #[non_exhaustive]
    pub enum ContactSource {
        /// It was given.
        Given = "given",
        /// It was fitted to the intervals between impacts.
        Intervals = "intervals",
    }
}

/// A strong event that is no impact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Rejected {
    /// Seconds from the first sample.
    pub time_s: f64,
    /// Why.
    pub reason: RejectReason,
    /// Why, in a sentence's part.
    pub detail: String,
}

words! {
    /// Why an event is no impact.
    #[non_exhaustive]
    pub enum RejectReason {
        /// It follows many impacts by the same time.
        Echo = "echo",
        /// It is the sound of an impact nearby.
        NearImpact = "near_impact",
        /// It lies between impacts, where no flight ends.
        OffSequence = "off_sequence",
        /// It belongs to no drop.
        NoSequence = "no_sequence",
    }
}

fn infinite_where_null<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Option::deserialize(deserializer).map(|number| number.unwrap_or(f64::INFINITY))
}

#[cfg(all(test, feature = "lab"))]
mod tests;
