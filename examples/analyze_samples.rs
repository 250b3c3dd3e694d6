//! Samples in memory in, the coefficient of restitution out: no files.
//!
//! ```text
//! cargo run --release --example analyze_samples
//! ```
#![allow(clippy::print_stdout, reason = "an example prints")]

use bounce_audio::{Error, Settings, analyze};

const RATE_HZ: f64 = 44_100.0;

/// The sample at a time.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "times are positive and of a few seconds"
)]
fn at(time_s: f64) -> usize {
    (time_s * RATE_HZ).round() as usize
}

/// What a microphone would give: a short ring at each impact of a ball with e = 0.85.
fn samples() -> Vec<f32> {
    let mut samples = vec![0.0; at(4.0)];
    let (mut at_s, mut flight_s, mut level) = (0.4, 0.45, 0.5_f32);
    while flight_s > 0.01 {
        let from = at(at_s);
        for (sample, i) in samples[from..].iter_mut().zip(0..100_u8) {
            let phase = 0.6 * f32::from(i);
            *sample += level * (-0.1 * phase).exp() * phase.sin();
        }
        at_s += flight_s;
        flight_s *= 0.85;
        level *= 0.85;
    }
    samples
}

/// Makes the samples, listens to them, and prints what was found.
pub(crate) fn main() -> Result<(), Error> {
    let settings = Settings::default().mass_kg(2.7e-3);
    let analysis = analyze(&samples(), RATE_HZ, &settings)?;

    for drop in &analysis.drops {
        println!(
            "{} impacts, the first at {:.4} s",
            drop.bounces, drop.impacts[0].time_s
        );
        if let Some(e) = drop.restitution.as_ref().map(|r| r.estimate) {
            println!(
                "e = {:.4} ± {:.4}",
                e.value,
                e.std_error.unwrap_or(f64::NAN)
            );
            assert!((e.value - 0.85).abs() < 0.002, "{}", e.value);
        }
    }
    for warning in &analysis.warnings {
        println!("{}: {}", warning.code, warning.message);
    }
    assert_eq!(analysis.drops.len(), 1);
    Ok(())
}
