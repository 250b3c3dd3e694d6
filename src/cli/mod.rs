//! The command line: parses, calls the library and says what to print. Files and standard input are touched here.

mod analyze;
mod batch;
mod compare;
mod completions;
mod document;
mod evaluate;
mod failure;
mod fit;
mod known;
mod labels;
mod limit;
mod listen;
mod live;
mod meant;
mod output;
mod picture;
mod predict;
mod quantity;
mod rule;
mod sha256;
mod solve;
mod synth;
mod terminal;
mod threads;

use std::ffi::OsString;
use std::process::ExitCode;
use std::sync::LazyLock;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::Error;
use crate::audio::FORMATS;

/// What `--version` says; `-V` says its first line. The commit is known where the program was built for an archive.
static LONG_VERSION: LazyLock<String> = LazyLock::new(|| {
    let commit = option_env!("BOUNCE_AUDIO_COMMIT").map(|commit| format!("\ncommit    {commit}"));
    format!(
        "{}{}\nreads     {FORMATS}\n{}{}",
        env!("CARGO_PKG_VERSION"),
        commit.unwrap_or_default(),
        "features  audio, opus, plots, lab, cli",
        if cfg!(feature = "internals") {
            ", internals"
        } else {
            ""
        },
    )
});

/// Listens to a ball bouncing: impact times, coefficient of restitution, and how sure that is.
#[derive(Debug, Parser)]
#[command(
    name = "bounce-audio",
    version,
    long_version = LONG_VERSION.as_str(),
    about,
    after_help = "Examples:
  bounce-audio analyze drop.wav                   what a recording says of the ball
  bounce-audio analyze drop.wav --height 30.5cm   the same, with the height known
  bounce-audio listen                             drops told while they are played
  bounce-audio batch recordings                   a table of many recordings
  bounce-audio compare cold warm --height 1m      groups of them against each other
  bounce-audio fit times.csv --height 30.5cm      impact times typed in
  bounce-audio synth --preset pingpong -o a.wav   a recording to try it with
  bounce-audio solve --bounces 70 --total-time 7.5s --height 30.5cm --mass 2.5g

Results go to standard output, everything else to standard error. Help and
errors have colours on a terminal only, and none where NO_COLOR is set."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Analyze(analyze::Arguments),
    Listen(live::Arguments),
    Batch(batch::Arguments),
    Compare(compare::Arguments),
    Fit(fit::Arguments),
    Solve(solve::Arguments),
    Synth(synth::Arguments),
    Evaluate(evaluate::Arguments),
    Completions(completions::Arguments),
}

/// What a command leaves behind.
#[derive(Debug)]
pub struct Outcome {
    /// For standard output.
    pub output: String,
    /// For standard error.
    pub note: String,
    /// 0: done; 1: it ran, but there was nothing to find; 3: a ball fails a rule; 4: that is undecided.
    pub status: u8,
}

/// Runs the command that the process was started with.
///
/// # Errors
/// Whatever kept the command from doing what was asked; the exit status is then 2.
pub fn run() -> Result<Outcome, Error> {
    let given: Vec<OsString> = std::env::args_os().collect();
    let json = failure::wants_json(&given);
    let outcome = match parsed(&given) {
        Ok(arguments) => arguments.command.run(),
        Err(error) => match meant::meant(&given) {
            Some(offer) if error.use_stderr() => Err(Error::refused(offer)),
            _ if json && error.use_stderr() => return Ok(failure::of_arguments(&error)),
            _ => error.exit(),
        },
    };
    match outcome {
        Err(error) if json => Ok(failure::in_json(&error)),
        outcome => outcome,
    }
}

/// The description of the command line, from which its manual pages are made.
#[cfg(feature = "internals")]
#[must_use]
pub fn command() -> clap::Command {
    Arguments::command()
}

fn parsed(given: &[OsString]) -> Result<Arguments, clap::Error> {
    let command = Arguments::command().term_width(terminal::help_width());
    let matches = command.try_get_matches_from(given)?;
    Arguments::from_arg_matches(&matches)
}

impl Command {
    fn run(&self) -> Result<Outcome, Error> {
        match self {
            Self::Analyze(arguments) => analyze::run(arguments),
            Self::Listen(arguments) => live::run(arguments),
            Self::Batch(arguments) => batch::run(arguments),
            Self::Compare(arguments) => compare::run(arguments),
            Self::Fit(arguments) => fit::run(arguments),
            Self::Solve(arguments) => solve::run(arguments),
            Self::Synth(arguments) => synth::run(arguments),
            Self::Evaluate(arguments) => evaluate::run(arguments),
            Self::Completions(arguments) => completions::run(arguments),
        }
    }
}

impl Outcome {
    /// A result without more to say.
    const fn of(output: String) -> Self {
        Self {
            output,
            note: String::new(),
            status: 0,
        }
    }

    /// The status for the system.
    #[must_use]
    pub fn code(&self) -> ExitCode {
        ExitCode::from(self.status)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_options_of_a_command_collide() {
        Arguments::command().debug_assert();
    }
}
