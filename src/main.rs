//! The `bounce-audio` command.
#![expect(clippy::print_stderr, reason = "this is the one place that prints")]

use std::io::{ErrorKind, Write};
use std::process::ExitCode;

use bounce_audio::Error;
use bounce_audio::cli::{Outcome, run};

fn main() -> ExitCode {
    match run().and_then(|outcome| print(&outcome)) {
        Ok(code) => code,
        Err(error) => {
            eprintln!("bounce-audio: {error}");
            ExitCode::from(2)
        }
    }
}

fn print(outcome: &Outcome) -> Result<ExitCode, Error> {
    let mut stdout = std::io::stdout().lock();
    match stdout
        .write_all(outcome.output.as_bytes())
        .and_then(|()| stdout.flush())
    {
        // Whoever closed the pipe (`| head`) has read enough.
        Err(e) if e.kind() == ErrorKind::BrokenPipe => Ok(outcome.code()),
        result => result.map(|()| outcome.code()).map_err(Error::from),
    }
}
