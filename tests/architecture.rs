//! Dependencies point one way, and the core touches no files, threads or terminal.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a failing test should panic"
)]

use std::fs;
use std::path::{Path, PathBuf};

/// What each folder must not name. Arrows: units, statistics, physics, audio ← detect, sequence, fit ← report ← analysis, evaluate, picture ← cli.
const FORBIDDEN: [(&str, &[&str]); 17] = [
    (
        "physics",
        &[
            "detect", "sequence", "fit", "audio", "report", "analysis", "synth", "evaluate", "cli",
        ],
    ),
    (
        "signal",
        &[
            "physics", "detect", "sequence", "timing", "fit", "audio", "report", "analysis",
            "synth", "evaluate", "cli",
        ],
    ),
    (
        "timing",
        &[
            "physics", "detect", "sequence", "fit", "audio", "report", "analysis", "synth",
            "evaluate", "cli",
        ],
    ),
    (
        "detect",
        &[
            "physics", "sequence", "timing", "fit", "audio", "report", "analysis", "synth",
            "evaluate", "cli",
        ],
    ),
    (
        "sequence",
        &[
            "detect", "timing", "fit", "audio", "report", "analysis", "synth", "evaluate", "cli",
        ],
    ),
    (
        "fit",
        &[
            "detect", "timing", "sequence", "audio", "report", "analysis", "synth", "evaluate",
            "cli",
        ],
    ),
    (
        "report",
        &[
            "sequence", "audio", "analysis", "rules", "synth", "evaluate", "cli",
        ],
    ),
    (
        "audio",
        &[
            "physics", "detect", "sequence", "fit", "report", "analysis", "synth", "evaluate",
            "cli",
        ],
    ),
    ("analysis", &["audio", "rules", "synth", "evaluate", "cli"]),
    (
        "rules",
        &[
            "detect", "sequence", "audio", "analysis", "solve", "synth", "evaluate", "cli",
        ],
    ),
    (
        "plot",
        &[
            "physics", "detect", "sequence", "fit", "audio", "report", "analysis", "picture",
            "solve", "synth", "cli",
        ],
    ),
    (
        "picture",
        &[
            "detect", "sequence", "audio", "analysis", "solve", "synth", "evaluate", "cli",
        ],
    ),
    (
        "solve",
        &[
            "detect", "sequence", "fit", "audio", "analysis", "synth", "cli",
        ],
    ),
    (
        "synth",
        &[
            "detect", "sequence", "fit", "audio", "report", "analysis", "evaluate", "cli",
        ],
    ),
    (
        "evaluate",
        &[
            "physics", "detect", "sequence", "fit", "audio", "analysis", "synth", "cli",
        ],
    ),
    (
        "statistics.rs",
        &[
            "physics", "detect", "sequence", "fit", "audio", "report", "analysis", "synth",
            "evaluate", "cli",
        ],
    ),
    (
        "random.rs",
        &[
            "physics", "detect", "sequence", "fit", "audio", "report", "analysis", "synth",
            "evaluate", "cli",
        ],
    ),
];

/// Folders that must build without a file system, threads or a terminal.
const CORE: [&str; 14] = [
    "picture", "physics", "signal", "detect", "timing", "sequence", "fit", "report", "analysis",
    "rules", "plot", "solve", "synth", "evaluate",
];
const OUTSIDE: [&str; 6] = [
    "std::fs",
    "std::thread",
    "std::io",
    "std::env",
    "println!",
    "print!(",
];

/// Source files, but for those that hold nothing but tests.
fn sources(under: &Path) -> Vec<PathBuf> {
    if under.is_file() {
        return vec![under.to_path_buf()];
    }
    let entries = fs::read_dir(under).unwrap_or_else(|e| panic!("{}: {e}", under.display()));
    entries
        .flat_map(|entry| sources(&entry.unwrap().path()))
        .filter(|p| p.extension().is_some_and(|e| e == "rs") && !p.ends_with("tests.rs"))
        .collect()
}

/// The lines of code of a file: not its comments, and not its tests, which may use anything.
fn code(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap();
    let product = text.split("#[cfg(test)]").next().unwrap_or_default();
    product
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"))
        .collect::<Vec<_>>()
        .join("\n")
}

#[test]
fn dependencies_point_one_way() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut looked_at = 0;
    for (layer, forbidden) in FORBIDDEN {
        for path in sources(&src.join(layer)) {
            let code = code(&path);
            looked_at += 1;
            for other in forbidden {
                let names = [format!("crate::{other}"), format!("bounce_audio::{other}")];
                let found = names.iter().find(|name| code.contains(name.as_str()));
                assert!(
                    found.is_none(),
                    "{} names {}",
                    path.display(),
                    found.unwrap()
                );
                // `use crate::{…}` would hide the name of the module from the search above.
                assert!(
                    !code.contains("use crate::{"),
                    "{}: one path per `use`",
                    path.display()
                );
            }
        }
    }
    assert!(looked_at > 20, "only {looked_at} files were looked at");
}

#[test]
fn the_core_touches_nothing_outside() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for layer in CORE {
        for path in sources(&src.join(layer)) {
            let code = code(&path);
            for outside in OUTSIDE {
                assert!(!code.contains(outside), "{} uses {outside}", path.display());
            }
        }
    }
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
