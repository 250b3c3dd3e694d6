//! A solution for a person: the ball first, one column per equation, then how safe the numbers are.

use super::{ContactSolution, GivenErrors, Parameters, SolvedBall, TotalTimeSolution, numbers};
use crate::report::{Warning, wrapped_to};

/// The table of the ball by (25), by (30) and with the contact time given, then what to know about it.
#[must_use]
pub fn total_time(solution: &TotalTimeSolution) -> String {
    let inputs = &solution.inputs;
    let mut out = format!(
        "A ball dropped from {} m, at rest after {} and {} s{}\n\n",
        inputs.height_m,
        numbers::bounces(inputs.bounces),
        inputs.total_time_s,
        setting(inputs.ball.gravity_m_per_s2, inputs.ball.mass_kg)
    );
    let mut columns = vec![
        ("by (25), (20)".to_owned(), &solution.eq25),
        ("by (30), (20)".to_owned(), &solution.eq30),
    ];
    if let (Some(ball), Some(time)) = (&solution.with_contact_time, inputs.contact_time_s) {
        columns.push((format!("with ΔT = {}", numbers::time(time)), ball));
    }
    out += &table(&columns);
    out += &notes(inputs.ball.mass_kg, &inputs.ball.std_error);
    out += &safety(&solution.warnings);
    out
}

/// The table of the ball, then what to know about it.
#[must_use]
pub fn contact(solution: &ContactSolution) -> String {
    let inputs = &solution.inputs;
    let mut out = format!(
        "A ball of e = {} that touches for {}{}\n\n",
        inputs.restitution,
        numbers::time(inputs.contact_time_s),
        setting(inputs.ball.gravity_m_per_s2, inputs.ball.mass_kg)
    );
    out += &table(&[("by (14)-(17)".to_owned(), &solution.ball)]);
    out += &notes(inputs.ball.mass_kg, &inputs.ball.std_error);
    out += &safety(&solution.warnings);
    out
}

fn setting(gravity_m_per_s2: f64, mass_kg: Option<f64>) -> String {
    let mass = mass_kg.map_or_else(String::new, |mass| {
        format!(", m = {} g", numbers::short(1e3 * mass))
    });
    format!(" (g = {gravity_m_per_s2} m/s²{mass})")
}

/// A line of the table: the name, the factor to the unit shown, the unit, and where the number is found.
struct Row {
    name: &'static str,
    scale: f64,
    unit: &'static str,
    get: fn(&Parameters) -> Option<f64>,
}

const ROWS: [Row; 8] = [
    Row {
        name: "ΔT   contact time",
        scale: 1e3,
        unit: "ms",
        get: |p| p.contact_time_s,
    },
    Row {
        name: "k    stiffness",
        scale: 1e-3,
        unit: "N/mm",
        get: |p| p.stiffness_n_per_m,
    },
    Row {
        name: "c    damping",
        scale: 1.0,
        unit: "N·s/m",
        get: |p| p.damping_n_s_per_m,
    },
    Row {
        name: "k/m",
        scale: 1.0,
        unit: "s⁻²",
        get: |p| p.stiffness_per_mass_per_s2,
    },
    Row {
        name: "c/m",
        scale: 1.0,
        unit: "s⁻¹",
        get: |p| p.damping_per_mass_per_s,
    },
    Row {
        name: "ω_n  natural frequency",
        scale: 1.0,
        unit: "rad/s",
        get: |p| p.natural_frequency_rad_per_s,
    },
    Row {
        name: "f_n  the same, per cycle",
        scale: 1.0,
        unit: "Hz",
        get: |p| p.natural_frequency_hz,
    },
    Row {
        name: "ζ    damping ratio",
        scale: 1.0,
        unit: "",
        get: |p| p.damping_ratio,
    },
];

fn table(columns: &[(String, &SolvedBall)]) -> String {
    let heads = columns.iter().map(|(head, _)| head.clone());
    let mut out = line("", "", heads);
    let values = columns.iter().map(|(_, ball)| restitution(ball));
    out += &line("e    restitution", "", values);
    for row in &ROWS {
        let cells: Vec<Option<String>> = columns.iter().map(|(_, b)| cell(row, b)).collect();
        // Without a mass nobody misses k and c; a note below says how to get them.
        if cells.iter().any(Option::is_some) {
            let dash = |cell: Option<String>| cell.unwrap_or_else(|| "-".to_owned());
            out += &line(row.name, row.unit, cells.into_iter().map(dash));
        }
    }
    if columns.iter().any(|(_, ball)| ball.rest.is_some()) {
        let counts = columns.iter().map(|(_, ball)| rest(ball));
        out += &line("     impacts until rest", "", counts);
    }
    out
}

fn line(name: &str, unit: &str, cells: impl Iterator<Item = String>) -> String {
    let mut out = format!("  {name:<24} {unit:<5}");
    for cell in cells {
        out += &format!("  {cell:<22}");
    }
    out.truncate(out.trim_end().len());
    out + "\n"
}

fn restitution(ball: &SolvedBall) -> String {
    let value = ball.values.restitution;
    match ball.std_error.map(|error| error.restitution) {
        Some(error) if error > 0.0 => numbers::with_error(value, Some(error)),
        _ => numbers::restitution(value),
    }
}

fn cell(row: &Row, ball: &SolvedBall) -> Option<String> {
    let value = (row.get)(&ball.values)? * row.scale;
    let error = ball.std_error.as_ref().and_then(row.get);
    Some(numbers::with_error(value, error.map(|e| e * row.scale)))
}

fn rest(ball: &SolvedBall) -> String {
    match ball.rest {
        None => "-".to_owned(),
        Some(rest) => {
            let exact = rest
                .impacts_exact
                .map_or_else(|| "> 100000".to_owned(), |n| n.to_string());
            format!("{} by (19), {exact} exact", rest.impacts_by_eq19)
        }
    }
}

fn notes(mass_kg: Option<f64>, errors: &GivenErrors) -> String {
    let mut out = String::new();
    if mass_kg.is_none() {
        out += "\n  k and c themselves need --mass.\n";
    }
    if errors.any() {
        out += "\n  ± is one standard error, from those of the inputs; what has none counts as exact.\n";
    }
    out
}

/// Longest line of a paragraph.
const WIDTH: usize = 100;

fn safety(warnings: &[Warning]) -> String {
    let mut out = "\nHow safe are these numbers?\n".to_owned();
    for warning in warnings {
        // A percent sign stays with its number.
        let message = warning.message.replace(" %", "\u{a0}%");
        let paragraph = wrapped_to(&format!("  - {message}"), 4, WIDTH);
        out += &paragraph.replace('\u{a0}', " ");
        out.push('\n');
    }
    out
}
