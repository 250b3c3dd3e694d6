//! What stopped a command, as a program reads it: JSON on standard output where JSON was asked for.

use std::ffi::OsString;

use serde_json::json;

use super::Outcome;
use crate::Error;

/// Whether the arguments ask for JSON; they may be wrong otherwise.
pub(super) fn wants_json(arguments: &[OsString]) -> bool {
    let words: Vec<_> = arguments.iter().map(|a| a.to_string_lossy()).collect();
    let is_json = |word: &str| word == "json" || word == "ndjson";
    let behind = words
        .windows(2)
        .any(|pair| pair[0] == "--format" && is_json(&pair[1]));
    behind
        || words
            .iter()
            .any(|w| w.strip_prefix("--format=").is_some_and(is_json))
}

/// `{"error", "file"}`: the file is null where the error is of none. Standard error has the sentence all the same.
pub(super) fn in_json(error: &Error) -> Outcome {
    let (file, reason) = match error {
        Error::InFile { file, source } => (Some(file), source.to_string()),
        other => (None, other.to_string()),
    };
    Outcome {
        note: format!("bounce-audio: {error}\n"),
        output: document(file, &reason),
        status: 2,
    }
}

/// The same of arguments that could not be parsed.
pub(super) fn of_arguments(error: &clap::Error) -> Outcome {
    let told = error.render().to_string();
    let reason = told.lines().next().unwrap_or_default();
    Outcome {
        output: document(None, reason.trim_start_matches("error: ")),
        note: told,
        status: 2,
    }
}

fn document(file: Option<&String>, reason: &str) -> String {
    json!({"file": file, "error": reason}).to_string() + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_is_asked_for_in_two_ways() {
        let asked =
            |line: &str| wants_json(&line.split(' ').map(OsString::from).collect::<Vec<_>>());
        assert!(asked("analyze a.wav --format json") && asked("batch --format=ndjson ."));
        assert!(!asked("analyze json --format csv") && !asked("analyze --format"));
    }

    #[test]
    fn the_file_stands_beside_the_reason() {
        let error = Error::refused("it is \"empty\"").in_file("a.wav");
        let said = in_json(&error);
        assert_eq!(
            said.output,
            "{\"error\":\"it is \\\"empty\\\"\",\"file\":\"a.wav\"}\n"
        );
        assert_eq!(said.note, "bounce-audio: a.wav: it is \"empty\"\n");
    }
}
