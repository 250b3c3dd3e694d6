//! The verdict of a rule book on a ball, as data and in words.

use serde::{Deserialize, Serialize};

use super::Report;
use super::rebound::Unit;
use crate::fit::Estimate;
use crate::words::words;

/// A rule and what each drop says of it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct RuleReport {
    /// Its name on the command line.
    pub name: String,
    /// Where it stands.
    pub source: String,
    /// From the ball's lowest point to the surface at release, in metres.
    pub drop_height_m: f64,
    /// The rebound that is allowed, to the ball's lowest point, in metres.
    pub allowed_m: [f64; 2],
    /// Mass of the ball in kg, as given or else the middle of what the rule allows.
    pub mass_kg: f64,
    /// Its diameter in metres, likewise.
    pub diameter_m: f64,
    /// The verdict on each drop, in their order.
    pub drops: Vec<Judged>,
    /// The highest predicted rebound less the lowest, of two drops or more, in metres.
    pub spread_m: Option<f64>,
    /// The most that the rule allows, over as many drops as it asks for.
    pub allowed_spread: Option<Spread>,
}

/// Allowed difference between rebounds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Spread {
    /// The highest less the lowest, in metres.
    pub greatest_m: f64,
    /// Number of drops.
    pub drops: usize,
}

words! {
    /// Whether a ball keeps to a rule.
    #[non_exhaustive]
    pub enum Outcome {
        /// The whole 95 % interval is allowed.
        Pass = "pass",
        /// None of it is.
        Fail = "fail",
        /// A part of it is, or there is no interval.
        Undecided = "undecided",
    }
}

words! {
    /// What a verdict rests on.
    #[non_exhaustive]
    pub enum Evidence {
        /// The drop's own first rebound, from about the height of the rule.
        FirstRebound = "first_rebound",
        /// e at the speed of the rule, under the selected model.
        Restitution = "restitution",
    }
}

/// A verdict of a document that does not say rests on e.
const fn of_restitution() -> Evidence {
    Evidence::Restitution
}

/// A drop judged by a rule.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Judged {
    /// Whether the ball keeps to it.
    pub outcome: Outcome,
    /// What that rests on.
    #[serde(default = "of_restitution")]
    pub evidence: Evidence,
    /// The rebound from the rule's height, in metres: the drop's own, or the mean that is predicted; null where e is not
    /// determined.
    pub rebound_m: Option<Estimate>,
    /// The mean that e at the rule's speed predicts, where the drop's own rebound decides.
    #[serde(default)]
    pub fitted_rebound_m: Option<Estimate>,
    /// Scatter of single rebounds about that, in metres.
    pub single_rebound_std_m: Option<f64>,
    /// Speed at which the ball of the rule arrives.
    pub impact_speed_m_per_s: f64,
    /// e at that speed, under the selected model.
    pub restitution: Option<f64>,
    /// The slowest and fastest speed at which e was measured.
    pub measured_speeds_m_per_s: Option<[f64; 2]>,
    /// Whether the rule's speed lies outside those: e there is an extrapolation.
    pub extrapolated: bool,
    /// Of an undecided one, what would decide it.
    pub would_decide: Option<String>,
}

/// A rule and what it says of a lot, ball by ball.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct LotJudged {
    /// The rule's name on the command line.
    pub name: String,
    /// Where it stands.
    pub source: String,
    /// Its height of release in metres.
    pub drop_height_m: f64,
    /// The rebound that it allows, in metres.
    pub allowed_m: [f64; 2],
    /// Whether the lot keeps to it.
    pub outcome: Outcome,
    /// Why not, or what is missing.
    pub why: Option<String>,
    /// Each ball, in the order in which they first appear.
    pub balls: Vec<BallJudged>,
}

/// A ball judged by the mean of its drops.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct BallJudged {
    /// Its name.
    pub name: String,
    /// How many drops have a rebound.
    pub drops: usize,
    /// Whether it keeps to the rule.
    pub outcome: Outcome,
    /// The mean that the rule asks for, of the rebounds in metres.
    pub rebound_m: Option<Estimate>,
    /// The highest rebound less the lowest, in metres, of two drops or more.
    pub spread_m: Option<f64>,
    /// Why it does not pass.
    pub why: Option<String>,
}

impl RuleReport {
    /// The verdict on the drop of this index, one entry after another.
    #[must_use]
    pub fn in_words(&self, drop: usize) -> Vec<String> {
        let Some(judged) = self.drops.get(drop) else {
            return Vec::new();
        };
        let unit = Unit::of(self.drop_height_m);
        let outcome = judged.outcome.word();
        let (height, allowed) = (
            unit.shown(self.drop_height_m, 0),
            unit.range(self.allowed_m),
        );
        let mut entries = vec![format!(
            "{}: {outcome}; from {height}, {allowed} are allowed to a ball of {:.1} g and {:.1} mm",
            self.name,
            1e3 * self.mass_kg,
            1e3 * self.diameter_m
        )];
        let rebound = judged.rebound_m.as_ref();
        let own = judged.evidence == Evidence::FirstRebound;
        let head = if own {
            "its own first rebound"
        } else {
            "rebound predicted"
        };
        entries.extend(rebound.map(|r| format!("{head} {}", unit.estimate(r))));
        let fitted = judged.fitted_rebound_m.as_ref();
        entries.extend(fitted.map(|r| format!("by e there {}", unit.estimate(r))));
        if let (Some(e), Some([slowest, fastest]), true) = (
            judged.restitution,
            judged.measured_speeds_m_per_s,
            judged.extrapolated && !own,
        ) {
            entries.push(format!(
            "e there is {e:.4} at {:.2} m/s, extrapolated: it was measured from {slowest:.2} to {fastest:.2} m/s",
            judged.impact_speed_m_per_s
        ));
        }
        entries.extend(judged.would_decide.clone());
        entries
    }
}

/// The verdict on all drops together.
pub(super) fn spread(report: &Report) -> Option<String> {
    let rule = report.rule.as_ref()?;
    let (spread_m, allowed) = (rule.spread_m?, rule.allowed_spread?);
    let unit = Unit::of(rule.drop_height_m);
    Some(format!(
        "{}: the rebounds of {} drops differ by {}; by the rule those of {} drops by {} at most",
        rule.name,
        rule.drops.len(),
        unit.shown(spread_m, 1),
        allowed.drops,
        unit.shown(allowed.greatest_m, 0)
    ))
}

impl Unit {
    fn shown(self, length_m: f64, decimals: usize) -> String {
        format!("{:.decimals$} {}", self.per_m * length_m, self.name)
    }

    fn range(self, [low, high]: [f64; 2]) -> String {
        let shown = |length_m: f64| format!("{:.1}", self.per_m * length_m);
        let [low, high] = [low, high].map(shown);
        let [low, high] = [&low, &high].map(|text| text.trim_end_matches(".0"));
        format!("{low} to {high} {}", self.name)
    }

    fn estimate(self, rebound: &Estimate) -> String {
        let Self { name, per_m } = self;
        let value = per_m * rebound.value;
        let (Some(std), Some(ends)) = (rebound.std_error, rebound.interval95) else {
            return format!("{value:.0} {name} (no error: a single ratio)");
        };
        let digits = super::decimals(per_m * std);
        let [low, high] = ends.map(|end| per_m * end);
        format!(
            "{value:.digits$} ± {:.digits$} {name} (95 %: {low:.digits$} to {high:.digits$})",
            per_m * std
        )
    }
}
