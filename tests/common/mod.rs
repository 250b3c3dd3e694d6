//! What several tests do: run the command, in a folder of their own.

mod piped;
mod writers;

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

pub(crate) use piped::piped;
use serde_json::Value;
pub(crate) use writers::WRITERS;

pub(crate) const PROGRAM: &str = env!("CARGO_BIN_EXE_bounce-audio");

/// Runs the command.
pub(crate) fn run(arguments: &[&str]) -> Output {
    Command::new(PROGRAM).args(arguments).output().unwrap()
}

/// Runs the command in a folder.
pub(crate) fn run_in(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(PROGRAM)
        .current_dir(folder)
        .args(arguments)
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

/// What the command prints as JSON.
pub(crate) fn json(arguments: &[&str]) -> Value {
    let output = run(&[arguments, &["--format", "json"]].concat());
    serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|e| panic!("{e}: {}", text(&output.stderr)))
}

/// Makes the recording of a scene in a folder; gives its path.
pub(crate) fn synthesized(folder: &Path, name: &str, scene: &str) -> String {
    let path = folder.join(format!("{name}.toml"));
    fs::write(&path, scene).unwrap();
    let wav = folder.join(format!("{name}.wav")).display().to_string();
    let made = run(&["synth", &path.display().to_string(), "-o", &wav]);
    assert!(made.status.success(), "{}", text(&made.stderr));
    wav
}

/// The only drop of a document.
pub(crate) fn only_drop(document: &Value) -> &Value {
    assert_eq!(document["drops"].as_array().unwrap().len(), 1, "{document}");
    &document["drops"][0]
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// An empty folder for a test of an area.
pub(crate) fn empty_folder(area: &str, name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(area).join(name);
    // There is none on the first run.
    drop(fs::remove_dir_all(&folder));
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// The names of the files in a folder.
pub(crate) fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}
