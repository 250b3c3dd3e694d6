//! The irregular bounces of a drop as they are reported, and what is said of them.

use super::{Settings, model};
use crate::Error;
use crate::fit::irregular::{Alternation, Irregularity, Kind, Regularity};
use crate::impact::Impact;
use crate::report::{Irregular, Warning, WarningCode, listed};

/// The irregular bounces; e of the other part is fitted where e changed.
pub(super) fn reported(
    timed: &[Impact],
    regularity: &Regularity,
    settings: &Settings,
) -> Result<Vec<Irregular>, Error> {
    let other = match &regularity.other {
        Some(part) => model::fitted(timed, part, regularity, settings)?.restitution,
        None => None,
    };
    let one = |found: &Irregularity| Irregular {
        other_restitution: other
            .as_ref()
            .filter(|_| found.kind == Kind::Changed)
            .map(|r| r.estimate),
        ..Irregular::new(
            found.impact + 1,
            timed[found.impact].time_s,
            found.kind,
            found.ratio,
            found.expected,
        )
    };
    Ok(regularity.irregular.iter().map(one).collect())
}

/// That bounces are left out of e, and that bounces alternate.
pub(super) fn warnings(irregular: &[Irregular], alternation: Option<Alternation>) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if !irregular.is_empty() {
        let numbers: Vec<usize> = irregular.iter().map(|i| i.impact).collect();
        let part = if irregular.iter().any(|i| i.kind == Kind::Changed) {
            "regular bounces of the part that lasts longer"
        } else {
            "regular bounces"
        };
        let impact = if numbers.len() == 1 {
            "impact"
        } else {
            "impacts"
        };
        let message = format!(
            "irregular at {impact} {}: e is that of the {part}. A joint, a speck, another surface or a cut of the recording \
             does this",
            listed(&numbers)
        );
        warnings.push(Warning::new(WarningCode::IrregularBounces, message));
    }
    if let Some([greater, less]) = alternation.map(|a| a.ratios()) {
        let message = format!(
            "the bounces alternate: ratios {greater:.3} and {less:.3} by turns, as a ball makes that turns by half between \
             bounces and has two unlike sides. e is their mean"
        );
        warnings.push(Warning::new(WarningCode::BouncesAlternate, message));
    }
    warnings
}
