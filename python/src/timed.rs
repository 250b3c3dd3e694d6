//! Times without a sound.

use bounce_audio::analyze_times;
use pyo3::{PyResult, Python, pyfunction};

use crate::asked::settings;
use crate::failure::detached;

/// The document of the drop with these times and errors.
#[pyfunction]
pub(crate) fn fit(
    py: Python<'_>,
    times_s: Vec<f64>,
    errors_s: Vec<f64>,
    document: &str,
) -> PyResult<String> {
    let settings = settings(document)?;
    detached(py, || {
        let times: Vec<(f64, f64)> = times_s.into_iter().zip(errors_s).collect();
        let drop = analyze_times(&times, &settings)?;
        Ok(serde_json::to_string(&drop)?)
    })
}
