//! The report for a person: the answer first, then the impacts, then what to know.

use super::{
    Ball, Drop, Estimates, Given, Impact, Model, Rejected, Report, Warning, rule, table,
    wrap::wrapped,
};
use crate::fit::model::Budget;
use crate::fit::model_selection::ALIKE;
use crate::fit::{Estimate, ModelKind};

/// The level of detail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Detail {
    /// The answer and the warnings.
    Answer,
    /// Beside them the ways to e, the impacts, and what was rejected, like by like.
    Usual,
    /// Beside them the models that were compared, and each sound that was rejected.
    Everything,
}

/// Lines that answer first (e, n, total time), then a table of impacts, then what was rejected, then warnings.
#[must_use]
pub fn to_text(report: &Report, detail: Detail) -> String {
    let mut out = String::new();
    let drops = &report.drops;
    let count = drops.len();
    line(
        &mut out,
        &match count {
            0 => format!("{}: no drop found", report.file),
            1 => format!("{}: one drop", report.file),
            _ => format!("{}: {count} drops", report.file),
        },
    );
    let judged = |i| {
        let judged = report.rule.as_ref();
        judged.map_or_else(Vec::new, |judged| rule::entries(judged, i))
    };
    for (i, drop) in drops.iter().enumerate() {
        if count > 1 {
            line(&mut out, &format!("\nDrop {}", i + 1));
        }
        answer(&mut out, drop, &judged(i));
        if detail != Detail::Answer {
            ways(&mut out, &drop.estimates);
            table(&mut out, &drop.impacts);
            if detail == Detail::Everything {
                models(&mut out, &drop.model);
            }
            rejects(&mut out, &drop.rejected, "between the impacts", detail);
        }
        warnings(&mut out, &drop.warnings);
    }
    if detail == Detail::Everything || detail == Detail::Usual && count == 0 {
        let place = if count == 0 {
            "in the recording"
        } else {
            "outside the drops"
        };
        rejects(&mut out, &report.rejected, place, detail);
    }
    if let Some(spread) = rule::spread(report) {
        line(&mut out, &format!("\n{}", wrapped(&spread, 2)));
    }
    warnings(&mut out, &report.warnings);
    out
}

fn line(out: &mut String, text: &str) {
    out.push_str(text);
    out.push('\n');
}

/// A line of the answer: what it says begins in the twelfth column.
fn entry(out: &mut String, text: &str) {
    line(out, &wrapped(text, 11));
}

/// The answer; what a rule book says of it stands beside it.
fn answer(out: &mut String, drop: &Drop, rule: &[String]) {
    line(out, "");
    match &drop.restitution {
        Some(r) => line(out, &format!("  e        {}", with_error(&r.estimate))),
        None => line(out, "  e        not determined"),
    }
    if let Some(model) = model(drop) {
        entry(out, &format!("  model    {model}"));
    }
    line(out, &format!("  bounces  {}", drop.bounces));
    let observed = format!("{:.4} s from first to last impact", drop.observed_time_s);
    match drop.total_time_s {
        Some(total) => entry(
            out,
            &format!("  T_total  {total:.4} s from release to rest ({observed})"),
        ),
        None => line(out, &format!("  time     {observed}")),
    }
    if let Some(ball) = &drop.ball {
        entry(out, &format!("  ball     {}", ball_line(ball)));
    }
    if let Some(budget) = &drop.budget {
        entry(out, &format!("  error    {}", causes(budget)));
    }
    if let Some(rivals) = rivals(&drop.model) {
        entry(out, &format!("  models   {rivals}"));
    }
    for (i, said) in rule.iter().enumerate() {
        let head = if i == 0 { "rule" } else { "" };
        entry(out, &format!("  {head:<9}{said}"));
    }
}

/// Plain formulas for e.
fn ways(out: &mut String, estimates: &Estimates) {
    let others = [
        ("flight ratios", estimates.flight_ratio),
        ("equation (25)", estimates.eq25),
        ("equation (30)", estimates.eq30),
        ("first rebound", estimates.first_rebound),
    ];
    line(out, "\n  e from");
    for (name, estimate) in others {
        let value = estimate.map_or_else(|| "-".to_owned(), |e| with_error(&e));
        line(out, &format!("    {name}  {value}"));
    }
}

/// The model beyond constant e, with what it fitted: `contact+drag: contact 0.78 ± 0.12 ms, drag K 1.26 ± 0.07 s⁻²`.
fn model(drop: &Drop) -> Option<String> {
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
fn rivals(model: &Model) -> Option<String> {
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

fn ball_line(ball: &Ball) -> String {
    let with = |label: &str, value: f64, std: f64, unit: &str| {
        let digits = digits_for(std);
        format!("{label} {value:.digits$} ± {std:.digits$}{unit}")
    };
    let mut parts = vec![with(
        "ω_n",
        ball.natural_frequency_rad_per_s,
        ball.natural_frequency_std_rad_per_s,
        " rad/s",
    )];
    parts.push(with("ζ", ball.damping_ratio, ball.damping_ratio_std, ""));
    let k = ball.stiffness_n_per_m.zip(ball.stiffness_std_n_per_m);
    let c = ball.damping_n_s_per_m.zip(ball.damping_std_n_s_per_m);
    parts.extend(k.map(|(k, std)| with("k", 1e-3 * k, 1e-3 * std, " N/mm")));
    parts.extend(c.map(|(c, std)| with("c", c, std, " N·s/m")));
    parts.join(", ")
}

/// Causes of the error of e, the greatest share first, down to a hundredth.
fn causes(budget: &Budget) -> String {
    let mut causes = [
        ("scatter of the bounces", budget.bounce),
        ("errors of the times", budget.timing),
        ("contact, drag and speed", budget.inputs),
        ("few bounces to judge the scatter by", budget.noise_sizes),
        ("which model is right", budget.model),
    ];
    causes.sort_by(|a, b| b.1.total_cmp(&a.1));
    let named = causes.iter().filter(|(_, share)| *share >= 0.01);
    let parts: Vec<String> = named
        .map(|(name, share)| format!("{:.0} % {name}", 100.0 * share))
        .collect();
    parts.join(", ")
}

/// `0.9452 ± 0.0006 (95 %: 0.9440 to 0.9464)`, to the digits that the error leaves.
pub(crate) fn with_error(estimate: &Estimate) -> String {
    let (Some(std), Some([low, high])) = (estimate.std_error, estimate.interval95) else {
        return format!("{:.3} (no error: a single ratio)", estimate.value);
    };
    let digits = digits_for(std);
    let value = plus_minus(estimate.value, std);
    format!("{value} (95 %: {low:.digits$} to {high:.digits$})")
}

/// `0.9452 ± 0.0006`, to the digits that the error leaves.
pub(super) fn plus_minus(value: f64, std: f64) -> String {
    let digits = digits_for(std);
    format!("{value:.digits$} ± {std:.digits$}")
}

/// Decimals that show an error with two digits, one at least.
pub(super) fn digits_for(std: f64) -> usize {
    table::decimals(std).max(1)
}

fn table(out: &mut String, impacts: &[Impact]) {
    line(out, "");
    for row in table::rows(impacts) {
        line(out, &row);
    }
}

/// Rejected events that are written out; the JSON document has them all.
const SHOWN: usize = 8;

/// The models that were compared, from the simplest up.
fn models(out: &mut String, model: &Model) {
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
}

fn rejects(out: &mut String, rejected: &[Rejected], place: &str, detail: Detail) {
    if rejected.is_empty() {
        return;
    }
    line(out, &format!("\nRejected {place}: {}", rejected.len()));
    if detail == Detail::Everything {
        for r in rejected {
            line(
                out,
                &wrapped(&format!("  {:.4} s: {}", r.time_s, r.detail), 4),
            );
        }
        return;
    }
    let mut kinds: Vec<(&str, usize, &Rejected)> = Vec::new();
    for r in rejected {
        match kinds.iter_mut().find(|(detail, ..)| *detail == r.detail) {
            Some((_, count, _)) => *count += 1,
            None => kinds.push((&r.detail, 1, r)),
        }
    }
    kinds.sort_by_key(|&(_, count, _)| std::cmp::Reverse(count));
    for (detail, count, first) in kinds.iter().take(SHOWN) {
        let told = match count {
            1 => format!("  {:.4} s: {detail}", first.time_s),
            _ => format!("  {count} times, first at {:.4} s: {detail}", first.time_s),
        };
        line(out, &wrapped(&told, 4));
    }
}

fn warnings(out: &mut String, warnings: &[Warning]) {
    if !warnings.is_empty() {
        line(out, "");
    }
    for warning in warnings {
        line(out, &wrapped(&format!("Warning: {}", warning.message), 2));
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

    #[test]
    fn values_are_written_to_the_digits_that_their_error_leaves() {
        let estimate = Estimate {
            value: 0.945_231,
            std_error: Some(0.000_61),
            interval95: Some([0.944, 0.9465]),
        };
        assert_eq!(
            with_error(&estimate),
            "0.94523 ± 0.00061 (95 %: 0.94400 to 0.94650)"
        );
        assert!(with_error(&Estimate::bare(0.8)).starts_with("0.800 (no error"));
    }
}
