//! A recording made from a scene, and how far the times found are from the true ones.
//!
//! ```text
//! cargo run --release --example synthesize
//! ```
#![allow(clippy::print_stdout, reason = "an example prints")]

use bounce_audio::synth::{presets::preset, render};
use bounce_audio::{Error, Settings, analyze};

/// Makes a recording and compares what is found in it with what is true.
pub(crate) fn main() -> Result<(), Error> {
    // The same seed makes the same recording.
    let made = render(&preset("steel")?, 7)?;
    let rate = f64::from(made.truth.sample_rate_hz);
    let analysis = analyze(&made.samples, rate, &Settings::default())?;

    let truth = &made.truth.drops[0].onsets_s;
    let found = &analysis.drops[0].impacts;
    println!("{} impacts made, {} found", truth.len(), found.len());
    println!(
        "first flight: true {:.9} s, found {:.9} s",
        truth[1] - truth[0],
        found[1].time_s - found[0].time_s
    );
    let off = (found[1].time_s - found[0].time_s) - (truth[1] - truth[0]);
    assert!(off.abs() < 1e-6, "{off}");
    Ok(())
}
