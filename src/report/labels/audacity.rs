//! Label tracks of Audacity.

use super::{Label, seconds};
use crate::Error;

const EXPECTED: &str = "start TAB end TAB text, in seconds";

pub(super) fn write(labels: &[(f64, String)]) -> String {
    let line = |(time_s, text): &(f64, String)| format!("{time_s}\t{time_s}\t{text}\n");
    labels.iter().map(line).collect()
}

/// Reads `start TAB end TAB text` in each line; text may be missing. Of a label with a length the start counts.
///
/// # Errors
/// [`Error::Line`] naming a line that does not begin with a time.
pub(super) fn read(text: &str) -> Result<Vec<Label>, Error> {
    let lines = text.lines().zip(1..);
    // A line that starts with a backslash holds the frequencies of the label above it.
    lines
        .filter(|(content, _)| !content.trim().is_empty() && !content.starts_with('\\'))
        .map(|(content, line)| {
            let mut fields = content.splitn(3, '\t');
            let start = fields.next().unwrap_or_default();
            Ok(Label {
                time_s: seconds(start, line, EXPECTED)?,
                text: fields.nth(1).unwrap_or_default().trim().to_owned(),
                line,
            })
        })
        .collect()
}
