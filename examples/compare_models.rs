//! One recording under every model: what e becomes, and what the recording supports.
//!
//! ```text
//! cargo run --release --example compare_models
//! ```
#![allow(clippy::print_stdout, reason = "an example prints")]

use bounce_audio::synth::{presets::preset, render};
use bounce_audio::{Error, ModelChoice, Settings, analyze};

/// Analyzes a recording under one model after another.
pub(crate) fn main() -> Result<(), Error> {
    let made = render(&preset("pingpong")?, 1)?;
    let rate = f64::from(made.truth.sample_rate_hz);
    let e = |model: ModelChoice| -> Result<f64, Error> {
        let settings = Settings::default().model(model);
        let analysis = analyze(&made.samples, rate, &settings)?;
        let drop = &analysis.drops[0];
        let e = drop
            .restitution
            .as_ref()
            .map_or(f64::NAN, |r| r.estimate.value);
        println!("{model:?}: e = {e:.5} by the model {}", drop.model.selected);
        Ok(e)
    };
    let constant = e(ModelChoice::Constant)?;
    let drag = e(ModelChoice::Drag)?;
    let auto = e(ModelChoice::Auto)?;
    // The air slows a ping-pong ball: with its drag left out, e reads as if the ball lost that too.
    assert!(
        drag.is_finite() && (auto - constant).abs() > 1e-4,
        "{constant} {auto}"
    );
    Ok(())
}
