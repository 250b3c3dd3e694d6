//! The tests that need nothing of their own, linked once.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::cast_precision_loss,
    reason = "a failing test should panic; test sizes are small"
)]

#[path = "../common/mod.rs"]
mod common;

mod batch;
mod cli;
mod cli_pictures;
mod cli_suite;
mod compressed;
mod document;
mod examples;
mod few;
mod first_minute;
mod fit_times;
mod invariance;
mod irregular;
mod labels;
mod licences;
mod limits;
mod listen;
mod louder_before;
mod man;
mod paper_figures;
mod physics_contact;
mod physics_input;
mod physics_oracle;
mod physics_paper;
mod physics_properties;
mod physics_uncertainty;
mod pictures;
mod plot;
mod readme;
mod rebound;
mod schema;
mod side_by_side;
mod solve;
mod synth;
mod synthetic;
mod two_microphones;
mod wav_variants;
mod writing;
