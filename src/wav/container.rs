//! The walk over the RIFF chunks, up to the first sample.
//!
//! hound alone reads about half of the WAV files that programs write: it never skips the pad byte after an odd chunk
//! and refuses streamed sizes. So the chunks are walked here, every length untrusted, and hound is handed a canonical
//! header to judge the format by its own rules.

use std::io::{ErrorKind, Read};

use super::wav;
use crate::Error;

/// How one sample is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SampleKind {
    /// Unsigned integer with the zero in the middle: 8 bit only.
    Unsigned8,
    /// Signed little-endian integer of 2 to 4 bytes.
    Signed,
    /// IEEE float of 4 bytes.
    Float32,
}

/// Where the samples are and how they are stored; the stream stands at the first of them.
#[derive(Debug, Clone)]
pub struct Container {
    /// How one sample is stored.
    pub kind: SampleKind,
    /// Bytes that one sample takes.
    pub bytes_per_sample: u16,
    /// Channels, interleaved.
    pub channels: u16,
    /// Frames per second.
    pub sample_rate_hz: u32,
    /// Bytes of samples that the file claims, if it claims any.
    pub claimed_bytes: Option<u64>,
    /// What was odd on the way here.
    pub warnings: Vec<String>,
}

/// The longest chunk before the samples that is skipped: pictures and logs stay far below it.
const LONGEST_SKIP: u64 = 1 << 28;

impl Container {
    /// Walks to the first sample.
    ///
    /// # Errors
    /// [`Error::Wav`] saying what is not a WAV about it; [`Error::Io`] if reading fails.
    pub fn open(stream: &mut impl Read) -> Result<Self, Error> {
        let mut riff = [0; 12];
        match fill(stream, &mut riff)? {
            0 => return Err(wav("it is empty")),
            12 if &riff[..4] == b"RIFF" && &riff[8..] == b"WAVE" => {}
            _ if &riff[..4] == b"RIFX" => return Err(wav("it is RIFX (big-endian), not RIFF")),
            _ => return Err(wav("it does not start with RIFF and WAVE")),
        }
        let mut format = None;
        loop {
            let mut head = [0; 8];
            if fill(stream, &mut head)? < 8 {
                return Err(wav("it ends before its samples"));
            }
            let length = u64::from(u32::from_le_bytes([head[4], head[5], head[6], head[7]]));
            match &head[..4] {
                b"fmt " => format = Some(Format::read(stream, length)?),
                b"data" => {
                    let format =
                        format.ok_or_else(|| wav("its samples come before their format"))?;
                    return format.into_container(length);
                }
                _ => skip(stream, length + length % 2)?,
            }
        }
    }

    /// Bytes of one frame: a sample of every channel.
    #[must_use]
    pub fn frame_bytes(&self) -> usize {
        usize::from(self.bytes_per_sample) * usize::from(self.channels)
    }

    /// The storage in words, such as `16-bit integer`.
    #[must_use]
    pub fn encoding(&self) -> String {
        let kind = if self.kind == SampleKind::Float32 {
            "float"
        } else {
            "integer"
        };
        format!("{}-bit {kind}", 8 * self.bytes_per_sample)
    }
}

/// The content of a `fmt ` chunk.
#[derive(Debug, Clone, Copy)]
struct Format {
    tag: u16,
    channels: u16,
    sample_rate_hz: u32,
    frame_bytes: u16,
    bits: u16,
}

const TAG_PCM: u16 = 1;
const TAG_FLOAT: u16 = 3;
const TAG_EXTENSIBLE: u16 = 0xFFFE;

impl Format {
    fn read(stream: &mut impl Read, length: u64) -> Result<Self, Error> {
        let mut body = [0; 40];
        let known = usize::try_from(length.min(40)).unwrap_or(40);
        if known < 16 || fill(stream, &mut body[..known])? < known {
            return Err(wav("its format chunk is too short"));
        }
        skip(stream, length - length.min(40) + length % 2)?;
        let u16_at = |i: usize| u16::from_le_bytes([body[i], body[i + 1]]);
        let mut tag = u16_at(0);
        if tag == TAG_EXTENSIBLE && known >= 26 {
            // The first two bytes of the sub-format GUID are the tag that the plain header would carry.
            tag = u16_at(24);
        }
        Ok(Self {
            tag,
            channels: u16_at(2),
            sample_rate_hz: u32::from_le_bytes([body[4], body[5], body[6], body[7]]),
            frame_bytes: u16_at(12),
            bits: u16_at(14),
        })
    }

    fn into_container(self, data_length: u64) -> Result<Container, Error> {
        if self.channels == 0 {
            return Err(wav("it has no channels"));
        }
        if self.sample_rate_hz == 0 {
            return Err(wav("its sample rate is 0"));
        }
        let bytes_per_sample = self.frame_bytes / self.channels;
        let kind = match (self.tag, bytes_per_sample) {
            (TAG_PCM, 1) => SampleKind::Unsigned8,
            (TAG_PCM, 2..=4) => SampleKind::Signed,
            (TAG_FLOAT, 4) => SampleKind::Float32,
            (tag, _) => {
                return Err(wav(format!(
                    "its samples (format {tag}, {} bits) are of a kind not read yet",
                    self.bits
                )));
            }
        };
        self.ask_hound(kind, bytes_per_sample)?;
        let claimed_bytes = match data_length {
            0 | 0xFFFF_FFFF => None,
            length => Some(length),
        };
        Ok(Container {
            kind,
            bytes_per_sample,
            channels: self.channels,
            sample_rate_hz: self.sample_rate_hz,
            claimed_bytes,
            warnings: Vec::new(),
        })
    }

    /// Has hound judge the format from a canonical header over no samples.
    fn ask_hound(self, kind: SampleKind, bytes_per_sample: u16) -> Result<(), Error> {
        let tag = if kind == SampleKind::Float32 {
            TAG_FLOAT
        } else {
            TAG_PCM
        };
        let frame_bytes = u32::from(bytes_per_sample) * u32::from(self.channels);
        let byte_rate = self.sample_rate_hz.saturating_mul(frame_bytes);
        let mut header = Vec::with_capacity(44);
        header.extend_from_slice(b"RIFF\x24\0\0\0WAVEfmt \x10\0\0\0");
        header.extend_from_slice(&tag.to_le_bytes());
        header.extend_from_slice(&self.channels.to_le_bytes());
        header.extend_from_slice(&self.sample_rate_hz.to_le_bytes());
        header.extend_from_slice(&byte_rate.to_le_bytes());
        header.extend_from_slice(&self.frame_bytes.to_le_bytes());
        header.extend_from_slice(&(8 * bytes_per_sample).to_le_bytes());
        header.extend_from_slice(b"data\0\0\0\0");
        match hound::WavReader::new(header.as_slice()) {
            Ok(_) => Ok(()),
            Err(e) => Err(wav(format!("its format is refused: {e}"))),
        }
    }
}

/// Reads until `buffer` is full or the stream ends; gives the number of bytes read.
pub(super) fn fill(stream: &mut impl Read, buffer: &mut [u8]) -> Result<usize, Error> {
    let mut filled = 0;
    while filled < buffer.len() {
        match stream.read(&mut buffer[filled..]) {
            Ok(0) => break,
            Ok(n) => filled += n,
            Err(e) if e.kind() == ErrorKind::Interrupted => {}
            Err(e) => return Err(e.into()),
        }
    }
    Ok(filled)
}

fn skip(stream: &mut impl Read, length: u64) -> Result<(), Error> {
    if length > LONGEST_SKIP {
        return Err(wav(format!(
            "a chunk of {length} bytes stands before its samples"
        )));
    }
    std::io::copy(&mut stream.take(length), &mut std::io::sink())?;
    Ok(())
}
