//! `bounce-audio fit`: impact times typed in.

use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};

use super::Outcome;
use super::analyze::keep;
use super::document::DocumentArguments;
use super::known::{DECIMALS, Known, Word, one_of};
use super::listen::name;
use super::picture::{Target, check_readable_twice, draw_all};
use super::predict::PredictArguments;
use super::quantity::time;
use super::rule::RuleArguments;
use crate::Error;
use crate::picture::sheet::sheets_of_times;
use crate::recording::Request;
use crate::report::text::Detail;
use crate::report::times::{self, Decimal, Kind, Reading, Unit};
use crate::report::{Report, csv, json, text};

/// Fit impact times that were measured otherwise: by a light gate, a video, a stopwatch.
///
/// A line holds a time, or the interval to the next impact, and in a second column which drop it is of; a heading may name
/// both and the unit. Where a line can be read in two ways, fit stops with an error that says
/// how to make it clear.
///
/// Exit status: 0 fitted, 2 the list could not be read or an argument is wrong; with --rule 3 a drop fails and 4 the verdict
/// is open.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  bounce-audio fit times.csv --height 30.5cm
  bounce-audio fit intervals.csv --unit ms --time-error 0.1ms
  printf '0.823\\n0.741\\n0.667\\n' | bounce-audio fit - --height 1m

A list with two drops, in ms:
  time [ms];drop
  0;first
  512,5;first
  0;second
  508;second")]
pub(super) struct Arguments {
    /// A list of times or intervals (CSV, tabs or blanks between columns), or - for standard input
    file: PathBuf,
    /// What the numbers are [default: by the heading, else whether they grow or shrink]
    #[arg(long = "as", value_name = "KIND", value_parser = one_of(&KINDS))]
    kind: Option<Kind>,
    /// Unit of the numbers [default: by the heading, else that in which the flights are those of a ball]
    #[arg(long, value_parser = one_of(&UNITS))]
    unit: Option<Unit>,
    /// What stands before the decimals of the list [default: as it shows], and of CSV that is written [default: point]
    #[arg(long, value_name = "MARK", value_parser = one_of(&DECIMALS))]
    decimal: Option<Decimal>,
    /// Standard error of each time [default: 1 ms, or that of the rounding if it is more]
    #[arg(long, value_parser = time, allow_hyphen_values = true)]
    time_error: Option<f64>,
    #[command(flatten)]
    known: Known,
    /// Form of the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// One line a drop for a shell script: e, its error, bounces, seconds, warnings, file
    #[arg(short, long, conflicts_with = "verbose")]
    quiet: bool,
    /// In the text also the plain formulas, every bounce and the models compared
    #[arg(short, long, visible_alias = "table")]
    verbose: bool,
    /// Draw flights, e and heights into this picture; of several drops OUT-1.svg, OUT-2.svg, …
    #[arg(long, value_name = "OUT.svg|png")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    predict: PredictArguments,
    #[command(flatten)]
    rule: RuleArguments,
    #[command(flatten)]
    document: DocumentArguments,
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

const KINDS: [Word<Kind>; 2] = [
    (Kind::Times.word(), Kind::Times, "When the ball hit"),
    (
        Kind::Intervals.word(),
        Kind::Intervals,
        "From one impact to the next",
    ),
];

const UNITS: [Word<Unit>; 3] = [
    (Unit::Seconds.word(), Unit::Seconds, "Seconds"),
    (Unit::Milliseconds.word(), Unit::Milliseconds, "Thousandths"),
    (Unit::Microseconds.word(), Unit::Microseconds, "Millionths"),
];

/// Standard error of a time of which nothing is said: that of a person with a label, as `analyze --label-error` has it.
const USUAL_ERROR_S: f64 = 1e-3;

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let target = arguments.plot.as_deref().map(Target::new).transpose()?;
    arguments.document.check()?;
    if arguments.document.report.is_some() {
        check_readable_twice(&arguments.file)?;
    }
    let report = report(arguments).map_err(|e| e.in_file(told(&arguments.file)))?;
    if let Some(target) = target {
        draw_all(&target, &sheets_of_times(&report))?;
    }
    let ball = |detail| arguments.rule.ball(&arguments.known, &report, detail);
    keep(
        &arguments.document,
        &arguments.file,
        &report,
        &ball(Detail::Usual),
        |_, report| Ok(sheets_of_times(report)),
    )?;
    let detail = match (arguments.quiet, arguments.verbose) {
        (true, _) => Detail::Answer,
        (false, false) => Detail::Usual,
        (false, true) => Detail::Everything,
    };
    let output = match arguments.format {
        Format::Text => text::to_text(&report, detail) + &ball(detail),
        Format::Csv if arguments.decimal == Some(Decimal::Comma) => {
            csv::with_decimal_commas(&csv::to_csv(&report))
        }
        Format::Csv => csv::to_csv(&report),
        Format::Json => json::to_json(&report).map_err(io::Error::from)?,
    };
    Ok(Outcome {
        status: arguments.rule.status(&report, 0),
        ..Outcome::of(output)
    })
}

fn told(file: &Path) -> &Path {
    if file == Path::new("-") {
        Path::new("standard input")
    } else {
        file
    }
}

fn report(arguments: &Arguments) -> Result<Report, Error> {
    let request = Request {
        settings: arguments.known.settings(),
        rule: arguments.rule.rule,
        question: arguments.predict.question(),
        ..Request::default()
    };
    let bytes = if arguments.file == Path::new("-") {
        let mut bytes = Vec::new();
        io::stdin().read_to_end(&mut bytes)?;
        bytes
    } else {
        fs::read(&arguments.file)?
    };
    let named = name(&arguments.file);
    of_list(
        &bytes,
        arguments.reading(),
        arguments.time_error,
        &request,
        &named,
    )
}

/// The report of a list of this name, each of its times with this standard error or that of its rounding.
pub(super) fn of_list(
    bytes: &[u8],
    reading: Reading,
    time_error_s: Option<f64>,
    request: &Request<'_>,
    name: &str,
) -> Result<Report, Error> {
    let typed = times::read(bytes, reading)?;
    let std_s = time_error_s.unwrap_or(USUAL_ERROR_S.max(typed.rounding_std_s));
    request.fit(&typed, std_s, name)
}

impl Arguments {
    const fn reading(&self) -> Reading {
        Reading {
            kind: self.kind,
            unit: self.unit,
            decimal: self.decimal,
        }
    }
}
