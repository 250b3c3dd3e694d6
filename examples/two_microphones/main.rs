//! Whether stated errors of times are true, by two microphones that heard one ball: no truth is needed for that.
//!
//! ```text
//! cargo run --release --example two_microphones               scenes, whose true delays are taken off
//! cargo run --release --example two_microphones -- FILE...    recordings of two channels
//! ```
//!
//! Each channel is analyzed by itself. The times of one impact differ by one delay, with a slow drift if the ball wanders, and
//! by the errors of both times. If the stated errors are true, the differences over them are normal: |z| 0.67, 1.15, 1.64 and
//! 1.96 at 50, 75, 90 and 95 %. What both channels have in common, such as a slow rise of the sound, does not show.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "an example prints, and stops at the first surprise"
)]

mod delays;
#[path = "../common/parallel.rs"]
mod parallel;
mod source;
#[path = "../common/sources.rs"]
mod sources;
mod table;

use source::Source;

fn main() {
    table::print(&sources::asked(source::scenes(), Source::File));
}
