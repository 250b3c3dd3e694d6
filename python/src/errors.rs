//! The library's errors as the exceptions of `bounce_audio.errors`.

use bounce_audio::Error;
use pyo3::exceptions::PyOSError;
use pyo3::{PyErr, import_exception, pyfunction};

import_exception!(bounce_audio.errors, ArgumentError);
import_exception!(bounce_audio.errors, InternalError);
import_exception!(bounce_audio.errors, NoSolutionError);
import_exception!(bounce_audio.errors, RecordingError);

/// The exception of an error, by its kind; its text names the file if there is one.
pub(crate) fn raised(error: Error) -> PyErr {
    let error = by_keyword(error);
    let said = error.to_string();
    let (file, cause) = innermost(None, error);
    match cause {
        Error::Io(cause) => from_system(file, &cause, said),
        Error::Argument { .. } | Error::Line { .. } => ArgumentError::new_err(said),
        Error::NoRoot { .. } => NoSolutionError::new_err(said),
        Error::Wav { .. } | Error::Recording { .. } => RecordingError::new_err(said),
        _ => InternalError::new_err(said),
    }
}

/// The same with the argument named as Python does.
fn by_keyword(error: Error) -> Error {
    match error {
        Error::Argument {
            argument,
            got,
            expected,
        } => Error::Argument {
            argument: keyword(argument),
            got,
            expected,
        },
        Error::InFile { file, source } => Error::InFile {
            file,
            source: Box::new(by_keyword(*source)),
        },
        other => other,
    }
}

/// The keyword of a setting that the library names by a word for people.
fn keyword(argument: &'static str) -> &'static str {
    match argument {
        "clock error" => "clock_std",
        "contact time" => "contact_time_s",
        "diameter" => "diameter_m",
        "end" => "end_s",
        "gravity" => "gravity_m_per_s2",
        "height" => "height_m",
        "height error" => "height_std_m",
        "mass" => "mass_kg",
        "start" => "start_s",
        "time error" => "time_std_s",
        "time scale" => "time_scale",
        other => other,
    }
}

/// The cause behind the names of files, and the last of these.
fn innermost(file: Option<String>, error: Error) -> (Option<String>, Error) {
    match error {
        Error::InFile { file, source } => innermost(Some(file), *source),
        cause => (file, cause),
    }
}

/// An `OSError`, which Python makes a `FileNotFoundError` and the like by the number.
fn from_system(file: Option<String>, cause: &std::io::Error, said: String) -> PyErr {
    match (cause.raw_os_error(), file) {
        (Some(number), Some(file)) => {
            let text = cause.to_string();
            // The system's text without Rust's addition to it.
            let text = text.split(" (os error").next().unwrap_or_default();
            PyOSError::new_err((number, text.to_owned(), file))
        }
        _ => PyOSError::new_err(said),
    }
}

/// What the command says of an error of the system, by its number.
#[pyfunction]
pub(crate) fn system_words(number: i32) -> String {
    Error::from(std::io::Error::from_raw_os_error(number)).to_string()
}
