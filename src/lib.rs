//! Listens to a recording of a ball bouncing and says what the ball is like.
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
pub mod sequence;
pub mod solve;
pub mod synth;
pub mod units;
pub mod wav;

pub use error::Error;
