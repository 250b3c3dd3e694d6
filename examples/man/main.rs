//! Writes the manual pages of `bounce-audio` and of each of its commands, for the archive that `.ci/release` builds.
//!
//! ```text
//! cargo run --example man -- FOLDER
//! ```
#![allow(clippy::unwrap_used, reason = "an example stops at the first surprise")]

mod pages;

use std::fs;
use std::path::PathBuf;

fn main() {
    let folder = std::env::args_os().nth(1).map(PathBuf::from);
    let folder = folder.unwrap_or_else(|| PathBuf::from("."));
    fs::create_dir_all(&folder).unwrap();
    for (name, page) in pages::pages(bounce_audio::cli::command()).unwrap() {
        fs::write(folder.join(name), page).unwrap();
    }
}
