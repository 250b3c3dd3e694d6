//! What an example listens to: the files that are named, or scenes where none is.

use std::env;
use std::path::{Path, PathBuf};

/// The files of the command line, or the scenes.
pub(crate) fn asked<S>(scenes: impl Iterator<Item = S>, file: impl Fn(PathBuf) -> S) -> Vec<S> {
    let files: Vec<S> = env::args_os().skip(1).map(|f| file(f.into())).collect();
    if files.is_empty() {
        scenes.collect()
    } else {
        files
    }
}

/// The name of a file without its folder.
pub(crate) fn name(path: &Path) -> String {
    let name = path.file_name().unwrap_or(path.as_os_str());
    name.to_string_lossy().into_owned()
}
