//! Many drops together.

use bounce_audio::fit::random_effects::{Measurement, RandomEffects, outliers};
use bounce_audio::report::batch::{Digest, summary as of_digests};
use bounce_audio::report::{Report, drops};
use pyo3::{PyResult, Python, pyclass, pyfunction, pymethods};
use serde_json::{Value, json};

use crate::failure::{Failure, detached};

/// Mean and spread of values with their standard errors, as a document.
#[pyfunction]
pub(crate) fn compare(py: Python<'_>, measurements: Vec<Measurement>) -> PyResult<String> {
    detached(py, || {
        let far = outliers(&measurements).into_iter();
        let far: Vec<Value> = far
            .map(|o| json!({"index": o.index, "distance": o.distance}))
            .collect();
        let pooled = RandomEffects::of(&measurements).map(|p| {
            json!({
                "count": p.count,
                "mean": p.mean,
                "mean_std": p.mean_std,
                "spread": p.spread,
                "claimed": p.claimed,
                "between": p.between,
                "chi_square": p.chi_square,
                "chance": p.chance,
                "birge": p.birge,
                "outliers": far,
            })
        });
        Ok(Value::from(pooled).to_string())
    })
}

/// Recordings in short, of which a batch tells at its end: little is kept of each.
#[pyclass(module = "bounce_audio._core")]
#[derive(Debug, Default)]
pub(crate) struct Digests {
    digests: Vec<Digest>,
}

#[pymethods]
impl Digests {
    #[new]
    fn new() -> Self {
        Self::default()
    }

    /// Takes in documents, each a line.
    fn add(&mut self, py: Python<'_>, lines: Vec<String>) -> PyResult<()> {
        let digests: Vec<Digest> = detached(py, || lines.iter().map(|l| digest(l)).collect())?;
        self.digests.extend(digests);
        Ok(())
    }

    /// What a batch says at its end.
    fn summary(&self, py: Python<'_>) -> PyResult<String> {
        detached(py, || Ok(of_digests(&self.digests)))
    }
}

/// The columns of [`drop_rows`].
#[pyfunction]
pub(crate) fn drop_columns() -> Vec<&'static str> {
    drops::COLUMNS.to_vec()
}

/// The rows of a batch's CSV for these documents, each a line: a row per drop, without the names of the columns.
#[pyfunction]
pub(crate) fn drop_rows(py: Python<'_>, lines: Vec<String>) -> PyResult<String> {
    let rows = |line: &String| {
        Ok(match Line::read(line)? {
            Line::Failed(file, reason) => drops::failure(&file, &reason),
            Line::Report(report) => drops::rows(&report),
        })
    };
    detached(py, || lines.iter().map(rows).collect())
}

fn digest(line: &str) -> Result<Digest, Failure> {
    Ok(match Line::read(line)? {
        Line::Failed(file, reason) => Digest::failed(file, reason),
        Line::Report(report) => Digest::from(&*report),
    })
}

/// A line of a batch's documents.
enum Line {
    /// A file that could not be analyzed, and why.
    Failed(String, String),
    Report(Box<Report>),
}

impl Line {
    fn read(line: &str) -> Result<Self, Failure> {
        let document: Value = serde_json::from_str(line)?;
        let text = |name: &str| Some(document.get(name)?.as_str()?.to_owned());
        Ok(match (text("file"), text("error")) {
            (Some(file), Some(reason)) => Self::Failed(file, reason),
            _ => Self::Report(Box::new(serde_json::from_value(document)?)),
        })
    }
}
