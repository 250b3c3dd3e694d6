//! From an array or a file to its report.

use std::io::Cursor;
use std::path::PathBuf;

use bounce_audio::audio::{Stream, has_ending};
use bounce_audio::recording::{Channel, listen};
use bounce_audio::report::{RecordingInfo, Report, json};
use bounce_audio::rules::RULES;
use bounce_audio::{Analysis, Error, analyze_clearest};
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::{PyResult, Python, pyfunction};
use serde_json::json;

use crate::asked::Asked;
use crate::errors::ArgumentError;
use crate::failure::detached;
use crate::pictures::Pictures;
use crate::samples::{Samples, index, repaired};

/// The document of rows of samples, and its pictures.
#[pyfunction]
#[pyo3(signature = (samples, sample_rate_hz, settings, *, channel, rule, name, encoding))]
#[expect(
    clippy::too_many_arguments,
    reason = "they cross the border one by one"
)]
pub(crate) fn analyze(
    py: Python<'_>,
    samples: PyReadonlyArray2<'_, f32>,
    sample_rate_hz: f64,
    settings: &str,
    channel: Option<usize>,
    rule: Option<&str>,
    name: String,
    encoding: String,
) -> PyResult<(String, Pictures)> {
    let asked = Asked::new(settings, rule)?;
    let length = samples.shape()[1];
    let all = samples.as_slice().map_err(|_| not_contiguous())?;
    detached(py, || {
        let samples = Samples::of(all, length);
        let recording =
            RecordingInfo::new(sample_rate_hz, length as f64 / sample_rate_hz, encoding);
        let (best, mut analysis) = heard(&samples, sample_rate_hz, channel, &asked)?;
        analysis.warnings.extend(repaired(samples.not_finite));
        analysis.drops.iter_mut().for_each(|d| asked.predict(d));
        let recording = recording.with_channel(best + 1, samples.channels.len());
        let rule = asked.judged(&analysis.drops)?;
        let report = Report::new(name, recording, asked.settings, analysis, rule);
        let document = json::to_line(&report)?;
        Ok((document, Pictures::of_samples(report, &samples)))
    })
}

/// What is heard on all channels, or on the one with a number, and the index of the best of them.
fn heard(
    samples: &Samples<'_>,
    sample_rate_hz: f64,
    channel: Option<usize>,
    asked: &Asked,
) -> Result<(usize, Analysis), Error> {
    let channels = &samples.channels;
    let Some(number) = channel else {
        return analyze_clearest(channels, sample_rate_hz, &asked.settings);
    };
    let only = index(number, channels.len())?;
    let one = &channels[only..=only];
    let (_, mut analysis) = analyze_clearest(one, sample_rate_hz, &asked.settings)?;
    for drop in &mut analysis.drops {
        drop.channel = number;
    }
    Ok((only, analysis))
}

pub(crate) fn not_contiguous() -> pyo3::PyErr {
    ArgumentError::new_err("samples are not in one piece, row after row")
}

/// The document of a file, and its pictures.
#[pyfunction]
#[pyo3(signature = (path, settings, *, channel, rule))]
pub(crate) fn analyze_file(
    py: Python<'_>,
    path: PathBuf,
    settings: &str,
    channel: Option<usize>,
    rule: Option<&str>,
) -> PyResult<(String, Pictures)> {
    let asked = Asked::new(settings, rule)?;
    detached(py, || {
        let stream = Stream::open_file(&path)?;
        let report = of_stream(stream, &path.to_string_lossy(), channel, &asked);
        let report = report.map_err(|e| e.in_file(&path))?;
        let document = json::to_line(&report)?;
        Ok((document, Pictures::of_file(report, path)))
    })
}

fn of_stream(
    stream: Stream<'_>,
    name: &str,
    channel: Option<usize>,
    asked: &Asked,
) -> Result<Report, Error> {
    let channel = channel.map_or(Channel::Best, Channel::Number);
    let mut report = listen(stream, name, channel, &asked.settings)?;
    report.drops.iter_mut().for_each(|d| asked.predict(d));
    report.rule = asked.judged(&report.drops)?;
    Ok(report)
}

/// The document of a recording whose file is in memory.
#[pyfunction]
#[pyo3(signature = (content, name, settings, *, channel, rule))]
pub(crate) fn analyze_bytes(
    py: Python<'_>,
    content: &[u8],
    name: &str,
    settings: &str,
    channel: Option<usize>,
    rule: Option<&str>,
) -> PyResult<String> {
    let asked = Asked::new(settings, rule)?;
    detached(py, || {
        let stream = Stream::open_seekable(Cursor::new(content));
        let report = stream.and_then(|stream| of_stream(stream, name, channel, &asked));
        Ok(json::to_line(&report.map_err(|e| e.in_file(name))?)?)
    })
}

/// Whether a name ends as those of recordings do.
#[pyfunction]
pub(crate) fn is_named_as_recording(path: PathBuf) -> bool {
    has_ending(&path)
}

/// The rules that a drop can be judged by, as a document.
#[pyfunction]
pub(crate) fn rules() -> String {
    let all = RULES.iter().map(|rule| {
        let spread = rule.allowed_spread;
        json!({
            "name": rule.name,
            "about": rule.about,
            "source": rule.source,
            "drop_height_m": rule.drop_height_m,
            "allowed_m": rule.allowed_m,
            "mass_kg": rule.mass_kg,
            "diameter_m": rule.diameter_m,
            "allowed_spread": spread.map(|s| json!({"greatest_m": s.greatest_m, "drops": s.drops})),
        })
    });
    serde_json::Value::from_iter(all).to_string()
}
