//! What is said while listening.

use std::io::{self, IsTerminal, Write};

use super::super::Outcome;
use super::Format;
use crate::Error;
use crate::analysis::{Hears, Told};
use crate::report::Drop;
use crate::report::text::{answer, mean_of, together_of};

/// From this share of full scale on a sample is clipped.
const CLIPPED: f32 = 0.999;

/// Lines for each drop, and the level on a terminal.
pub(super) struct Said {
    format: Format,
    /// The drops as they were told last.
    drops: Vec<Drop>,
    shows_level: bool,
    /// The number of the first channel that is listened to, from 0.
    first_channel: usize,
}

impl Said {
    pub(super) fn new(format: Format, first_channel: usize) -> Self {
        Self {
            first_channel,
            format,
            drops: Vec::new(),
            shows_level: io::stderr().is_terminal(),
        }
    }

    /// A line for a drop, at once.
    ///
    /// # Errors
    /// [`Error::Io`] if it cannot be written.
    pub(super) fn tell(&mut self, mut told: Told) -> Result<(), Error> {
        told.drop.channel += self.first_channel;
        self.clear();
        let again = told.number <= self.drops.len();
        let line = match self.format {
            Format::Ndjson => serde_json::to_string(&told).map_err(io::Error::from)?,
            Format::Text => format!(
                "{:>3}  {}{}",
                told.number,
                answer(&told.drop),
                if again { ", more of it was heard" } else { "" }
            ),
        };
        if again {
            self.drops[told.number - 1] = told.drop;
        } else {
            self.drops.push(told.drop);
        }
        let mean = match self.format {
            Format::Text => mean_of(&self.drops).map(|mean| format!(", {mean}")),
            Format::Ndjson => None,
        };
        let mut output = io::stdout().lock();
        writeln!(output, "{line}{}", mean.unwrap_or_default())?;
        Ok(output.flush()?)
    }

    /// The level, and what is heard, in one line of a terminal.
    pub(super) fn level(&self, block: &[Vec<f32>], hears: Hears) {
        if !self.shows_level || block.iter().all(Vec::is_empty) {
            return;
        }
        let samples = block.iter().flatten();
        let peak = samples.fold(0.0_f32, |peak, x| peak.max(x.abs()));
        let level = if peak > 0.0 {
            format!("{:>4.0} dB", 20.0 * peak.log10())
        } else {
            "silent".to_owned()
        };
        let clipped = if peak >= CLIPPED { "  clipped" } else { "" };
        let heard = match hears {
            Hears::Nothing => "",
            Hears::Something => "  something sounds",
            Hears::Drop => "  a drop",
        };
        write!(io::stderr(), "\r\x1b[K{level}{clipped}{heard}").ok();
        io::stderr().flush().ok();
    }

    fn clear(&self) {
        if self.shows_level {
            write!(io::stderr(), "\r\x1b[K").ok();
        }
    }

    /// What is said at the end: of all drops, and of the samples.
    pub(super) fn outcome(self, ended: Result<Vec<String>, Error>) -> Outcome {
        self.clear();
        let together = match self.format {
            Format::Text => together_of(&self.drops),
            Format::Ndjson => String::new(),
        };
        let (said, status) = match (ended, self.drops.len()) {
            (Err(error), 0) => (vec![error.to_string()], 2),
            (Err(error), 1) => (vec![format!("1 drop was heard; {error}")], 2),
            (Err(error), count) => (vec![format!("{count} drops were heard; {error}")], 2),
            (Ok(mut said), 0) => {
                said.push("no drop was heard".to_owned());
                (said, 1)
            }
            (Ok(said), _) => (said, 0),
        };
        let note = said.iter().map(|line| format!("bounce-audio: {line}\n"));
        Outcome {
            output: if together.is_empty() {
                together
            } else {
                format!("\n{together}")
            },
            note: note.collect(),
            status,
        }
    }
}
