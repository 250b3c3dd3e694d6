//! `bounce-audio batch`: many recordings.

mod curve;
mod format;
mod inputs;
mod job;
mod options;
mod ordered;
mod plots;
mod progress;
mod rows_file;
mod screen;
mod target;
mod together;

use std::collections::HashSet;
use std::io::{self, ErrorKind, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use clap::{Args, value_parser};

use super::document::{DocumentArguments, pictures, section};
use super::known::{DECIMALS, one_of};
use super::listen::{Listening, name};
use super::output::{followed, place};
use super::picture::Target as Picture;
use super::quantity::time;
use super::rule::RuleArguments;
use super::{Outcome, output, terminal, threads};
use crate::Error;
use crate::plot::Figure;
use crate::report::batch::{Digest, Found, answer, conclusion, summary};
use crate::report::curve::Bounces;
use crate::report::html::Content;
use crate::report::times::Decimal;
use curve::CurveArguments;
use format::Format;
use inputs::Input;
use job::{Job, PerFile};
use options::{Pattern, Table};
use plots::{PlotOrder, Plots};
use progress::Progress;
use rows_file::partial;
use screen::Screen;
use target::Target;
use together::{GroupBy, Together};

/// Analyze many recordings: files, and folders with all that is in them.
///
/// One row per drop. Files come in the order in which you name them; those of a folder are sorted by name. A file without a
/// drop or with an error has one row with the reason. At the end stand the mean, whether the drops differ by more than their
/// errors explain, and which are far from the rest.
///
/// A terminal gets a table that fits it; the rows go into a pipe, or into the file of -o.
///
/// Exit status: 0 a drop in every file, 1 some file failed or had none, 2 what was asked could not be done; with --rule 3 the
/// lot fails and 4 the verdict is open.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  bounce-audio batch recordings --height 30.5cm -o drops.csv
  bounce-audio batch recordings --pattern 'ball-{height}-{number}.wav'
  bounce-audio batch recordings --options balls.csv --format ndjson
  bounce-audio batch recordings -o drops.csv --resume
  bounce-audio batch lot --height 30.5cm --rule ittf-ball --pattern '{ball}-{number}.wav'
  bounce-audio batch cold warm --height 1m --group folder
  bounce-audio batch recordings --at-speed 1,2,4 --curve e-against-speed.svg

A table for --options has a line per file; what is empty is as for all:
  file,height,mass,diameter
  ball-1.wav,30.5cm,2.7g,40mm
  tuesday/ball-1.wav,12in,,")]
pub(super) struct Arguments {
    /// Recordings, folders that hold some, and lists of impact times (.csv, .tsv, .txt) as for fit
    #[arg(required = true, value_name = "PATH")]
    paths: Vec<PathBuf>,
    /// How many recordings to listen to at once [default: one for each core]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..), allow_hyphen_values = true)]
    jobs: Option<u16>,
    /// Form of the rows [default: csv; on a terminal without -o a table]
    #[arg(long, value_enum)]
    format: Option<Format>,
    /// What stands before the decimals in CSV; with commas semicolons separate fields, as spreadsheets of such countries read
    #[arg(long, value_name = "MARK", default_value = "point", value_parser = one_of(&DECIMALS), conflicts_with = "resume")]
    decimal: Decimal,
    /// The file to write; until it is whole, rows are in OUT.partial
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
    /// Go on with what an interrupted run left in OUT.partial; inputs and options must be the same
    #[arg(long, requires = "output")]
    resume: bool,
    /// Replace OUT if it is there, and without --resume what an interrupted run left
    #[arg(long, requires = "output")]
    force: bool,
    /// Height, mass, diameter, ball and group of each file, by its name or the end of its path
    #[arg(long, value_name = "TABLE.csv")]
    options: Option<PathBuf>,
    /// Read {height}, {mass} and {diameter}, with units, {ball} and {group} from the names; any other word in braces stands for
    /// anything
    #[arg(long, conflicts_with = "options")]
    pattern: Option<Pattern>,
    /// Compare groups of drops: those of each folder, or of each {group} of --pattern or of the column group of --options
    #[arg(long, value_enum, value_name = "BY")]
    group: Option<GroupBy>,
    /// Write what all drops say together as JSON: mean, spread, the verdict of a rule, groups
    #[arg(long, value_name = "OUT.json")]
    summary: Option<PathBuf>,
    /// Draw e of each drop with its interval, their mean, and a histogram
    #[arg(long, value_name = "OUT.svg|png")]
    plot: Option<PathBuf>,
    /// What the rows of that picture are sorted by
    #[arg(long, value_enum, value_name = "BY", default_value = "file")]
    plot_order: PlotOrder,
    /// Draw a sheet for each recording into this folder, which is made: NAME.wav.svg
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    /// Standard error of each time of a list [default: 1 ms, or that of the rounding if it is more]
    #[arg(long, value_parser = time, allow_hyphen_values = true)]
    time_error: Option<f64>,
    #[command(flatten)]
    listening: Listening,
    #[command(flatten)]
    rule: RuleArguments,
    #[command(flatten)]
    curve: CurveArguments,
    #[command(flatten)]
    document: DocumentArguments,
}

/// What standard output is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Purpose {
    /// The rows, or a table of them on a terminal.
    Rows,
    /// The comparison of groups.
    Comparison,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    run_for(arguments, Purpose::Rows)
}

pub(super) fn run_for(arguments: &Arguments, purpose: Purpose) -> Result<Outcome, Error> {
    arguments.curve.check()?;
    arguments.document.check()?;
    arguments.listening.request().settings.check()?;
    if purpose == Purpose::Comparison && arguments.format.is_some() && arguments.output.is_none() {
        return Err(Error::refused(
            "compare prints the comparison: --format is of the rows, which go into -o",
        ));
    }
    let plot = arguments.plot.as_deref().map(Picture::new).transpose()?;
    let inputs = inputs::gather(&arguments.paths)?;
    let job = Job {
        per_file: per_file(arguments)?,
        plots: arguments
            .plots
            .as_deref()
            .map(|d| Plots::new(d, &inputs))
            .transpose()?,
        inputs,
        listening: &arguments.listening,
        format: arguments.format(),
        rule: arguments.rule.rule,
        time_error_s: arguments.time_error,
    };
    check_apart(arguments, &job)?;
    job.plots.as_ref().map_or(Ok(()), Plots::make)?;
    if let Some(note) = job.unmatched() {
        say(&note);
    }
    let quiet = purpose == Purpose::Comparison;
    let screen = screen(arguments, &job.inputs).filter(|_| !quiet);
    let (mut target, mut digests) = Target::open(arguments, &job, quiet || screen.is_some())?;
    if let Some(screen) = screen {
        let done = digests.iter().map(|digest| screen.rows(digest, &[]));
        let _: ControlFlow<()> = print(&(screen.heading() + &done.collect::<String>()))?;
    }
    let mut bounces = Bounces::default();
    let progress = Progress::new(job.inputs.len(), digests.len());
    let done = ordered::in_order(
        threads(arguments, &job),
        digests.len()..job.inputs.len(),
        |number| {
            let done = job.done(number);
            progress.one_more();
            done
        },
        |done| {
            let flow = progress.aside(|| {
                let flow = target.add(&done.rows)?;
                match screen.filter(|_| flow.is_continue()) {
                    Some(screen) => print(&screen.rows(&done.digest, &done.remarks)),
                    None => Ok(flow),
                }
            })?;
            digests.push(done.digest);
            bounces.append(done.bounces);
            Ok(flow)
        },
    );
    progress.end();
    done.and_then(|()| target.finish())?;
    say(&if screen.is_some() {
        "\n".to_owned() + &conclusion(&digests)
    } else {
        summary(&digests)
    });
    let together = Together::of(&job, arguments.group(purpose), &digests);
    if !quiet {
        say(&together.said);
    }
    let curve = arguments.curve.told(bounces)?;
    if let Some(path) = &arguments.summary {
        let document = together.json(&digests).to_string() + "\n";
        output::write(path, b"{", document.as_bytes())?;
    }
    if let Some(plot) = plot {
        plot.draw(&plots::all(&digests, arguments.plot_order.into()))?;
    }
    let output = quiet.then(|| together.said.trim_start().to_owned());
    let (compared, status) = (together.is_compared() || !quiet, together.status);
    let told = together.said + &curve.said;
    keep(arguments, &job, &digests, &told, curve.figure)?;
    let found = |d: &Digest| matches!(d.found, Found::Drops(_));
    let whole = digests.iter().all(found);
    Ok(Outcome {
        status: if whole && compared { status } else { 1 },
        ..Outcome::of(output.unwrap_or_default())
    })
}

/// Writes the page of a batch, if one was asked for.
fn keep(
    arguments: &Arguments,
    job: &Job<'_>,
    digests: &[Digest],
    told: &str,
    curve: Option<Figure>,
) -> Result<(), Error> {
    let parts = || {
        let figures: Vec<Figure> = [plots::all(digests, arguments.plot_order.into())]
            .into_iter()
            .chain(curve)
            .collect();
        let mut parts = vec![section("All drops", Content::Text(conclusion(digests)))];
        if !told.is_empty() {
            parts.push(section(
                "Verdict, groups, curve",
                Content::Text(told.trim_start().to_owned()),
            ));
        }
        parts.push(pictures(&figures)?);
        parts.push(section("Each drop", Content::Text(summary(digests))));
        Ok(parts)
    };
    let answer = vec![answer(digests)];
    let files: Vec<&Path> = job.inputs.iter().filter_map(Input::recording).collect();
    let settings = arguments.listening.request().settings;
    arguments
        .document
        .write("Many drops", answer, parts, &settings, &files)
}

/// The table for the terminal on standard output, unless rows were asked for there.
fn screen(arguments: &Arguments, inputs: &[Input]) -> Option<Screen> {
    let columns = terminal::output_width()?;
    if arguments.format.is_some() && arguments.output.is_none() {
        return None;
    }
    let names: Vec<String> = inputs.iter().map(|input| name(input.path())).collect();
    Some(Screen::new(names.iter().map(String::as_str), columns))
}

/// Refuses two outputs in one place: the later one would replace the earlier.
fn check_apart(arguments: &Arguments, job: &Job<'_>) -> Result<(), Error> {
    let rows = arguments.output.iter();
    let rows = rows.flat_map(|path| [path.clone(), partial(&followed(path))]);
    let sheets = job.plots.iter().flat_map(|plots| plots.sheets(&job.inputs));
    let mut places = HashSet::new();
    for path in rows
        .chain(arguments.plot.clone())
        .chain(arguments.curve.path().cloned())
        .chain(arguments.document.report.clone())
        .chain(arguments.summary.clone())
        .chain(sheets)
    {
        if !places.insert(place(&path)) {
            let problem = "two results would be written here: give them names of their own";
            return Err(Error::refused(problem).in_file(path));
        }
    }
    Ok(())
}

fn per_file(arguments: &Arguments) -> Result<PerFile, Error> {
    Ok(match (&arguments.options, &arguments.pattern) {
        (Some(path), _) => PerFile::Table(path.clone(), Table::read(path)?),
        (None, Some(pattern)) => PerFile::Pattern(pattern.clone()),
        (None, None) => PerFile::Same,
    })
}

/// No more threads than there are recordings.
fn threads(arguments: &Arguments, job: &Job<'_>) -> usize {
    threads::count(arguments.jobs).min(job.inputs.len()).max(1)
}

/// Writes to standard error. A note that nobody can read is no reason to stop.
fn say(text: &str) {
    io::stderr().write_all(text.as_bytes()).ok();
}

/// Writes to standard output, which whoever closed the pipe (`| head`) has read enough of.
fn print(text: &str) -> Result<ControlFlow<()>, Error> {
    let mut stdout = io::stdout().lock();
    let written = stdout.write_all(text.as_bytes());
    match written.and_then(|()| stdout.flush()) {
        Err(e) if e.kind() == ErrorKind::BrokenPipe => Ok(ControlFlow::Break(())),
        written => Ok(written.map(|()| ControlFlow::Continue(()))?),
    }
}

impl Arguments {
    /// What makes a group, if groups are to be compared.
    fn group(&self, purpose: Purpose) -> Option<GroupBy> {
        let named = self.pattern.is_some() || self.options.is_some();
        let usual = if named {
            GroupBy::Group
        } else {
            GroupBy::Folder
        };
        self.group
            .or((purpose == Purpose::Comparison).then_some(usual))
    }

    fn format(&self) -> Format {
        match self.format.unwrap_or(Format::Csv) {
            Format::Csv if self.decimal == Decimal::Comma => Format::CsvComma,
            format => format,
        }
    }
}
