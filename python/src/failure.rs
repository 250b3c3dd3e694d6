//! What can go wrong on this side of the border, panics included.

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};

use bounce_audio::Error;
use pyo3::{PyErr, PyResult, Python, pyfunction};

use crate::errors;

/// Why there is no result.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The library says why.
    Error(Error),
    /// A bug, with what it said.
    Panic(String),
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::Error(error)
    }
}

impl From<serde_json::Error> for Failure {
    fn from(error: serde_json::Error) -> Self {
        Self::Panic(error.to_string())
    }
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        match failure {
            Failure::Error(error) => errors::raised(error),
            Failure::Panic(said) => errors::InternalError::new_err(format!(
                "the library broke off here, which is its own mistake: {said}"
            )),
        }
    }
}

/// Does work without the interpreter's lock; a panic in it becomes an exception.
pub(crate) fn detached<T: Send>(
    py: Python<'_>,
    work: impl FnOnce() -> Result<T, Failure> + Send,
) -> PyResult<T> {
    let done = py.detach(|| catch_unwind(AssertUnwindSafe(work)));
    let done = done.unwrap_or_else(|payload| Err(Failure::Panic(said(payload.as_ref()))));
    done.map_err(PyErr::from)
}

fn said(payload: &(dyn Any + Send)) -> String {
    let text = payload.downcast_ref::<String>().map(String::as_str);
    let text = text.or_else(|| payload.downcast_ref::<&str>().copied());
    text.unwrap_or("no reason").to_owned()
}

/// Panics as a bug would, on the way that all work goes: what becomes of it can be seen without one.
#[pyfunction]
#[expect(clippy::panic, reason = "that is what it is for")]
pub(crate) fn break_off(py: Python<'_>) -> PyResult<()> {
    detached(py, || panic!("asked to"))
}
