//! What the fitted ball would do in another drop.

use serde::{Deserialize, Serialize};

use super::numbers::listed_words;
use super::rebound::Unit;
use crate::fit::Estimate;

/// A fall is no higher than this many times the height that a bounce shall reach.
pub(crate) const HIGHEST: f64 = 1e4;

/// What the law that a drop was fitted by says of other drops of its ball. Errors are those of one drop more, not of a mean.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Prediction {
    /// How high the ball comes back; null unless a height was asked about.
    pub rebounds: Option<Rebounds>,
    /// From how high it must fall to come back to a height; null unless that was asked.
    pub reach: Option<Reach>,
}

/// The rebounds of a ball from a height.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Rebounds {
    /// Height of release in metres.
    pub drop_height_m: f64,
    /// Height in metres after each bounce, the first one first; fewer than ten where the ball comes to rest before.
    pub heights_m: Vec<Estimate>,
}

/// A height that a bounce shall reach.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Reach {
    /// The bounce, counted from 1.
    pub bounce: usize,
    /// Height after it in metres.
    pub height_m: f64,
    /// Height of release in metres; null where not even 10,000 times the height is enough, as in air that holds the ball back.
    pub drop_height_m: Option<Estimate>,
}

impl Rebounds {
    pub(crate) const fn new(drop_height_m: f64, heights_m: Vec<Estimate>) -> Self {
        Self {
            drop_height_m,
            heights_m,
        }
    }
}

impl Reach {
    pub(crate) const fn new(bounce: usize, height_m: f64, drop_height_m: Option<Estimate>) -> Self {
        Self {
            bounce,
            height_m,
            drop_height_m,
        }
    }
}

/// A line for what was asked.
pub(super) fn in_words(prediction: &Prediction) -> Vec<String> {
    let rebounds = prediction.rebounds.as_ref().map(of_rebounds);
    let reach = prediction.reach.as_ref().map(of_reach);
    rebounds.into_iter().chain(reach).collect()
}

/// `from 100 cm to 64.0 ± 1.2, 41.0 ± 1.5 and 26.2 ± 1.4 cm`.
fn of_rebounds(rebounds: &Rebounds) -> String {
    let unit = Unit::of(rebounds.drop_height_m);
    let heights = rebounds.heights_m.iter().map(|height| {
        let told = unit.plus_minus(height.value, height.std_error.unwrap_or(0.0));
        told.trim_end_matches(unit.name).trim_end().to_owned()
    });
    let heights: Vec<String> = heights.collect();
    let from = unit.bare(rebounds.drop_height_m);
    if heights.is_empty() {
        return format!("from {from} it would not come back");
    }
    format!(
        "from {from} back to {} {}",
        listed_words(&heights),
        unit.name
    )
}

/// `for bounce 2 to reach 100 cm it must fall from 244 ± 9 cm`.
fn of_reach(reach: &Reach) -> String {
    let unit = Unit::of(reach.height_m);
    let goal = format!(
        "for bounce {} to reach {}",
        reach.bounce,
        unit.bare(reach.height_m)
    );
    match &reach.drop_height_m {
        Some(from) => format!(
            "{goal} it must fall from {}",
            unit.plus_minus(from.value, from.std_error.unwrap_or(0.0))
        ),
        None => format!("{goal} a fall from {HIGHEST} times that is not enough"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_prediction_is_told_with_its_errors_in_one_unit() {
        let with = |value: f64, std: f64| Estimate {
            std_error: Some(std),
            ..Estimate::bare(value)
        };
        let heights = vec![with(0.64, 0.012), with(0.41, 0.015)];
        let mut prediction = Prediction {
            rebounds: Some(Rebounds::new(1.0, heights)),
            reach: Some(Reach::new(2, 1.0, Some(with(2.44, 0.09)))),
        };
        assert_eq!(
            in_words(&prediction),
            [
                "from 100 cm back to 64.0 ± 1.2 and 41.0 ± 1.5 cm",
                "for bounce 2 to reach 100 cm it must fall from 244.0 ± 9.0 cm"
            ]
        );
        prediction.rebounds = Some(Rebounds::new(0.3, vec![]));
        prediction.reach = Some(Reach::new(3, 0.5, None));
        assert_eq!(
            in_words(&prediction),
            [
                "from 300 mm it would not come back",
                "for bounce 3 to reach 500 mm a fall from 10000 times that is not enough"
            ]
        );
    }
}
