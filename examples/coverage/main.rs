//! How often the 95 % interval of e holds the e that made the impact times, from times alone.
//!
//! ```text
//! cargo run --release --example coverage [drops a cell] > docs/coverage.md
//! cargo run --release --example coverage outside [drops]        only balls whose laws no model has
//! ```
//!
//! Each cell is fitted on the model that made it and, for a tenth of the drops, by `auto`. The spread of ln e stands beside
//! the least that an unbiased estimate can have where the sizes of both noises are known (Cramér and Rao).
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "an example prints, and stops at the first surprise"
)]

mod cell;
mod laws;
mod outside;
mod tally;

use std::sync::Mutex;
use std::thread;

use bounce_audio::units::real;

use cell::{Cell, cells};
use tally::Tally;

const GRAVITY: f64 = 9.81;
/// Drops of each ball whose law no model has.
const OUTSIDE: usize = 300;
/// The first flight, in seconds.
const FIRST_S: f64 = 0.8;
/// Flights are longer than this, and than ten errors of a time, in every cell.
const SHORTEST_S: f64 = 4e-3;
/// Models that differ by less than this many nats are not told apart.
const ALIKE: f64 = 3.0;

/// One line of the table.
fn line(cell: &Cell, tally: &Tally) -> String {
    let share = |part: usize, of: usize| real(part) / real(of.max(1));
    let spread = (tally.squares / real(tally.drops.max(1))).sqrt();
    let stated = (tally.variances / real(tally.drops.max(1))).sqrt();
    let contact = match cell.ball.contact_s() {
        Some(_) => format!("{:.3}", share(tally.contact_held, tally.drops)),
        None => String::new(),
    };
    let bound = cell
        .bound()
        .map_or(String::new(), |b| format!("{:.2}", spread / b));
    format!(
        "| {} | {} | {} | {} | {} | {:.3} | {contact} | {:.3} | {:.2} | {spread:.1e} | {:.2} | {bound} |",
        cell.ball.name(),
        cell.e,
        cell.impacts,
        1e6 * cell.time_std_s,
        100.0 * cell.bounce_std,
        share(tally.held, tally.drops),
        share(tally.auto_held, tally.auto_drops),
        share(tally.auto_right, tally.auto_drops),
        spread / stated,
    )
}

fn main() {
    if std::env::args().nth(1).is_some_and(|a| a == "outside") {
        let drops = std::env::args()
            .nth(2)
            .map_or(OUTSIDE, |a| a.parse().unwrap());
        return outside::print(drops);
    }
    let drops: usize = std::env::args().nth(1).map_or(500, |a| a.parse().unwrap());
    let cells = cells();
    let lines = Mutex::new(vec![String::new(); cells.len()]);
    let next = std::sync::atomic::AtomicUsize::new(0);
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let i = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                    let Some(cell) = cells.get(i) else { break };
                    let seed = u64::try_from(i).unwrap();
                    let text = line(cell, &Tally::of(cell, drops, seed));
                    lines.lock().unwrap()[i] = text;
                }
            });
        }
    });
    let error = (0.95 * 0.05 / real(drops)).sqrt();
    println!("# How often the interval holds e\n");
    println!("## Balls whose laws no model has\n");
    println!(
        "Made by `cargo run --release --example coverage outside {OUTSIDE}`, {OUTSIDE} drops of each ball: 6 to 25 impacts, errors of"
    );
    println!(
        "the times of 1 to 300 µs, scatter of none in a fifth of the drops and up to 1 % in others; `examples/coverage/laws.rs` has"
    );
    println!(
        "the laws. z: error of ln e over what is stated; half-width: median, of the interval.\n"
    );
    outside::print(OUTSIDE);
    println!("\n## Balls of each model\n");
    println!(
        "Made by `cargo run --release --example coverage {drops} > docs/coverage.md`: {drops} drops a cell, so a share"
    );
    println!(
        "of 0.95 is known to ± {error:.3} (one standard deviation); `auto` is tried on a tenth of them. The first flight"
    );
    println!(
        "lasts {FIRST_S} s; cells whose shortest flight is below {} ms or ten errors of a time are left out.\n",
        1e3 * SHORTEST_S
    );
    println!(
        "- ball: the model that made the times and on which they are fitted; n: impacts; σ_t: error of each time, as stated;"
    );
    println!("  σ_e: scatter of each bounce.");
    println!(
        "- holds e, holds C, auto holds: how often the 95 % interval of e, of the contact time, and of e by `auto` hold the truth."
    );
    println!(
        "- auto right: how often `auto` takes this model or one within {ALIKE} nats of it; the viscoelastic one is none of its own."
    );
    println!(
        "- spread: root mean square error of ln e; over stated; over the least that is possible with known σ_t and σ_e.\n"
    );
    println!(
        "| ball | e | n | σ_t µs | σ_e % | holds e | holds C | auto holds | auto right | spread | /stated | /least |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for line in lines.into_inner().unwrap() {
        println!("{line}");
    }
}
