//! `bounce-audio analyze`: one recording.

use std::io::{self, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::labels::{Given, LabelArguments};
use super::rule::RuleArguments;
use super::{Outcome, acceleration, length, mass, time};
use crate::Error;
use crate::analysis::{Listener, Settings, analyze_labelled};
use crate::detect::refine::Timing;
use crate::fit::ladder::Choice;
use crate::report::text::Detail;
use crate::report::{self, RecordingInfo, Report, SettingsInfo, csv, json, text};
use crate::wav::Stream;

/// Analyze one recording of a bouncing ball.
///
/// Exit status: 0 a drop was found, 1 none was found, 2 the recording could not be read or an argument is wrong.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  bounce-audio analyze drop.wav
  bounce-audio analyze drop.wav --height 30.5cm
  bounce-audio analyze drop.wav --start 2 --end 9 --format json
  bounce-audio analyze drop.wav --labels drop.txt       (open both in Audacity, edit, export the labels)
  bounce-audio analyze drop.wav --impacts drop.txt      (fit what was edited)
  bounce-audio analyze drop.wav --rule ittf-ball
  sox drop.mp3 -t wav - | bounce-audio analyze -")]
pub(super) struct Arguments {
    /// A WAV file, or - for standard input
    file: PathBuf,
    /// Height of release, from the ball's lowest point to the surface: 30.5cm, 12in, 0.305
    #[arg(long, value_parser = length, allow_negative_numbers = true)]
    height: Option<f64>,
    /// Standard error of the height
    #[arg(long, value_parser = length, default_value = "1mm", allow_negative_numbers = true)]
    height_error: f64,
    /// Mass of the ball: 2.5g, 0.6kg; with --diameter the drag of the air is known, with a contact time k and c
    #[arg(long, value_parser = mass, allow_negative_numbers = true)]
    mass: Option<f64>,
    /// Diameter of the ball: 38mm
    #[arg(long, value_parser = length, allow_negative_numbers = true)]
    diameter: Option<f64>,
    /// Time in contact at each impact, if known: 1ms
    #[arg(long, value_parser = time, allow_negative_numbers = true)]
    contact_time: Option<f64>,
    /// Model of the intervals: constant e, and what is added to it
    #[arg(long, value_enum, default_value_t = ModelChoice::Auto)]
    model: ModelChoice,
    /// Gravity in m/s²
    #[arg(long, value_parser = acceleration, default_value = "9.81", allow_negative_numbers = true)]
    gravity: f64,
    /// Which channel to listen to: best (the one in which impacts stand out most) or its number from 1
    #[arg(long, default_value = "best", value_name = "best|N")]
    channel: Channel,
    /// Listen from here: 2s, 1.5, 2min
    #[arg(long, value_parser = time, allow_negative_numbers = true)]
    start: Option<f64>,
    /// Listen up to here
    #[arg(long, value_parser = time, allow_negative_numbers = true)]
    end: Option<f64>,
    /// How impacts are timed, from fastest to most exact
    #[arg(long, value_enum, default_value_t = TimingChoice::Auto)]
    timing: TimingChoice,
    /// Form of the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Of the text only the answer and what to know about it: no table of impacts, nothing of what was rejected
    #[arg(short, long, conflicts_with = "verbose")]
    quiet: bool,
    /// In the text every sound that was rejected, and the models that were compared
    #[arg(short, long)]
    verbose: bool,
    #[command(flatten)]
    labels: LabelArguments,
    #[command(flatten)]
    rule: RuleArguments,
}

#[derive(Debug, Clone, Copy)]
enum Channel {
    Best,
    Number(usize),
}

impl Channel {
    /// The indices of the channels that are listened to, of this many.
    fn of(self, channels: usize) -> Result<Range<usize>, Error> {
        match self {
            Self::Best => Ok(0..channels),
            Self::Number(number) if number <= channels => Ok(number - 1..number),
            Self::Number(number) => Err(Error::Argument {
                argument: "--channel",
                got: format!("{number} of a recording with {channels}"),
                expected: "best or the number of a channel, from 1",
            }),
        }
    }
}

impl std::str::FromStr for Channel {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse() {
            _ if text == "best" => Ok(Self::Best),
            Ok(number) if number > 0 => Ok(Self::Number(number)),
            _ => Err("expected best or a number from 1".to_owned()),
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum TimingChoice {
    /// The most exact that the recording allows
    Auto,
    /// The detector's grid, a quarter of a millisecond
    Envelope,
    /// A fixed fraction of each impact's rise
    Fraction,
    /// Correlation with the mean impact
    Correlation,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum ModelChoice {
    /// As much as the recording supports
    Auto,
    /// Constant e
    Constant,
    /// The time in contact stands in every interval
    Contact,
    /// A linear ball with weight: slow impacts last longer and lose more
    Linear,
    /// The air slows the ball
    Drag,
    /// e is a power of the impact speed
    Speed,
}

impl From<ModelChoice> for Choice {
    fn from(choice: ModelChoice) -> Self {
        match choice {
            ModelChoice::Auto => Self::Auto,
            ModelChoice::Constant => Self::Constant,
            ModelChoice::Contact => Self::Contact,
            ModelChoice::Linear => Self::Linear,
            ModelChoice::Drag => Self::Drag,
            ModelChoice::Speed => Self::Speed,
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Format {
    /// For a person
    Text,
    /// For programs: everything
    Json,
    /// One row per impact
    Csv,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let labels = arguments.labels.given()?;
    let mut report = if arguments.file == Path::new("-") {
        let open = Stream::open(io::stdin().lock());
        open.and_then(|stream| listen(arguments, labels, stream))
            .map_err(|e| e.in_file("standard input"))?
    } else {
        let stream = Stream::open_file(&arguments.file)?;
        listen(arguments, labels, stream).map_err(|e| e.in_file(&arguments.file))?
    };
    arguments.rule.judge(&mut report)?;
    arguments.labels.write(&report)?;
    let output = match arguments.format {
        Format::Text => text::to_text(&report, detail(arguments)),
        Format::Csv => csv::to_csv(&report),
        Format::Json => json::to_json(&report).map_err(io::Error::from)?,
    };
    Ok(Outcome {
        output,
        status: u8::from(report.analysis.drops.is_empty()),
    })
}

const fn detail(arguments: &Arguments) -> Detail {
    match (arguments.quiet, arguments.verbose) {
        (true, _) => Detail::Answer,
        (false, false) => Detail::Usual,
        (false, true) => Detail::Everything,
    }
}

/// Listens to a stream to its end, or fits the impacts of labels to it.
fn listen(
    arguments: &Arguments,
    labels: Option<Given<'_>>,
    mut stream: Stream<impl Read>,
) -> Result<Report, Error> {
    let settings = settings(arguments);
    let channels = usize::from(stream.container().channels);
    let heard = arguments.channel.of(channels)?;
    let rate = f64::from(stream.container().sample_rate_hz);
    let encoding = stream.container().encoding();
    let (ending, (channel, mut analysis)) = match labels {
        None => {
            let mut listener = Listener::new(heard.len(), rate, &settings)?;
            while listener.push_with(|room| stream.append(&heard, room))?? {}
            // A file without audio is no WAV to listen to: that comes before what was not found in it.
            (stream.finish()?, listener.finish()?)
        }
        Some((path, drops)) => {
            let mut samples = vec![Vec::new(); heard.len()];
            while stream.append(&heard, &mut samples)? {}
            let ending = stream.finish()?;
            let fitted = analyze_labelled(&samples, rate, &drops, &settings);
            (ending, fitted.map_err(|e| e.in_file(path))?)
        }
    };
    for drop in &mut analysis.drops {
        drop.channel += heard.start;
    }
    let repairs = ending.warnings.into_iter();
    let repairs = repairs.map(|message| report::Warning::new("repaired", message));
    analysis.warnings.extend(repairs);
    Ok(Report {
        schema_version: report::SCHEMA_VERSION,
        file: arguments.file.display().to_string(),
        recording: RecordingInfo {
            sample_rate_hz: rate,
            channels,
            channel: heard.start + channel + 1,
            duration_s: ending.duration_s,
            encoding,
        },
        settings: SettingsInfo {
            height_m: settings.height_m,
            height_std_m: settings.height_std_m,
            gravity_m_per_s2: settings.gravity_m_per_s2,
            mass_kg: settings.mass_kg,
            diameter_m: settings.diameter_m,
            contact_time_s: settings.contact_time_s,
            model: settings.model,
            start_s: settings.start_s,
            end_s: settings.end_s,
            timing: settings.timing,
        },
        analysis,
    })
}

fn settings(arguments: &Arguments) -> Settings {
    let mut settings = Settings {
        height_m: arguments.height,
        height_std_m: arguments.height_error,
        gravity_m_per_s2: arguments.gravity,
        mass_kg: arguments.mass,
        diameter_m: arguments.diameter,
        contact_time_s: arguments.contact_time,
        model: arguments.model.into(),
        start_s: arguments.start,
        end_s: arguments.end,
        timing: match arguments.timing {
            TimingChoice::Envelope => Timing::Envelope,
            TimingChoice::Fraction => Timing::Fraction,
            TimingChoice::Auto | TimingChoice::Correlation => Timing::Correlation,
        },
        ..Settings::default()
    };
    arguments.rule.complete(&mut settings);
    settings
}
