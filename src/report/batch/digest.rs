//! What a summary needs of each recording and each drop.

use super::super::rule::{Judged, Outcome};
use super::super::{Drop, Report, doubt_height};
use crate::fit::Estimate;
use crate::fit::random_effects::Measurement;

/// One recording in short.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Digest {
    /// Its name.
    pub file: String,
    /// Its result.
    pub found: Found,
}

impl Digest {
    /// A recording that could not be analyzed, with the reason.
    #[must_use]
    pub const fn failed(file: String, reason: String) -> Self {
        let found = Found::Failed(reason);
        Self { file, found }
    }
}

/// The result of one recording.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Found {
    /// Its drops; one at least.
    Drops(Vec<DropDigest>),
    /// It has no drop, with the reason.
    Nothing(String),
    /// It could not be analyzed, with the reason.
    Failed(String),
}

/// One drop in short.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct DropDigest {
    /// Impacts heard.
    pub bounces: usize,
    /// e of the selected model.
    pub restitution: Option<Estimate>,
    /// The speed that this e belongs to.
    pub at_speed_m_per_s: Option<f64>,
    /// The share of its height that the drop came back to at first.
    pub resilience: Option<Measurement>,
    /// What a rule says of it.
    pub judged: Option<JudgedDigest>,
    /// Whether the height of release that was given does not fit its first flight.
    pub is_height_unfit: bool,
}

/// The verdict on a drop in short.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct JudgedDigest {
    /// Whether it keeps to the rule.
    pub outcome: Outcome,
    /// The rebound from the rule's height in metres, with its standard error if it has one.
    pub rebound_m: Option<(f64, Option<f64>)>,
}

#[cfg(test)]
impl Digest {
    /// A recording of this name with this result.
    pub(crate) const fn new(file: String, found: Found) -> Self {
        Self { file, found }
    }
}

#[cfg(test)]
impl DropDigest {
    /// A drop of so many impacts with this e.
    pub(crate) const fn new(bounces: usize, restitution: Option<Estimate>) -> Self {
        Self {
            bounces,
            restitution,
            at_speed_m_per_s: None,
            resilience: None,
            judged: None,
            is_height_unfit: false,
        }
    }
}

impl From<&Drop> for DropDigest {
    fn from(drop: &Drop) -> Self {
        Self {
            bounces: drop.bounces,
            restitution: drop.restitution.as_ref().map(|r| r.estimate),
            at_speed_m_per_s: drop.restitution.as_ref().and_then(|r| r.at_speed_m_per_s),
            resilience: drop
                .first_rebound
                .as_ref()
                .and_then(|r| weighed(r.resilience)),
            judged: None,
            is_height_unfit: doubt_height(drop.warnings.iter().map(|w| w.code.word())),
        }
    }
}

impl From<&Judged> for JudgedDigest {
    fn from(judged: &Judged) -> Self {
        Self {
            outcome: judged.outcome,
            rebound_m: judged.rebound_m.map(|r| (r.value, r.std_error)),
        }
    }
}

/// A value with an error to weigh it by.
pub(super) fn weighed(estimate: Estimate) -> Option<Measurement> {
    let std = estimate
        .std_error
        .filter(|std| std.is_finite() && *std > 0.0)?;
    Some((estimate.value, std))
}

impl From<&Report> for Digest {
    fn from(report: &Report) -> Self {
        let drops = &report.drops;
        Self {
            file: report.file.clone(),
            found: if drops.is_empty() {
                Found::Nothing(report.why_none().to_owned())
            } else {
                let judged = |i: usize| report.rule.as_ref()?.drops.get(i).map(JudgedDigest::from);
                let drop = |(i, drop): (usize, &Drop)| DropDigest {
                    judged: judged(i),
                    ..DropDigest::from(drop)
                };
                Found::Drops(drops.iter().enumerate().map(drop).collect())
            },
        }
    }
}
