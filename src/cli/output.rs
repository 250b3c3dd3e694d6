//! Files that are whole or not there: written beside their place, then renamed. What a person made is not replaced.

use std::fs::{self, File, Metadata};
use std::io::{self, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};

use crate::Error;

/// Links that are followed from one to the next, as the system does.
const MOST_LINKS: usize = 40;

/// Writes a file, in place of one that is there and begins with `alike`. What is no file (a pipe, a terminal) is written
/// to as it is.
///
/// # Errors
/// [`Error::InFile`] naming the file that could not be written; then what was there before still is.
pub(super) fn write(path: &Path, alike: &[u8], bytes: &[u8]) -> Result<(), Error> {
    Whole::fill(path, alike, |file| Ok(file.write_all(bytes)?))?.put()
}

/// Where a name leads if it is a link, even to what is not there: a link stays, and what it leads to is written.
pub(super) fn followed(path: &Path) -> PathBuf {
    let mut path = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        let Ok(to) = fs::read_link(&path) else {
            break;
        };
        path = path.with_file_name("").join(to);
    }
    path
}

/// The place that a name stands for, whether or not there is something: two outputs must not have one.
pub(super) fn place(path: &Path) -> PathBuf {
    let path = followed(path);
    let name = path.file_name().unwrap_or_default();
    let folder = path.parent().filter(|f| !f.as_os_str().is_empty());
    let folder = fs::canonicalize(folder.unwrap_or(Path::new(".")));
    folder.map_or_else(|_| path.clone(), |folder| folder.join(name))
}

/// A file with all that it will hold, which is not in its place yet. Dropped, it was never there.
#[derive(Debug)]
pub(super) struct Whole {
    path: PathBuf,
    /// What to rename, and to what; none for what is no file.
    rename: Option<(PathBuf, PathBuf)>,
}

impl Whole {
    /// Writes the file beside its place, piece by piece. A file that is there has to begin with `alike`, or it is no
    /// earlier result but perhaps a recording: anything can have any name.
    ///
    /// # Errors
    /// [`Error::InFile`] naming the file that could not be written.
    pub(super) fn fill(
        path: &Path,
        alike: &[u8],
        write: impl FnOnce(&mut File) -> Result<(), Error>,
    ) -> Result<Self, Error> {
        let mut whole = Self {
            path: path.to_path_buf(),
            rename: None,
        };
        let written = whole.write(alike, write);
        // If this fails, `whole` is dropped, and the partial file with it.
        written.map_err(|e| e.in_file(path)).map(|()| whole)
    }

    fn write(
        &mut self,
        alike: &[u8],
        write: impl FnOnce(&mut File) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let there = fs::metadata(&self.path).ok();
        if there.as_ref().is_some_and(|m| !m.is_file() && !m.is_dir()) {
            return write(&mut File::create(&self.path)?);
        }
        if let Some(there) = &there {
            check_replaceable(there)?;
            check_alike(&self.path, alike)?;
        }
        let place = followed(&self.path);
        let mut name = place.file_name().unwrap_or_default().to_os_string();
        name.push(format!(".{}.partial", std::process::id()));
        let partial = place.with_file_name(name);
        let mut file = File::create(&partial).map_err(|e| by_folder(e, &place))?;
        self.rename = Some((partial, place));
        write(&mut file)?;
        if let Some(there) = there {
            file.set_permissions(there.permissions())?;
        }
        // Some disks say only now that they are full; and after a power cut the name must not come before the bytes.
        Ok(file.sync_all()?)
    }

    /// Removes what is in the file's place.
    ///
    /// # Errors
    /// [`Error::InFile`] if that cannot be.
    pub(super) fn clear(&self) -> Result<(), Error> {
        match self
            .rename
            .as_ref()
            .map(|(_, place)| fs::remove_file(place))
        {
            Some(Err(e)) if e.kind() != ErrorKind::NotFound => {
                Err(Error::from(e).in_file(&self.path))
            }
            _ => Ok(()),
        }
    }

    /// Puts the file in its place.
    ///
    /// # Errors
    /// [`Error::InFile`] if that cannot be; then what was there before still is.
    pub(super) fn put(mut self) -> Result<(), Error> {
        let Some((partial, place)) = &self.rename else {
            return Ok(());
        };
        fs::rename(partial, place).map_err(|e| Error::from(e).in_file(&self.path))?;
        self.rename = None;
        Ok(())
    }
}

impl Drop for Whole {
    fn drop(&mut self) {
        if let Some((partial, _)) = &self.rename {
            // The first error is what counts; that this file may stay behind adds nothing.
            drop(fs::remove_file(partial));
        }
    }
}

/// Of a file that could not be made: that its folder is at fault, where it is.
pub(super) fn by_folder(error: io::Error, place: &Path) -> io::Error {
    let folder = place.parent().filter(|f| !f.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let shown = folder.display();
    let said = match error.kind() {
        ErrorKind::NotFound if !folder.exists() => format!("there is no folder {shown}"),
        _ if folder.is_file() => format!("{shown} is a file, not a folder"),
        ErrorKind::NotFound | ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            format!("no file can be made in the folder {shown}")
        }
        _ => return error,
    };
    io::Error::new(error.kind(), said)
}

/// A rename would take the place of a file even where writing to it is not allowed.
pub(super) fn check_replaceable(there: &Metadata) -> io::Result<()> {
    if there.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    if there.permissions().readonly() {
        return Err(ErrorKind::PermissionDenied.into());
    }
    Ok(())
}

/// Refuses to replace what does not begin as what is to be written. Nothing is lost with an empty file.
fn check_alike(path: &Path, alike: &[u8]) -> Result<(), Error> {
    let mut head = Vec::new();
    let most = u64::try_from(alike.len()).unwrap_or(u64::MAX);
    File::open(path)?.take(most).read_to_end(&mut head)?;
    if head.is_empty() || head == alike {
        return Ok(());
    }
    Err(Error::refused(
        "it is there and holds something else than what is to be written: choose another name, or delete it",
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_put_in_its_place_leaves_nothing_behind() {
        let folder = std::env::temp_dir().join(format!("bounce-output-{}", std::process::id()));
        fs::create_dir_all(folder.join("taken.svg/inside")).unwrap();
        let file = folder.join("a.svg");
        write(&file, b"", b"old").unwrap();
        write(&file, b"o", b"new").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
        let error = write(&folder.join("taken.svg"), b"", b"x").unwrap_err();
        assert!(error.to_string().contains("taken.svg"), "{error}");
        let error = write(&file, b"o", b"x").unwrap_err().to_string();
        assert!(error.contains("a.svg: it is there"), "{error}");
        let error = Whole::fill(&file, b"", |file| {
            file.write_all(b"half")?;
            Err(Error::refused("no more"))
        });
        assert!(error.is_err());
        drop(Whole::fill(&file, b"", |file| Ok(file.write_all(b"whole")?)).unwrap());
        assert_eq!(fs::read(&file).unwrap(), b"new");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);
        fs::remove_dir_all(folder).unwrap();
    }
}
