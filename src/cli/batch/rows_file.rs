//! Rows go to `OUT.partial`, which becomes `OUT` when it is whole; what an interruption left is gone on with.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::format::{Format, ReadBack};
use crate::Error;
use crate::cli::output::{by_folder, check_replaceable};

/// The file that rows are added to.
#[derive(Debug)]
pub(super) struct RowsFile {
    partial: File,
    partial_path: PathBuf,
    path: PathBuf,
    replace: bool,
}

/// What `--resume` found.
#[derive(Debug)]
pub(super) enum Resumed {
    /// Rows to go on behind.
    Partial(RowsFile, ReadBack),
    /// A file that was finished.
    Finished(File, ReadBack),
}

impl RowsFile {
    /// A new file; `replace` takes the place of what is there.
    pub(super) fn create(path: &Path, replace: bool, format: Format) -> Result<Self, Error> {
        if path.exists() && !replace {
            return Err(Error::refused("it is there already: --force replaces it").in_file(path));
        }
        let mut options = OpenOptions::new();
        options.read(true).write(true);
        if replace {
            options.create(true).truncate(false);
        } else {
            options.create_new(true);
        }
        let mut made = Self::open(path, replace, &options)?;
        made.cut(0, format)?;
        Ok(made)
    }

    /// What an interrupted run left, without its torn end; a new file if it left nothing.
    pub(super) fn resume(path: &Path, replace: bool, format: Format) -> Result<Resumed, Error> {
        let partial_path = partial(path);
        if !partial_path.exists() {
            if path.exists() && !replace {
                let file = File::open(path).map_err(|e| Error::from(e).in_file(path))?;
                let back = read_back(&file, path, format)?;
                return Ok(Resumed::Finished(file, back));
            }
            let made = Self::create(path, replace, format)?;
            return Ok(Resumed::Partial(made, ReadBack::default()));
        }
        if path.exists() && !replace {
            let problem = format!(
                "it is there already, beside what an interrupted run left in {}: --force replaces it",
                partial_path.display()
            );
            return Err(Error::refused(problem).in_file(path));
        }
        let opened = Self::open(path, replace, OpenOptions::new().read(true).write(true))?;
        let back = read_back(&opened.partial, &partial_path, format)?;
        Ok(Resumed::Partial(opened, back))
    }

    fn open(path: &Path, replace: bool, options: &OpenOptions) -> Result<Self, Error> {
        let partial_path = partial(path);
        let open = options.open(&partial_path).map_err(|e| match e.kind() {
            ErrorKind::AlreadyExists => Error::refused(
                "it was left by an interrupted run: --resume goes on with it, --force starts again",
            )
            .in_file(&partial_path),
            _ if partial_path.exists() => Error::from(e).in_file(&partial_path),
            // The user named the other file, and neither is there.
            _ => Error::from(by_folder(e, path)).in_file(path),
        });
        let partial = open?;
        // Where files cannot be locked, nobody is kept out.
        if matches!(partial.try_lock(), Err(TryLockError::WouldBlock)) {
            let problem = "another run is writing it: wait for its end";
            return Err(Error::refused(problem).in_file(partial_path));
        }
        Ok(Self {
            partial,
            partial_path,
            path: path.to_path_buf(),
            replace,
        })
    }

    /// Leaves the first bytes, and writes the heading if those are none.
    pub(super) fn cut(&mut self, end: u64, format: Format) -> Result<(), Error> {
        let cut = self.partial.set_len(end);
        let cut = cut.and_then(|()| self.partial.seek(SeekFrom::Start(end)));
        cut.map_err(|e| Error::from(e).in_file(&self.partial_path))?;
        if end == 0 {
            self.add(&format.header())?;
        }
        Ok(())
    }

    /// Adds rows; the system has them when this returns.
    pub(super) fn add(&mut self, rows: &str) -> Result<(), Error> {
        let written = self.partial.write_all(rows.as_bytes());
        written.map_err(|e| Error::from(e).in_file(&self.partial_path))
    }

    /// All rows are there.
    pub(super) fn finish(self) -> Result<(), Error> {
        if self.path.exists() && !self.replace {
            let problem = format!(
                "it came into being meanwhile: the rows are in {}",
                self.partial_path.display()
            );
            return Err(Error::refused(problem).in_file(self.path));
        }
        let kept = self.partial.sync_all();
        let kept = kept.and_then(|()| fs::rename(&self.partial_path, &self.path));
        kept.map_err(|e| Error::from(e).in_file(self.path))
    }

    /// The file as it is until it is whole.
    pub(super) const fn partial(&self) -> &File {
        &self.partial
    }
}

/// A folder cannot be replaced by rows, and a pipe, a device or a protected file must not be.
pub(super) fn check_is_file(path: &Path) -> Result<(), Error> {
    let Ok(there) = fs::metadata(path) else {
        return Ok(());
    };
    if !there.is_file() {
        let problem = "it is not a file: rows go into a file, or without -o to standard output";
        return Err(Error::refused(problem).in_file(path));
    }
    check_replaceable(&there).map_err(|e| Error::from(e).in_file(path))
}

/// `OUT.partial`.
pub(super) fn partial(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".partial");
    name.into()
}

fn read_back(source: impl Read, path: &Path, format: Format) -> Result<ReadBack, Error> {
    let back = format.read_back(source).and_then(|back| {
        let problem = "it does not hold the rows that --resume could go on with: it needs the --format of the \
                       interrupted run, or --force without --resume to start again";
        back.ok_or_else(|| Error::refused(problem))
    });
    back.map_err(|e| e.in_file(path))
}
