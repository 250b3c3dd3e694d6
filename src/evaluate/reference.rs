//! What is known to be true of a recording: a truth file of `synth`, or the labels that a person set.

use serde::Deserialize;

use crate::Error;
use crate::report::labels::{Form, read};

/// What is true of a recording.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
pub struct Reference {
    /// The scene, if it was made from one.
    #[serde(default)]
    pub scene: String,
    /// Its drops.
    pub drops: Vec<ReferenceDrop>,
}

/// What is true of a drop. Lists other than `onsets_s` and `audible` may be empty.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
pub struct ReferenceDrop {
    /// When each impact is heard, in seconds from the first sample.
    pub onsets_s: Vec<f64>,
    /// The same in each channel but the first, whose times `onsets_s` are.
    #[serde(default)]
    pub more_onsets_s: Vec<Vec<f64>>,
    /// Whether it can be heard at all.
    pub audible: Vec<bool>,
    /// Least standard error of its time, in seconds.
    #[serde(default)]
    pub timing_limit_s: Vec<Option<f64>>,
    /// Standard error that a match with the mean sound reaches at best, in seconds.
    #[serde(default)]
    pub timing_floor_s: Vec<Option<f64>>,
    /// Speed of each impact in m/s.
    #[serde(default)]
    pub speeds_m_per_s: Vec<f64>,
    /// e of each impact before scatter.
    #[serde(default)]
    pub restitution_nominal_each: Vec<f64>,
    /// e of each impact as it happened.
    #[serde(default)]
    pub restitution_each: Vec<f64>,
    /// Period of the sound in seconds.
    #[serde(default)]
    pub period_s: Option<f64>,
}

impl Reference {
    /// Reads a truth file.
    ///
    /// # Errors
    /// [`Error::Argument`] if it is none, or its lists differ in length.
    pub fn from_json(text: &str) -> Result<Self, Error> {
        let reference: Self = serde_json::from_str(text).map_err(|e| broken(e.to_string()))?;
        for drop in &reference.drops {
            let count = drop.onsets_s.len();
            let fits = |length: usize| length == 0 || length == count;
            let each = drop.restitution_each.len();
            if drop.audible.len() != count
                || drop.more_onsets_s.iter().any(|o| o.len() != count)
                || !fits(drop.timing_limit_s.len())
                || !fits(drop.timing_floor_s.len())
                || !fits(drop.speeds_m_per_s.len())
                || drop.restitution_nominal_each.len() != drop.speeds_m_per_s.len()
                || !fits(each)
            {
                return Err(broken("its lists differ in length".to_owned()));
            }
        }
        Ok(reference)
    }

    /// Reads an Audacity label track: `start TAB end TAB text` in each line. Every label is an impact that can be heard,
    /// all of one drop.
    ///
    /// # Errors
    /// [`Error::Line`] naming a line that is no label.
    pub fn from_labels(text: &str) -> Result<Self, Error> {
        let labels = read(text.as_bytes(), Form::Audacity)?;
        let mut onsets_s: Vec<f64> = labels.iter().map(|l| l.time_s).collect();
        onsets_s.sort_by(f64::total_cmp);
        let drop = ReferenceDrop {
            audible: vec![true; onsets_s.len()],
            onsets_s,
            ..ReferenceDrop::default()
        };
        Ok(Self {
            scene: String::new(),
            drops: vec![drop],
        })
    }
}

impl ReferenceDrop {
    /// How much later than in the first channel an impact is heard in this one, counted from 1.
    #[must_use]
    pub fn later_s(&self, impact: usize, channel: usize) -> f64 {
        let other = channel
            .checked_sub(2)
            .and_then(|i| self.more_onsets_s.get(i));
        other.map_or(0.0, |onsets_s| onsets_s[impact] - self.onsets_s[impact])
    }

    /// e before scatter at a speed, between those of the impacts: linear in ln v, constant beyond the ends.
    #[must_use]
    pub fn restitution_at(&self, speed_m_per_s: f64) -> Option<f64> {
        let known = self
            .speeds_m_per_s
            .iter()
            .zip(&self.restitution_nominal_each);
        // Speeds fall from impact to impact.
        let mut faster: Option<(f64, f64)> = None;
        for (&speed, &e) in known.filter(|(_, e)| **e > 0.0) {
            if speed <= speed_m_per_s {
                return Some(match faster {
                    None => e,
                    Some((v, e_v)) => {
                        let share = (speed_m_per_s / speed).ln() / (v / speed).ln();
                        e + share * (e_v - e)
                    }
                });
            }
            faster = Some((speed, e));
        }
        faster.map(|(_, e)| e)
    }
}

fn broken(got: String) -> Error {
    Error::Argument {
        argument: "truth",
        got,
        expected: "a .truth.json of bounce-audio synth",
    }
}
