//! What each candidate model costs: the fit of 60 impacts, and auto, which tries all. `cargo bench --bench fit`
#![expect(clippy::print_stdout, reason = "a benchmark prints")]
#![allow(clippy::unwrap_used, reason = "a failing benchmark should panic")]

use std::hint::black_box;
use std::time::Instant;

use bounce_audio::fit::model_selection::{Choice, Inputs, select};
use bounce_audio::impact::Impact;
use bounce_audio::random::SplitMix64;

const IMPACTS: usize = 60;
const REPEATS: usize = 201;

/// A drop with contact: e = 0.93, scatter of half a per cent, times good to 5 µs.
fn drop(seed: u64) -> Vec<Impact> {
    let mut rng = SplitMix64::new(seed);
    let (mut at_s, mut flight_s) = (0.0, 0.6);
    let mut impacts = Vec::with_capacity(IMPACTS);
    for _ in 0..IMPACTS {
        impacts.push(Impact::heard(at_s + 5e-6 * rng.normal(), 5e-6));
        at_s += flight_s + 1e-3;
        flight_s *= 0.93 * (0.005 * rng.normal()).exp();
    }
    impacts
}

/// Median time in microseconds.
fn median_us(choice: Choice) -> f64 {
    let mut times: Vec<f64> = (0..REPEATS)
        .map(|seed| {
            let impacts = drop(seed as u64);
            let start = Instant::now();
            black_box(select(black_box(&impacts), &[], &Inputs::default(), choice));
            1e6 * start.elapsed().as_secs_f64()
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[REPEATS / 2]
}

fn main() {
    println!("model      median us, {IMPACTS} impacts");
    for (name, choice) in [
        ("constant", Choice::Constant),
        ("contact", Choice::Contact),
        ("linear", Choice::Linear),
        ("drag", Choice::Drag),
        ("speed", Choice::Speed),
        ("viscoelastic", Choice::Viscoelastic),
        ("auto", Choice::Auto),
    ] {
        println!("{name:<10} {:>8.0}", median_us(choice));
    }
}
