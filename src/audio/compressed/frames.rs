//! Frames of MP3 and ADTS, one after the other, with nothing that says where they are but their headers.
//!
//! Where frames are damaged the next good one is sought, and the bytes in between say how many were lost: all but exactly
//! where frames have one length, about so many where they have not.

use std::collections::VecDeque;

use symphonia::core::audio::layouts::{CHANNEL_LAYOUT_MONO, CHANNEL_LAYOUT_STEREO};
use symphonia::core::codecs::audio::AudioCodecParameters;
use symphonia::core::codecs::audio::well_known::{CODEC_ID_AAC, CODEC_ID_MP3};
use symphonia::core::packet::PacketBuilder;
use symphonia::core::units::{Duration, Timestamp};

use super::codec::{Decoder, other_aac};
use super::header::{self, Format, HEADER_BYTES, Header, MOST_BYTES, Parse};
use super::source::Source;
use super::start::{Span, Start};
use super::{Next, Opened, Packets};
use crate::Error;
use crate::audio::unreadable;
use crate::audio::wav::fill;

/// Bytes that are sought through for the first frame: tags and padding are shorter.
const MOST_BEFORE: u64 = 1 << 20;

/// Where the bytes are, with as many looked at before they are taken as it needs.
struct Window<'s> {
    source: Source<'s>,
    bytes: VecDeque<u8>,
    ended: bool,
}

impl Window<'_> {
    /// Looks at bytes from so many ahead; fewer come at the end.
    fn look(&mut self, ahead: usize, count: usize) -> Result<&[u8], Error> {
        if self.bytes.len() < ahead + count && !self.ended {
            let mut block = vec![0; 1 << 15];
            let got = fill(&mut self.source, &mut block)?;
            self.ended = got < block.len();
            self.bytes.extend(&block[..got]);
        }
        let there = self.bytes.len();
        let bytes = self.bytes.make_contiguous();
        Ok(&bytes[ahead.min(there)..(ahead + count).min(there)])
    }

    fn header(&mut self, ahead: usize, parse: Parse) -> Result<Option<Header>, Error> {
        let bytes = self.look(ahead, HEADER_BYTES)?;
        Ok(bytes.first_chunk().and_then(parse))
    }

    fn take(&mut self, count: usize) {
        self.bytes.drain(..count);
    }
}

/// Frames of one format.
struct Frames<'s> {
    window: Window<'s>,
    parse: Parse,
    format: Format,
    /// Frames and their bytes that were followed by another in place.
    sure: (u64, u64),
    /// Bytes since the end of the last of these, and frames that were given of them.
    since: (u64, u64),
}

/// Opens a stream of frames of MP3.
pub(super) fn mp3(source: Source<'_>) -> Result<Opened<'_>, Error> {
    let mut frames = Frames::open(source, header::mp3, "MP3")?;
    let first = frames.first()?;
    let mut start = Start::default();
    if let Some(delay) = header::note(frames.window.look(0, first.bytes)?, frames.format) {
        let hidden = Span::new(delay.into(), frames.format.sample_rate_hz);
        start.hidden = hidden.unwrap_or(start.hidden);
        frames.window.take(first.bytes);
    }
    let mut params = AudioCodecParameters::new();
    params.for_codec(CODEC_ID_MP3);
    let decoder = Decoder::new(&params, "mp3")?;
    Ok(Opened {
        packets: Box::new(frames),
        decoder,
        start,
        note: None,
        units_per_s: None,
    })
}

/// Opens a stream of frames of AAC.
pub(super) fn adts(source: Source<'_>) -> Result<Opened<'_>, Error> {
    /// Low complexity, as ADTS has it.
    const LC: u8 = 1;
    let frames = Frames::open(source, header::adts, "AAC")?;
    let channels = match (frames.format.version, frames.format.channels) {
        (LC, 1) => CHANNEL_LAYOUT_MONO,
        (LC, 2) => CHANNEL_LAYOUT_STEREO,
        _ => return Err(other_aac("aac")),
    };
    let mut params = AudioCodecParameters::new();
    let params = params
        .for_codec(CODEC_ID_AAC)
        .with_sample_rate(frames.format.sample_rate_hz);
    let decoder = Decoder::new(params.with_channels(channels), "aac")?;
    Ok(Opened {
        packets: Box::new(frames),
        decoder,
        start: Start::default(),
        note: None,
        units_per_s: None,
    })
}

impl<'s> Frames<'s> {
    /// Seeks the first frame.
    fn open(source: Source<'s>, parse: Parse, name: &str) -> Result<Self, Error> {
        let mut window = Window {
            source,
            bytes: VecDeque::new(),
            ended: false,
        };
        for _ in 0..MOST_BEFORE {
            if let Some(header) = window.header(0, parse)?
                && follows(&mut window, header, parse, 2)?
            {
                let format = header.format;
                return Ok(Self {
                    window,
                    parse,
                    format,
                    sure: (0, 0),
                    since: (0, 0),
                });
            }
            if window.look(0, 1)?.is_empty() {
                break;
            }
            window.take(1);
        }
        Err(unreadable(format!(
            "it begins as {name}, but no frames follow"
        )))
    }

    fn first(&mut self) -> Result<Header, Error> {
        let header = self.window.header(0, self.parse)?;
        header.ok_or_else(|| unreadable("it holds no audio"))
    }

    /// Goes on to the next frame of this format, past what is none; none at the end, or with its reason.
    fn seek(&mut self) -> Result<Result<Header, Next>, Error> {
        loop {
            let in_place = self.since == (0, 0);
            if let Some(header) = self.window.header(0, self.parse)? {
                let alike = header.format == self.format;
                // Where a frame is due it needs no other to vouch for it. Chance looks like a header now and then.
                if alike && (in_place || follows(&mut self.window, header, self.parse, 1)?) {
                    let whole = self.window.look(0, header.bytes)?.len() == header.bytes;
                    return Ok(if whole { Ok(header) } else { Err(Next::Cut) });
                }
                if !alike && follows(&mut self.window, header, self.parse, 2)? {
                    return Ok(Err(Next::Changed));
                }
            }
            if self.window.look(0, 1)?.is_empty() {
                return Ok(Err(Next::End));
            }
            self.window.take(1);
            self.since.0 += 1;
        }
    }

    /// Frames lost before the one that begins here.
    fn lost(&self) -> u64 {
        let (bytes, given) = self.since;
        let (frames, all) = self.sure;
        let span = (2 * bytes * frames + all).checked_div(2 * all);
        span.unwrap_or(0).saturating_sub(given)
    }
}

/// Whether a frame is followed by so many of its format, or by fewer and the end.
fn follows(
    window: &mut Window<'_>,
    header: Header,
    parse: Parse,
    times: usize,
) -> Result<bool, Error> {
    let (mut at, mut seen) = (header.bytes, 0);
    while seen < times {
        debug_assert!(at <= 3 * MOST_BYTES, "a frame is short");
        let Some(next) = window.header(at, parse)? else {
            let there = window.look(0, at)?.len();
            let at_end = there == at && window.look(at, 1)?.is_empty();
            return Ok(at_end || seen > 0 && there < at);
        };
        if next.format != header.format {
            return Ok(false);
        }
        at += next.bytes;
        seen += 1;
    }
    Ok(true)
}

impl Packets for Frames<'_> {
    fn next(&mut self) -> Result<Next, Error> {
        let header = match self.seek()? {
            Ok(header) => header,
            Err(end) => return Ok(end),
        };
        let lost = self.lost();
        if self.since.0 > 0 {
            self.since = (0, 0);
        }
        let body = header.header_bytes..header.bytes;
        let data = self.window.look(0, header.bytes)?[body].to_vec();
        self.window.take(header.bytes);
        let next = self.window.header(0, self.parse)?;
        if next.is_some_and(|next| next.format == self.format) {
            self.sure = (self.sure.0 + 1, self.sure.1 + header.bytes as u64);
            self.since = (0, 0);
        } else {
            self.since = (self.since.0 + header.bytes as u64, self.since.1 + 1);
        }
        let samples = u64::from(self.format.samples);
        let packet = PacketBuilder::new()
            .track_id(0)
            .pts(Timestamp::ZERO)
            .dur(Duration::new(samples))
            .data(data)
            .build();
        Ok(Next::Packet {
            packet,
            lost: lost * samples,
        })
    }
}
