//! Rule-book drops: how high would this ball rebound from the height that the rule states, and is that allowed?
//!
//! A drop that was heard gives e; a [`Rule`] gives a height and a band. Between them stands flight in air: down to the
//! rule's impact, e at that speed under the model that was fitted, and up again.

mod catalogue;
mod decide;
mod lot;
mod own;
mod verdict;

pub use catalogue::{Mean, RULES, Rule, rule};
pub use lot::judge_lot;

use crate::Error;
use crate::physics::Sphere;
use crate::report::Drop;
use crate::report::rule::RuleReport;

impl Rule {
    /// The ball of this mass and diameter, where they are known, and else of the rule.
    #[must_use]
    pub fn ball(&self, mass_kg: Option<f64>, diameter_m: Option<f64>) -> Sphere {
        Sphere {
            mass_kg: mass_kg.unwrap_or(self.mass_kg),
            diameter_m: diameter_m.unwrap_or(self.diameter_m),
        }
    }
}

/// Judges every drop of a recording, which was analyzed with the mass and diameter of this ball.
///
/// # Errors
/// [`Error::Argument`] for a ball or gravity that is none.
pub fn judge(
    rule: &Rule,
    drops: &[Drop],
    ball: Sphere,
    gravity_m_per_s2: f64,
) -> Result<RuleReport, Error> {
    let test = verdict::Test::new(rule, ball, gravity_m_per_s2)?;
    let judged = drops.iter().map(|drop| test.judge(drop));
    let drops = judged.collect::<Result<Vec<_>, Error>>()?;
    let rebounds = || drops.iter().filter_map(|d| Some(d.rebound_m?.value));
    let (low, high) = (
        rebounds().fold(f64::INFINITY, f64::min),
        rebounds().fold(f64::NEG_INFINITY, f64::max),
    );
    Ok(RuleReport {
        name: rule.name.to_owned(),
        source: rule.source.to_owned(),
        drop_height_m: rule.drop_height_m,
        allowed_m: rule.allowed_m,
        mass_kg: ball.mass_kg,
        diameter_m: ball.diameter_m,
        spread_m: (rebounds().count() > 1).then_some(high - low),
        allowed_spread: rule.allowed_spread,
        drops,
    })
}

#[cfg(test)]
mod tests;
