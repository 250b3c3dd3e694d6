//! `bounce-audio analyze`: one recording.

use std::io::{self, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::picture::{Target, check_readable_twice, draw_sheets};
use super::{Outcome, acceleration, length, mass, time};
use crate::Error;
use crate::analysis::{Listener, Settings};
use crate::detect::refine::Timing;
use crate::fit::ladder::Choice;
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
  bounce-audio analyze drop.wav --plot drop.svg
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
    /// Draw a sheet into this picture; of several drops OUT-1.svg, OUT-2.svg, …; not for a pipe
    #[arg(long, value_name = "OUT.svg|png")]
    plot: Option<PathBuf>,
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
                got: number.to_string(),
                expected: "a channel that the recording has",
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
    let target = arguments.plot.as_deref().map(Target::new).transpose()?;
    if target.is_some() {
        check_readable_twice(&arguments.file)?;
    }
    let report = if arguments.file == Path::new("-") {
        let open = Stream::open(io::stdin().lock());
        open.and_then(|stream| listen(arguments, stream))
            .map_err(|e| e.in_file("standard input"))?
    } else {
        let stream = Stream::open_file(&arguments.file)?;
        listen(arguments, stream).map_err(|e| e.in_file(&arguments.file))?
    };
    if let Some(target) = target {
        draw_sheets(&target, &arguments.file, &report)?;
    }
    let output = match arguments.format {
        Format::Text => text::to_text(&report),
        Format::Csv => csv::to_csv(&report),
        Format::Json => json::to_json(&report).map_err(io::Error::from)?,
    };
    Ok(Outcome {
        output,
        status: u8::from(report.analysis.drops.is_empty()),
    })
}

/// Listens to a stream to its end.
fn listen(arguments: &Arguments, mut stream: Stream<impl Read>) -> Result<Report, Error> {
    let settings = settings(arguments);
    let channels = usize::from(stream.container().channels);
    let heard = arguments.channel.of(channels)?;
    let rate = f64::from(stream.container().sample_rate_hz);
    let encoding = stream.container().encoding();
    let mut listener = Listener::new(heard.len(), rate, &settings)?;
    while listener.push_with(|room| stream.append(&heard, room))?? {}
    // A file without audio is no WAV to listen to: that comes before what was not found in it.
    let ending = stream.finish()?;
    let (channel, mut analysis) = listener.finish()?;
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
    Settings {
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
    }
}
