//! How often the 95 % interval of e holds the e that made the impact times, and how far e spreads against what is stated.
//!
//! ```text
//! cargo run --release --example coverage [drops per cell]
//! ```
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "an example prints, and stops at the first surprise"
)]

use bounce_audio::fit::bounces::{Known, Terms};
use bounce_audio::fit::flights::Impact;
use bounce_audio::fit::model::fit;
use bounce_audio::physics::FlightLaw;
use bounce_audio::random::SplitMix64;
use bounce_audio::units::real;

struct Cell {
    e: f64,
    n: usize,
    time_std_s: f64,
    bounce_std: f64,
    contact_s: f64,
    drag_per_s2: f64,
}

/// Flights without contact, by the law of flight; `K = g²/v_t²`.
fn flights(cell: &Cell, first_s: f64, rng: &mut Option<&mut SplitMix64>) -> Vec<f64> {
    const GRAVITY: f64 = 9.81;
    let law = if cell.drag_per_s2 > 0.0 {
        FlightLaw::with_terminal_speed(GRAVITY, GRAVITY / cell.drag_per_s2.sqrt())
    } else {
        FlightLaw::without_air(GRAVITY)
    };
    let law = law.unwrap();
    let mut hop = law.hop(0.5 * GRAVITY * first_s).unwrap();
    let mut out = vec![hop.time_s];
    for _ in 2..cell.n {
        let noise = rng.as_mut().map_or(0.0, |r| cell.bounce_std * r.normal());
        hop = law
            .hop(hop.landing_speed_m_per_s * cell.e * noise.exp())
            .unwrap();
        out.push(hop.time_s);
    }
    out
}

fn main() {
    let drops: usize = std::env::args().nth(1).map_or(1000, |a| a.parse().unwrap());
    println!(
        "| e | n | σ_t µs | σ_e % | C ms | K s⁻² | holds e | Monte Carlo ± | spread of ln e | spread/stated | no interval |"
    );
    println!("|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for (contact_s, drag_per_s2) in [(0.0, 0.0), (2e-3, 0.0), (0.0, 1.4), (2e-3, 1.4)] {
        for (e, n) in [
            (0.4, 4),
            (0.4, 5),
            (0.6, 5),
            (0.6, 12),
            (0.8, 8),
            (0.8, 20),
            (0.93, 4),
            (0.93, 12),
            (0.93, 50),
            (0.98, 5),
            (0.98, 150),
        ] {
            for time_std_s in [1e-6, 3e-5, 1e-3] {
                for bounce_std in [0.0, 0.005, 0.02] {
                    let cell = Cell {
                        e,
                        n,
                        time_std_s,
                        bounce_std,
                        contact_s,
                        drag_per_s2,
                    };
                    run(&cell, drops);
                }
            }
        }
    }
}

fn run(cell: &Cell, drops: usize) {
    let first = 0.8;
    let ideal = flights(cell, first, &mut None);
    let last = ideal[ideal.len() - 1];
    if last < 4e-3 || last < 10.0 * cell.time_std_s {
        return;
    }
    let terms = Terms {
        contact: (cell.contact_s > 0.0).then_some(Known {
            value: 2e-3,
            std: 4e-3,
        }),
        drag: (cell.drag_per_s2 > 0.0).then_some(Known {
            value: 1.0,
            std: 2.0,
        }),
        speed: None,
        weight: false,
    };
    let mut rng = SplitMix64::new(7);
    let (mut held, mut counted, mut none) = (0usize, 0usize, 0usize);
    let mut squares = 0.0;
    let mut stds = 0.0;
    for _ in 0..drops {
        let made = flights(cell, first, &mut Some(&mut rng));
        let mut at = 0.0;
        let mut impacts = vec![Impact {
            time_s: cell.time_std_s * rng.normal(),
            std_s: cell.time_std_s,
            heard: true,
        }];
        for f in &made {
            at += f + cell.contact_s;
            impacts.push(Impact {
                time_s: at + cell.time_std_s * rng.normal(),
                std_s: cell.time_std_s,
                heard: true,
            });
        }
        let Some(fitted) = fit(&impacts, &terms) else {
            none += 1;
            continue;
        };
        let Some([low, high]) = fitted.ln_restitution.interval95 else {
            none += 1;
            continue;
        };
        counted += 1;
        held += usize::from(low <= cell.e.ln() && cell.e.ln() <= high);
        squares += (fitted.ln_restitution.value - cell.e.ln()).powi(2);
        stds += fitted.ln_restitution.std.unwrap().powi(2);
    }
    let share = real(held) / real(counted.max(1));
    let error = (share * (1.0 - share) / real(counted.max(1))).sqrt();
    println!(
        "| {} | {} | {} | {} | {} | {} | {:.3} | {:.3} | {:.2e} | {:.2} | {} |",
        cell.e,
        cell.n,
        cell.time_std_s * 1e6,
        cell.bounce_std * 100.0,
        cell.contact_s * 1e3,
        cell.drag_per_s2,
        share,
        error,
        (squares / real(counted.max(1))).sqrt(),
        (squares / stds).sqrt(),
        none
    );
}
