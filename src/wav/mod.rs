//! From the bytes of a WAV file to the samples of each channel, in blocks.
//!
//! [`container`] finds the samples, [`stream`] reads them block by block, from any [`std::io::Read`], so a pipe is as
//! good as a file. [`read`] holds a whole recording in memory.

pub mod container;
mod decode;
mod format;
pub mod stream;

use std::io::Read;
use std::path::Path;

pub use stream::{Ending, Stream};

use crate::Error;

/// A recording in memory: one vector of samples for each channel, full scale being ±1.
#[derive(Debug, Clone)]
pub struct Recording {
    /// Samples per second of each channel.
    pub sample_rate_hz: u32,
    /// One vector of samples in ±1 for each channel, all of one length.
    pub channels: Vec<Vec<f32>>,
    /// How the samples were stored, for instance `16-bit integer`.
    pub encoding: String,
    /// What was repaired while reading.
    pub warnings: Vec<String>,
}

/// Reads a WAV file.
///
/// # Errors
/// [`Error::InFile`] naming the file, with the reason: it cannot be opened, is a directory, is empty, is no WAV, or
/// holds no audio.
pub fn read_file(path: &Path) -> Result<Recording, Error> {
    whole(Stream::open_file(path)?).map_err(|e| e.in_file(path))
}

/// Reads a WAV stream to its end.
///
/// # Errors
/// [`Error::Wav`] if it is no WAV or holds no audio; [`Error::Io`] if reading fails.
pub fn read(source: impl Read) -> Result<Recording, Error> {
    whole(Stream::open(source)?)
}

fn whole(mut stream: Stream<impl Read>) -> Result<Recording, Error> {
    let mut channels = vec![Vec::new(); usize::from(stream.container().channels)];
    let all = 0..channels.len();
    while stream.append(&all, &mut channels)? {}
    let (sample_rate_hz, encoding) = (
        stream.container().sample_rate_hz,
        stream.container().encoding(),
    );
    Ok(Recording {
        sample_rate_hz,
        channels,
        encoding,
        warnings: stream.finish()?.warnings,
    })
}

/// An [`Error::Wav`] for a problem.
pub(crate) fn wav(problem: impl Into<String>) -> Error {
    Error::Wav {
        problem: problem.into(),
    }
}
