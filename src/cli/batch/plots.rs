//! Pictures of a batch.

use std::collections::HashMap;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use clap::ValueEnum;

use super::inputs::Input;
use crate::Error;
use crate::audio::Track;
use crate::cli::picture::{Target, draw_all, draw_sheets};
use crate::picture::batch::{BatchRow, Order, Ranged, sheet};
use crate::picture::sheet::sheets_of_times;
use crate::plot::Figure;
use crate::report::batch::{Digest, Found, Pooled};
use crate::report::{Report, short};

/// What the rows of the picture are sorted by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum PlotOrder {
    /// The files, as they were named; those of a folder by name
    File,
    /// e, the greatest first
    E,
}

impl From<PlotOrder> for Order {
    fn from(order: PlotOrder) -> Self {
        match order {
            PlotOrder::File => Self::File,
            PlotOrder::E => Self::Restitution,
        }
    }
}

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

    /// Draws the sheets of a track of a recording.
    pub(super) fn draw(
        &self,
        recording: &Path,
        track: Track,
        report: &Report,
    ) -> Result<(), Error> {
        let target = Target::new(&self.sheet(recording))?;
        draw_sheets(&target, recording, track, report)
    }

    /// Draws the sheets of times that were typed in.
    pub(super) fn draw_times(&self, list: &Path, report: &Report) -> Result<(), Error> {
        let target = Target::new(&self.sheet(list))?;
        draw_all(&target, &sheets_of_times(report))
    }
}

/// `NAME.wav.svg`: with the whole name, so that recordings that differ in their ending alone do not meet.
fn file_name(recording: &Path) -> OsString {
    let mut name = OsString::from(recording.file_name().unwrap_or_default());
    name.push(".svg");
    name
}

/// All drops on one picture with their mean, and the recordings that have none.
pub(super) fn all(digests: &[Digest], order: Order) -> Figure {
    let pooled = Pooled::of(digests);
    let mut rows = Vec::new();
    let mut number = 0;
    for digest in digests {
        let row = |drop: Option<usize>, restitution, outlier| BatchRow {
            file: digest.file.clone(),
            drop,
            restitution,
            outlier,
        };
        let drops = match &digest.found {
            Found::Drops(drops) => drops,
            Found::Nothing(_) => {
                rows.push(row(None, Err("no drop".to_owned()), false));
                continue;
            }
            Found::Failed(_) => {
                rows.push(row(None, Err("failed".to_owned()), false));
                continue;
            }
        };
        for (i, drop) in (1..).zip(drops) {
            let e = drop.restitution.map(|e| Ranged {
                value: e.value,
                interval95: e.interval95,
            });
            let e = e.ok_or_else(|| "e not determined".to_owned());
            let outlier = pooled.outliers.contains(&number);
            rows.push(row((drops.len() > 1).then_some(i), e, outlier));
            number += 1;
        }
    }
    let mean = pooled.mean.map(|m| (m.mean, m.mean_std));
    let outliers = match pooled.outliers.len() {
        1 => "outlier",
        _ => "outliers",
    };
    let rest = pooled.without_outliers;
    Figure {
        subtitle: rest
            .map(|m| format!("without the {outliers}: e = {}", short(m.mean, m.mean_std))),
        ..sheet(&rows, mean, order)
    }
}
