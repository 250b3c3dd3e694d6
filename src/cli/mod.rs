//! The command line: parses, calls the library and says what to print. Files and standard input are touched here.

mod analyze;
mod batch;
mod completions;
mod evaluate;
mod labels;
mod limit;
mod listen;
mod output;
mod picture;
mod rule;
mod solve;
mod synth;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::Error;
use crate::units::Quantity;

/// Listens to a recording of a ball bouncing and says when it hit, how often, and its coefficient of restitution.
#[derive(Debug, Parser)]
#[command(
    name = "bounce-audio",
    version,
    about,
    max_term_width = 100,
    after_help = "Examples:
  bounce-audio analyze drop.wav                       what a recording says of the ball
  bounce-audio analyze drop.wav --height 30.5cm       the same, knowing from where it fell
  bounce-audio synth --preset pingpong -o drop.wav    a recording to try it with
  bounce-audio solve --bounces 70 --total-time 7.5s --height 30.5cm --mass 2.5g

Results go to standard output, everything else to standard error. Help and errors have colours on a
terminal only, and none where NO_COLOR is set."
)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Analyze(analyze::Arguments),
    Batch(batch::Arguments),
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
    /// 0: done; 1: it ran, but there was nothing to find.
    pub status: u8,
}

/// Runs the command that the process was started with.
///
/// # Errors
/// Whatever kept the command from doing what was asked; the exit status is then 2.
pub fn run() -> Result<Outcome, Error> {
    match Arguments::parse().command {
        Command::Analyze(arguments) => analyze::run(&arguments),
        Command::Batch(arguments) => batch::run(&arguments),
        Command::Solve(arguments) => solve::run(&arguments),
        Command::Synth(arguments) => synth::run(&arguments),
        Command::Evaluate(arguments) => evaluate::run(&arguments),
        Command::Completions(arguments) => completions::run(&arguments),
    }
}

impl Outcome {
    /// The status for the system.
    #[must_use]
    pub fn code(&self) -> ExitCode {
        ExitCode::from(self.status)
    }
}

fn length(text: &str) -> Result<f64, Error> {
    Quantity::Length.parse("length", text)
}

fn time(text: &str) -> Result<f64, Error> {
    Quantity::Time.parse("time", text)
}

fn mass(text: &str) -> Result<f64, Error> {
    Quantity::Mass.parse("mass", text)
}

fn acceleration(text: &str) -> Result<f64, Error> {
    Quantity::Acceleration.parse("acceleration", text)
}
