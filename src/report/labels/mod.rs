//! Impacts as labels for other tools, and labels as impacts again.
//!
//! A label stands at the time of its impact. Its text says what the impact is and holds the time and its standard error
//! in full, because tools round the times that they write:
//!
//! ```text
//! 2:17 heard -3.4 dB at 1.1564341234567 ±1.3e-8 s
//! ```
//!
//! is impact 17 of drop 2 (of a single drop only `17` is said). [`drops`] reads that back; a label that was moved, or
//! set by a person, has another error than one that was left alone.

mod audacity;
mod impacts;
mod instants;
mod text_grid;

pub use impacts::{Marked, drops};

use super::Impact;
use crate::Error;

/// Which tool labels are for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Form {
    /// A label track of Audacity: `start TAB end TAB text` in each line.
    Audacity,
    /// Time instants of Sonic Visualiser: `time,text` in each line.
    Instants,
    /// A `TextGrid` of Praat with one tier of points.
    TextGrid,
}

/// Audacity writes six decimals, Praat all of them.
const DECIMALS_S: f64 = 0.6e-6;
/// Sonic Visualiser puts instants on whole samples, which are nearer than this at 44.1 kHz and more.
const SAMPLE_S: f64 = 12e-6;

impl Form {
    /// By the ending of a file's name: `txt`, `csv` or `TextGrid`, in whatever case.
    #[must_use]
    pub fn of_extension(extension: &str) -> Option<Self> {
        [
            ("txt", Self::Audacity),
            ("csv", Self::Instants),
            ("textgrid", Self::TextGrid),
        ]
        .into_iter()
        .find(|(name, _)| name.eq_ignore_ascii_case(extension))
        .map(|(_, form)| form)
    }

    /// How far off the tool itself may write a time that no one moved, in seconds.
    const fn rounding_s(self) -> f64 {
        match self {
            Self::Audacity | Self::TextGrid => DECIMALS_S,
            Self::Instants => SAMPLE_S,
        }
    }
}

/// A label as it stands in a file.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Label {
    /// Where it begins, in seconds from the first sample.
    pub time_s: f64,
    /// Its text.
    pub text: String,
    /// The line that it stands in, from 1.
    pub line: usize,
}

/// The impacts of each drop as labels, in order of time; the recording lasts for `duration_s`.
#[must_use]
pub fn to_labels(drops: &[&[Impact]], duration_s: f64, form: Form) -> String {
    let labels = impacts::labels(drops);
    match form {
        Form::Audacity => audacity::write(&labels),
        Form::Instants => instants::write(&labels),
        Form::TextGrid => text_grid::write(&labels, duration_s),
    }
}

/// Reads labels, in the order of the file, which is UTF-8 or, with a byte order mark, UTF-16.
///
/// # Errors
/// [`Error::Line`] naming the line that is no label.
pub fn read(bytes: &[u8], form: Form) -> Result<Vec<Label>, Error> {
    let text = decoded(bytes).ok_or_else(|| Error::Line {
        line: 1,
        problem: "no text in UTF-8 or UTF-16: export the labels as text".to_owned(),
    })?;
    // Editors of some systems put a byte order mark first in UTF-8 too.
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text);
    match form {
        Form::Audacity => audacity::read(text),
        Form::Instants => instants::read(text),
        Form::TextGrid => text_grid::read(text),
    }
}

/// The text of a file; Praat writes UTF-16 where a text is not all ASCII, and ± is not.
pub(super) fn decoded(bytes: &[u8]) -> Option<String> {
    let (pairs, first_is_high) = match bytes {
        [0xfe, 0xff, pairs @ ..] => (pairs, true),
        [0xff, 0xfe, pairs @ ..] => (pairs, false),
        _ => return String::from_utf8(bytes.to_vec()).ok(),
    };
    let units = pairs.chunks_exact(2).map(|pair| {
        let pair = [pair[0], pair[1]];
        if first_is_high {
            u16::from_be_bytes(pair)
        } else {
            u16::from_le_bytes(pair)
        }
    });
    char::decode_utf16(units).collect::<Result<_, _>>().ok()
}

/// A time as tools write it; where the system has a decimal comma, so have some.
fn seconds(field: &str, line: usize, expected: &str) -> Result<f64, Error> {
    let time: Option<f64> = field.trim().replace(',', ".").parse().ok();
    match time.filter(|t| t.is_finite()) {
        Some(time_s) if time_s >= 0.0 => Ok(time_s),
        Some(time_s) => Err(Error::Line {
            line,
            problem: format!("{time_s} s is before the recording begins"),
        }),
        None => Err(Error::Line {
            line,
            problem: format!("'{}' is no time, expected {expected}", field.trim()),
        }),
    }
}

#[cfg(test)]
mod tests;
