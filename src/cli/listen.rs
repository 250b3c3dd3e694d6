//! What `analyze` and `batch` share: how to listen, and one recording to its report.

use std::path::Path;

use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};

use super::quantity::{acceleration, contact_time, diameter, height, length_error, mass, time};
use crate::Error;
use crate::analysis::Settings;
use crate::audio::Stream;
use crate::fit::model_selection::Choice;
use crate::recording::{Channel, Request};
use crate::report::Report;
use crate::timing::Timing;

/// What is known beforehand and how to listen.
#[derive(Debug, Clone, Args)]
pub(super) struct Listening {
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
    /// Model of the intervals: constant e, and what is added to it
    #[arg(long, default_value = "auto", value_parser = one_of(&MODELS))]
    model: Choice,
    /// Gravity in m/s²
    #[arg(long, value_parser = acceleration, default_value = "9.81", allow_hyphen_values = true)]
    gravity: f64,
    /// Which channel to listen to: best (the one in which impacts stand out most) or its number from 1
    #[arg(
        long,
        value_parser = channel,
        default_value = "best",
        value_name = "best|N",
        allow_hyphen_values = true
    )]
    channel: Channel,
    /// Listen from here: 2s, 1.5, 2min, 1:30
    #[arg(long, value_parser = time, allow_hyphen_values = true)]
    start: Option<f64>,
    /// Listen up to here
    #[arg(long, value_parser = time, allow_hyphen_values = true)]
    end: Option<f64>,
    /// How impacts are timed, from fastest to most exact
    #[arg(long, default_value = "auto", value_parser = one_of(&TIMINGS))]
    timing: Timing,
}

fn channel(text: &str) -> Result<Channel, String> {
    match text.parse() {
        _ if text == "best" => Ok(Channel::Best),
        Ok(number) if number > 0 => Ok(Channel::Number(number)),
        _ => Err("expected best or a number from 1".to_owned()),
    }
}

/// A word of the command line, what it stands for and what the help says of it.
type Word<T> = (&'static str, T, &'static str);

const TIMINGS: [Word<Timing>; 4] = [
    (
        "auto",
        Timing::Correlation,
        "The most exact that the recording allows",
    ),
    (
        Timing::Envelope.word(),
        Timing::Envelope,
        "The detector's grid, a quarter of a millisecond",
    ),
    (
        Timing::Fraction.word(),
        Timing::Fraction,
        "A fixed fraction of each impact's rise",
    ),
    (
        Timing::Correlation.word(),
        Timing::Correlation,
        "Correlation with the mean impact",
    ),
];

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
fn one_of<T: Copy + Send + Sync + 'static>(
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

impl Listening {
    /// What the library is asked.
    pub(super) fn request(&self) -> Request<'static> {
        let settings = Settings::default()
            .height_m(self.height)
            .height_std_m(self.height_error)
            .gravity_m_per_s2(self.gravity)
            .mass_kg(self.mass)
            .diameter_m(self.diameter)
            .contact_time_s(self.contact_time)
            .model(self.model)
            .start_s(self.start)
            .end_s(self.end)
            .timing(self.timing);
        Request {
            settings,
            channel: self.channel,
            ..Request::default()
        }
    }
}

/// The report of a file.
pub(super) fn listen_to_file(path: &Path, request: &Request<'_>) -> Result<Report, Error> {
    let stream = Stream::open_file(path)?;
    let report = request.listen(stream, &name(path));
    report.map_err(|e| e.in_file(path))
}

/// The name of a file in a document: as it is, but for bytes that are no UTF-8, which are written as `\xFF`.
///
/// A replacement character would give two files one name.
pub(super) fn name(path: &Path) -> String {
    let mut name = String::new();
    for chunk in path.as_os_str().as_encoded_bytes().utf8_chunks() {
        name += chunk.valid();
        for byte in chunk.invalid() {
            name += &format!("\\x{byte:02X}");
        }
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn names_that_are_no_text_stay_apart() {
        use std::ffi::OsStr;
        use std::os::unix::ffi::OsStrExt;
        for (bytes, shown) in [
            (&b"a b,\n.wav"[..], "a b,\n.wav"),
            (b"h\xE9.wav", "h\\xE9.wav"),
            (b"h\xE8.wav", "h\\xE8.wav"),
            ("hé.wav".as_bytes(), "hé.wav"),
        ] {
            assert_eq!(name(Path::new(OsStr::from_bytes(bytes))), shown);
        }
    }
}
