//! MP4, FLAC, AIFF and CAF, which symphonia takes apart.

use std::io::ErrorKind;

use symphonia::core::errors::Error as Problem;
use symphonia::core::formats::{FormatOptions, FormatReader};
use symphonia::core::io::{MediaSourceStream, ReadBytes};
use symphonia::core::packet::Packet;
use symphonia::core::units::Duration;
use symphonia::default::formats::{AiffReader, CafReader, FlacReader, IsoMp4Reader};

use super::edits::Edits;
use super::index::index;
use super::names::Names;
use super::source::Source;
use super::start::Start;
use super::tracks::{self, Ahead, Chosen};
use super::{Next, Opened, Packets};
use crate::Error;
use crate::audio::{Track as Wanted, unreadable};

/// A container that symphonia takes apart, and the stream of it that is listened to.
struct Indexed<'s> {
    reader: Box<dyn FormatReader + 's>,
    track: u32,
    /// What was read when the track was chosen.
    ahead: Ahead,
    /// Where the next packet should begin, if packets say where they do.
    expected: Option<i64>,
    /// Whether that is so.
    placed: bool,
}

/// Opens an MP4 at its beginning.
pub(super) fn mp4(source: Source<'_>, wanted: Wanted) -> Result<Opened<'_>, Error> {
    let is_pipe = matches!(source, Source::Pipe(_));
    let (index, source) = index(source)?;
    let (edits, names) = (Edits::of(&index), Names::of(&index));
    drop(index);
    let mut reader = mp4_reader(source.into_media(), is_pipe)?;
    let track = tracks::choose(&mut *reader, "mp4", &names, wanted)?;
    Ok(opened(reader, track, &edits, false))
}

/// What takes an MP4 apart, from its first byte on.
fn mp4_reader(
    mut media: MediaSourceStream<'_>,
    is_pipe: bool,
) -> Result<Box<dyn FormatReader + '_>, Error> {
    // Its type stands behind a length, which the reader goes back for.
    media.ignore_bytes(4)?;
    match IsoMp4Reader::try_new(media, FormatOptions::default()) {
        Ok(reader) => Ok(Box::new(reader)),
        Err(problem) if !is_without_index(&problem) => Err(broken(problem, "MP4")),
        Err(_) if is_pipe => Err(unreadable(
            "its index (moov) stands behind its sound, where a pipe cannot look first, or is missing: give the file itself, \
             or move it with ffmpeg -i IN.m4a -c copy -movflags +faststart OUT.m4a",
        )),
        Err(_) => Err(unreadable(
            "its index (moov) is missing or cut: the recording was not finished, or the file is cut",
        )),
    }
}

/// Whether an MP4 ended before its index did.
fn is_without_index(problem: &Problem) -> bool {
    match problem {
        Problem::Unsupported(what) => what.contains("missing moov"),
        Problem::IoError(e) => e.kind() == ErrorKind::UnexpectedEof,
        _ => false,
    }
}

/// Opens a FLAC at its first byte.
pub(super) fn flac(source: Source<'_>) -> Result<Opened<'_>, Error> {
    let media = source.into_media();
    match FlacReader::try_new(media, FormatOptions::default()) {
        Ok(reader) => only(Box::new(reader), "flac", true),
        Err(problem) => Err(broken(problem, "FLAC")),
    }
}

/// Opens an AIFF or an AIFF-C at its first byte.
pub(super) fn aiff(source: Source<'_>) -> Result<Opened<'_>, Error> {
    let media = source.into_media();
    match AiffReader::try_new(media, FormatOptions::default()) {
        Ok(reader) => only(Box::new(reader), "aiff", false),
        Err(problem) => Err(broken(problem, "AIFF")),
    }
}

/// Opens a Core Audio file at its first byte.
pub(super) fn caf(source: Source<'_>) -> Result<Opened<'_>, Error> {
    if matches!(source, Source::Pipe(_)) {
        return Err(unreadable(
            "it is a Core Audio file, which cannot be read from a pipe: give the file itself",
        ));
    }
    let media = source.into_media();
    match CafReader::try_new(media, FormatOptions::default()) {
        Ok(reader) => only(Box::new(reader), "caf", false),
        Err(Problem::IoError(e)) if e.kind() == ErrorKind::UnexpectedEof => Err(unreadable(
            "the chunks of its Core Audio file end too early: the recording was not finished, or the file is cut",
        )),
        Err(problem) => Err(broken(problem, "Core Audio file")),
    }
}

/// What has one track. `placed`: whether packets say where they begin.
fn only<'s>(
    mut reader: Box<dyn FormatReader + 's>,
    ending: &'static str,
    placed: bool,
) -> Result<Opened<'s>, Error> {
    let track = tracks::choose(&mut *reader, ending, &Names::default(), Wanted::WithSound)?;
    Ok(opened(reader, track, &Edits::default(), placed))
}

fn opened<'s>(
    reader: Box<dyn FormatReader + 's>,
    track: Chosen,
    edits: &Edits,
    placed: bool,
) -> Opened<'s> {
    let start = edits.start(track.id);
    let is_within = lasts(&*reader, track.id).is_none_or(|units| start.hidden.units() < units);
    let units_per_s = units_per_s(&*reader, track.id);
    Opened {
        packets: Box::new(Indexed {
            reader,
            track: track.id,
            ahead: track.ahead,
            expected: None,
            placed,
        }),
        decoder: track.decoder,
        start: if is_within { start } else { Start::default() },
        note: track.note,
        units_per_s,
    }
}

/// How long a stream lasts in its own units, if its container says so.
fn lasts(reader: &dyn FormatReader, track: u32) -> Option<u64> {
    let track = reader.tracks().iter().find(|of| of.id == track)?;
    track.duration.map(Duration::get).filter(|units| *units > 0)
}

/// How many units of time a second has in a stream, if it is a whole number.
fn units_per_s(reader: &dyn FormatReader, track: u32) -> Option<u32> {
    let track = reader.tracks().iter().find(|of| of.id == track)?;
    let base = track.time_base?;
    (base.numer.get() == 1).then_some(base.denom.get())
}

fn broken(problem: Problem, name: &str) -> Error {
    match problem {
        Problem::IoError(e) if e.kind() != ErrorKind::UnexpectedEof => e.into(),
        Problem::IoError(_) => unreadable(format!("it ends within the header of its {name}")),
        problem => unreadable(format!("the header of its {name} is damaged: {problem}")),
    }
}

/// The next packet of any track, or the end.
pub(super) fn packet(reader: &mut dyn FormatReader) -> Result<Result<Packet, Next>, Error> {
    Ok(match reader.next_packet() {
        Ok(Some(packet)) => Ok(packet),
        Ok(None) => Err(Next::End),
        Err(Problem::ResetRequired) => Err(Next::Changed),
        Err(Problem::IoError(e)) if e.kind() != ErrorKind::UnexpectedEof => return Err(e.into()),
        Err(_) => Err(Next::Cut),
    })
}

impl Indexed<'_> {
    /// The next packet of the track, or the end.
    fn packet(&mut self) -> Result<Result<Packet, Next>, Error> {
        if let Some(packet) = self.ahead.packets.pop_front() {
            return Ok(Ok(packet));
        }
        if let Some(end) = self.ahead.end.take() {
            return Ok(Err(end));
        }
        loop {
            match packet(&mut *self.reader)? {
                Ok(packet) if packet.track_id != self.track => {}
                next => return Ok(next),
            }
        }
    }
}

impl Packets for Indexed<'_> {
    fn next(&mut self) -> Result<Next, Error> {
        let mut packet = match self.packet()? {
            Ok(packet) => packet,
            Err(end) => return Ok(end),
        };
        let begins = packet.pts.get();
        let late = self
            .expected
            .map_or(0, |expected| begins.saturating_sub(expected));
        let lasts = i64::try_from(packet.dur.get()).unwrap_or(i64::MAX);
        self.expected = self.placed.then(|| begins.saturating_add(lasts));
        packet.trim_end = Duration::ZERO;
        let lost = u64::try_from(late).unwrap_or(0);
        Ok(Next::Packet { packet, lost })
    }
}
