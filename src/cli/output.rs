//! Files that are whole or not there.

use std::ffi::OsString;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::Path;

use crate::Error;

/// Writes a file beside its place and then puts it there: whoever looks sees the old file or the new one, never a part.
///
/// # Errors
/// [`Error::InFile`] naming the file; what was there before is then still there.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.partial", std::process::id()));
    let partial = path.with_file_name(name);
    let written = || -> std::io::Result<()> {
        let mut file = OpenOptions::new()
            .write(true)
            .create_new(true)
            .open(&partial)?;
        let done = file.write_all(bytes).and_then(|()| file.sync_all());
        drop(file);
        let done = done.and_then(|()| fs::rename(&partial, path));
        if done.is_err() {
            // What is wrong is told by the first error.
            fs::remove_file(&partial).ok();
        }
        done
    };
    written().map_err(|e| Error::from(e).in_file(path))
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
