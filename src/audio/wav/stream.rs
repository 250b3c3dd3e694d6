//! A WAV stream, read in blocks: what is held does not grow with its length.

use std::io::{ErrorKind, Read};
use std::ops::Range;

use super::container::{Container, fill};
use super::{decode, wav};
use crate::Error;
use crate::audio::Ending;
use crate::units::real;

/// Most bytes read at a time: as many as a pipe holds, and their samples still fit the cache.
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

    /// Adds the next samples of some channels to those of each, full scale being ±1; false at the end. Of a pipe it gives what
    /// has come: whoever listens live must not wait for a whole block.
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
        let frame_bytes = self.container.frame_bytes();
        let got = some(&mut self.source, &mut self.bytes[..wanted], frame_bytes)?;
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

/// Reads what has come and waits for the rest of its last frame; gives how many bytes that are: none at the end.
fn some(source: &mut impl Read, buffer: &mut [u8], frame_bytes: usize) -> Result<usize, Error> {
    let came = loop {
        match source.read(buffer) {
            Err(e) if e.kind() == ErrorKind::Interrupted => {}
            result => break result?,
        }
    };
    let whole = came.next_multiple_of(frame_bytes).min(buffer.len());
    Ok(came + fill(source, &mut buffer[came..whole])?)
}

#[cfg(test)]
mod tests {
    use std::io::{Cursor, Read};

    use super::Stream;
    use crate::audio::{Form, write_wav};

    /// Gives so many bytes at a time.
    struct Dripping<'a>(&'a [u8], usize);

    impl Read for Dripping<'_> {
        fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
            let most = buffer.len().min(self.1);
            self.0.read(&mut buffer[..most])
        }
    }

    #[test]
    fn samples_are_given_as_they_come() {
        let channels: [Vec<f32>; 2] = [1.0, -1.0].map(|sign| {
            let sample = |i: u8| sign * f32::from(i) / 256.0;
            (0..200).map(sample).collect()
        });
        let mut file = Cursor::new(Vec::new());
        write_wav(
            &mut file,
            8_000,
            &[&channels[0], &channels[1]],
            Form::Float32,
        )
        .unwrap();
        // Frames of 8 bytes: a part of one is waited for.
        for (bytes, frames) in [(3, 1), (8, 1), (12, 2), (1_000, 125)] {
            let mut stream = Stream::open(Dripping(file.get_ref(), bytes)).unwrap();
            let mut heard = [Vec::new(), Vec::new()];
            assert!(stream.append(&(0..2), &mut heard).unwrap());
            assert_eq!(heard[0].len(), frames, "{bytes} bytes at a time");
            while stream.append(&(0..2), &mut heard).unwrap() {}
            assert_eq!(heard, channels, "{bytes} bytes at a time");
            assert_eq!(stream.finish().unwrap().warnings, Vec::<String>::new());
        }
    }
}
