//! Time instants of Sonic Visualiser.

use super::{Label, seconds};
use crate::Error;

const EXPECTED: &str = "time,text, with the time in seconds";

pub(super) fn write(labels: &[(f64, String)]) -> String {
    // No text of an impact holds a comma or a quote.
    let line = |(time_s, text): &(f64, String)| format!("{time_s},{text}\n");
    labels.iter().map(line).collect()
}

/// Reads `time,text` in each line, the text in quotes or not; a first line that begins with a word is a heading.
pub(super) fn read(text: &str) -> Result<Vec<Label>, Error> {
    let is_heading = |content: &str| content.to_ascii_lowercase().starts_with("time");
    let lines = text.lines().zip(1..);
    lines
        .filter(|(content, _)| !content.trim().is_empty())
        .filter(|(content, line)| *line > 1 || !is_heading(content))
        .map(|(content, line)| {
            let (time, text) = content.split_once(',').unwrap_or((content, ""));
            Ok(Label {
                time_s: seconds(time, line, EXPECTED)?,
                text: text.trim().trim_matches('"').replace("\"\"", "\""),
                line,
            })
        })
        .collect()
}
