//! Where the rows of a run go, and what is there already.

use std::fs::File;
use std::ops::ControlFlow;
use std::path::Path;

use super::format::ReadBack;
use super::job::Job;
use super::rows_file::{Resumed, RowsFile, check_is_file, partial};
use super::{Arguments, print};
use crate::Error;
use crate::cli::output::followed;
use crate::report::batch::Digest;

/// Where the rows go.
pub(super) enum Target {
    Output,
    /// A terminal has a table in place of them, or they are not asked for.
    Nowhere,
    File(RowsFile),
    /// A file that was finished before.
    Finished,
}

impl Target {
    /// Makes ready to write, and gives what is there already.
    pub(super) fn open(
        arguments: &Arguments,
        job: &Job<'_>,
        no_rows: bool,
    ) -> Result<(Self, Vec<Digest>), Error> {
        let (force, format) = (arguments.force, arguments.format());
        // A link stays a link, so the rows go beside what it leads to.
        let Some(path) = arguments.output.as_deref().map(followed) else {
            if no_rows {
                return Ok((Self::Nowhere, Vec::new()));
            }
            let mut output = Self::Output;
            // If nobody reads, the first row says so again.
            output.add(&format.header()).map(|_| ())?;
            return Ok((output, Vec::new()));
        };
        for written in [&path, &partial(&path)] {
            job.spare(written)?;
            check_is_file(written)?;
        }
        if !arguments.resume {
            return Ok((
                Self::File(RowsFile::create(&path, force, format)?),
                Vec::new(),
            ));
        }
        match RowsFile::resume(&path, force, format)? {
            Resumed::Finished(file, back) => {
                Ok((Self::Finished, finished(job, &file, back, &path)?))
            }
            Resumed::Partial(mut rows, back) => {
                let same = job.same_run(rows.partial(), &back);
                same.map_err(|e| e.in_file(partial(&path)))?;
                rows.cut(back.end, format)?;
                Ok((Self::File(rows), back.digests))
            }
        }
    }

    pub(super) fn add(&mut self, rows: &str) -> Result<ControlFlow<()>, Error> {
        match self {
            Self::File(file) => file.add(rows)?,
            Self::Finished | Self::Nowhere => {}
            Self::Output => return print(rows),
        }
        Ok(ControlFlow::Continue(()))
    }

    pub(super) fn finish(self) -> Result<(), Error> {
        match self {
            Self::File(file) => file.finish(),
            Self::Output | Self::Nowhere | Self::Finished => Ok(()),
        }
    }
}

/// What was finished before, if it is of the same inputs and options.
fn finished(job: &Job<'_>, file: &File, back: ReadBack, path: &Path) -> Result<Vec<Digest>, Error> {
    job.same_run(file, &back).map_err(|e| e.in_file(path))?;
    if back.digests.len() < job.inputs.len() {
        let problem = "it is finished, but there are more inputs now: --force does them all again";
        return Err(Error::refused(problem).in_file(path));
    }
    Ok(back.digests)
}
