//! What many recordings say together, as one JSON document.

use serde_json::{Map, Value, json};

use super::super::rule::LotJudged;
use super::{Digest, DropDigest, Found, levelled, measurement};
use crate::fit::Estimate;
use crate::fit::groups::{Difference, Groups, Mean};
use crate::fit::random_effects::{Measurement, RandomEffects};

/// Counts, the mean and spread of e and of the first rebounds, and what a rule and groups say, if they were asked for.
#[must_use]
pub fn summary_json(
    digests: &[Digest],
    lot: Option<&LotJudged>,
    groups: Option<(&[String], &Groups)>,
) -> Value {
    let of = |digest: &Digest| match &digest.found {
        Found::Drops(drops) => drops.clone(),
        Found::Nothing(_) | Found::Failed(_) => Vec::new(),
    };
    let drops: Vec<DropDigest> = digests.iter().flat_map(of).collect();
    let count = |is: fn(&Found) -> bool| digests.iter().filter(|d| is(&d.found)).count();
    let weighed: Vec<DropDigest> = drops
        .iter()
        .filter(|d| measurement(d).is_some())
        .copied()
        .collect();
    let (values, _) = levelled(&weighed);
    let rebounds: Vec<Measurement> = drops.iter().filter_map(|drop| drop.resilience).collect();
    json!({
        "schema_version": super::super::SCHEMA_VERSION,
        "program": concat!("bounce-audio ", env!("CARGO_PKG_VERSION")),
        "recordings": digests.len(),
        "drops": drops.len(),
        "without_drop": count(|found| matches!(found, Found::Nothing(_))),
        "failed": count(|found| matches!(found, Found::Failed(_))),
        "restitution": pooled(&values),
        "resilience": pooled(&rebounds),
        "rule": lot,
        "groups": groups.map(|(names, groups)| of_groups(names, groups)),
    })
}

/// Null of fewer than two measurements.
fn pooled(measurements: &[Measurement]) -> Value {
    RandomEffects::of(measurements).map_or(Value::Null, |p| {
        json!({
            "count": p.count,
            "mean": p.mean,
            "mean_std": p.mean_std,
            "spread": p.spread,
            "claimed": p.claimed,
            "between": p.between,
            "chi_square": p.chi_square,
            "chance": p.chance,
            "birge_ratio": p.birge,
        })
    })
}

fn of_groups(names: &[String], groups: &Groups) -> Value {
    let mean = |(name, mean): (&String, &Mean)| {
        let mut document = Map::from_iter([
            ("name".to_owned(), json!(name)),
            ("drops".to_owned(), json!(mean.count)),
            ("spread".to_owned(), json!(mean.spread)),
        ]);
        document.insert("restitution".to_owned(), estimate(&mean.mean));
        Value::Object(document)
    };
    let difference = |d: &Difference| {
        json!({
            "first": names[d.groups[0]],
            "second": names[d.groups[1]],
            "second_less_first": estimate(&d.difference),
            "chance": d.chance,
            "chance_corrected": d.corrected,
            "real": d.is_real(),
        })
    };
    json!({
        "at_speed_m_per_s": groups.at_speed_m_per_s,
        "slope_per_ln_speed": groups.slope.as_ref().map(estimate),
        "scatter_within_drops": groups.within,
        "scatter_between_drops": groups.between_drops,
        "scatter_between_groups": groups.between_groups,
        "groups": names.iter().zip(&groups.means).map(mean).collect::<Vec<_>>(),
        "differences": groups.differences.iter().map(difference).collect::<Vec<_>>(),
    })
}

fn estimate(estimate: &Estimate) -> Value {
    serde_json::to_value(estimate).unwrap_or_default()
}
