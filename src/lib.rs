//! Listens to a recording of a ball bouncing and says what the ball is like.
//!
//! [`analysis::analyze`] takes samples in memory and a rate, and gives the drops that it hears: when the ball hit, the
//! coefficient of restitution with its error, the model that the recording supports. No file, thread or terminal is
//! needed; those are touched in [`audio`] and [`cli`] alone.
//!
//! ```
//! use bounce_audio::analysis::{Settings, analyze};
//! use bounce_audio::synth::{presets::preset, render};
//!
//! // A recording of a steel ball, of which the truth is known.
//! let made = render(&preset("steel")?, 1)?;
//! let rate = f64::from(made.truth.sample_rate_hz);
//!
//! let mut settings = Settings::default();
//! settings.height_m = Some(0.15);
//! let analysis = analyze(&made.samples, rate, &settings)?;
//!
//! let drop = &analysis.drops[0];
//! let times: Vec<f64> = drop.impacts.iter().map(|impact| impact.time_s).collect();
//! let first_flight_s = made.truth.drops[0].onsets_s[1] - made.truth.drops[0].onsets_s[0];
//! assert!((times[1] - times[0] - first_flight_s).abs() < 1e-6);
//!
//! let e = drop.restitution.as_ref().map(|r| r.estimate);
//! let [low, high] = e.and_then(|e| e.interval95).unwrap_or([0.0; 2]);
//! assert!(0.0 < low && low < high && high < 1.0);
//! assert!(analysis.warnings.is_empty());
//! # Ok::<(), bounce_audio::Error>(())
//! ```
//!
//! | module | what it does |
//! |---|---|
//! | [`analysis`] | the whole way from samples to drops, from memory or [block by block](analysis::Listener) |
//! | [`audio`] | files and pipes to samples: WAV, FLAC, MP3, MP4 and others |
//! | [`detect`], [`sequence`], [`timing`], [`fit`] | its steps: candidate impacts, the chain that is a drop, their times, e from these |
//! | [`signal`] | what listening is made of: octave bands, whitening, correlation, interpolation |
//! | [`report`] | what was found, as data; text, JSON, CSV and [labels](report::labels) are functions of it |
//! | [`rules`] | the rebound that a rule book asks for |
//! | [`physics`], [`solve`] | flight, contact and the paper's equations; the ball from numbers |
//! | [`synth`], [`evaluate`] | recordings with known truth, and how well they are heard |
//!
//! `examples/` has programs to start from: `analyze_samples`, `synthesize`, `compare_models`.
#![cfg_attr(
    test,
    allow(
        clippy::unwrap_used,
        clippy::expect_used,
        clippy::panic,
        clippy::cast_precision_loss,
        clippy::float_cmp,
        reason = "a failing test should panic; test sizes are small and exact values are meant"
    )
)]

pub mod analysis;
pub mod audio;
pub mod cli;
pub mod detect;
pub mod error;
pub mod evaluate;
pub mod fit;
pub mod physics;
pub mod picture;
pub mod plot;
pub mod random;
pub mod report;
pub mod rules;
pub mod sequence;
pub mod signal;
pub mod solve;
pub mod statistics;
pub mod synth;
pub mod timing;
pub mod units;
mod words;

pub use error::Error;
