//! What is known beforehand of the ball and its drop, for all commands that fit; and options that take one of some words.

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use super::quantity::{
    acceleration, contact_time, diameter, height, length_error, mass, share_of_clock,
};
use crate::analysis::Settings;
use crate::fit::model_selection::Choice;
use crate::report::times::Decimal;

/// Known properties of the ball and of the place, and the model that is fitted.
#[derive(Debug, Clone, Args)]
pub(super) struct Known {
    /// Height of release, from the ball's lowest point to the surface: 30.5cm, 12in, 0.305
    #[arg(long, value_parser = height, allow_hyphen_values = true)]
    pub height: Option<f64>,
    /// Standard error of the height
    #[arg(long, value_parser = length_error, default_value = "1mm", allow_hyphen_values = true)]
    height_error: f64,
    /// Mass of the ball: 2.5g, 0.6kg; with --diameter the drag of the air is known, with a contact time k and c
    #[arg(long, value_parser = mass, allow_hyphen_values = true)]
    pub mass: Option<f64>,
    /// Diameter of the ball: 38mm
    #[arg(long, value_parser = diameter, allow_hyphen_values = true)]
    pub diameter: Option<f64>,
    /// Time in contact at each impact, if known: 1ms
    #[arg(long, value_parser = contact_time, allow_hyphen_values = true)]
    contact_time: Option<f64>,
    /// Time in the recording divided by real time: 8 for sound that was slowed down eight times
    #[arg(
        long,
        value_name = "FACTOR",
        default_value = "1",
        allow_hyphen_values = true
    )]
    time_scale: f64,
    /// Relative standard error of the clock of the device: 0.1%, 0.001
    #[arg(long, value_name = "SHARE", value_parser = share_of_clock, default_value = "0", allow_hyphen_values = true)]
    clock_error: f64,
    /// Model of the intervals: constant e, and what is added to it
    #[arg(long, default_value = "auto", value_parser = one_of(&MODELS))]
    model: Choice,
    /// Gravity in m/s²
    #[arg(long, value_parser = acceleration, default_value = "9.81", allow_hyphen_values = true)]
    gravity: f64,
}

impl Known {
    /// The settings with these properties.
    pub(super) fn settings(&self) -> Settings {
        Settings::default()
            .height_m(self.height)
            .height_std_m(self.height_error)
            .gravity_m_per_s2(self.gravity)
            .mass_kg(self.mass)
            .diameter_m(self.diameter)
            .contact_time_s(self.contact_time)
            .model(self.model)
            .time_scale(self.time_scale)
            .clock_std(self.clock_error)
    }
}

/// A word of the command line, what it stands for and what the help says of it.
pub(super) type Word<T> = (&'static str, T, &'static str);

const MODELS: [Word<Choice>; 8] = [
    model(
        Choice::Auto,
        "All of them but viscoelastic, by what the recording supports",
    ),
    model(Choice::Constant, "Constant e"),
    model(
        Choice::Contact,
        "The time in contact stands in every interval",
    ),
    model(
        Choice::Linear,
        "A linear ball with weight: slow impacts last longer and lose more",
    ),
    model(Choice::Drag, "The air slows the ball"),
    model(Choice::Speed, "e is a power of the impact speed"),
    model(
        Choice::Viscoelastic,
        "Viscoelastic spheres: 1 − e goes with the fifth root of the impact speed",
    ),
    model(
        Choice::Flexible,
        "Contact, drag, and any smooth course of e with the speed",
    ),
];

const fn model(choice: Choice, help: &'static str) -> Word<Choice> {
    (choice.word(), choice, help)
}

/// One of these words.
pub(super) fn one_of<T: Copy + Send + Sync + 'static>(
    words: &'static [Word<T>],
) -> impl TypedValueParser<Value = T> {
    let values = words
        .iter()
        .map(|(word, _, help)| PossibleValue::new(*word).help(*help));
    PossibleValuesParser::new(values).try_map(|given| {
        let named = words.iter().find(|(word, ..)| *word == given);
        named
            .map(|(_, value, _)| *value)
            .ok_or("not one of the words")
    })
}

/// Decimal marks.
pub(super) const DECIMALS: [Word<Decimal>; 2] = [
    (Decimal::Point.word(), Decimal::Point, "As in 0.5"),
    (Decimal::Comma.word(), Decimal::Comma, "As in 0,5"),
];
