//! Blocks of bytes into samples.

use std::io::Read;

use super::container::{Container, SampleKind, fill};
use crate::Error;

/// Bytes read at a time: small enough for the cache, large enough that the call costs nothing.
const BLOCK_BYTES: usize = 1 << 16;

/// How much of the claimed audio was there.
#[derive(Debug, Clone, Copy)]
pub struct Frames {
    /// Whole frames read.
    pub whole: u64,
    /// Bytes after the last whole frame.
    pub torn_bytes: usize,
}

impl Frames {
    /// What a user should know about the length.
    #[must_use]
    pub fn warnings(self, container: &Container) -> Vec<String> {
        let mut warnings = Vec::new();
        let frame_bytes = container.frame_bytes() as u64;
        match container.claimed_bytes {
            None => {
                warnings.push("the header gives no length; read to the end of the file".to_owned());
            }
            Some(claimed) if self.whole < claimed / frame_bytes => {
                let missing = claimed / frame_bytes - self.whole;
                warnings.push(format!(
                    "the file ends {missing} frames before its header says; the rest was read"
                ));
            }
            Some(_) => {}
        }
        if self.torn_bytes > 0 {
            warnings.push(format!(
                "{} bytes after the last whole frame were left out",
                self.torn_bytes
            ));
        }
        warnings
    }
}

/// Decodes the stream block by block: `each` gets interleaved samples of whole frames, full scale being ±1.
///
/// # Errors
/// [`Error::Io`] if reading fails.
pub fn for_each_block(
    stream: &mut impl Read,
    container: &Container,
    mut each: impl FnMut(&[f32]),
) -> Result<Frames, Error> {
    let frame_bytes = container.frame_bytes();
    let block_bytes = (BLOCK_BYTES / frame_bytes).max(1) * frame_bytes;
    let mut bytes = vec![0; block_bytes];
    let mut samples = Vec::with_capacity(block_bytes / usize::from(container.bytes_per_sample));
    let mut left = container.claimed_bytes.unwrap_or(u64::MAX);
    let mut frames = Frames {
        whole: 0,
        torn_bytes: 0,
    };
    while left > 0 && frames.torn_bytes == 0 {
        let wanted = usize::try_from(left).map_or(block_bytes, |left| left.min(block_bytes));
        let got = fill(stream, &mut bytes[..wanted])?;
        if got == 0 {
            break;
        }
        left -= got as u64;
        frames.torn_bytes = got % frame_bytes;
        frames.whole += (got / frame_bytes) as u64;
        samples.clear();
        decode(&bytes[..got - frames.torn_bytes], container, &mut samples);
        each(&samples);
    }
    Ok(frames)
}

/// Full scale of 32-bit integers.
const FULL_SCALE_32: f32 = 65_536.0 * 32_768.0;

/// Full scale of each integer width is a power of two, so scaling is exact; 32-bit integers are rounded to the
/// 24 bits of an `f32`, which is below the noise of any microphone.
#[expect(
    clippy::cast_precision_loss,
    reason = "an f32 keeps 24 bits, more than a microphone gives"
)]
fn decode(bytes: &[u8], container: &Container, samples: &mut Vec<f32>) {
    match (container.kind, container.bytes_per_sample) {
        (SampleKind::Unsigned8, _) => {
            samples.extend(bytes.iter().map(|&b| (f32::from(b) - 128.0) / 128.0));
        }
        (SampleKind::Signed, 2) => samples.extend(
            bytes
                .as_chunks::<2>()
                .0
                .iter()
                .map(|&b| f32::from(i16::from_le_bytes(b)) / 32_768.0),
        ),
        (SampleKind::Signed, 3) => samples.extend(
            bytes
                .as_chunks::<3>()
                .0
                .iter()
                .map(|&[a, b, c]| i32::from_le_bytes([0, a, b, c]) as f32 / FULL_SCALE_32),
        ),
        (SampleKind::Signed, _) => samples.extend(
            bytes
                .as_chunks::<4>()
                .0
                .iter()
                .map(|&b| i32::from_le_bytes(b) as f32 / FULL_SCALE_32),
        ),
        (SampleKind::Float32, _) => samples.extend(
            bytes
                .as_chunks::<4>()
                .0
                .iter()
                .map(|&b| f32::from_le_bytes(b)),
        ),
    }
}
