//! MP4 and FLAC, which symphonia takes apart.

use std::io::ErrorKind;

use symphonia::core::codecs::CodecParameters;
use symphonia::core::codecs::audio::{AudioCodecParameters, CODEC_ID_NULL_AUDIO};
use symphonia::core::errors::Error as Problem;
use symphonia::core::formats::{FormatOptions, FormatReader};
use symphonia::core::io::ReadBytes;
use symphonia::core::units::Duration;
use symphonia::default::formats::{FlacReader, IsoMp4Reader};

use super::codec::Decoder;
use super::edits::Edits;
use super::index::index;
use super::source::Source;
use super::start::Start;
use super::{Next, Opened, Packets};
use crate::Error;
use crate::audio::content::Refused;
use crate::audio::unreadable;

/// A container that symphonia takes apart, and the stream of it that is listened to.
struct Indexed<'s> {
    reader: Box<dyn FormatReader + 's>,
    track: u32,
    /// Where the next packet should begin, if packets say where they do.
    expected: Option<i64>,
    /// Whether that is so.
    placed: bool,
}

/// Opens an MP4 at its beginning.
pub(super) fn mp4(source: Source<'_>) -> Result<Opened<'_>, Error> {
    let is_pipe = matches!(source, Source::Pipe(_));
    let (index, source) = index(source)?;
    let edits = Edits::of(&index);
    drop(index);
    let mut media = source.into_media();
    // Its type stands behind a length, which the reader goes back for.
    media.ignore_bytes(4)?;
    match IsoMp4Reader::try_new(media, FormatOptions::default()) {
        Ok(reader) => opened(Box::new(reader), "mp4", false, &edits),
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
        Ok(reader) => opened(Box::new(reader), "flac", true, &Edits::default()),
        Err(problem) => Err(broken(problem, "FLAC")),
    }
}

fn opened<'s>(
    reader: Box<dyn FormatReader + 's>,
    ending: &'static str,
    placed: bool,
    edits: &Edits,
) -> Result<Opened<'s>, Error> {
    let none = || {
        unreadable(
            Refused::new(
                "an MP4 without AAC or ALAC (it may hold AMR, Opus, or no sound)",
                ending,
            )
            .sentence(),
        )
    };
    let (track, params) = sound(&*reader).ok_or_else(none)?;
    let decoder = Decoder::new(&params, ending)?;
    let start = edits.start(track);
    let is_within = lasts(&*reader, track).is_none_or(|units| start.hidden.units() < units);
    let start = if is_within { start } else { Start::default() };
    let expected = None;
    let packets = Box::new(Indexed {
        reader,
        track,
        expected,
        placed,
    });
    Ok(Opened {
        packets,
        decoder,
        start,
    })
}

/// The first stream of sound, one of a known codec if there is one.
fn sound(reader: &dyn FormatReader) -> Option<(u32, AudioCodecParameters)> {
    let audio = reader
        .tracks()
        .iter()
        .filter_map(|track| match &track.codec_params {
            Some(CodecParameters::Audio(params)) => Some((track.id, params.clone())),
            _ => None,
        });
    let unknown = |(_, params): &(u32, AudioCodecParameters)| params.codec == CODEC_ID_NULL_AUDIO;
    audio.min_by_key(unknown)
}

/// How long a stream lasts in its own units, if its container says so.
fn lasts(reader: &dyn FormatReader, track: u32) -> Option<u64> {
    let track = reader.tracks().iter().find(|of| of.id == track)?;
    track.duration.map(Duration::get).filter(|units| *units > 0)
}

fn broken(problem: Problem, name: &str) -> Error {
    match problem {
        Problem::IoError(e) if e.kind() != ErrorKind::UnexpectedEof => e.into(),
        Problem::IoError(_) => unreadable(format!("it ends within the header of its {name}")),
        problem => unreadable(format!("the header of its {name} is damaged: {problem}")),
    }
}

impl Packets for Indexed<'_> {
    fn next(&mut self) -> Result<Next, Error> {
        loop {
            let mut packet = match self.reader.next_packet() {
                Ok(Some(packet)) => packet,
                Ok(None) => return Ok(Next::End),
                Err(Problem::ResetRequired) => return Ok(Next::Changed),
                Err(Problem::IoError(e)) if e.kind() != ErrorKind::UnexpectedEof => {
                    return Err(e.into());
                }
                Err(_) => return Ok(Next::Cut),
            };
            if packet.track_id != self.track {
                continue;
            }
            let begins = packet.pts.get();
            let late = self
                .expected
                .map_or(0, |expected| begins.saturating_sub(expected));
            let lasts = i64::try_from(packet.dur.get()).unwrap_or(i64::MAX);
            self.expected = self.placed.then(|| begins.saturating_add(lasts));
            packet.trim_end = Duration::ZERO;
            let lost = u64::try_from(late).unwrap_or(0);
            return Ok(Next::Packet { packet, lost });
        }
    }
}
