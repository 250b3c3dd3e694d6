//! MP4, Matroska, FLAC, AIFF and CAF, which symphonia takes apart.

use std::io::ErrorKind;

use symphonia::core::codecs::CodecParameters;
use symphonia::core::codecs::audio::AudioCodecParameters;
use symphonia::core::errors::Error as Problem;
use symphonia::core::formats::{FormatOptions, FormatReader};
use symphonia::core::io::{MediaSourceStream, ReadBytes};
use symphonia::core::packet::Packet;
use symphonia::core::units::Duration;
#[cfg(feature = "opus")]
use symphonia::default::formats::MkvReader;
use symphonia::default::formats::{AiffReader, CafReader, FlacReader, IsoMp4Reader};

use super::edits::Edits;
use super::index::index;
use super::names::Names;
use super::opus;
use super::source::Source;
use super::start::{Span, Start};
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
    /// Where packets last until the next begins: units of a second of time stamps, and frames of one.
    until_next: Option<(u32, u32)>,
    read: Read,
}

/// Reads the next packet of any track, or the end.
pub(super) type Read = fn(&mut dyn FormatReader) -> Result<Result<Packet, Next>, Error>;

/// Says of a Matroska or `WebM` what converts it.
#[cfg(not(feature = "opus"))]
pub(super) fn matroska(_: Source<'_>, _: Wanted) -> Result<Opened<'_>, Error> {
    Err(unreadable(
        crate::audio::content::Refused::new("WebM or Matroska", "webm").sentence(),
    ))
}

/// Opens a Matroska or `WebM` at its first byte.
///
/// Its time stamps are in ms as a rule. What the encoder put before the first sample lies before 0; of Opus its header says it
/// to the sample.
#[cfg(feature = "opus")]
pub(super) fn matroska(source: Source<'_>, wanted: Wanted) -> Result<Opened<'_>, Error> {
    let media = source.into_media();
    let mut reader = match MkvReader::try_new(media, FormatOptions::default()) {
        Ok(reader) => reader,
        Err(problem) => return Err(broken(problem, "WebM or Matroska")),
    };
    let track = tracks::choose(&mut reader, "webm", &Names::default(), wanted, open_packet)?;
    let params = params(&reader, track.id);
    let units = units_per_s(&reader, track.id);
    let rate = params.as_ref().and_then(|params| params.sample_rate);
    let head = params.and_then(|params| params.extra_data);
    let mut indexed = Indexed::new(Box::new(reader), track.id, track.ahead);
    indexed.until_next = units.zip(rate);
    indexed.read = open_packet;
    let begins = match indexed.packet()? {
        Ok(packet) => {
            let begins = packet.pts.get();
            indexed.ahead.packets.push_front(packet);
            begins
        }
        Err(end) => {
            indexed.ahead.end = Some(end);
            0
        }
    };
    let span = |units_of: i64| Span::new(u64::try_from(units_of).unwrap_or(0), units?);
    let mut start = Start::default();
    start.later = span(begins).unwrap_or(start.later);
    let by_header = head
        .and_then(|head| opus::hidden(&head))
        .filter(|_| begins < 0);
    let by_stamp = || span(begins.saturating_neg());
    start.hidden = by_header.or_else(by_stamp).unwrap_or(start.hidden);
    Ok(Opened {
        packets: Box::new(indexed),
        decoder: track.decoder,
        start,
        note: track.note,
        units_per_s: rate,
    })
}

/// What a container says of the sound of a track.
fn params(reader: &dyn FormatReader, track: u32) -> Option<AudioCodecParameters> {
    let track = reader.tracks().iter().find(|of| of.id == track)?;
    match &track.codec_params {
        Some(CodecParameters::Audio(params)) => Some(params.clone()),
        _ => None,
    }
}

/// Opens an MP4 at its beginning.
pub(super) fn mp4(source: Source<'_>, wanted: Wanted) -> Result<Opened<'_>, Error> {
    let is_pipe = matches!(source, Source::Pipe(_));
    let (index, source) = index(source)?;
    let (edits, names) = (Edits::of(&index), Names::of(&index));
    drop(index);
    let mut reader = mp4_reader(source.into_media(), is_pipe)?;
    let track = tracks::choose(&mut *reader, "mp4", &names, wanted, packet)?;
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
    let track = tracks::choose(
        &mut *reader,
        ending,
        &Names::default(),
        Wanted::WithSound,
        packet,
    )?;
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
            placed,
            ..Indexed::new(reader, track.id, track.ahead)
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

fn packet(reader: &mut dyn FormatReader) -> Result<Result<Packet, Next>, Error> {
    of(reader.next_packet(), Next::Cut)
}

/// The same where only the end of the bytes says where it ends, as in what a browser records.
fn open_packet(reader: &mut dyn FormatReader) -> Result<Result<Packet, Next>, Error> {
    of(reader.next_packet(), Next::End)
}

/// What a reader gave; `at_end`: what the end of the bytes is.
fn of(next: Result<Option<Packet>, Problem>, at_end: Next) -> Result<Result<Packet, Next>, Error> {
    Ok(match next {
        Ok(Some(packet)) => Ok(packet),
        Ok(None) => Err(Next::End),
        Err(Problem::ResetRequired) => Err(Next::Changed),
        Err(Problem::IoError(e)) if e.kind() != ErrorKind::UnexpectedEof => return Err(e.into()),
        Err(Problem::IoError(_)) => Err(at_end),
        Err(_) => Err(Next::Cut),
    })
}

impl<'s> Indexed<'s> {
    fn new(reader: Box<dyn FormatReader + 's>, track: u32, ahead: Ahead) -> Self {
        Self {
            reader,
            track,
            ahead,
            expected: None,
            placed: false,
            until_next: None,
            read: packet,
        }
    }

    /// How long a packet lasts until the next begins, in frames; nothing behind the last.
    fn until_next(&mut self, begins: i64, units_per_s: u32, rate: u32) -> Result<Duration, Error> {
        let frame = |units: i64| {
            let frame = i128::from(units) * i128::from(rate) / i128::from(units_per_s);
            i64::try_from(frame).unwrap_or(i64::MAX)
        };
        let lasts = match self.packet()? {
            Ok(next) => {
                let ends = next.pts.get();
                self.ahead.packets.push_front(next);
                frame(ends).saturating_sub(frame(begins))
            }
            Err(end) => {
                self.ahead.end = Some(end);
                0
            }
        };
        Ok(Duration::new(u64::try_from(lasts).unwrap_or(0)))
    }

    /// The next packet of the track, or the end.
    fn packet(&mut self) -> Result<Result<Packet, Next>, Error> {
        if let Some(packet) = self.ahead.packets.pop_front() {
            return Ok(Ok(packet));
        }
        if let Some(end) = self.ahead.end.take() {
            return Ok(Err(end));
        }
        loop {
            match (self.read)(&mut *self.reader)? {
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
        if let Some((units_per_s, rate)) = self.until_next {
            packet.dur = self.until_next(begins, units_per_s, rate)?;
        }
        packet.trim_end = Duration::ZERO;
        let lost = u64::try_from(late).unwrap_or(0);
        Ok(Next::Packet { packet, lost })
    }
}
