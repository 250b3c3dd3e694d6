//! What is told of the models: the one that was selected, its rivals, and all that were compared.

use super::line;
use crate::fit::model_selection::ALIKE;
use crate::fit::{Estimate, ModelKind};
use crate::report::numbers::digits_for;
use crate::report::{Drop, Given, Model};

/// The model beyond constant e, with what it fitted: `contact+drag: contact 0.78 ± 0.12 ms, drag K 1.26 ± 0.07 s⁻²`.
pub(super) fn model(drop: &Drop) -> Option<String> {
    let shown = |parameter: Option<Estimate>, label: &str, unit: &str, scale: f64| {
        let parameter = parameter?;
        let (value, std) = (scale * parameter.value, parameter.std_error);
        let std = std.map(|s| scale * s);
        let digits = digits_for(std.unwrap_or(value));
        let error = std.map_or_else(String::new, |s| format!(" ± {s:.digits$}"));
        Some(format!("{label} {value:.digits$}{error}{unit}"))
    };
    let of = &drop.model.parameters;
    let terms: Vec<String> = [
        shown(of.contact_time_s, "contact", " ms", 1e3),
        shown(of.drag_per_s2, "drag K", " s⁻²", 1.0),
        shown(of.speed_exponent, "speed exponent", "", 1.0),
    ]
    .into_iter()
    .flatten()
    .collect();
    let name = model_name(&drop.model);
    match (terms.is_empty(), drop.model.selected) {
        (false, _) => Some(format!("{name}: {}", terms.join(", "))),
        // It has no parameter beyond e.
        (true, ModelKind::Viscoelastic) => Some(format!("{name}: ln e in proportion to v^(1/5)")),
        (true, _) => None,
    }
}

/// By how much the model is better than constant e, and which others are as likely: `10.2 nats better than constant e; as
/// likely: linear (e 0.8641)`.
pub(super) fn rivals(model: &Model) -> Option<String> {
    let gain = |kind: ModelKind| {
        let found = model.candidates.iter().find(|c| c.model == kind);
        found.map(|c| c.gain_nats)
    };
    let (selected, constant) = (model.selected, ModelKind::Constant);
    let own = gain(selected)?;
    let mut parts = Vec::new();
    if let Some(constant) = gain(constant).filter(|_| selected != constant) {
        parts.push(format!("{:.1} nats better than constant e", own - constant));
    }
    let as_likely = model.candidates.iter().filter(|c| {
        c.model != selected && c.model != constant && (c.gain_nats - own).abs() < ALIKE
    });
    let named: Vec<String> = as_likely
        .map(|c| format!("{} (e {:.4})", c.model, c.restitution))
        .collect();
    if !named.is_empty() {
        parts.push(format!("as likely: {}", named.join(", ")));
    }
    (!parts.is_empty()).then(|| parts.join("; "))
}

/// The name of a model, with what it has because it was given: `constant e, with the contact time given`.
pub(crate) fn model_name(model: &Model) -> String {
    let given = model.given.iter().map(|term| match term {
        Given::ContactTime => "contact time",
        Given::Drag => "drag",
    });
    let given: Vec<&str> = given.collect();
    let name = match model.selected {
        ModelKind::Constant => "constant e",
        other => other.word(),
    };
    if given.is_empty() {
        name.to_owned()
    } else {
        format!("{name}, with the {} given", given.join(" and "))
    }
}

/// The models that were compared, from the simplest up.
pub(super) fn models(out: &mut String, model: &Model) {
    if model.candidates.is_empty() {
        return;
    }
    line(
        out,
        "\nModels compared, by their evidence over the first in nats",
    );
    for candidate in &model.candidates {
        line(
            out,
            &format!(
                "  {:<14} {:>9.1}   e {:.5}",
                candidate.model, candidate.gain_nats, candidate.restitution
            ),
        );
    }
    for unfit in &model.unfitted {
        let reason = unfit.reason.in_words();
        line(out, &format!("  {:<14} not fitted: {reason}", unfit.model));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::model_selection::Candidate;

    #[test]
    fn a_model_says_what_it_has_because_it_was_given() {
        let named = |selected, given: &[Given]| {
            let given = given.to_vec();
            model_name(&Model {
                selected,
                given,
                ..Model::default()
            })
        };
        assert_eq!(named(ModelKind::ContactDrag, &[]), "contact+drag");
        assert_eq!(named(ModelKind::Constant, &[]), "constant e");
        let contact = named(ModelKind::Constant, &[Given::ContactTime]);
        assert_eq!(contact, "constant e, with the contact time given");
        let both = named(ModelKind::Speed, &[Given::ContactTime, Given::Drag]);
        assert_eq!(both, "speed, with the contact time and drag given");
    }

    #[test]
    fn a_model_without_a_parameter_of_its_own_is_named_all_the_same() {
        let mut drop = Drop::empty();
        assert_eq!(model(&drop), None);
        drop.model.selected = ModelKind::Viscoelastic;
        let told = model(&drop).unwrap();
        assert!(told.starts_with("viscoelastic: ln e"), "{told}");
    }

    #[test]
    fn a_model_is_told_against_constant_e_and_those_as_likely() {
        let candidate = |model, gain_nats, restitution| Candidate {
            model,
            gain_nats,
            restitution,
        };
        let mut model = Model {
            selected: ModelKind::Contact,
            candidates: vec![
                candidate(ModelKind::Constant, 0.0, 0.88),
                candidate(ModelKind::Contact, 10.2, 0.878),
                candidate(ModelKind::Linear, 9.0, 0.864),
                candidate(ModelKind::Drag, 1.0, 0.87),
            ],
            ..Model::default()
        };
        assert_eq!(
            rivals(&model).unwrap(),
            "10.2 nats better than constant e; as likely: linear (e 0.8640)"
        );
        model.selected = ModelKind::Constant;
        assert_eq!(rivals(&model).unwrap(), "as likely: drag (e 0.8700)");
    }
}
