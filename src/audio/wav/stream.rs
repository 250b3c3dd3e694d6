//! A WAV stream, read in blocks: what is held does not grow with its length.

use std::io::Read;
use std::ops::Range;

use super::container::{Container, fill};
use super::{decode, wav};
use crate::Error;
use crate::audio::Ending;
use crate::units::real;

/// Bytes read at a time: as many as a pipe holds, and their samples still fit the cache.
const BLOCK_BYTES: usize = 1 << 16;

/// A WAV stream that stands at its samples.
#[derive(Debug)]
pub(in crate::audio) struct Stream<R> {
    source: R,
    container: Container,
    bytes: Vec<u8>,
    /// Bytes that may still come.
    left: u64,
    /// Whole frames read.
    frames: u64,
    /// Bytes after the last whole frame.
    torn_bytes: usize,
    not_finite: usize,
}

impl<R: Read> Stream<R> {
    /// Walks to the samples.
    ///
    /// # Errors
    /// [`Error::Wav`] if it is no WAV; [`Error::Io`] if reading fails.
    pub(in crate::audio) fn open(mut source: R) -> Result<Self, Error> {
        let container = Container::open(&mut source)?;
        let frame_bytes = container.frame_bytes();
        Ok(Self {
            source,
            bytes: vec![0; (BLOCK_BYTES / frame_bytes).max(1) * frame_bytes],
            left: container.claimed_bytes.unwrap_or(u64::MAX),
            frames: 0,
            torn_bytes: 0,
            not_finite: 0,
            container,
        })
    }

    /// What the header says.
    pub(in crate::audio) const fn container(&self) -> &Container {
        &self.container
    }

    /// Adds the next samples of some channels to those of each, full scale being ±1; false at the end.
    ///
    /// # Errors
    /// [`Error::Io`] if reading fails.
    pub(in crate::audio) fn append(
        &mut self,
        channels: &Range<usize>,
        samples: &mut [Vec<f32>],
    ) -> Result<bool, Error> {
        if self.torn_bytes > 0 {
            return Ok(false);
        }
        let wanted =
            usize::try_from(self.left).map_or(self.bytes.len(), |left| left.min(self.bytes.len()));
        let got = fill(&mut self.source, &mut self.bytes[..wanted])?;
        let frame_bytes = self.container.frame_bytes();
        self.left -= got as u64;
        self.torn_bytes = got % frame_bytes;
        self.frames += (got / frame_bytes) as u64;
        let whole = &self.bytes[..got - self.torn_bytes];
        self.not_finite += decode::decode(whole, &self.container, channels, samples);
        Ok(!whole.is_empty())
    }

    /// What is known after the last block.
    ///
    /// # Errors
    /// [`Error::Wav`] if there was no audio; [`Error::Io`] if reading what follows it fails.
    pub(in crate::audio) fn finish(mut self) -> Result<Ending, Error> {
        if self.frames == 0 {
            return Err(wav("it holds no audio"));
        }
        let mut warnings = self.container.warnings.clone();
        warnings.extend(self.length_warning());
        if self.torn_bytes > 0 {
            warnings.push(format!(
                "what follows the last whole frame was left out: {} of {} bytes",
                self.torn_bytes,
                self.container.frame_bytes()
            ));
        }
        if self.not_finite > 0 {
            warnings.push(format!(
                "samples that are not finite numbers were read as zero: {}",
                self.not_finite
            ));
        }
        if self.left == 0 && self.container.more_follow(&mut self.source)? {
            let message = "samples follow in a second chunk of them; only the first was read";
            warnings.push(message.to_owned());
        }
        let frames = usize::try_from(self.frames).map_or(f64::INFINITY, real);
        Ok(Ending {
            duration_s: frames / f64::from(self.container.sample_rate_hz),
            warnings,
            tracks: None,
        })
    }

    /// Whether the header told the truth about the length.
    fn length_warning(&self) -> Option<String> {
        let Some(claimed) = self.container.claimed_bytes else {
            return Some("the header gives no length; read to the end of the file".to_owned());
        };
        let missing = (claimed / self.container.frame_bytes() as u64).saturating_sub(self.frames);
        (missing > 0).then(|| {
            format!("the file ends before its header says, by {missing} frames; the rest was read")
        })
    }
}
