//! Pictures of a batch.

use std::collections::HashMap;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use super::inputs::Input;
use crate::Error;
use crate::cli::picture::{Target, draw_sheets};
use crate::picture::batch::BatchRow;
use crate::report::Report;
use crate::report::batch::{Digest, Found};

/// The folder into which each recording's sheet goes.
#[derive(Debug)]
pub(super) struct Plots {
    folder: PathBuf,
}

impl Plots {
    /// # Errors
    /// If two inputs would have the same picture: neither may replace the other's.
    pub(super) fn new(folder: &Path, inputs: &[Input]) -> Result<Self, Error> {
        let mut owners: HashMap<OsString, &Path> = HashMap::new();
        for input in inputs {
            let Some(other) = owners.insert(file_name(input.path()), input.path()) else {
                continue;
            };
            return Err(Error::Argument {
                argument: "--plots",
                got: format!("{} and {}", other.display(), input.path().display()),
                expected: "recordings of different names, as both would have one picture: rename one, or run their folders apart",
            });
        }
        Ok(Self {
            folder: folder.to_path_buf(),
        })
    }

    /// Makes the folder.
    pub(super) fn make(&self) -> Result<(), Error> {
        let made = fs::create_dir_all(&self.folder);
        made.map_err(|e| Error::from(e).in_file(&self.folder))
    }

    /// Where the sheet of each input goes.
    pub(super) fn sheets(&self, inputs: &[Input]) -> Vec<PathBuf> {
        inputs.iter().map(|i| self.sheet(i.path())).collect()
    }

    fn sheet(&self, recording: &Path) -> PathBuf {
        self.folder.join(file_name(recording))
    }

    /// Draws the sheets of a recording.
    pub(super) fn draw(&self, recording: &Path, report: &Report) -> Result<(), Error> {
        let target = Target::new(&self.sheet(recording))?;
        draw_sheets(&target, recording, report)
    }
}

/// `NAME.wav.svg`: with the whole name, so that recordings that differ in their ending alone do not meet.
fn file_name(recording: &Path) -> OsString {
    let mut name = OsString::from(recording.file_name().unwrap_or_default());
    name.push(".svg");
    name
}

/// The drops that have an e, each by the name of its recording.
pub(super) fn rows(digests: &[Digest]) -> Vec<BatchRow> {
    let mut rows = Vec::new();
    for digest in digests {
        let Found::Drops(drops) = &digest.found else {
            continue;
        };
        for (number, drop) in (1..).zip(drops) {
            let Some(e) = drop.restitution else { continue };
            let name = match drops.len() {
                1 => digest.file.clone(),
                _ => format!("{}, {number}", digest.file),
            };
            rows.push(BatchRow {
                name,
                restitution: e.value,
                interval95: e.interval95,
            });
        }
    }
    rows
}
