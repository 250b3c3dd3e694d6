//! Files that are whole or not there: written beside their place, then renamed.

use std::fs;
use std::io;
use std::path::Path;

use crate::Error;

/// Writes a file, in place of one that is there. What is no file (a pipe, a terminal) is written to as it is.
///
/// # Errors
/// [`Error::InFile`] naming the file that could not be written; then what was there before still is.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let is_other = fs::metadata(path).is_ok_and(|m| !m.is_file() && !m.is_dir());
    let written = if is_other {
        fs::write(path, bytes)
    } else {
        replace(path, bytes)
    };
    written.map_err(|e| Error::from(e).in_file(path))
}

fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    // A link stays a link: what it leads to is replaced.
    let place = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
    if place.is_dir() {
        return Err(io::Error::from(io::ErrorKind::IsADirectory));
    }
    let mut name = place.file_name().unwrap_or_default().to_os_string();
    name.push(format!(".{}.partial", std::process::id()));
    let partial = place.with_file_name(name);
    let done = fs::write(&partial, bytes).and_then(|()| fs::rename(&partial, &place));
    done.inspect_err(|_| {
        // The first error is what counts; that this file may stay behind adds nothing.
        drop(fs::remove_file(&partial));
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_put_in_its_place_leaves_nothing_behind() {
        let folder = std::env::temp_dir().join(format!("bounce-output-{}", std::process::id()));
        fs::create_dir_all(folder.join("taken.svg/inside")).unwrap();
        let file = folder.join("a.svg");
        write(&file, b"old").unwrap();
        write(&file, b"new").unwrap();
        assert_eq!(fs::read(&file).unwrap(), b"new");
        let error = write(&folder.join("taken.svg"), b"x").unwrap_err();
        assert!(error.to_string().contains("taken.svg"), "{error}");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 2);
        fs::remove_dir_all(folder).unwrap();
    }
}
