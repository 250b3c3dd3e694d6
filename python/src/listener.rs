//! Listening to a stream, block by block.

use bounce_audio::report::{RecordingInfo, Report, json};
use bounce_audio::{Error, Listener as Core, Live, Told};
use numpy::{PyReadonlyArray2, PyUntypedArrayMethods};
use pyo3::{PyResult, Python, pyclass, pymethods};

use crate::asked::Asked;
use crate::failure::detached;
use crate::recordings::not_contiguous;
use crate::samples::{Samples, repaired};

/// A listener; none once it has finished.
#[pyclass(module = "bounce_audio._core")]
#[derive(Debug)]
pub(crate) struct Listener {
    core: Option<Core>,
    live: Live,
    asked: Asked,
    sample_rate_hz: f64,
    channels: usize,
    frames: u64,
    not_finite: usize,
}

#[pymethods]
impl Listener {
    #[new]
    fn new(
        sample_rate_hz: f64,
        channels: usize,
        settings: &str,
        rule: Option<&str>,
    ) -> PyResult<Self> {
        let asked = Asked::new(settings, rule)?;
        let core = Core::new(channels, sample_rate_hz, &asked.settings);
        Ok(Self {
            core: Some(core.map_err(crate::errors::raised)?),
            live: Live::new(channels, sample_rate_hz, &asked.settings)
                .map_err(crate::errors::raised)?,
            asked,
            sample_rate_hz,
            channels,
            frames: 0,
            not_finite: 0,
        })
    }

    /// Listens to rows of samples; gives the drops that are over, as a document.
    fn push(&mut self, py: Python<'_>, samples: PyReadonlyArray2<'_, f32>) -> PyResult<String> {
        let (rows, length) = (samples.shape()[0], samples.shape()[1]);
        let all = samples.as_slice().map_err(|_| not_contiguous())?;
        detached(py, || {
            let samples = Samples::of(all, length);
            let core = self.core.as_mut().ok_or_else(finished)?;
            if length == 0 && rows == self.channels {
                return Ok("[]".to_owned());
            }
            core.push(&samples.channels)?;
            self.frames += length as u64;
            self.not_finite += samples.not_finite;
            let told = self.live.hear(&samples.channels)?;
            Ok(self.document(told)?)
        })
    }

    /// The drops that are over because the sound ends here, as a document.
    fn rest(&mut self, py: Python<'_>) -> PyResult<String> {
        detached(py, || {
            let told = self.live.finish()?;
            Ok(self.document(told)?)
        })
    }

    /// The document of the whole recording.
    fn finish(&mut self, py: Python<'_>, name: String, encoding: String) -> PyResult<String> {
        detached(py, || {
            let core = self.core.take().ok_or_else(finished)?;
            let (best, mut analysis) = core.finish()?;
            analysis.warnings.extend(repaired(self.not_finite));
            let duration_s = self.frames as f64 / self.sample_rate_hz;
            let recording = RecordingInfo::new(self.sample_rate_hz, duration_s, encoding)
                .with_channel(best + 1, self.channels);
            analysis
                .drops
                .iter_mut()
                .for_each(|d| self.asked.predict(d));
            let rule = self.asked.judged(&analysis.drops)?;
            let settings = self.asked.settings.clone();
            let report = Report::new(name, recording, settings, analysis, rule);
            Ok(json::to_line(&report)?)
        })
    }
}

impl Listener {
    /// The document of the drops that were told.
    fn document(&self, mut told: Vec<Told>) -> serde_json::Result<String> {
        told.iter_mut()
            .for_each(|t| self.asked.predict(&mut t.drop));
        serde_json::to_string(&told)
    }
}

fn finished() -> Error {
    Error::Argument {
        argument: "the listener",
        got: "finished".to_owned(),
        expected: "a new one for more",
    }
}
