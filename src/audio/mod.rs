//! From the bytes of a recording to the samples of each channel, in blocks.
//!
//! What a recording is says its content, never its name (`content`). WAV is read by `wav` and what is compressed by
//! `compressed`; a [`Stream`] is either, and holds a block of it, whatever its length. [`read_file`] holds a whole
//! recording in memory, [`Stream::again`] streams it from there, [`write_wav`] writes one.

mod compressed;
mod content;
mod memory;
mod stream;
mod system;
mod wav;

use std::io::Read;
use std::path::Path;

pub use compressed::is_guarded;
pub use content::{FORMATS, HEAD_BYTES, could_be_recording, has_ending};
pub use stream::Stream;
pub use wav::{Form, write_wav};

use crate::Error;

/// A recording in memory: one vector of samples for each channel, full scale being ±1.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Recording {
    /// Samples per second of each channel.
    pub sample_rate_hz: u32,
    /// One vector of samples for each channel, all of one length.
    pub channels: Vec<Vec<f32>>,
    /// How the samples were stored, for instance `16-bit integer` or `AAC`.
    pub encoding: String,
    /// Whether something was thrown away when they were stored.
    pub lossy: bool,
    /// What was repaired while reading.
    pub warnings: Vec<String>,
    /// All tracks of sound and which was read, where there are several and none was asked for.
    pub tracks: Option<String>,
}

/// Which track of sound is read of a file with several, as videos may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum Track {
    /// The first that can be read and has sound; the first that can be read where none has.
    #[default]
    WithSound,
    /// The one with this number among those of sound, from 1.
    Number(usize),
}

/// What is known of a recording once it was read.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Ending {
    /// Length in seconds.
    pub duration_s: f64,
    /// What was repaired while reading.
    pub warnings: Vec<String>,
    /// All tracks of sound and which was read, where there are several and none was asked for.
    pub tracks: Option<String>,
}

/// Reads a file.
///
/// # Errors
/// [`Error::InFile`] naming the file, with the reason: it cannot be opened, is a directory, is empty, is no recording
/// that can be read, or holds no audio.
pub fn read_file(path: &Path) -> Result<Recording, Error> {
    let read = Stream::open_file(path)?.into_recording();
    read.map_err(|e| e.in_file(path))
}

/// Reads a stream to its end.
///
/// # Errors
/// [`Error::Wav`] or [`Error::Recording`] if it cannot be read or holds no audio; [`Error::Io`] if reading fails.
pub fn read(source: impl Read + Send + Sync) -> Result<Recording, Error> {
    Stream::open(source)?.into_recording()
}

impl Stream<'_> {
    /// Reads all channels to the end.
    ///
    /// # Errors
    /// [`Error::Wav`] or [`Error::Recording`] if it holds no audio; [`Error::Io`] if reading fails.
    pub fn into_recording(self) -> Result<Recording, Error> {
        let whole = self.into_recording_within(usize::MAX)?;
        whole.ok_or_else(|| unreadable("it is longer than any memory"))
    }

    /// Reads all channels to the end, unless they have more samples than this together: none then.
    ///
    /// # Errors
    /// As for [`into_recording`](Self::into_recording).
    pub fn into_recording_within(mut self, samples: usize) -> Result<Option<Recording>, Error> {
        let mut channels = vec![Vec::new(); self.channels()];
        let all = 0..channels.len();
        while self.append(&all, &mut channels)? {
            if channels.iter().map(Vec::len).sum::<usize>() > samples {
                return Ok(None);
            }
        }
        let (sample_rate_hz, encoding) = (self.sample_rate_hz(), self.encoding());
        let lossy = self.is_lossy();
        let Ending {
            warnings, tracks, ..
        } = self.finish()?;
        Ok(Some(Recording {
            sample_rate_hz,
            channels,
            encoding,
            lossy,
            warnings,
            tracks,
        }))
    }
}

impl Error {
    /// Says in which file this error happened.
    #[must_use]
    pub fn in_file(self, path: impl AsRef<Path>) -> Self {
        Self::InFile {
            file: path.as_ref().display().to_string(),
            source: Box::new(self),
        }
    }
}

/// An [`Error::Recording`] for a problem.
fn unreadable(problem: impl Into<String>) -> Error {
    Error::Recording {
        problem: problem.into(),
    }
}
