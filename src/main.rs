//! The `bounce-audio` command.

use std::io::{ErrorKind, Write};
use std::panic;
use std::process::ExitCode;

use bounce_audio::Error;
use bounce_audio::audio::is_guarded;
use bounce_audio::cli::{Outcome, run};

fn main() -> ExitCode {
    spare_what_is_caught();
    match run().and_then(|outcome| print(&outcome)) {
        Ok(code) => code,
        Err(error) => {
            // Where nobody reads what went wrong the status still says so.
            writeln!(std::io::stderr(), "bounce-audio: {error}").ok();
            ExitCode::from(2)
        }
    }
}

/// Keeps quiet about panics that are caught: those of the decoders, which are told as damage of the file.
fn spare_what_is_caught() {
    let usual = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if !is_guarded() {
            usual(info);
        }
    }));
}

fn print(outcome: &Outcome) -> Result<ExitCode, Error> {
    let mut stdout = std::io::stdout().lock();
    std::io::stderr().write_all(outcome.note.as_bytes()).ok();
    match stdout
        .write_all(outcome.output.as_bytes())
        .and_then(|()| stdout.flush())
    {
        // Whoever closed the pipe (`| head`) has read enough.
        Err(e) if e.kind() == ErrorKind::BrokenPipe => Ok(outcome.code()),
        result => result.map(|()| outcome.code()).map_err(Error::from),
    }
}
