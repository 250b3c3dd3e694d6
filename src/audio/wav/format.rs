//! The `fmt ` chunk: how samples are stored, as far as the header can be believed.

use super::container::{Container, SampleKind};
use super::wav;
use crate::Error;

/// The content of a `fmt ` chunk.
#[derive(Debug, Clone, Copy)]
pub(super) struct Format {
    tag: u16,
    channels: u16,
    sample_rate_hz: u32,
    byte_rate: u32,
    frame_bytes: u16,
    bits: u16,
}

/// Bytes of a frame at most: what the header has room for.
const MOST_FRAME_BYTES: usize = 65_535;

const TAG_PCM: u16 = 1;
const TAG_FLOAT: u16 = 3;
const TAG_A_LAW: u16 = 6;
const TAG_MU_LAW: u16 = 7;
const TAG_EXTENSIBLE: u16 = 0xFFFE;

impl Format {
    /// Reads the content of a chunk.
    ///
    /// # Errors
    /// [`Error::Wav`] if it is too short.
    pub(super) fn of(body: &[u8]) -> Result<Self, Error> {
        let fields = body.as_chunks::<2>().0;
        let u16_at = |i: usize| fields.get(i / 2).map(|f| u16::from_le_bytes(*f));
        let u32_at = |i: usize| Some(u32::from(u16_at(i)?) | u32::from(u16_at(i + 2)?) << 16);
        let read = || {
            Some(Self {
                // The first two bytes of the sub-format GUID are the tag that the plain header would carry.
                tag: u16_at(if u16_at(0)? == TAG_EXTENSIBLE { 24 } else { 0 })?,
                channels: u16_at(2)?,
                sample_rate_hz: u32_at(4)?,
                byte_rate: u32_at(8)?,
                frame_bytes: u16_at(12)?,
                bits: u16_at(14)?,
            })
        };
        read().ok_or_else(|| wav("its format chunk is too short"))
    }

    /// The container that holds samples in this format, claimed to be so long.
    ///
    /// # Errors
    /// [`Error::Wav`] if it has no channels, no sample rate, or samples of a kind that is not read.
    pub(super) fn into_container(self, claimed_bytes: Option<u64>) -> Result<Container, Error> {
        if self.channels == 0 {
            return Err(wav("it has 0 channels, expected 1 or more"));
        }
        if self.sample_rate_hz == 0 {
            return Err(wav("its sample rate is 0 Hz, expected 1 or more"));
        }
        let mut warnings = Vec::new();
        let bytes_per_sample = self.bytes_per_sample(&mut warnings);
        let kind = self.kind(bytes_per_sample)?;
        let container = Container {
            kind,
            bytes_per_sample,
            channels: self.channels,
            sample_rate_hz: self.sample_rate_hz,
            claimed_bytes,
            warnings,
        };
        if container.frame_bytes() > MOST_FRAME_BYTES {
            return Err(wav(format!(
                "its {} channels make frames of {} bytes, expected at most {MOST_FRAME_BYTES}",
                container.channels,
                container.frame_bytes()
            )));
        }
        Ok(container)
    }

    /// From the length of a frame where it can be, else from the bits of a sample; what contradicts that is a warning.
    fn bytes_per_sample(self, warnings: &mut Vec<String>) -> u16 {
        let (channels, by_bits) = (self.channels, self.bits.div_ceil(8));
        let by_frame = self.frame_bytes / channels;
        let whole = self.frame_bytes.is_multiple_of(channels);
        // Samples may take more room than they need, as 12 bits in 16, but not less.
        let bytes_per_sample = if whole && by_frame >= by_bits.max(1) {
            by_frame
        } else {
            warnings.push(format!(
                "the header gives {channels} channels of {} bits {} bytes together; the bits were believed",
                self.bits, self.frame_bytes
            ));
            by_bits
        };
        let frame_bytes = u64::from(bytes_per_sample) * u64::from(channels);
        let byte_rate = frame_bytes * u64::from(self.sample_rate_hz);
        if byte_rate != u64::from(self.byte_rate) {
            warnings.push(format!(
                "the header gives {} bytes a second where its rate and format make {byte_rate}; these were believed",
                self.byte_rate
            ));
        }
        bytes_per_sample
    }

    fn kind(self, bytes_per_sample: u16) -> Result<SampleKind, Error> {
        match (self.tag, bytes_per_sample) {
            (TAG_PCM, 1) => Ok(SampleKind::Unsigned8),
            (TAG_PCM, 2..=4) => Ok(SampleKind::Signed),
            (TAG_FLOAT, 4) => Ok(SampleKind::Float32),
            (TAG_FLOAT, 8) => Ok(SampleKind::Float64),
            (TAG_A_LAW, 1) => Ok(SampleKind::ALaw),
            (TAG_MU_LAW, 1) => Ok(SampleKind::MuLaw),
            (tag, _) => Err(wav(format!(
                "its samples are of format {tag} with {} bits, expected 1 (integers of 8 to 32 bits), 3 (floats of 32 \
                 or 64), 6 (A-law) or 7 (µ-law); ffmpeg -i IN.wav -c:a pcm_s16le OUT.wav converts it",
                self.bits
            ))),
        }
    }
}
