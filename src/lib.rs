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

pub mod error;
pub mod physics;
pub mod random;
pub mod units;

pub use error::Error;
