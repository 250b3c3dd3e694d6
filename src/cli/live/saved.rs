//! The sound of each drop, kept.

use std::fs;
use std::path::{Path, PathBuf};

use super::super::output;
use crate::Error;
use crate::analysis::{Live, Told};
use crate::audio::{Form, write_wav};
use crate::report::Impact;
use crate::report::labels::{self, to_labels};
use crate::units::{real, whole};

/// Sound before the first impact and after the last that is kept, in seconds.
const AROUND_S: f64 = 0.5;
/// What a WAV begins with.
const WAV: &[u8] = b"RIFF";

/// A folder that drops are kept in.
pub(super) struct Saved {
    folder: PathBuf,
    rate_hz: f64,
    /// The number of the last file that was there before.
    before: usize,
    /// Drops the sound after which is still to come.
    waiting: Vec<Told>,
}

impl Saved {
    /// Makes the folder; drops that are there stay.
    ///
    /// # Errors
    /// [`Error::InFile`] naming the folder if it cannot be made or read.
    pub(super) fn into(folder: &Path, rate_hz: f64) -> Result<Self, Error> {
        let numbers = || -> Result<usize, Error> {
            fs::create_dir_all(folder)?;
            let mut last = 0;
            for entry in fs::read_dir(folder)? {
                let name = entry?.file_name();
                let number = name.to_str().and_then(number);
                last = last.max(number.unwrap_or(0));
            }
            Ok(last)
        };
        Ok(Self {
            before: numbers().map_err(|e| e.in_file(folder))?,
            folder: folder.to_path_buf(),
            rate_hz,
            waiting: Vec::new(),
        })
    }

    /// Takes drops that are told, and writes those after which as much sound came as is kept, or where it ends, all.
    ///
    /// # Errors
    /// [`Error::InFile`] naming the file that could not be written.
    pub(super) fn keep(&mut self, told: &[Told], live: &Live, ends: bool) -> Result<(), Error> {
        for told in told {
            self.waiting.retain(|other| other.number != told.number);
            self.waiting.push(told.clone());
        }
        let (from_s, held) = live.since(f64::INFINITY);
        let end_s = from_s + held.first().map_or(0.0, |h| real(h.len()) / self.rate_hz);
        let is_due = |told: &mut Told| {
            let last = told.drop.impacts.last();
            ends || last.is_none_or(|last| last.time_s + AROUND_S <= end_s)
        };
        let due: Vec<Told> = self.waiting.extract_if(.., is_due).collect();
        due.iter().try_for_each(|told| self.write(told, live))
    }

    /// Writes the sound of a drop and its labels; one that is told again in place of what was kept of it.
    fn write(&self, told: &Told, live: &Live) -> Result<(), Error> {
        let rate_hz = self.rate_hz;
        let impacts = &told.drop.impacts;
        let (Some(first), Some(last)) = (impacts.first(), impacts.last()) else {
            return Ok(());
        };
        let (from_s, held) = live.since(first.time_s - AROUND_S);
        let length = whole(((last.time_s + AROUND_S - from_s) * rate_hz).ceil());
        let held: Vec<&[f32]> = held.iter().map(|h| &h[..length.min(h.len())]).collect();
        let stem = self.folder.join(format!(
            "drop-{:03}",
            self.before.saturating_add(told.number)
        ));
        let wav = stem.with_extension("wav");
        let rate = u32::try_from(whole(rate_hz)).unwrap_or(u32::MAX);
        let write = |file: &mut fs::File| write_wav(file, rate, &held, Form::Float32);
        output::Whole::fill(&wav, WAV, write)?.put()?;
        let shifted = impacts.iter().map(|impact| Impact {
            time_s: impact.time_s - from_s,
            ..impact.clone()
        });
        let shifted: Vec<Impact> = shifted.collect();
        let text = to_labels(
            &[&shifted],
            last.time_s + AROUND_S - from_s,
            labels::Form::Audacity,
        );
        output::write(&stem.with_extension("txt"), b"", text.as_bytes())
    }
}

/// The number of a file `drop-001.wav`.
fn number(name: &str) -> Option<usize> {
    name.strip_prefix("drop-")?.split('.').next()?.parse().ok()
}
