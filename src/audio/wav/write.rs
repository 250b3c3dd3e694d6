//! From samples to a WAV file.

use std::io::{self, BufWriter, ErrorKind, Seek, Write};

use crate::Error;

/// How samples are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Form {
    /// Integers of so many bits, 8 to 32.
    Integer(u16),
    /// Floating point of 32 bits.
    Float32,
}

/// Writes a WAV file: samples of each channel, full scale being ±1; those beyond it are clipped where they are stored as
/// integers. Channels that are longer than the first are cut.
///
/// # Errors
/// [`Error::Io`] if writing fails, or if a WAV file cannot hold so many bits, channels or samples.
pub fn write_wav(
    file: impl Write + Seek,
    sample_rate_hz: u32,
    channels: &[&[f32]],
    form: Form,
) -> Result<(), Error> {
    let (bits_per_sample, sample_format) = match form {
        Form::Integer(bits) => (bits, hound::SampleFormat::Int),
        Form::Float32 => (32, hound::SampleFormat::Float),
    };
    let spec = hound::WavSpec {
        channels: u16::try_from(channels.len()).unwrap_or(u16::MAX),
        sample_rate: sample_rate_hz,
        bits_per_sample,
        sample_format,
    };
    let mut writer = hound::WavWriter::new(BufWriter::new(file), spec).map_err(from_hound)?;
    for frame in 0..channels.first().map_or(0, |first| first.len()) {
        for channel in channels {
            match form {
                Form::Float32 => writer.write_sample(channel[frame]),
                Form::Integer(bits) => writer.write_sample(step(channel[frame], bits)),
            }
            .map_err(from_hound)?;
        }
    }
    writer.finalize().map_err(from_hound)
}

/// The step of a sample that is already a whole number of them.
#[expect(
    clippy::cast_possible_truncation,
    reason = "`as` saturates, and only full scale of 32 bits is rounded up to its limit"
)]
fn step(x: f32, bits: u16) -> i32 {
    (f64::from(x) * f64::from(bits - 1).exp2()).round() as i32
}

fn from_hound(error: hound::Error) -> Error {
    match error {
        hound::Error::IoError(e) => e.into(),
        other => io::Error::new(ErrorKind::InvalidData, other.to_string()).into(),
    }
}
