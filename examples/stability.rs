//! Prints how far every function of `physics` is from 60-digit arithmetic, and what a call costs.
//!
//! ```text
//! cargo run --release --example stability
//! ```
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "an example prints, and stops at the first surprise"
)]

#[path = "../tests/oracle/mod.rs"]
mod oracle;

use std::hint::black_box;
use std::time::Instant;

use bounce_audio::physics::{
    Bounce, DropSetup, FlightLaw, Oscillator, ReleaseRule, Restitution, RestitutionLaw,
};
use bounce_audio::units::real;
use oracle::{Row, answer, rows};

const PREFACE: &str = "\
Relative error against 60-digit arithmetic (`table.csv`). The goal is 1e-12, or 8 times what rounding every input once
causes, whichever is larger; \"in 8 roundings\" is the worst error in units of the latter (of 8 roundings of the result where
the condition is below 1). Errors above 1e-12 belong to inputs that do not hold the answer any better: impacts within 1e-3
to 1e-9 of the speed at which the ball no longer leaves, and total times next to the ends of what is attainable. `leaves`
is the branch, down to 1e-12 from that speed: 0 is right everywhere. A time per call contains some 25 ns for finding the
function by its name.
";

fn main() {
    println!("{PREFACE}");
    println!(
        "| function | cases | worst error | in 8 roundings of the inputs | goal | ns per call |"
    );
    println!("|---|---:|---:|---:|---|---:|");
    for group in rows().chunk_by(|a, b| a.function == b.function) {
        println!("{}", line(group));
    }
    println!("\n{}", whole_drops());
}

/// What a hundred bounces of a long drop cost, for each kind of bounce.
fn whole_drops() -> String {
    const BOUNCES: usize = 10_000;
    let e = Restitution::from_one_minus(1e-4).unwrap();
    let given = Bounce::Given {
        restitution: RestitutionLaw::Constant(e),
        contact_time_s: 0.0,
    };
    let linear = Bounce::Linear {
        ball: Oscillator::from_contact(e, 1e-3).unwrap(),
        release_rule: ReleaseRule::ZeroDisplacement,
    };
    let free = FlightLaw::without_air(9.81).unwrap();
    let drag = FlightLaw::with_terminal_speed(9.81, 8.0).unwrap();
    let costs = [
        ("constant e", given, free),
        ("constant e, drag", given, drag),
        ("linear ball", linear, free),
    ]
    .map(|(name, bounce, flight)| {
        let mut setup = DropSetup::new(1.0, flight, bounce);
        setup.most_impacts = Some(BOUNCES);
        let start = Instant::now();
        let made = setup.impacts().unwrap().map(black_box).count();
        let microseconds = start.elapsed().as_secs_f64() * 1e6;
        assert_eq!(made, BOUNCES);
        format!("{name} {:.1} µs", microseconds / real(BOUNCES) * 100.0)
    });
    format!(
        "A drop of {BOUNCES} bounces, per hundred of them: {}.",
        costs.join(", ")
    )
}

/// One line of the table: all rows of one function.
fn line(group: &[Row]) -> String {
    let errors: Vec<f64> = (group.iter())
        .map(|row| row.error_of(answer(row.function, &row.inputs)))
        .collect();
    let worst = errors.iter().copied().fold(0.0, f64::max);
    let each = || group.iter().zip(&errors);
    let in_roundings = each()
        .map(|(row, &e)| row.in_roundings(e))
        .fold(0.0, f64::max);
    let met = each().all(|(row, &e)| e <= row.goal());
    let verdict = if met { "met" } else { "MISSED" };
    format!(
        "| {} | {} | {worst:.1e} | {in_roundings:.2} | {verdict} | {:.0} |",
        group[0].function,
        group.len(),
        nanoseconds_per_call(group)
    )
}

/// The fastest of some rounds over all rows: what interrupts a round only adds to it.
fn nanoseconds_per_call(group: &[Row]) -> f64 {
    const ROUNDS: usize = 50;
    (0..ROUNDS)
        .map(|_| {
            let start = Instant::now();
            for row in group {
                black_box(answer(black_box(row.function), black_box(&row.inputs)));
            }
            start.elapsed().as_secs_f64() * 1e9 / real(group.len())
        })
        .fold(f64::INFINITY, f64::min)
}
