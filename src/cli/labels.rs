//! Label files of `analyze`: written with `--labels`, read again with `--impacts`.

use std::fs;
use std::path::{Path, PathBuf};

use clap::Args;

use super::output;
use super::quantity::time;
use crate::Error;
use crate::report::Report;
use crate::report::labels::{Form, Marked, drops, read, to_labels};

/// A label file and the impacts of each drop in it.
pub(super) type Given<'a> = (&'a Path, Vec<Vec<Marked>>);

/// Where labels go, and where they come from.
#[derive(Debug, Args)]
#[command(next_help_heading = "Labels")]
pub(super) struct LabelArguments {
    /// Write the impacts as labels (without a drop, the sounds that come nearest to one); the ending chooses: txt for Audacity, csv
    /// for Sonic Visualiser, `TextGrid` for Praat
    #[arg(
        long,
        value_name = "OUT.txt|csv|TextGrid",
        conflicts_with = "time_scale"
    )]
    labels: Option<PathBuf>,
    /// Replace labels that are there and differ
    #[arg(long, requires = "labels")]
    force: bool,
    /// Fit exactly the impacts of a label file, as written by --labels and then edited, or set by hand
    #[arg(long, value_name = "LABELS", conflicts_with_all = ["start", "end", "timing", "time_scale"])]
    impacts: Option<PathBuf>,
    /// Standard error of the time of a label that was moved or set by hand
    #[arg(long, value_parser = time, default_value = "1ms", requires = "impacts", allow_hyphen_values = true)]
    label_error: f64,
}

impl LabelArguments {
    /// Whether labels can be written and read, before anything is listened to. The impacts to fit, if they are given.
    pub(super) fn given(&self) -> Result<Option<Given<'_>>, Error> {
        if let Some(path) = &self.labels {
            form(path, "--labels")?;
        }
        if !(self.label_error.is_finite() && self.label_error > 0.0) {
            return Err(Error::argument("label error", self.label_error, "above 0"));
        }
        let Some(path) = &self.impacts else {
            return Ok(None);
        };
        let form = form(path, "--impacts")?;
        let marked = || {
            let labels = read(&fs::read(path)?, form)?;
            drops(&labels, form, self.label_error)
        };
        let marked = marked().map_err(|e| e.in_file(path))?;
        if marked.is_empty() {
            let none = Error::Line {
                line: 1,
                problem: "there are no labels".to_owned(),
            };
            return Err(none.in_file(path));
        }
        Ok(Some((path, marked)))
    }

    /// Writes the labels, if that was asked for. Others that are there are not lost.
    pub(super) fn write(&self, report: &Report) -> Result<(), Error> {
        let Some(path) = &self.labels else {
            return Ok(());
        };
        let form = form(path, "--labels")?;
        let text = to_labels(&report.to_be_labelled(), report.recording.duration_s, form);
        if path.is_file() {
            let there = fs::read(path).map_err(|e| Error::from(e).in_file(path))?;
            self.spare(&there, text.as_bytes())
                .map_err(|e| e.in_file(path))?;
        }
        output::write(path, b"", text.as_bytes())
    }

    /// Refuses to lose what is there. Labels are made to be edited: it may be a day's work, or a recording of this name.
    fn spare(&self, there: &[u8], labels: &[u8]) -> Result<(), Error> {
        if there.contains(&0) {
            let problem = "it is there and is no text, so it holds no labels: choose another name, or delete it";
            return Err(Error::refused(problem));
        }
        if self.force || there.is_empty() || there == labels {
            return Ok(());
        }
        let problem =
            "it is there and differs from the labels that are to be written: --force replaces it";
        Err(Error::refused(problem))
    }
}

fn form(path: &Path, argument: &'static str) -> Result<Form, Error> {
    let extension = path.extension().and_then(|e| e.to_str());
    extension
        .and_then(Form::of_extension)
        .ok_or_else(|| Error::Argument {
            argument,
            got: format!("'{}'", path.display()),
            expected: "a name that ends in .txt (Audacity), .csv (Sonic Visualiser) or .TextGrid (Praat)",
        })
}
