//! What is done with each input.

use std::any::Any;
use std::fs::{self, File};
use std::io::{Read, Seek, SeekFrom};
use std::panic::{self, AssertUnwindSafe};
use std::path::{Path, PathBuf};

use super::format::{Format, ReadBack};
use super::inputs::{Input, is_list};
use super::options::{Given, Pattern, Table};
use super::plots::Plots;
use super::screen::remarks;
use crate::Error;
use crate::cli::fit::of_list;
use crate::cli::listen::{Listening, listen_to_file, name};
use crate::recording::Request;
use crate::report::batch::{Digest, Found};
use crate::report::curve::Bounces;
use crate::report::times::Reading;
use crate::rules::Rule;
use crate::workers::Workers;

/// What differs from file to file.
#[derive(Debug)]
pub(super) enum PerFile {
    Same,
    Table(PathBuf, Table),
    Pattern(Pattern),
}

/// A batch.
#[derive(Debug)]
pub(super) struct Job<'a> {
    pub per_file: PerFile,
    pub plots: Option<Plots>,
    pub inputs: Vec<Input>,
    pub listening: &'a Listening,
    pub format: Format,
    pub rule: Option<Rule>,
    /// Standard error of the times of lists.
    pub time_error_s: Option<f64>,
}

/// An input that is done.
#[derive(Debug)]
pub(super) struct Done {
    /// To be written.
    pub rows: String,
    /// To be remembered for the summary.
    pub digest: Digest,
    /// What to know about each drop, for the table on a terminal.
    pub remarks: Vec<String>,
    /// Its bounces, for the curve.
    pub bounces: Bounces,
}

impl Job<'_> {
    /// Does one input. Whatever goes wrong with it is its row's reason.
    pub(super) fn done(&self, number: usize) -> Done {
        let input = &self.inputs[number];
        guarded(|| self.analyzed(input)).unwrap_or_else(|error| {
            let (file, reason) = (name(input.path()), reason(error));
            Done {
                rows: self.format.failure(&file, &reason),
                digest: Digest {
                    file,
                    found: Found::Failed(reason),
                },
                remarks: Vec::new(),
                bounces: Bounces::default(),
            }
        })
    }

    fn analyzed(&self, input: &Input) -> Result<Done, Error> {
        let path = match input {
            Input::Recording(path) => path,
            Input::Folder(_, reason) => return Err(Error::refused(reason)),
        };
        let listening = self.given(path)?.over(self.listening);
        let request = Request {
            rule: self.rule,
            ..listening.request()
        };
        let list = is_list(path);
        let report = if list {
            let bytes = fs::read(path)?;
            let named = name(path);
            of_list(
                &bytes,
                Reading::default(),
                self.time_error_s,
                &request,
                &named,
            )?
        } else {
            listen_to_file(path, listening.track(), &request, Workers::default())?
        };
        match &self.plots {
            Some(plots) if list => plots.draw_times(path, &report)?,
            Some(plots) => plots.draw(path, listening.track(), &report)?,
            None => {}
        }
        Ok(Done {
            rows: self.format.rows(&report)?,
            digest: Digest::from(&report),
            remarks: remarks(&report),
            bounces: Bounces::of(&report),
        })
    }

    /// What the table or the name says of a file.
    pub(super) fn given(&self, path: &Path) -> Result<Given, Error> {
        Ok(match &self.per_file {
            PerFile::Same => Given::default(),
            PerFile::Table(_, table) => table.of(path).unwrap_or_default(),
            PerFile::Pattern(pattern) => pattern.of(path)?,
        })
    }

    /// Which files the table has no row for, and which rows name no file.
    pub(super) fn unmatched(&self) -> Option<String> {
        let PerFile::Table(path, table) = &self.per_file else {
            return None;
        };
        let (missing, unused) = table.unmatched(self.inputs.iter().map(Input::path));
        let mut note = String::new();
        for file in missing {
            note += &format!("{}: no row for {:?}\n", path.display(), name(file));
        }
        for (file, line) in unused {
            note += &format!(
                "{}, line {line}: no input is named {:?}\n",
                path.display(),
                file
            );
        }
        Some(note)
    }

    /// Whether earlier rows are of these inputs, from the first, and of these options: the last file with a drop must
    /// give its rows again.
    pub(super) fn same_run(&self, mut file: &File, back: &ReadBack) -> Result<(), Error> {
        self.same_inputs(back)?;
        let Some((number, place)) = &back.sample else {
            return Ok(());
        };
        let mut rows = Vec::new();
        file.seek(SeekFrom::Start(place.start))?;
        file.take(place.end - place.start).read_to_end(&mut rows)?;
        if rows == self.done(*number).rows.as_bytes() {
            return Ok(());
        }
        Err(Error::refused(
            "it was made with other options or of recordings that have changed: give those of the interrupted run, or \
             --force without --resume to start again",
        ))
    }

    fn same_inputs(&self, back: &ReadBack) -> Result<(), Error> {
        let mut names = self.inputs.iter().map(|input| name(input.path()));
        for digest in &back.digests {
            let input = names.next();
            if input.as_ref() != Some(&digest.file) {
                let found = input.map_or_else(|| "nothing".to_owned(), |name| format!("{name:?}"));
                return Err(Error::refused(format!(
                    "it has rows of {:?} where the inputs now have {found}: give those of the interrupted run, or \
                     --force without --resume to start again",
                    digest.file
                )));
            }
        }
        Ok(())
    }

    /// Refuses to write over what is read.
    pub(super) fn spare(&self, written: &Path) -> Result<(), Error> {
        let Ok(real) = fs::canonicalize(written) else {
            return Ok(());
        };
        let is_it = |input: &Input| fs::canonicalize(input.path()).is_ok_and(|path| path == real);
        let problem = if self.inputs.iter().any(is_it) {
            "it is one of the recordings: it will not be written over"
        } else if matches!(&self.per_file, PerFile::Table(path, _) if fs::canonicalize(path).is_ok_and(|p| p == real))
        {
            "it is the table of the options: it will not be written over"
        } else {
            return Ok(());
        };
        Err(Error::refused(problem).in_file(written))
    }
}

/// Runs something that may have a bug: even then it costs one row and not the batch.
fn guarded<T>(work: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    panic::catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|payload| {
        let said = said(payload.as_ref());
        let problem = format!("the program broke off here, which is its own mistake: {said}");
        Err(Error::refused(problem))
    })
}

fn said(payload: &(dyn Any + Send)) -> &str {
    let text = payload.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| payload.downcast_ref::<&str>().copied())
        .unwrap_or("no reason")
}

/// A reason without the name of the file, which the row has already.
fn reason(error: Error) -> String {
    match error {
        Error::InFile { source, .. } => reason(*source),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bug_costs_one_file() {
        let broken = guarded(|| -> Result<(), Error> { panic!("index out of range") });
        let said = broken.unwrap_err().to_string();
        assert!(
            said.contains("own mistake") && said.ends_with("index out of range"),
            "{said}"
        );
    }

    #[test]
    fn a_reason_does_not_name_the_file_again() {
        let error = Error::refused("it is empty").in_file("a.wav");
        assert_eq!(reason(error), "it is empty");
    }
}
