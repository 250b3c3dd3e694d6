//! From the bytes of a WAV file to the samples of each channel, in blocks.
//!
//! [`container`] finds the samples and [`decode`] turns blocks of bytes into numbers. Reading works on any [`std::io::Read`], so a pipe is as good as a file.

pub mod container;
pub mod decode;

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use crate::Error;
use container::Container;

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
    let open = || -> Result<Recording, Error> {
        if path.is_dir() {
            return Err(wav("it is a directory"));
        }
        read(BufReader::with_capacity(1 << 16, File::open(path)?))
    };
    open().map_err(|e| e.in_file(path))
}

/// Reads a WAV stream to its end.
///
/// # Errors
/// [`Error::Wav`] if it is no WAV or holds no audio; [`Error::Io`] if reading fails.
pub fn read(mut stream: impl Read) -> Result<Recording, Error> {
    let mut container = Container::open(&mut stream)?;
    let mut channels = vec![Vec::new(); usize::from(container.channels)];
    let frames = decode::for_each_block(&mut stream, &container, |block| {
        let count = channels.len();
        for (c, samples) in channels.iter_mut().enumerate() {
            samples.extend(block.iter().skip(c).step_by(count));
        }
    })?;
    if frames.whole == 0 {
        return Err(wav("it holds no audio"));
    }
    container.warnings.extend(frames.warnings(&container));
    let marked = zero_what_is_not_finite(&mut channels);
    if marked > 0 {
        container.warnings.push(format!(
            "{marked} samples are not finite numbers and were read as zero"
        ));
    }
    Ok(Recording {
        sample_rate_hz: container.sample_rate_hz,
        channels,
        encoding: container.encoding(),
        warnings: container.warnings,
    })
}

/// An [`Error::Wav`] for a problem.
pub(crate) fn wav(problem: impl Into<String>) -> Error {
    Error::Wav {
        problem: problem.into(),
    }
}

/// A NaN would reach every sum that touches it; a zero is a sample of silence. Gives how many there were.
fn zero_what_is_not_finite(channels: &mut [Vec<f32>]) -> usize {
    let mut marked = 0;
    for x in channels.iter_mut().flat_map(|samples| samples.iter_mut()) {
        if !x.is_finite() {
            *x = 0.0;
            marked += 1;
        }
    }
    marked
}
