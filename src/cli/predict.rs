//! `--predict` and `--reach`: what another drop of the ball would do.

use clap::{Args, value_parser};

use super::quantity::height;
use crate::Error;
use crate::analysis::{Question, Settings};

/// What to predict.
#[derive(Debug, Args)]
#[command(next_help_heading = "Predictions")]
pub(super) struct PredictArguments {
    /// Say how high the ball would come back after each of ten bounces from this height: 1m, 30.5cm
    #[arg(long, value_name = "HEIGHT", value_parser = checked, allow_hyphen_values = true)]
    predict: Option<f64>,
    /// Say from how high the ball must fall for its second bounce to rise to this height: 1m
    #[arg(long, value_name = "HEIGHT", value_parser = checked, allow_hyphen_values = true)]
    reach: Option<f64>,
    /// Which bounce is to reach it
    #[arg(long, value_name = "N", default_value = "2", value_parser = value_parser!(u8).range(1..=10), requires = "reach", allow_hyphen_values = true)]
    reach_bounce: u8,
}

/// A height that a ball can be dropped from.
fn checked(text: &str) -> Result<f64, Error> {
    let height_m = height(text)?;
    Settings::default().height_m(height_m).check()?;
    Ok(height_m)
}

impl PredictArguments {
    /// None where nothing was asked.
    pub(super) fn question(&self) -> Option<Question> {
        let question = Question {
            from_m: self.predict,
            reach: self.reach.map(|h| (usize::from(self.reach_bounce), h)),
        };
        (question != Question::default()).then_some(question)
    }
}
