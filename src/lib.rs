//! Listens to a recording of a ball bouncing and says what the ball is like.
//!
//! [`analyze`] takes samples in memory and a rate, and gives the drops that it hears: when the ball hit, the coefficient of
//! restitution with its error, the model that the recording supports. [`Listener`] takes a recording of any length block by
//! block, [`Live`] tells each drop as it is played, and [`fit_times`] takes times alone. No file, thread, clock or terminal is
//! touched in any of them.
//!
//! ```
//! use bounce_audio::{Settings, analyze};
//!
//! // A click every flight of a ball with e = 0.8, at 8 kHz.
//! let mut samples = vec![0.0_f32; 32_000];
//! let (mut at_s, mut flight_s) = (0.5, 0.5);
//! while flight_s > 0.01 {
//!     samples[(at_s * 8_000.0) as usize] = 0.5;
//!     at_s += flight_s;
//!     flight_s *= 0.8;
//! }
//!
//! let settings = Settings::default().height_m(0.305);
//! let analysis = analyze(&samples, 8_000.0, &settings)?;
//!
//! let drop = &analysis.drops[0];
//! let times: Vec<f64> = drop.impacts.iter().map(|impact| impact.time_s).collect();
//! assert!((times[1] - times[0] - 0.5).abs() < 1e-3);
//!
//! let e = drop.restitution.as_ref().map(|r| r.estimate);
//! assert!((e.map_or(0.0, |e| e.value) - 0.8).abs() < 0.002);
//! # Ok::<(), bounce_audio::Error>(())
//! ```
//!
//! | feature | what it adds to the core |
//! |---|---|
//! | | `analyze`, `fit_times`, `Listener`, `Live`, `Settings`; [`report`]: what was found, as data, and its text, JSON, CSV and labels; [`physics`]: flight, contact and the paper's equations |
//! | `audio` | `audio`: files and pipes to samples (WAV, FLAC, MP3, MP4 and others); `recording`: from there to a report |
//! | `plots` | `picture`: a report as SVG and PNG |
//! | `lab` | `synth`: recordings with known truth |
//! | `cli` | `cli::run`, the command line; it is switched on by default, with all of the above |
//! | `internals` | the stages, for this project's own tests, examples, benches, Python package and page; it promises nothing |
//!
//! The stages of the core, each a folder: `signal` (octave bands, whitening, correlation, interpolation), `detect` (candidate
//! impacts), `sequence` (the chain that is a drop), `timing` (the times of its impacts), `fit` (e from these), `analysis` (the
//! whole way); beside them `rules` (the rebound that a rule book asks for) and `solve` (the ball from numbers).
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
#![cfg_attr(
    not(feature = "internals"),
    allow(
        unreachable_pub,
        reason = "the stages say what is theirs as if they were open, which `internals` makes them"
    )
)]
#![cfg_attr(
    not(feature = "cli"),
    allow(
        dead_code,
        unused_imports,
        reason = "the command line uses all of the library; a part of it leaves tools of the core idle"
    )
)]

mod error;
mod linalg;
pub mod physics;
pub mod report;
mod words;

#[cfg(feature = "audio")]
pub mod audio;
#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "plots")]
pub mod picture;
#[cfg(feature = "audio")]
pub mod recording;
#[cfg(feature = "lab")]
pub mod synth;

/// The stages, each once: `internals` opens them, and without it they are the crate's own.
#[path = ""]
mod stages {
    pub mod analysis;
    pub mod detect;
    #[cfg(feature = "lab")]
    pub mod evaluate;
    pub mod event;
    pub mod fit;
    pub mod impact;
    pub(crate) mod order;
    #[cfg(feature = "plots")]
    pub mod plot;
    pub mod random;
    pub mod rules;
    pub mod sequence;
    pub mod signal;
    pub mod solve;
    pub mod statistics;
    pub mod timing;
    pub mod units;
    pub mod workers;
}
#[cfg(feature = "internals")]
pub use stages::*;
#[cfg(not(feature = "internals"))]
#[expect(clippy::wildcard_imports, reason = "the list above is the only one")]
use stages::*;

pub use analysis::{Hears, Listener, Live, Settings, Told, analyze, analyze_clearest, fit_times};
pub use error::Error;
pub use fit::model_selection::Choice as ModelChoice;
pub use report::{Analysis, Drop, Report, Warning, WarningCode};
pub use timing::Timing;
