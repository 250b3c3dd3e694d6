//! `bounce-audio analyze`: one recording.

use std::io;
use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum, value_parser};

use super::Outcome;
use super::document::{DocumentArguments, pictures, section};
use super::known::{DECIMALS, one_of};
use super::labels::LabelArguments;
use super::listen::{Listening, by_option, listen_to_file};
use super::picture::{Target, check_readable_twice, draw_sheets, figures};
use super::predict::PredictArguments;
use super::rule::RuleArguments;
use super::threads;
use crate::Error;
use crate::audio::Stream;
use crate::plot::Figure;
use crate::recording::Request;
use crate::report::html::Content;
use crate::report::text::Detail;
use crate::report::times::Decimal;
use crate::report::{GIVE_HEIGHT, LISTEN_TO_PART, Report, WarningCode, csv, json, text};

/// Analyze one recording of a bouncing ball.
///
/// Exit status: 0 a drop was found, 1 none was found, 2 the recording could not be read or an argument is wrong; with --rule
/// 3 a drop fails and 4 the verdict is open.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  bounce-audio analyze drop.wav
  bounce-audio analyze drop.wav --height 30.5cm
  bounce-audio analyze drop.wav --table
  bounce-audio analyze drop.wav --start 2 --end 9 --format json
  bounce-audio analyze drop.wav --plot drop.svg
  bounce-audio analyze drop.wav --labels drop.txt    (open both in Audacity, edit,
                                                      export the labels)
  bounce-audio analyze drop.wav --impacts drop.txt   (fit what was edited)
  bounce-audio analyze drop.wav --rule ittf-ball
  bounce-audio analyze drop.wav --report drop.html --note 'steel on granite, 21 °C'
  bounce-audio analyze voice-memo.m4a
  bounce-audio analyze -q drop.wav | while read -r e error bounces seconds \\
      warnings file; do echo \"$file: $e\"; done
  ffmpeg -i drop.amr -f wav - | bounce-audio analyze -")]
pub(super) struct Arguments {
    /// A recording (WAV, FLAC, M4A, MP3, AAC, Ogg, a video), or - for standard input
    file: PathBuf,
    #[command(flatten)]
    listening: Listening,
    /// How many drops to time and fit at once, 8 at most; the result is the same for any N [default: one for each core]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..), allow_hyphen_values = true)]
    jobs: Option<u16>,
    /// Form of the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// What stands before the decimals in CSV; with commas semicolons separate fields
    #[arg(long, value_name = "MARK", default_value = "point", value_parser = one_of(&DECIMALS))]
    decimal: Decimal,
    /// One line a drop for a shell script: e, its error, bounces, seconds, warnings, file
    #[arg(short, long, conflicts_with = "verbose")]
    quiet: bool,
    /// In the text also the plain formulas, every bounce, the models compared, and the sounds rejected
    #[arg(short, long, visible_alias = "table")]
    verbose: bool,
    /// Draw a sheet into this picture; of several drops OUT-1.svg, OUT-2.svg, …; not for a pipe
    #[arg(long, value_name = "OUT.svg|png")]
    plot: Option<PathBuf>,
    #[command(flatten)]
    labels: LabelArguments,
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

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let target = arguments.plot.as_deref().map(Target::new).transpose()?;
    arguments.document.check()?;
    if target.is_some() || arguments.document.report.is_some() {
        check_readable_twice(&arguments.file)?;
    }
    let labels = arguments.labels.given()?;
    let track = arguments.listening.track();
    let request = Request {
        labels,
        rule: arguments.rule.rule,
        question: arguments.predict.question(),
        ..arguments.listening.request()
    };
    if arguments.file.is_dir() {
        return Err(Error::refused(format!(
            "it is a directory. To listen to all recordings in it: bounce-audio batch {}",
            arguments.file.display()
        ))
        .in_file(&arguments.file));
    }
    let workers = threads::workers(arguments.jobs);
    let report = if arguments.file == Path::new("-") {
        let stream = Stream::open_track(io::stdin(), track);
        let report = stream.and_then(|stream| request.listen_by(stream, "-", workers));
        report.map_err(|e| by_option(e).in_file("standard input"))?
    } else {
        listen_to_file(&arguments.file, track, &request, workers)?
    };
    arguments.labels.write(&report)?;
    if let Some(target) = target {
        draw_sheets(&target, &arguments.file, track, &report)?;
    }
    let sheets = |file: &Path, report: &Report| figures(file, track, report);
    let known = &arguments.listening.known;
    let ball = |detail| arguments.rule.ball(known, &report, detail);
    keep(
        &arguments.document,
        &arguments.file,
        &report,
        &ball(Detail::Usual),
        sheets,
    )?;
    let output = match arguments.format {
        Format::Text => {
            let advice = |code| advice(&report, code);
            let detail = detail(arguments);
            text::to_text_with(&report, detail, &advice) + &ball(detail)
        }
        Format::Csv if arguments.decimal == Decimal::Comma => {
            csv::with_decimal_commas(&csv::to_csv(&report))
        }
        Format::Csv => csv::to_csv(&report),
        Format::Json => json::to_json(&report).map_err(io::Error::from)?,
    };
    Ok(Outcome {
        note: note(arguments, &report),
        output,
        status: arguments
            .rule
            .status(&report, u8::from(report.drops.is_empty())),
    })
}

/// Writes the page of a report, if one was asked for; what it means ends with what is said of the ball.
pub(super) fn keep(
    document: &DocumentArguments,
    file: &Path,
    report: &Report,
    ball: &str,
    figures: impl FnOnce(&Path, &Report) -> Result<Vec<Figure>, Error>,
) -> Result<(), Error> {
    let usual = text::to_text(report, Detail::Usual);
    let (answer, words) = usual.split_once('\n').unwrap_or((&usual, ""));
    let parts = || {
        Ok(vec![
            section("What it means", Content::Text(words.to_owned() + ball)),
            pictures(&figures(file, report)?)?,
            section(
                "In full",
                Content::Text(text::to_text(report, Detail::Everything)),
            ),
        ])
    };
    document.write(
        &report.file,
        vec![answer.to_owned()],
        parts,
        &report.settings,
        &[file],
    )
}

/// Why a result without a drop has no row and no line.
fn note(arguments: &Arguments, report: &Report) -> String {
    let rows_only = matches!(arguments.format, Format::Csv)
        || matches!(arguments.format, Format::Text) && arguments.quiet;
    match report.drops.is_empty() && rows_only {
        true => format!(
            "bounce-audio: {}: no drop: {}\n",
            report.file,
            report.why_none()
        ),
        false => String::new(),
    }
}

/// The options with which the user can do something about a warning.
fn advice(report: &Report, code: WarningCode) -> Option<&'static str> {
    let drag_known = report
        .drops
        .iter()
        .all(|d| d.model.parameters.drag_per_s2.is_some());
    let settings = &report.settings;
    let height_known = settings.height_m.is_some();
    let ball_known = settings.mass_kg.is_some() && settings.diameter_m.is_some();
    Some(match code {
        WarningCode::NoDrop if report.candidate.is_some() => "--labels and --impacts",
        WarningCode::NoDrop if report.why_none().contains(LISTEN_TO_PART) => "--start and --end",
        WarningCode::NoDrop if report.why_none().contains(GIVE_HEIGHT) && !height_known => {
            "--height"
        }
        WarningCode::SeveralTracks => "--track",
        WarningCode::StrayTime => "--labels and --impacts",
        WarningCode::AirDrag if drag_known => return None,
        WarningCode::LeftOut => "--start and --end",
        WarningCode::BeyondBounces => "--mass and --diameter, --contact-time",
        WarningCode::AirDrag | WarningCode::ModelsAlike => "--mass and --diameter",
        WarningCode::FewBounces if !height_known => "--height",
        WarningCode::FewBounces if !ball_known => "--mass and --diameter",
        WarningCode::ContactTooLong => "--contact-time",
        WarningCode::HeightTooSmall => "--height, --time-scale",
        WarningCode::FirstImpactMissing
        | WarningCode::WrongHeight
        | WarningCode::NoRoot
        | WarningCode::EstimatesDisagree => "--height",
        WarningCode::LouderBefore => "--impacts, --start",
        _ => return None,
    })
}

const fn detail(arguments: &Arguments) -> Detail {
    match (arguments.quiet, arguments.verbose) {
        (true, _) => Detail::Answer,
        (false, false) => Detail::Usual,
        (false, true) => Detail::Everything,
    }
}
