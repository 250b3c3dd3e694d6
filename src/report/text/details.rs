//! The answer of a drop in the letters of the physics: e, what it rests on, and the ball.

use super::models::{model, rivals};
use super::{entry, line};
use crate::fit::model::Budget;
use crate::order::sort_by_number;
use crate::report::numbers::{digits_for, with_error};
use crate::report::{Ball, Drop, Estimates, release};

/// What the answer rests on, in the letters of the physics.
pub(super) fn basis(out: &mut String, drop: &Drop) {
    line(out, "");
    if let Some(r) = &drop.restitution {
        line(out, &format!("  e        {}", with_error(&r.estimate)));
    }
    if let Some(model) = model(drop) {
        entry(out, &format!("  model    {model}"));
    }
    let observed = format!("{:.4} s from first to last impact", drop.observed_time_s);
    match drop.total_time_s {
        Some(total) => entry(
            out,
            &format!("  T_total  {total:.4} s from release to rest ({observed})"),
        ),
        None => line(out, &format!("  time     {observed}")),
    }
    if let Some(release) = &drop.release {
        entry(out, &format!("  release  {}", release::in_words(release)));
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
}

/// The plain formulas for e that have a value.
pub(super) fn ways(out: &mut String, estimates: &Estimates) {
    let ways = [
        ("flight ratios", estimates.flight_ratio),
        ("equation (25)", estimates.eq25),
        ("equation (30)", estimates.eq30),
        ("first rebound", estimates.first_rebound),
    ];
    let known = ways.iter().filter_map(|(name, e)| Some((name, (*e)?)));
    let rows: Vec<String> = known
        .map(|(name, e)| format!("    {name}  {}", with_error(&e)))
        .collect();
    if !rows.is_empty() {
        line(out, "\n  e from");
    }
    rows.iter().for_each(|row| line(out, row));
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
    sort_by_number(&mut causes, |(_, share)| -share);
    let named = causes.iter().filter(|(_, share)| *share >= 0.01);
    let parts: Vec<String> = named
        .map(|(name, share)| format!("{:.0} % {name}", 100.0 * share))
        .collect();
    parts.join(", ")
}
