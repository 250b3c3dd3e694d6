//! A recording of any kind, read in blocks.

use std::fs::File;
use std::io::{Cursor, Read, Seek, SeekFrom};
use std::ops::Range;
use std::path::Path;

use super::compressed::{self, Source};
use super::content::{Content, HEAD_BYTES};
use super::memory;
use super::wav::{self, fill};
use super::{Ending, Recording, Track, unreadable};
use crate::Error;

/// A recording that stands at its samples. What is held of it does not grow with its length.
#[derive(Debug)]
pub struct Stream<'s> {
    form: Form<'s>,
}

enum Form<'s> {
    Wav(wav::Stream<Box<dyn Read + Send + Sync + 's>>),
    Compressed(Box<compressed::Stream<'s>>),
    Memory(memory::Stream<'s>),
}

impl std::fmt::Debug for Form<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Wav(stream) => f.debug_tuple("Wav").field(stream.container()).finish(),
            Self::Compressed(stream) => stream.fmt(f),
            Self::Memory(stream) => stream.fmt(f),
        }
    }
}

impl Stream<'static> {
    /// Opens a file; a named pipe is read as a pipe.
    ///
    /// # Errors
    /// [`Error::InFile`] naming the file, with the reason: it cannot be opened, is a directory, is empty, or is no
    /// recording that can be read.
    pub fn open_file(path: &Path) -> Result<Self, Error> {
        Self::open_file_track(path, Track::default())
    }

    /// Opens one track of a file.
    ///
    /// # Errors
    /// As [`open_file`](Self::open_file); if the file has no such track, with a list of those that it has.
    pub fn open_file_track(path: &Path, track: Track) -> Result<Self, Error> {
        let open = || -> Result<Self, Error> {
            if path.is_dir() {
                return Err(unreadable("it is a directory"));
            }
            let file = File::open(path)?;
            if file.metadata()?.is_file() {
                Self::of_seekable(file, track)
            } else {
                Self::open_track(file, track)
            }
        };
        open().map_err(|e| e.in_file(path))
    }
}

impl<'s> Stream<'s> {
    /// Opens a pipe, which is only read forwards.
    ///
    /// # Errors
    /// [`Error::Wav`] or [`Error::Recording`] if it is no recording that can be read, such as an MP4 with its index at the
    /// end; [`Error::Io`] if reading fails.
    pub fn open(source: impl Read + Send + Sync + 's) -> Result<Self, Error> {
        Self::open_track(source, Track::default())
    }

    /// Opens one track of what comes from a pipe.
    ///
    /// # Errors
    /// As [`open`](Self::open); if there is no such track, with a list of those that there are.
    pub fn open_track(
        mut source: impl Read + Send + Sync + 's,
        track: Track,
    ) -> Result<Self, Error> {
        let head = head(&mut source)?;
        let content = Content::of(&head);
        let source = Source::Pipe(Box::new(Cursor::new(head).chain(source)));
        Self::of(content, source, track)
    }

    /// Opens what can be read anywhere, such as a file or a [`Cursor`] over bytes in memory.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn open_seekable(source: impl Read + Seek + Send + Sync + 's) -> Result<Self, Error> {
        Self::of_seekable(source, Track::default())
    }

    fn of_seekable(
        mut source: impl Read + Seek + Send + Sync + 's,
        track: Track,
    ) -> Result<Self, Error> {
        let content = Content::of(&head(&mut source)?);
        source.seek(SeekFrom::Start(0))?;
        let source = match content {
            Content::Mp4 => Source::seekable(source)?,
            Content::Caf => Source::anywhere(source)?,
            // All others are read forwards, so that a file gives what a pipe gives.
            _ => Source::Pipe(Box::new(source)),
        };
        Self::of(content, source, track)
    }

    fn of(content: Content, source: Source<'s>, track: Track) -> Result<Self, Error> {
        let form = match (content, source) {
            (Content::Wav, Source::Pipe(source)) => Form::Wav(wav::Stream::open(source)?),
            (Content::Refused(what), _) => return Err(unreadable(what.sentence())),
            (content, source) => {
                Form::Compressed(Box::new(compressed::Stream::open(content, source, track)?))
            }
        };
        let has_tracks = matches!(content, Content::Mp4 | Content::Matroska);
        if let (false, Track::Number(number @ (0 | 2..))) = (has_tracks, track) {
            let problem = format!("it has one track of sound, and no number {number}");
            return Err(unreadable(problem));
        }
        Ok(Self { form })
    }

    /// A recording that was read before, once more from its start.
    #[must_use]
    pub const fn again(recording: &'s Recording) -> Self {
        Self {
            form: Form::Memory(memory::Stream::new(recording)),
        }
    }

    /// Frames per second.
    #[must_use]
    pub fn sample_rate_hz(&self) -> u32 {
        match &self.form {
            Form::Wav(stream) => stream.container().sample_rate_hz,
            Form::Compressed(stream) => stream.sample_rate_hz(),
            Form::Memory(stream) => stream.recording.sample_rate_hz,
        }
    }

    /// How many channels there are.
    #[must_use]
    pub fn channels(&self) -> usize {
        match &self.form {
            Form::Wav(stream) => usize::from(stream.container().channels),
            Form::Compressed(stream) => stream.channels(),
            Form::Memory(stream) => stream.recording.channels.len(),
        }
    }

    /// How samples are stored, such as `16-bit integer`, `16-bit FLAC` or `AAC`.
    #[must_use]
    pub fn encoding(&self) -> String {
        match &self.form {
            Form::Wav(stream) => stream.container().encoding(),
            Form::Compressed(stream) => stream.encoding(),
            Form::Memory(stream) => stream.recording.encoding.clone(),
        }
    }

    /// Whether something was thrown away when they were stored.
    #[must_use]
    pub fn is_lossy(&self) -> bool {
        match &self.form {
            Form::Wav(_) => false,
            Form::Compressed(stream) => stream.is_lossy(),
            Form::Memory(stream) => stream.recording.lossy,
        }
    }

    /// Adds the next samples of some channels to those of each, full scale being ±1; false at the end.
    ///
    /// # Errors
    /// [`Error::Io`] if reading fails.
    pub fn append(
        &mut self,
        channels: &Range<usize>,
        samples: &mut [Vec<f32>],
    ) -> Result<bool, Error> {
        match &mut self.form {
            Form::Wav(stream) => stream.append(channels, samples),
            Form::Compressed(stream) => stream.append(channels, samples),
            Form::Memory(stream) => Ok(stream.append(channels, samples)),
        }
    }

    /// What is known after the last block.
    ///
    /// # Errors
    /// [`Error::Wav`] if there was no audio; [`Error::Io`] if reading what follows it fails.
    pub fn finish(self) -> Result<Ending, Error> {
        match self.form {
            Form::Wav(stream) => stream.finish(),
            Form::Compressed(stream) => Ok(stream.finish()),
            Form::Memory(stream) => Ok(stream.finish()),
        }
    }
}

fn head(source: &mut impl Read) -> Result<Vec<u8>, Error> {
    let mut head = vec![0; HEAD_BYTES];
    let got = fill(source, &mut head)?;
    head.truncate(got);
    Ok(head)
}
