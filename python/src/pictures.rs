//! Pictures of a report, drawn when they are looked at.

use std::path::{Path, PathBuf};

use bounce_audio::Error;
use bounce_audio::audio::Stream;
use bounce_audio::picture::sheet::sheets;
use bounce_audio::picture::sound::Sound;
use bounce_audio::picture::to_svg;
use bounce_audio::report::Report;
use pyo3::{PyResult, Python, pyclass, pymethods};

use crate::failure::detached;
use crate::samples::Samples;

/// Height in pixels of a picture with the level alone.
const LEVEL_HEIGHT: u32 = 480;

/// A report and the sound that its pictures need.
#[pyclass(frozen, module = "bounce_audio._core")]
#[derive(Debug)]
pub(crate) struct Pictures {
    report: Report,
    sound: Kept,
}

#[derive(Debug)]
enum Kept {
    /// What is needed of samples in memory: its size does not grow with theirs.
    Sounds(Vec<Sound>),
    /// The file, which is read again.
    File(PathBuf),
}

impl Pictures {
    pub(crate) fn of_samples(report: Report, samples: &Samples<'_>) -> Self {
        let mut sounds = Sound::of(&report);
        for sound in &mut sounds {
            let channel = sound.channel - 1;
            sound.hear(0, &samples.channels[channel]);
        }
        let sound = Kept::Sounds(sounds);
        Self { report, sound }
    }

    pub(crate) const fn of_file(report: Report, path: PathBuf) -> Self {
        let sound = Kept::File(path);
        Self { report, sound }
    }

    fn draw(&self, number: usize, level_only: bool) -> Result<Option<String>, Error> {
        let drawn = match &self.sound {
            Kept::Sounds(sounds) => sheets(&self.report, sounds),
            Kept::File(path) => sheets(&self.report, &read(path, &self.report)?),
        };
        let Some(mut figure) = drawn.into_iter().nth(number) else {
            return Ok(None);
        };
        if level_only {
            figure.rows.truncate(1);
            figure.size.1 = LEVEL_HEIGHT;
        }
        to_svg(&figure).map(Some)
    }
}

#[pymethods]
impl Pictures {
    /// The sheet of the drop with this number from 0 as SVG, or of a recording without a drop; its level alone if that is
    /// asked for.
    fn svg(&self, py: Python<'_>, number: usize, level_only: bool) -> PyResult<Option<String>> {
        detached(py, || Ok(self.draw(number, level_only)?))
    }
}

/// Reads a recording again, for what its pictures need.
fn read(path: &Path, report: &Report) -> Result<Vec<Sound>, Error> {
    let mut sounds = Sound::of(report);
    let mut stream = Stream::open_file(path)?;
    let all = 0..stream.channels();
    let mut block = vec![Vec::new(); all.len()];
    let mut first = 0;
    while stream.append(&all, &mut block)? {
        for sound in &mut sounds {
            // A file that was changed since may have fewer channels.
            if let Some(samples) = block.get(sound.channel - 1) {
                sound.hear(first, samples);
            }
        }
        first += block.first().map_or(0, Vec::len);
        block.iter_mut().for_each(Vec::clear);
    }
    Ok(sounds)
}
