//! What an answer means, in at most seven lines of words.

use super::entry;
use crate::fit::model::Budget;
use crate::fit::model_selection::ALIKE;
use crate::fit::{Estimate, ModelKind};
use crate::order::sort_by_number;
use crate::report::numbers::{odds, short, short_decimals};
use crate::report::{Ball, Drop, Given, Model, Report, Settings, prediction, rebound};

/// The lines of a drop, and what a rule book says of it.
pub(super) fn words(out: &mut String, report: &Report, drop: &Drop, rule: &[String]) {
    let gravity = report.settings.gravity_m_per_s2;
    let lines = [
        ("range", range(drop)),
        ("odds", evidence(drop)),
        (
            "air",
            air(&drop.model, gravity).or_else(|| speed(&drop.model)),
        ),
        ("contact", contact(drop)),
        ("rebound", rebounds(drop, &report.settings)),
        ("rest", rest(drop)),
        ("error", drop.budget.as_ref().map(causes)),
    ];
    for (head, said) in lines {
        if let Some(said) = said {
            entry(out, &format!("  {head:<9}{said}"));
        }
    }
    let predicted = drop.prediction.iter().flat_map(prediction::in_words);
    for said in predicted {
        entry(out, &format!("  predict  {said}"));
    }
    for (i, said) in rule.iter().enumerate() {
        let head = if i == 0 { "rule" } else { "" };
        entry(out, &format!("  {head:<9}{said}"));
    }
}

/// `0.9287 to 0.9307 with 95 % confidence, for impacts at 0.19 m/s`.
pub(crate) fn range(drop: &Drop) -> Option<String> {
    let restitution = drop.restitution.as_ref()?;
    let [low, high] = restitution.estimate.interval95?;
    let digits = short_decimals(restitution.estimate.std_error?);
    let at = restitution.at_speed_m_per_s;
    let at = at.map_or_else(String::new, |v| format!(", for impacts at {v:.2} m/s"));
    Some(format!(
        "{low:.digits$} to {high:.digits$} with 95 % confidence{at}"
    ))
}

/// Odds for the drop, and for its model over constant e where that is clearly worse.
fn evidence(drop: &Drop) -> Option<String> {
    let by_chance = drop.evidence_nats.is_finite() && drop.evidence_nats > 0.0;
    let of_drop = by_chance.then(|| {
        let odds = odds(drop.evidence_nats);
        format!("{odds} that this is a drop and not chance")
    });
    let gain = gain_over_constant(&drop.model).filter(|gain| *gain > ALIKE);
    let of_model = gain.map(|gain| format!("{} {}", odds(gain), beside_e(drop.model.selected)));
    let parts: Vec<String> = of_drop.into_iter().chain(of_model).collect();
    (!parts.is_empty()).then(|| parts.join("; "))
}

/// What a model says beside e: `that contact and drag count too`.
fn beside_e(model: ModelKind) -> String {
    let terms: Vec<&str> = model.word().split('+').collect();
    match terms.as_slice() {
        [one @ ("contact" | "drag" | "speed")] => format!("that {one} counts too"),
        [one] => format!("for the {one} model over a constant e"),
        several => format!("that {} count too", several.join(" and ")),
    }
}

fn gain_over_constant(model: &Model) -> Option<f64> {
    let gain = |kind: ModelKind| {
        let found = model.candidates.iter().find(|c| c.model == kind);
        found.map(|c| c.gain_nats)
    };
    Some(gain(model.selected)? - gain(ModelKind::Constant)?)
}

/// Drag as the speed beyond which the ball cannot fall: `v = g/√K`.
fn air(model: &Model, gravity_m_per_s2: f64) -> Option<String> {
    let drag = model
        .parameters
        .drag_per_s2
        .filter(|drag| drag.value > 0.0)?;
    let speed = gravity_m_per_s2 / drag.value.sqrt();
    let std = drag.std_error.map(|std| 0.5 * speed * std / drag.value);
    let given = model.given.contains(&Given::Drag);
    Some(match std {
        _ if given => format!(
            "slows the ball: it cannot fall faster than {speed:.1} m/s, by its mass and size"
        ),
        Some(std) => format!(
            "slows the ball: it cannot fall faster than {} m/s",
            short(speed, std)
        ),
        None => format!("slows the ball: it cannot fall faster than {speed:.1} m/s"),
    })
}

/// e by the speed, where the model has that in place of drag.
fn speed(model: &Model) -> Option<String> {
    if model.selected == ModelKind::Viscoelastic {
        return Some(
            "is not in the chosen model, by which faster impacts lose more, as between viscoelastic spheres".to_owned(),
        );
    }
    let Estimate {
        value, std_error, ..
    } = model.parameters.speed_exponent?;
    let power = std_error.map_or_else(|| format!("{value:.3}"), |std| short(value, std));
    let rises = if value > 0.0 { "falls" } else { "rises" };
    Some(format!(
        "is not in the chosen model, by which e {rises} with the speed v, as v^(−p) with p = {power}"
    ))
}

/// The time in contact, and with a mass the spring and the damper that have it.
fn contact(drop: &Drop) -> Option<String> {
    let given = drop.model.given.contains(&Given::ContactTime);
    let time = drop.model.parameters.contact_time_s;
    let said = match (&drop.ball, time) {
        (Some(ball), _) => ms(ball.contact_time_s, Some(ball.contact_time_std_s)),
        (None, Some(time)) => ms(time.value, time.std_error),
        (None, None) => return None,
    };
    let given = if given { ", as given" } else { "" };
    Some(format!(
        "{said} at each bounce{given}{}",
        drop.ball.as_ref().map_or_else(String::new, spring)
    ))
}

fn ms(time_s: f64, std_s: Option<f64>) -> String {
    match std_s {
        Some(std) if std > 0.0 => format!("{} ms", short(1e3 * time_s, 1e3 * std)),
        _ => format!("{:.2} ms", 1e3 * time_s),
    }
}

fn spring(ball: &Ball) -> String {
    let k = ball.stiffness_n_per_m.zip(ball.stiffness_std_n_per_m);
    let c = ball.damping_n_s_per_m.zip(ball.damping_std_n_s_per_m);
    let (Some((k, k_std)), Some((c, c_std))) = (k, c) else {
        return String::new();
    };
    let (k, c) = (short(1e-3 * k, 1e-3 * k_std), short(c, c_std));
    format!(", as of a spring of {k} N/mm and a damper of {c} N·s/m")
}

/// How high the ball rose first, by a height of release or else `g·T²/8`, and how long it took to rest. From where it fell is not told: e of the first and
/// fastest impact, which nobody heard before, may be another by several hundredths.
fn rebounds(drop: &Drop, settings: &Settings) -> Option<String> {
    if let Some(measured) = &drop.first_rebound {
        let told = rebound::in_words(measured);
        return Some(match (settings.mass_kg, settings.diameter_m) {
            (Some(_), Some(_)) => told,
            _ => format!("{told}: the ball's mass and diameter make the error smaller"),
        });
    }
    let first = drop.impacts.first()?;
    Some(match first.rebound_height_m? {
        low if low < 0.9995 => format!("{:.0} mm high after the first bounce heard", 1e3 * low),
        high => format!("{high:.2} m high after the first bounce heard"),
    })
}

fn rest(drop: &Drop) -> Option<String> {
    let total_s = drop.total_time_s?;
    Some(format!("{total_s:.2} s from release to rest"))
}

/// The two greatest causes of the error of e, each if it makes a fifth of its variance or more, and what makes the first smaller.
fn causes(budget: &Budget) -> String {
    let few = budget.bounce + budget.noise_sizes;
    let mut causes = [
        (
            few,
            "bounces that differ from one another",
            "more drops make it smaller",
        ),
        (
            budget.timing,
            "the times",
            "a nearer microphone makes it smaller",
        ),
        (
            budget.inputs,
            "contact, drag or speed",
            "the ball's mass and diameter make it smaller",
        ),
        (
            budget.model,
            "not knowing which model is right",
            "a longer drop makes it smaller",
        ),
    ];
    sort_by_number(&mut causes, |(share, ..)| -share);
    let named = causes.iter().take(2).filter(|(share, ..)| *share >= 0.2);
    let named: Vec<String> = named
        .map(|(share, name, _)| format!("{name} ({:.0} %)", 100.0 * share))
        .collect();
    format!("mostly from {}: {}", named.join(" and "), causes[0].2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::Impact;

    #[test]
    fn a_model_is_told_by_what_counts_beside_e() {
        for (model, told) in [
            (ModelKind::Contact, "that contact counts too"),
            (ModelKind::ContactDrag, "that contact and drag count too"),
            (
                ModelKind::Flexible,
                "for the flexible model over a constant e",
            ),
        ] {
            assert_eq!(beside_e(model), told);
        }
    }

    #[test]
    fn the_first_rebound_is_told_in_a_unit_of_its_size() {
        let mut drop = Drop::empty();
        assert_eq!(rebounds(&drop, &Settings::default()), None);
        let mut first = Impact::heard(0.7);
        first.rebound_height_m = Some(0.255_22);
        drop.impacts = vec![first.clone()];
        assert_eq!(
            rebounds(&drop, &Settings::default()).unwrap(),
            "255 mm high after the first bounce heard"
        );
        drop.impacts[0].rebound_height_m = Some(1.253);
        drop.total_time_s = Some(6.0601);
        let told = rebounds(&drop, &Settings::default()).unwrap();
        assert_eq!(told, "1.25 m high after the first bounce heard");
        assert_eq!(rest(&drop).unwrap(), "6.06 s from release to rest");
    }

    #[test]
    fn drag_is_told_as_the_speed_of_fall() {
        let mut model = Model::default();
        assert_eq!(air(&model, 9.81), None);
        model.parameters.drag_per_s2 = Some(Estimate {
            value: 1.09,
            std_error: Some(0.1),
            interval95: None,
        });
        let told = air(&model, 9.81).unwrap();
        assert!(told.ends_with("faster than 9.4 ± 0.4 m/s"), "{told}");
    }

    #[test]
    fn the_causes_of_the_error_come_with_what_makes_it_smaller() {
        let budget = Budget {
            timing: 0.01,
            bounce: 0.5,
            inputs: 0.02,
            noise_sizes: 0.04,
            model: 0.43,
        };
        assert_eq!(
            causes(&budget),
            "mostly from bounces that differ from one another (54 %) and not knowing which model is right (43 %): more \
             drops make it smaller"
        );
    }
}
