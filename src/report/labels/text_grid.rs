//! A tier of points in a `TextGrid` of Praat, in its long form.

use super::{Label, seconds};
use crate::Error;

/// Praat's words for a tier of points.
const TIER: &str = "\"TextTier\"";

pub(super) fn write(labels: &[(f64, String)], duration_s: f64) -> String {
    let count = labels.len();
    let mut out = format!(
        "File type = \"ooTextFile\"\nObject class = \"TextGrid\"\n\nxmin = 0\nxmax = {duration_s}\n\
         tiers? <exists>\nsize = 1\nitem []:\n    item [1]:\n        class = {TIER}\n        name = \"impacts\"\n        \
         xmin = 0\n        xmax = {duration_s}\n        points: size = {count}\n"
    );
    for ((time_s, text), number) in labels.iter().zip(1..) {
        out += &format!(
            "        points [{number}]:\n            number = {time_s}\n            mark = \"{text}\"\n"
        );
    }
    out
}

/// Reads the points of all tiers of points: `number = ` (or `time = `, as older versions have it) and `mark = "…"`.
pub(super) fn read(text: &str) -> Result<Vec<Label>, Error> {
    if !text.contains(TIER) {
        return Err(Error::Line {
            line: 1,
            problem: "no TextGrid with a tier of points: in Praat, save as a text file".to_owned(),
        });
    }
    let mut labels: Vec<Label> = Vec::new();
    for (content, line) in text.lines().zip(1..) {
        let Some((key, value)) = content.split_once('=') else {
            continue;
        };
        match key.trim() {
            "number" | "time" => labels.push(Label {
                time_s: seconds(value, line, "number = a time in seconds")?,
                text: String::new(),
                line,
            }),
            "mark" => {
                if let Some(label) = labels.last_mut() {
                    value.trim().trim_matches('"').clone_into(&mut label.text);
                }
            }
            _ => {}
        }
    }
    Ok(labels)
}
