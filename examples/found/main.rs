//! How sure drops are found that are odd, short, lively or in company, and how often one is found where no ball is.
//!
//! ```text
//! cargo run --release --example found -- range            e from 0.2 to 0.995 by the number of impacts
//! cargo run --release --example found -- scatter          e that scatters from bounce to bounce
//! cargo run --release --example found -- alternating      e by turns
//! cargo run --release --example found -- odd              odd bounces, splices, another surface
//! cargo run --release --example found -- begin            first impacts that are hard to find
//! cargo run --release --example found -- few              one to five impacts, then caught
//! cargo run --release --example found -- rebound          two impacts from a known height
//! cargo run --release --example found -- curve            e against speed over many drops
//! cargo run --release --example found -- knocks           what knocks before a drop cost it
//! cargo run --release --example found -- copies DIR       recordings put several times into one
//! cargo run --release --example found -- nothing [SEED] [DIR]  clips without a ball, of seeds from this on, and recordings without one
//! cargo run --release --example found -- voices DIR DIR   recordings of drops under recordings of voices, and those alone
//! ```
//!
//! Each prints a table of a line per row, so that `diff` compares two builds. The product knows nothing of this.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "an example prints, and stops at the first surprise; counts are small"
)]

mod begin;
mod bounces;
mod company;
mod copies;
mod curve;
mod few;
mod nothing;
#[path = "../common/parallel.rs"]
mod parallel;
mod range;
mod rebound;
mod trial;
mod voices;

use std::env;
use std::path::Path;

fn main() {
    let words: Vec<String> = env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match words.as_slice() {
        ["range"] => range::table(),
        ["scatter"] => bounces::scatter(),
        ["alternating"] => bounces::alternating(),
        ["odd"] => bounces::odd(),
        ["begin"] => begin::table(),
        ["few"] => few::table(),
        ["rebound"] => rebound::table(),
        ["curve"] => curve::table(),
        ["knocks"] => company::knocks(),
        ["copies", folder] => copies::table(Path::new(folder)),
        ["nothing", rest @ ..] => nothing(rest),
        ["voices", balls, voices] => voices::table(Path::new(balls), Path::new(voices)),
        _ => eprintln!(
            "found range | scatter | alternating | odd | begin | few | rebound | curve | knocks | copies DIR | nothing [SEED] [DIR] | voices DIR DIR"
        ),
    }
}

fn nothing(words: &[&str]) {
    let seed = words.first().and_then(|word| word.parse().ok());
    let folder = if seed.is_some() {
        words.get(1)
    } else {
        words.first()
    };
    nothing::table(seed.unwrap_or(1), folder.map(Path::new));
}
