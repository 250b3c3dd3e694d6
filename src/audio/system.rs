//! What the system says of files, in words.

use std::io::{self, ErrorKind};

use crate::Error;

impl Error {
    /// What the system says of a file, in words that need no knowledge of systems, and without its number. What this program or
    /// a library said itself stays as it is.
    pub(crate) fn of_system(error: &io::Error) -> String {
        let said = error.to_string();
        // A page opens no files, and whoever visits it would load these sentences.
        if cfg!(target_family = "wasm") || error.get_ref().is_some() {
            return said;
        }
        let known = match error.kind() {
            ErrorKind::NotFound => "there is no such file or folder",
            ErrorKind::PermissionDenied => "reading or writing it is not permitted",
            ErrorKind::IsADirectory => "it is a directory",
            ErrorKind::NotADirectory => "a folder on the way to it is a file",
            ErrorKind::StorageFull => "there is no room left on the disk",
            _ => said.split(" (os error").next().unwrap_or_default(),
        };
        known.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_system_is_told_in_words_without_its_number() {
        let missing = Error::from(std::fs::File::open("no such file").unwrap_err());
        assert_eq!(
            missing.in_file("a.wav").to_string(),
            "a.wav: there is no such file or folder"
        );
        // Numbers that have no sentence here: on each system other ones.
        for number in 1..40 {
            let said = Error::of_system(&io::Error::from_raw_os_error(number));
            assert!(!said.is_empty() && !said.contains("os error"), "{said}");
        }
        let own = io::Error::new(ErrorKind::NotFound, "there is no folder out");
        assert_eq!(Error::of_system(&own), "there is no folder out");
    }
}
