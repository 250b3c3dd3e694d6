//! Times without a sound.

use bounce_audio::fit_times;
use pyo3::{PyResult, Python, pyfunction};

use crate::asked::Asked;
use crate::failure::detached;

/// The document of the drop with these times and errors.
#[pyfunction]
pub(crate) fn fit(
    py: Python<'_>,
    times_s: Vec<f64>,
    errors_s: Vec<f64>,
    document: &str,
) -> PyResult<String> {
    let asked = Asked::new(document, None)?;
    detached(py, || {
        let times: Vec<(f64, f64)> = times_s.into_iter().zip(errors_s).collect();
        let mut analysis = fit_times(&[times], &asked.settings)?;
        asked.predict(&mut analysis.drops[0]);
        Ok(serde_json::to_string(&analysis.drops[0])?)
    })
}
