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
#[path = "../found/parallel.rs"]
mod parallel;
mod recording;
mod source;
mod table;
mod variants;

use std::env;
use std::path::PathBuf;

use source::Source;

fn main() {
    let paths: Vec<PathBuf> = env::args_os().skip(1).map(PathBuf::from).collect();
    let sources: Vec<Source> = if paths.is_empty() {
        source::scenes().collect()
    } else {
        paths.into_iter().map(Source::File).collect()
    };
    table::print(&sources);
}
