//! The report as a JSON document.

use super::Report;

/// The document, ending with a line feed. Numbers that do not exist are null.
///
/// # Errors
/// If a value cannot be written as JSON, which no report of this library holds.
pub fn to_json(report: &Report) -> Result<String, serde_json::Error> {
    serde_json::to_string_pretty(report).map(|s| s + "\n")
}

/// The document in one line, ending with a line feed.
///
/// # Errors
/// As [`to_json`].
pub fn to_line(report: &Report) -> Result<String, serde_json::Error> {
    serde_json::to_string(report).map(|s| s + "\n")
}
