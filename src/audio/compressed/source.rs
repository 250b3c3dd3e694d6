//! Where the bytes of a compressed recording come from.

use std::io::{self, Read, Seek, SeekFrom};

use super::atoms::Head;
use super::index::{HEAD_BYTES, MOST_ATOMS};
use symphonia::core::io::{MediaSource, MediaSourceStream, ReadOnlySource};

/// Bytes that can only be read forwards, or anywhere.
pub(in crate::audio) enum Source<'s> {
    Pipe(Box<dyn Read + Send + Sync + 's>),
    Seekable(Box<dyn MediaSource + 's>),
}

impl<'s> Source<'s> {
    /// An MP4 that can be read anywhere.
    ///
    /// Where its last atom says that it ends is told for its end: symphonia takes no atom that is longer than the file,
    /// and a recording that was cut would give nothing.
    pub(in crate::audio) fn seekable(
        mut inner: impl Read + Seek + Send + Sync + 's,
    ) -> io::Result<Self> {
        let there = inner.seek(SeekFrom::End(0))?;
        let length = end_of_atoms(&mut inner, there)?.max(there);
        inner.seek(SeekFrom::Start(0))?;
        Ok(Self::Seekable(Box::new(Seekable { inner, length })))
    }

    /// Anything else that can be read anywhere.
    pub(in crate::audio) fn anywhere(
        mut inner: impl Read + Seek + Send + Sync + 's,
    ) -> io::Result<Self> {
        let length = inner.seek(SeekFrom::End(0))?;
        inner.seek(SeekFrom::Start(0))?;
        Ok(Self::Seekable(Box::new(Seekable { inner, length })))
    }

    /// For a container that symphonia takes apart.
    pub(super) fn into_media(self) -> MediaSourceStream<'s> {
        let source = match self {
            Self::Pipe(inner) => Box::new(ReadOnlySource::new(Patient(inner))),
            Self::Seekable(inner) => inner,
        };
        MediaSourceStream::new(
            source,
            symphonia::core::io::MediaSourceStreamOptions::default(),
        )
    }
}

impl Read for Source<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        match self {
            Self::Pipe(inner) => inner.read(buffer),
            Self::Seekable(inner) => inner.read(buffer),
        }
    }
}

/// A signal may interrupt a read, which is then asked for again: symphonia would take it as a failure.
struct Patient<R>(R);

impl<R: Read> Read for Patient<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        loop {
            match self.0.read(buffer) {
                Err(e) if e.kind() == io::ErrorKind::Interrupted => {}
                result => return result,
            }
        }
    }
}

/// Where the last of the atoms ends that follow each other from the beginning.
fn end_of_atoms(source: &mut (impl Read + Seek), there: u64) -> io::Result<u64> {
    let mut at = 0;
    for _ in 0..MOST_ATOMS {
        source.seek(SeekFrom::Start(at))?;
        let mut head = Vec::new();
        source.by_ref().take(HEAD_BYTES).read_to_end(&mut head)?;
        let Some(length) = Head::of(&head).and_then(|head| head.length) else {
            return Ok(at);
        };
        let end = at.saturating_add(length);
        if end >= there {
            return Ok(end.min(u64::MAX / 2));
        }
        at = end;
    }
    Ok(at)
}

struct Seekable<R> {
    inner: R,
    length: u64,
}

impl<R: Read> Read for Seekable<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        Patient(&mut self.inner).read(buffer)
    }
}

impl<R: Seek> Seek for Seekable<R> {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let to = match to {
            SeekFrom::End(from_end) => SeekFrom::Start(self.length.saturating_add_signed(from_end)),
            to => to,
        };
        self.inner.seek(to)
    }
}

impl<R: Read + Seek + Send + Sync> MediaSource for Seekable<R> {
    fn is_seekable(&self) -> bool {
        true
    }

    fn byte_len(&self) -> Option<u64> {
        Some(self.length)
    }
}
