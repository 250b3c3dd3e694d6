//! Dependencies point one way, and the core touches no files, threads or terminal.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a failing test should panic"
)]

use std::fs;
use std::path::{Path, PathBuf};

/// All of src, from the bottom up, and what each may name: only what stands above its own line.
const MAY_NAME: [(&str, &[&str]); 29] = [
    ("error.rs", &[]),
    ("words.rs", &[]),
    ("units", &[]),
    ("random.rs", &[]),
    ("order.rs", &[]),
    ("workers.rs", &[]),
    ("event.rs", &[]),
    ("impact.rs", &["words"]),
    ("linalg.rs", &["units"]),
    ("statistics.rs", &["units"]),
    ("physics", &["units", "random"]),
    ("signal", &["units", "order", "linalg"]),
    (
        "detect",
        &["units", "order", "statistics", "event", "linalg", "signal"],
    ),
    (
        "sequence",
        &[
            "units",
            "order",
            "statistics",
            "event",
            "impact",
            "linalg",
            "physics",
        ],
    ),
    (
        "timing",
        &[
            "units",
            "order",
            "statistics",
            "linalg",
            "words",
            "impact",
            "signal",
        ],
    ),
    (
        "fit",
        &[
            "units",
            "order",
            "statistics",
            "linalg",
            "words",
            "impact",
            "physics",
        ],
    ),
    (
        "report",
        &[
            "units", "order", "words", "impact", "physics", "timing", "fit",
        ],
    ),
    (
        "rules",
        &["units", "statistics", "physics", "fit", "report"],
    ),
    ("solve", &["physics", "report"]),
    (
        "analysis",
        &[
            "units",
            "order",
            "statistics",
            "event",
            "impact",
            "physics",
            "signal",
            "detect",
            "sequence",
            "timing",
            "fit",
            "report",
            "workers",
        ],
    ),
    ("audio", &["units"]),
    (
        "recording.rs",
        &["workers", "report", "rules", "analysis", "audio"],
    ),
    ("plot", &[]),
    (
        "picture",
        &["units", "order", "statistics", "physics", "report", "plot"],
    ),
    ("synth", &["units", "random", "physics"]),
    (
        "evaluate",
        &["units", "statistics", "fit", "report", "plot"],
    ),
    (
        "cli",
        &[
            "units",
            "workers",
            "statistics",
            "timing",
            "fit",
            "report",
            "rules",
            "solve",
            "analysis",
            "audio",
            "recording",
            "plot",
            "picture",
            "synth",
            "evaluate",
        ],
    ),
    ("lib.rs", &[]),
    ("main.rs", &["audio", "cli"]),
];

/// Who touches files, threads, clocks or the terminal. All else is pure.
const OUTWARD: [&str; 4] = ["audio", "recording.rs", "cli", "main.rs"];
const OUTSIDE: [&str; 12] = [
    "std::fs",
    "std::thread",
    "std::time",
    "std::io",
    "std::env",
    "std::path",
    "std::process",
    "PathBuf",
    "Path",
    "println!",
    "print!",
    "dbg!",
];

/// Crates that a feature brings, and who may name them: the core is without.
const OPTIONAL: [(&str, &[&str]); 12] = [
    ("hound", &["audio"]),
    ("opus_pure", &["audio"]),
    ("symphonia", &["audio"]),
    ("plotters", &["plot"]),
    ("plotters_backend", &["plot"]),
    ("png", &["plot"]),
    ("toml", &["synth", "evaluate"]),
    ("clap", &["cli"]),
    ("clap_complete", &["cli"]),
    ("csv", &["cli"]),
    ("indicatif", &["cli"]),
    ("rayon", &["cli"]),
];

/// What the root promises, line by line. Whoever changes it changes what programs lean on.
const SURFACE: [&str; 12] = [
    "pub mod physics;",
    "pub mod report;",
    "pub mod audio; // audio",
    "pub mod cli; // cli",
    "pub mod picture; // plots",
    "pub mod recording; // audio",
    "pub mod synth; // lab",
    "pub use analysis::{Hears, Listener, Live, Settings, Told, analyze, analyze_clearest, fit_times};",
    "pub use error::Error;",
    "pub use fit::model_selection::Choice as ModelChoice;",
    "pub use report::{Analysis, Drop, Report, Warning, WarningCode};",
    "pub use timing::Timing;",
];

/// Source files, but for those that hold nothing but tests.
fn sources(under: &Path) -> Vec<PathBuf> {
    if under.is_file() {
        return vec![under.to_path_buf()];
    }
    let entries = fs::read_dir(under).unwrap_or_else(|e| panic!("{}: {e}", under.display()));
    entries
        .flat_map(|entry| sources(&entry.unwrap().path()))
        .filter(|p| p.extension().is_some_and(|e| e == "rs"))
        .filter(|p| !p.to_string_lossy().ends_with("tests.rs"))
        .collect()
}

/// Where the tests of a file begin, which stand last: a module with its body. Other items that only tests have stand among
/// the rest.
fn begin_of_tests(text: &str) -> usize {
    let begins = |(at, _): &(usize, &str)| {
        let of_tests = ["#[cfg(test)]", "#[cfg(all(test"];
        let mut lines = text[*at..].lines();
        let attribute = lines.next().unwrap_or_default();
        of_tests.iter().any(|t| attribute.starts_with(t))
            && lines
                .next()
                .is_some_and(|l| l.starts_with("mod ") && l.ends_with('{'))
    };
    let mut attributes = text.match_indices("#[cfg(");
    attributes.find(begins).map_or(text.len(), |(at, _)| at)
}

/// The lines of code of a file: not its comments, not what only a feature has, and not its tests, which may use anything.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap();
    let mut of_feature = false;
    let product = text[..begin_of_tests(&text)].lines().filter(|line| {
        let line = line.trim_start();
        let left_out = of_feature || line.starts_with("//");
        of_feature = line.starts_with("#[cfg(feature");
        !left_out
    });
    product.collect::<Vec<_>>().join("\n")
}

/// Whether code has a word, not as a part of another and not of a path to it.
fn names(code: &str, word: &str) -> bool {
    let of_word = |c: char| c.is_alphanumeric() || c == '_';
    code.match_indices(word).any(|(at, _)| {
        let before = code[..at].chars().next_back();
        let after = code[at + word.len()..].chars().next();
        !before.is_some_and(|c| of_word(c) || c == ':') && !after.is_some_and(of_word)
    })
}

fn src() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

#[test]
fn dependencies_point_one_way() {
    let entries = fs::read_dir(src()).unwrap();
    let mut there: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let mut listed = MAY_NAME.map(|(layer, _)| layer.to_owned()).to_vec();
    there.sort();
    listed.sort();
    assert_eq!(there, listed, "all of src stands in the list");

    let modules = MAY_NAME.map(|(layer, _)| layer.trim_end_matches(".rs"));
    for (place, (layer, may_name)) in MAY_NAME.into_iter().enumerate() {
        for below in may_name {
            assert!(modules[..place].contains(below), "{layer}: {below}");
        }
        for path in sources(&src().join(layer)) {
            let code = code(&path);
            for other in modules {
                let paths = [format!("crate::{other}"), format!("bounce_audio::{other}")];
                let found = paths.iter().any(|name| names(&code, name));
                let allowed = layer.starts_with(other) || may_name.contains(&other);
                assert!(!found || allowed, "{} names {other}", path.display());
            }
            // `use crate::{…}` would hide the name of the module from the search above.
            assert!(
                !code.contains("use crate::{"),
                "{}: one path per `use`",
                path.display()
            );
        }
    }
}

#[test]
fn the_core_touches_nothing_outside() {
    for (layer, _) in MAY_NAME {
        for path in sources(&src().join(layer)) {
            let code = code(&path);
            for outside in OUTSIDE {
                let found = names(&code, outside);
                assert!(
                    !found || OUTWARD.contains(&layer),
                    "{} uses {outside}",
                    path.display()
                );
            }
            for (name, whose) in OPTIONAL {
                let found =
                    names(&code, &format!("{name}::")) || code.contains(&format!("use {name}"));
                assert!(
                    !found || whose.contains(&layer),
                    "{} uses {name}",
                    path.display()
                );
            }
        }
    }
}

#[test]
fn the_root_promises_what_is_written_here_and_nothing_else() {
    let text = fs::read_to_string(src().join("lib.rs")).unwrap();
    let mut promised = Vec::new();
    let mut feature = None;
    for line in text.lines() {
        if line.starts_with("pub ") && feature != Some("internals") {
            let of_feature = feature.map_or_else(String::new, |f| format!(" // {f}"));
            promised.push(format!("{line}{of_feature}"));
        }
        let condition = line.strip_prefix("#[cfg(");
        feature = condition.map(|c| match c.contains("internals") {
            true => "internals",
            false => c.split('"').nth(1).unwrap(),
        });
    }
    assert_eq!(promised, SURFACE);
}

/// The crates that a table of TOML names, up to the next table.
fn dependencies(manifest: &str) -> Vec<&str> {
    let table = manifest.split("\n[dependencies]\n").nth(1).unwrap();
    let lines = table.lines().take_while(|line| !line.starts_with('['));
    let named = lines.filter_map(|line| Some(line.split_once('=')?.0.trim()));
    let mut names: Vec<&str> = named.collect();
    names.sort_unstable();
    names
}

#[test]
fn every_dependency_is_accounted_for_and_unsafe_code_is_forbidden() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let manifest = fs::read_to_string(root.join("Cargo.toml")).unwrap();
    let text = fs::read_to_string(root.join("docs/dependencies.md")).unwrap();
    let rows = text.lines().filter_map(|line| line.strip_prefix("| `"));
    let mut explained: Vec<&str> = rows.filter_map(|row| row.split('`').next()).collect();
    explained.sort_unstable();
    assert_eq!(explained, dependencies(&manifest));
    assert!(manifest.contains("unsafe_code = \"forbid\""));
}
