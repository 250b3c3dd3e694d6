//! The same sound, the same answer: what a report changes by where nothing that matters was changed.
//!
//! ```text
//! cargo run --release --example invariance                  scenes of all kinds of ball
//! cargo run --release --example invariance -- FILE...       recordings
//! ```
//!
//! Zeros or quiet in front, gain, polarity, quiet cut off, rounding far below the noise, every channel twice, a second drop
//! long after the first: none of it may move e by more than a small share of its standard error, nor cost or bring an impact or
//! a drop. A row per recording, the sum in the last lines, so that `diff` compares two builds.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::cast_precision_loss,
    reason = "an example prints, and stops at the first surprise; counts are small"
)]

mod compare;
#[path = "../common/parallel.rs"]
mod parallel;
mod recording;
mod source;
#[path = "../common/sources.rs"]
mod sources;
mod table;
mod variants;

use source::Source;

fn main() {
    table::print(&sources::asked(source::scenes(), Source::File));
}
