//! Recordings with known truth.

use bounce_audio::synth::presets::{found_names, names, preset};
use bounce_audio::synth::{render, scene::Scene};
use numpy::ndarray::Array2;
use numpy::{IntoPyArray, PyArray2};
use pyo3::{Bound, PyResult, Python, pyfunction};

use crate::errors::InternalError;
use crate::failure::detached;

/// Rows of samples of a scene, which is the name of a preset or a text, and its truth as a document.
#[pyfunction]
pub(crate) fn synth<'py>(
    py: Python<'py>,
    scene: &str,
    is_text: bool,
    seed: u64,
) -> PyResult<(Bound<'py, PyArray2<f32>>, String)> {
    let (channels, truth) = detached(py, || {
        let scene = if is_text {
            Scene::from_toml(scene)
        } else {
            preset(scene)
        };
        let made = render(&scene?, seed)?;
        let truth = serde_json::to_string(&made.truth)?;
        let first = std::iter::once(made.samples);
        let channels: Vec<Vec<f32>> = first.chain(made.more_channels).collect();
        Ok((channels, truth))
    })?;
    let shape = (channels.len(), channels.first().map_or(0, Vec::len));
    let rows = Array2::from_shape_vec(shape, channels.concat());
    let rows = rows.map_err(|e| InternalError::new_err(e.to_string()))?;
    Ok((rows.into_pyarray(py), truth))
}

/// The name of each preset and what it is there to show.
#[pyfunction]
pub(crate) fn presets(py: Python<'_>) -> PyResult<Vec<(String, String)>> {
    detached(py, || {
        let names = names().chain(found_names());
        let told = names.map(|name| Ok((name.to_owned(), preset(name)?.about)));
        told.collect()
    })
}
