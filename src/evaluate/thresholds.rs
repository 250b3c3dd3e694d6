//! What was once reached, scene by scene, and must not be lost again.

use std::collections::BTreeMap;

use serde::Deserialize;

use super::rows::Row;
use crate::Error;

/// Thresholds by the name of the scene; `all` is for all recordings together.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(transparent)]
pub struct Thresholds {
    scenes: BTreeMap<String, Threshold>,
}

/// The least or the most that a row may show. What is absent is not held.
#[derive(Debug, Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Threshold {
    recall: Option<f64>,
    precision: Option<f64>,
    coverage95: Option<f64>,
    false_drops: Option<f64>,
    lost_drops: Option<f64>,
    timing_error_median_s: Option<f64>,
    restitution_error_p90: Option<f64>,
}

/// A number that is held: its name, where it is in a threshold and in a row, and whether more of it is better.
struct Held {
    name: &'static str,
    bound: fn(&mut Threshold) -> &mut Option<f64>,
    value: fn(&Row) -> Option<f64>,
    more_is_better: bool,
    /// The margin as a share of the value, and at least this much: a change of compiler or of one impact must not fail.
    margin: (f64, f64),
}

const HELD: [Held; 7] = [
    Held {
        name: "recall",
        bound: |t| &mut t.recall,
        value: |r| r.recall,
        more_is_better: true,
        margin: (0.0, 0.02),
    },
    Held {
        name: "precision",
        bound: |t| &mut t.precision,
        value: |r| r.precision,
        more_is_better: true,
        margin: (0.0, 0.02),
    },
    Held {
        name: "coverage95",
        bound: |t| &mut t.coverage95,
        value: |r| r.scene.is_none().then_some(r.coverage95).flatten(),
        more_is_better: true,
        margin: (0.0, 0.02),
    },
    Held {
        name: "false_drops",
        bound: |t| &mut t.false_drops,
        value: |r| Some(crate::units::real(r.false_drops)),
        more_is_better: false,
        margin: (0.0, 0.0),
    },
    Held {
        name: "lost_drops",
        bound: |t| &mut t.lost_drops,
        value: |r| Some(crate::units::real(r.lost_drops)),
        more_is_better: false,
        margin: (0.0, 0.0),
    },
    Held {
        name: "timing_error_median_s",
        bound: |t| &mut t.timing_error_median_s,
        value: |r| r.timing_error_median_s,
        more_is_better: false,
        margin: (0.25, 20e-9),
    },
    Held {
        name: "restitution_error_p90",
        bound: |t| &mut t.restitution_error_p90,
        // A few drops of one scene differ by the luck of their bounces more than by how they are analyzed.
        value: |r| {
            let all = r.scene.is_none();
            all.then_some(r.restitution_error_p90).flatten()
        },
        more_is_better: false,
        margin: (0.1, 2e-4),
    },
];

impl Thresholds {
    /// Reads thresholds.
    ///
    /// # Errors
    /// [`Error::Argument`] saying where the text is none.
    pub fn from_toml(text: &str) -> Result<Self, Error> {
        toml::from_str(text).map_err(|e| Error::Argument {
            argument: "thresholds",
            got: e.to_string().trim_end().to_owned(),
            expected: "a table for each scene",
        })
    }

    /// What falls short, a sentence each. A scene without thresholds falls short, and so does one that is missing.
    #[must_use]
    pub fn complaints<'a>(&self, rows: impl IntoIterator<Item = &'a Row>) -> Vec<String> {
        let mut complaints = Vec::new();
        let mut unseen: Vec<&str> = self.scenes.keys().map(String::as_str).collect();
        for row in rows {
            let name = row.scene.as_deref().unwrap_or("all");
            unseen.retain(|other| *other != name);
            match self.scenes.get(name) {
                Some(threshold) => complaints.extend(shortfalls(name, *threshold, row)),
                None => complaints.push(format!("{name}: no thresholds")),
            }
        }
        complaints.extend(unseen.iter().map(|name| format!("{name}: not evaluated")));
        complaints
    }

    /// These thresholds, made stricter where rows are better than they ask by more than a margin, and with those of new
    /// scenes, as text.
    #[must_use]
    pub fn tightened<'a>(&self, rows: impl IntoIterator<Item = &'a Row>) -> String {
        let mut scenes = self.scenes.clone();
        for row in rows {
            let name = row.scene.as_deref().unwrap_or("all");
            let threshold = scenes.entry(name.to_owned()).or_default();
            for held in &HELD {
                let bound = (held.bound)(threshold);
                *bound = stricter(held, *bound, (held.value)(row));
            }
        }
        let mut text = String::from(
            "# What was reached, less a margin. Made by `bounce-audio evaluate DIR --tighten`, which only makes it stricter.\n",
        );
        for (name, mut threshold) in scenes {
            text += &format!("\n[{name}]\n");
            for held in &HELD {
                if let Some(bound) = (held.bound)(&mut threshold) {
                    text += &format!("{} = {bound:?}\n", held.name);
                }
            }
        }
        text
    }
}

fn shortfalls(name: &str, mut threshold: Threshold, row: &Row) -> Vec<String> {
    let mut found = Vec::new();
    for held in &HELD {
        let Some(bound) = *(held.bound)(&mut threshold) else {
            continue;
        };
        let value = (held.value)(row);
        let good = value.is_some_and(|v| {
            if held.more_is_better {
                v >= bound
            } else {
                v <= bound
            }
        });
        if !good {
            let side = if held.more_is_better {
                "at least"
            } else {
                "at most"
            };
            let value = value.map_or_else(|| "absent".to_owned(), |v| format!("{v:.4e}"));
            found.push(format!(
                "{name}: {} is {value}, {side} {bound:.4e} was reached",
                held.name
            ));
        }
    }
    found
}

/// The stricter of a bound and a value less its margin, rounded to three digits away from strictness.
fn stricter(held: &Held, bound: Option<f64>, value: Option<f64>) -> Option<f64> {
    let Some(value) = value else {
        return bound;
    };
    let margin = (held.margin.0 * value).max(held.margin.1);
    let reached = if held.more_is_better {
        rounded(value - margin, f64::floor).max(0.0)
    } else {
        rounded(value + margin, f64::ceil)
    };
    Some(match bound {
        None => reached,
        Some(old) if held.more_is_better => old.max(reached),
        Some(old) => old.min(reached),
    })
}

fn rounded(x: f64, way: fn(f64) -> f64) -> f64 {
    if x == 0.0 {
        return 0.0;
    }
    // Dividing by whole powers of ten gives the double that the short decimal is read as.
    let digits = 2.0 - x.abs().log10().floor();
    let power = 10.0_f64.powi(exponent(digits.abs()));
    if digits >= 0.0 {
        way(x * power) / power
    } else {
        way(x / power) * power
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "exponents of doubles are below 400"
)]
fn exponent(digits: f64) -> i32 {
    digits as i32
}
