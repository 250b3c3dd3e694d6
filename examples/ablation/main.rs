//! What each constant of detection, sequence, timing and analysis does to both suites: halved, doubled and switched off.
//!
//! ```text
//! cargo run --release --example ablation -- list [PACKAGE]   the constants, of another checkout too
//! cargo run --release --example ablation -- run              measure all that rest on judgement or on figures; an hour
//! cargo run --release --example ablation -- run --new        measure those of them that have not been measured
//! cargo run --release --example ablation -- run PART         measure those whose file and name contain PART, of any class
//! cargo run --release --example ablation -- check            whether the changed package compiles
//! cargo run --release --example ablation -- table            write docs/constants.md anew from what was measured last
//! ```
//!
//! The product knows nothing of this. A copy of the package is made under `target/ablation`, in which every constant is a
//! function that asks the environment whether it is the one to change; it is built once and runs over the suite in a process
//! for each change.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::print_stderr,
    clippy::cast_possible_truncation,
    reason = "an example prints, and stops at the first surprise"
)]

mod constants;
mod copy;
mod figures;
mod mask;
mod rows;
mod run;
mod score;
mod table;
mod uses;

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use constants::{Constant, Source};
use rows::Row;
use table::Entry;

/// Recordings of each scene.
const SEEDS: u64 = 1;

fn main() {
    let words: Vec<String> = env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let here = || Place::of(Path::new(env!("CARGO_MANIFEST_DIR")));
    match words.as_slice() {
        ["score", suite] => print!("{}", score::suite(Path::new(suite)).unwrap().to_text()),
        ["list"] => list(&here()),
        ["list", package] => list(&Place::of(Path::new(package))),
        ["check"] => check(&here()),
        ["run"] => measure(&here(), ""),
        ["run", part] => measure(&here(), part),
        ["table"] => here().write_table(),
        _ => eprintln!("ablation list | check | run [--new | PART] | table"),
    }
}

/// Where things are, and the constants.
struct Place {
    root: PathBuf,
    work: PathBuf,
    sources: Vec<Source>,
    constants: Vec<Constant>,
}

impl Place {
    fn of(root: &Path) -> Self {
        let target =
            env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
        let sources = constants::sources(&root.join("src")).unwrap();
        Self {
            work: target.join("ablation"),
            constants: constants::constants(&sources),
            sources,
            root: root.to_path_buf(),
        }
    }

    fn table_path(&self) -> PathBuf {
        self.root.join("docs/constants.md")
    }

    fn results(&self) -> PathBuf {
        self.work.join("results")
    }

    /// All numbers with what is known of them, and the rows of which nothing is left.
    fn entries(&self) -> (Vec<Entry<'_>>, Vec<Row>) {
        let text = fs::read_to_string(self.table_path()).unwrap_or_default();
        table::entries(&self.constants, rows::read(&text))
    }

    fn write_table(&self) {
        let text = table::written(&self.entries().0, &self.results());
        fs::write(self.table_path(), text).unwrap();
    }
}

fn list(place: &Place) {
    let (entries, gone) = place.entries();
    for Entry { constant, row } in &entries {
        let Constant {
            file, line, about, ..
        } = constant;
        let class = row.class.split(':').next().unwrap_or_default();
        println!(
            "{file}:{line}: {} = {} [{class}] {about}",
            row.name, row.value
        );
    }
    for row in gone {
        println!("gone: {}::{}", row.file, row.name);
    }
    let listed: Vec<&Constant> = place.constants.iter().filter(|c| c.is_listed()).collect();
    let structural = listed.iter().filter(|c| c.structural).count();
    let tuned = entries.iter().filter(|e| e.is_tuned()).count();
    println!(
        "{} constants, {structural} of which the compiler has to know; {tuned} numbers can be changed",
        listed.len(),
    );
}

/// A change of the source that the copy cannot follow shows here, and not when somebody measures.
fn check(place: &Place) {
    cargo("check", &made(place), &place.work);
}

/// The copy, made anew.
fn made(place: &Place) -> PathBuf {
    let copy = place.work.join("copy");
    copy::make(&place.root, &copy, &place.sources, &place.constants).unwrap();
    copy
}

/// Builds the copy, makes the suite and measures what is asked for.
fn measure(place: &Place, part: &str) {
    let (entries, _) = place.entries();
    let asked = entries.iter().filter(|e| match part {
        "" => e.is_open(),
        "--new" => e.is_open() && e.row.effects.iter().all(String::is_empty),
        part => format!("{}::{}", e.row.file, e.row.name).contains(part),
    });
    let changes: Vec<String> = asked
        .flat_map(Entry::changes)
        .filter(|c| !c.is_empty())
        .collect();
    let scorer = build(&made(place), &place.work);
    let suite = place.work.join("suite");
    if !suite.is_dir() {
        score::make_suite(&suite, SEEDS).unwrap();
    }
    if part.is_empty() {
        fs::remove_dir_all(place.results()).ok();
    }
    run::all(&scorer, &suite, &place.results(), &changes).unwrap();
    place.write_table();
}

/// Builds this program in the copy, and keeps it apart from the one that runs.
fn build(copy: &Path, work: &Path) -> PathBuf {
    let target = cargo("build", copy, work);
    let scorer = work.join("scorer");
    fs::copy(target.join("release/examples/ablation"), &scorer).unwrap();
    scorer
}

/// Lets cargo build or check this program in the copy; gives the folder where it does.
fn cargo(command: &str, copy: &Path, work: &Path) -> PathBuf {
    // Of its own: cargo would take the copy for the package that it is a copy of.
    let target = work.join("target");
    let cargo = Command::new(env!("CARGO"))
        .current_dir(copy)
        .args([
            command,
            "--release",
            "--offline",
            "--no-default-features",
            "--features",
            "lab",
            "--example",
            "ablation",
            "--target-dir",
        ])
        .arg(&target)
        .status()
        .unwrap();
    assert!(cargo.success(), "the copy does not compile");
    target
}
