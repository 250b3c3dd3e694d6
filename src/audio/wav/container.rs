//! The walk over the RIFF chunks, up to the first sample and past the last.
//!
//! hound alone reads about half of the WAV files that programs write: it never skips the pad byte after an odd chunk
//! and refuses streamed sizes. So the chunks are walked here, every length untrusted: none is ever room to be set
//! aside, and a file may end anywhere.

use std::io::{ErrorKind, Read};

use super::format::Format;
use super::wav;
use crate::Error;
use crate::audio::{FORMATS, unreadable};

/// How one sample is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::audio) enum SampleKind {
    /// Unsigned integer with the zero in the middle: 8 bit only.
    Unsigned8,
    /// Signed little-endian integer of 2 to 4 bytes.
    Signed,
    /// IEEE float of 4 bytes.
    Float32,
    /// IEEE float of 8 bytes.
    Float64,
    /// G.711 A-law, 1 byte.
    ALaw,
    /// G.711 µ-law, 1 byte.
    MuLaw,
}

/// Where the samples are and how they are stored; the stream stands at the first of them.
#[derive(Debug, Clone)]
pub(in crate::audio) struct Container {
    /// How one sample is stored.
    pub(in crate::audio) kind: SampleKind,
    /// Bytes that one sample takes.
    pub(in crate::audio) bytes_per_sample: u16,
    /// Channels, interleaved.
    pub(in crate::audio) channels: u16,
    /// Frames per second.
    pub(in crate::audio) sample_rate_hz: u32,
    /// Bytes of samples that the file claims, if it claims any.
    pub(in crate::audio) claimed_bytes: Option<u64>,
    /// What was odd on the way here.
    pub(in crate::audio) warnings: Vec<String>,
}

/// The longest chunk that is skipped: pictures and logs stay far below it.
const LONGEST_SKIP: u64 = 1 << 28;
/// A length of 32 bits that stands for one in the `ds64` chunk, or for none: a stream had not ended.
const LENGTH_ELSEWHERE: u64 = 0xFFFF_FFFF;

impl Container {
    /// Walks to the first sample.
    ///
    /// # Errors
    /// [`Error::Wav`] saying what is not a WAV about it; [`Error::Io`] if reading fails.
    pub(super) fn open(stream: &mut impl Read) -> Result<Self, Error> {
        check_magic(stream)?;
        let (mut format, mut long) = (None, None);
        let mut odd = false;
        while let Some(chunk) = Head::read(stream, odd)? {
            match &chunk.id {
                b"fmt " => format = Some(Format::of(&body(stream, chunk.length)?)?),
                b"ds64" => long = data_length(&body(stream, chunk.length)?),
                b"data" => {
                    let format: Format =
                        format.ok_or_else(|| wav("its samples come before their format"))?;
                    let length = match chunk.length {
                        LENGTH_ELSEWHERE => long,
                        length => Some(length),
                    };
                    return format.into_container(length.filter(|&l| l != 0 && l != u64::MAX));
                }
                _ => skip(stream, chunk.length)?,
            }
            odd = chunk.length % 2 == 1;
        }
        Err(wav("it ends before its samples"))
    }

    /// Whether more samples follow behind those that the stream has just passed, in a chunk of their own.
    ///
    /// # Errors
    /// [`Error::Io`] if reading fails.
    pub(super) fn more_follow(&self, stream: &mut impl Read) -> Result<bool, Error> {
        let mut odd = self.claimed_bytes.is_some_and(|length| length % 2 == 1);
        while let Some(chunk) = Head::read(stream, odd)? {
            if &chunk.id == b"data" {
                return Ok(true);
            }
            // What cannot be a chunk is no reason to refuse samples that were read.
            if chunk.length > LONGEST_SKIP {
                break;
            }
            skip(stream, chunk.length)?;
            odd = chunk.length % 2 == 1;
        }
        Ok(false)
    }

    /// Bytes of one frame: a sample of every channel.
    pub(super) fn frame_bytes(&self) -> usize {
        usize::from(self.bytes_per_sample) * usize::from(self.channels)
    }

    /// The storage in words, such as `16-bit integer`.
    pub(in crate::audio) fn encoding(&self) -> String {
        let kind = match self.kind {
            SampleKind::Unsigned8 | SampleKind::Signed => "integer",
            SampleKind::Float32 | SampleKind::Float64 => "float",
            SampleKind::ALaw => "A-law",
            SampleKind::MuLaw => "µ-law",
        };
        format!("{}-bit {kind}", 8 * self.bytes_per_sample)
    }
}

/// RIFF, or one of its forms with lengths of 64 bits: RF64 (EBU Tech 3306) and BW64 (ITU-R BS.2088).
fn check_magic(stream: &mut impl Read) -> Result<(), Error> {
    let mut magic = [0; 12];
    let got = fill(stream, &mut magic)?;
    match (&magic[..4], &magic[8..]) {
        _ if got == 0 => Err(unreadable("it is empty")),
        (b"RIFF" | b"RF64" | b"BW64", b"WAVE") => Ok(()),
        (b"RIFX", _) => Err(wav("it is RIFX (big-endian), not RIFF")),
        _ if magic[..got]
            .iter()
            .all(|b| b.is_ascii_graphic() || b.is_ascii_whitespace()) =>
        {
            Err(unreadable(format!(
                "it is text, which `bounce-audio fit` reads if it lists times, and begins like none of {FORMATS}"
            )))
        }
        _ => Err(unreadable(format!("it begins like none of {FORMATS}"))),
    }
}

/// How a chunk begins.
struct Head {
    id: [u8; 4],
    length: u64,
}

impl Head {
    /// Reads the next one; none at the end. A chunk of odd length is followed by a zero, which some programs leave out
    /// and some fill with anything.
    fn read(stream: &mut impl Read, after_odd: bool) -> Result<Option<Self>, Error> {
        let mut bytes = [0; 9];
        if fill(stream, &mut bytes[..8])? < 8 {
            return Ok(None);
        }
        let padded =
            after_odd && (bytes[0] == 0 || matches!(&bytes[1..5], b"fmt " | b"data" | b"LIST"));
        if padded && fill(stream, &mut bytes[8..])? < 1 {
            return Ok(None);
        }
        let (_, [a, b, c, d, length @ ..]) = bytes.split_at(usize::from(padded)) else {
            return Ok(None);
        };
        let length = length.first_chunk().map_or(0, |l| u32::from_le_bytes(*l));
        Ok(Some(Self {
            id: [*a, *b, *c, *d],
            length: u64::from(length),
        }))
    }
}

/// The first bytes of a chunk, and past the rest of it. Of a short chunk fewer come.
fn body(stream: &mut impl Read, length: u64) -> Result<Vec<u8>, Error> {
    /// As much as any chunk holds that is looked into.
    const MOST: u64 = 40;
    let mut bytes = Vec::new();
    stream.take(length.min(MOST)).read_to_end(&mut bytes)?;
    skip(stream, length - length.min(MOST))?;
    Ok(bytes)
}

/// The length of the samples in a `ds64` chunk: its second number.
fn data_length(ds64: &[u8]) -> Option<u64> {
    Some(u64::from_le_bytes(*ds64.get(8..)?.first_chunk()?))
}

/// Reads until `buffer` is full or the stream ends; gives the number of bytes read.
pub(in crate::audio) fn fill(stream: &mut impl Read, buffer: &mut [u8]) -> Result<usize, Error> {
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
            "it names a chunk of {length} bytes before its samples, expected at most {LONGEST_SKIP}: its lengths are \
             damaged"
        )));
    }
    std::io::copy(&mut stream.take(length), &mut std::io::sink())?;
    Ok(())
}
