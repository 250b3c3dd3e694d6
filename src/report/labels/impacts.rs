//! Between impacts and the texts of labels.

use super::{Form, Label};
use crate::Error;
use crate::order::sort_by_number;
use crate::report::{Impact, Status};

/// An impact that a label stands for.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Marked {
    /// Seconds from the first sample.
    pub time_s: f64,
    /// Standard error of the time in seconds; 0 where it is inferred and counts for no flight.
    pub std_s: f64,
    /// Whether it was heard; an impact that a person set was.
    pub status: Status,
    /// Whether a person set or moved it.
    pub by_hand: bool,
    /// The line of its label.
    pub line: usize,
}

/// Time and text of the label of each impact, in order of time.
pub(super) fn labels(drops: &[&[Impact]]) -> Vec<(f64, String)> {
    let mut labels = Vec::new();
    for (drop, d) in drops.iter().zip(1..) {
        for (impact, number) in drop.iter().zip(1..) {
            let number = if drops.len() > 1 {
                format!("{d}:{number}")
            } else {
                format!("{number}")
            };
            labels.push((impact.time_s, format!("{number} {}", text(impact))));
        }
    }
    sort_by_number(&mut labels, |(time_s, _)| *time_s);
    labels
}

fn text(impact: &Impact) -> String {
    let mut text = impact.status.word().to_owned();
    if let Some(level) = impact.level_db {
        text += &format!(" {level:.1} dB");
    }
    text += &format!(" at {}", impact.time_s);
    match impact.time_std_s {
        Some(std) => text + &format!(" ±{std:e} s"),
        None => text + " s",
    }
}

/// The content of a label's text; a label that a person wrote may have none.
#[derive(Debug, Clone, Copy, Default)]
struct Said {
    drop: Option<usize>,
    status: Option<Status>,
    time_s: Option<f64>,
    std_s: Option<f64>,
}

impl Said {
    fn by(label: &Label) -> Result<Self, Error> {
        let mut said = Self::default();
        let mut words = label.text.split_whitespace().peekable();
        if let Some((drop, _)) = words.peek().and_then(|word| word.split_once(':')) {
            said.drop = drop.parse().ok();
        }
        while let Some(word) = words.next() {
            if let Some(std) = word.strip_prefix('±') {
                said.std_s = Some(error(std, label)?);
            } else if word == "at" {
                said.time_s = words.peek().and_then(|time| time.parse().ok());
            } else {
                let status = [Status::Heard, Status::Doubtful, Status::Inferred];
                said.status = status
                    .into_iter()
                    .find(|s| s.word() == word)
                    .or(said.status);
            }
        }
        Ok(said)
    }

    /// The impact. A label that stands where its text says it does has the time and error of its text. Of one that was
    /// moved from there neither counts: it is heard, and a person's.
    fn impact(self, label: &Label, form: Form, by_hand_s: f64) -> Marked {
        let inferred = self.status == Some(Status::Inferred);
        let from_text = self.time_s.filter(|t| is_there(*t, label.time_s, form));
        let moved = self.time_s.is_some() && from_text.is_none();
        let heard = Marked {
            time_s: from_text.unwrap_or(label.time_s),
            std_s: self.std_s.filter(|_| !moved).unwrap_or(by_hand_s),
            status: self.status.filter(|_| !moved).unwrap_or(Status::Heard),
            by_hand: from_text.is_none(),
            line: label.line,
        };
        if inferred && !moved {
            return Marked {
                std_s: 0.0,
                ..heard
            };
        }
        heard
    }
}

/// Whether a label that stands at one time was set at another, and only rounded by the tool.
fn is_there(set_s: f64, stands_s: f64, form: Form) -> bool {
    (set_s - stands_s).abs() <= form.rounding_s()
}

fn error(text: &str, label: &Label) -> Result<f64, Error> {
    let std: Option<f64> = text.parse().ok();
    std.filter(|s| s.is_finite() && *s > 0.0)
        .ok_or_else(|| Error::Line {
            line: label.line,
            problem: format!("'±{text}' is no standard error, expected ± and seconds above 0"),
        })
}

/// The impacts that labels stand for, drop by drop, in order of time.
///
/// A label is of the drop that its text says (`2:` or `2:17`); one that does not say is of the drop of that label with a
/// drop, or any, that is nearest in time. A label that stands where its text says (`at 1.156 ±2e-7 s`), but for what the
/// tool rounds, keeps that time and error. Others are a person's: they have the error that they state (`±0.0002`), or
/// `by_hand_s`. With `inferred` as part of its text, an impact is counted but bounds no flight.
///
/// # Errors
/// [`Error::Line`] naming the label, for an invalid error or a time that another label of the drop has.
pub fn drops(labels: &[Label], form: Form, by_hand_s: f64) -> Result<Vec<Vec<Marked>>, Error> {
    let said = labels.iter().map(Said::by);
    let said = said.collect::<Result<Vec<Said>, Error>>()?;
    let named: Vec<(f64, usize)> = labels
        .iter()
        .zip(&said)
        .filter_map(|(label, said)| Some((label.time_s, said.drop?)))
        .collect();
    let nearest = |time_s: f64| {
        let off = |other: &&(f64, usize)| (other.0 - time_s).abs();
        let found = named.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
        found.map_or(1, |(_, drop)| *drop)
    };
    let mut drops = std::collections::BTreeMap::<usize, Vec<Marked>>::new();
    for (label, said) in labels.iter().zip(&said) {
        let drop = said.drop.unwrap_or_else(|| nearest(label.time_s));
        let impact = said.impact(label, form, by_hand_s);
        drops.entry(drop).or_default().push(impact);
    }
    for impacts in drops.values_mut() {
        sort_by_number(impacts, |impact| impact.time_s);
        if let Some(pair) = impacts.windows(2).find(|p| p[0].time_s >= p[1].time_s) {
            return Err(Error::Line {
                line: pair[1].line,
                problem: format!(
                    "at {} s there is a label already, in line {}",
                    pair[1].time_s, pair[0].line
                ),
            });
        }
    }
    let mut drops: Vec<Vec<Marked>> = drops.into_values().collect();
    sort_by_number(&mut drops, |impacts| impacts[0].time_s);
    Ok(drops)
}
