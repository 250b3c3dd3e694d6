//! Which recordings are meant: files as named, folders with all that is in them.

use std::collections::HashSet;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::Error;
use crate::audio;

/// One input, which gets a row or more.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Input {
    /// A file to analyze.
    Recording(PathBuf),
    /// A folder that gave nothing, with the reason.
    Folder(PathBuf, String),
}

impl Input {
    /// The path, if it is one of a file.
    pub(super) fn recording(&self) -> Option<&Path> {
        match self {
            Self::Recording(path) => Some(path),
            Self::Folder(..) => None,
        }
    }

    pub(super) fn path(&self) -> &Path {
        match self {
            Self::Recording(path) | Self::Folder(path, _) => path,
        }
    }
}

/// The inputs in the order in which they were named, those of a folder by name; what is reached twice is taken once.
pub(super) fn gather(paths: &[PathBuf]) -> Result<Vec<Input>, Error> {
    let mut gathered = Gathered::default();
    for path in paths {
        if path == Path::new("-") {
            return Err(Error::Argument {
                argument: "PATH",
                got: "- (standard input)".to_owned(),
                expected: "files and folders; analyze - reads a pipe, ./- is a file of this name",
            });
        }
        if path.is_dir() {
            gathered.folder(path);
        } else {
            gathered.file(path.clone());
        }
    }
    let recording = |input: &Input| matches!(input, Input::Recording(_));
    match gathered.inputs.first() {
        Some(Input::Folder(path, reason)) if !gathered.inputs.iter().any(recording) => {
            Err(Error::refused(reason).in_file(path))
        }
        _ => Ok(gathered.inputs),
    }
}

#[derive(Debug, Default)]
struct Gathered {
    inputs: Vec<Input>,
    /// Where everything reached so far really is: a folder that links to itself is walked once.
    seen: HashSet<PathBuf>,
    /// How many recordings were reached, again or for the first time.
    reached: usize,
}

impl Gathered {
    /// Whether this was not reached before. What cannot be looked up is new.
    fn is_new(&mut self, path: &Path) -> bool {
        fs::canonicalize(path).map_or(true, |real| self.seen.insert(real))
    }

    fn file(&mut self, path: PathBuf) {
        self.reached += 1;
        if self.is_new(&path) {
            self.inputs.push(Input::Recording(path));
        }
    }

    /// A folder that was named.
    fn folder(&mut self, path: &Path) {
        let before = (self.reached, self.inputs.len());
        if self.is_new(path) {
            self.walk(path);
            if before == (self.reached, self.inputs.len()) {
                let reason = "the folder holds no recording, nor does any folder in it";
                self.inputs
                    .push(Input::Folder(path.into(), reason.to_owned()));
            }
        }
    }

    fn walk(&mut self, folder: &Path) {
        let listed = fs::read_dir(folder).and_then(Iterator::collect::<io::Result<Vec<_>>>);
        let mut paths: Vec<PathBuf> = match listed {
            Ok(entries) => entries.iter().map(fs::DirEntry::path).collect(),
            Err(e) => {
                let reason = format!("the folder cannot be read: {}", Error::from(e));
                return self.inputs.push(Input::Folder(folder.into(), reason));
            }
        };
        paths.sort();
        for path in paths {
            // Links are followed; one that leads nowhere is no folder.
            if path.is_dir() {
                if self.is_new(&path) {
                    self.walk(&path);
                }
            } else if is_recording(&path) {
                self.file(path);
            }
        }
    }
}

/// Whether a file in a folder is meant: it begins as a recording does, or its name says that it should, and then the reason
/// why it is none is worth a row. A hidden file (`._drop.wav`, as macOS leaves on other disks) must be one.
fn is_recording(path: &Path) -> bool {
    let name = path.file_name().map_or(&[][..], OsStr::as_encoded_bytes);
    let named = !name.starts_with(b".") && audio::has_ending(path);
    // Opening a named pipe would wait for someone to write into it.
    named || (path.is_file() && begins_as_recording(path).unwrap_or(false))
}

/// Whether a file is a list of times, by its name; what begins as a recording is one, whatever its name. In a folder lists are not
/// looked for: rows that were written before are such files too.
pub(super) fn is_list(path: &Path) -> bool {
    let ending = path.extension().and_then(OsStr::to_str);
    let listed = ending.is_some_and(|e| LISTS.iter().any(|list| e.eq_ignore_ascii_case(list)));
    listed && path.is_file() && !begins_as_recording(path).unwrap_or(false)
}

/// Endings of lists of times.
const LISTS: [&str; 3] = ["csv", "tsv", "txt"];

fn begins_as_recording(path: &Path) -> io::Result<bool> {
    let mut head = [0; audio::HEAD_BYTES];
    let got = File::open(path)?.read(&mut head)?;
    Ok(audio::could_be_recording(&head[..got]))
}
