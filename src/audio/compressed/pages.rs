//! Pages of an Ogg (RFC 3533), and the packets of Vorbis or Opus in them.
//!
//! A page carries a sum by which damage is known, and says where its sound ends: so it is known how much a lost page
//! held, and its place is exact.

use std::collections::VecDeque;

use symphonia::core::checksum::Crc32;
use symphonia::core::codecs::audio::AudioCodecParameters;
use symphonia::core::codecs::audio::well_known::{CODEC_ID_OPUS, CODEC_ID_VORBIS};
use symphonia::core::io::Monitor;
use symphonia::core::packet::Packet;
use symphonia::core::units::{Duration, Timestamp};

use super::codec::Decoder;
use super::opus;
use super::source::Source;
use super::start::Start;
use super::{Next, Opened, Packets};
use crate::Error;
use crate::audio::unreadable;
use crate::audio::wav::fill;

/// Bytes of a page before the lengths of its pieces.
const HEADER_BYTES: usize = 27;
/// The longest page.
const MOST_BYTES: usize = HEADER_BYTES + 255 + 255 * 255;
/// The longest packet: the setup of Vorbis stays far below it, its sound far below that.
const MOST_PACKET: usize = 1 << 20;
/// How Ogg writes that no packet ends on a page.
const NOWHERE: u64 = u64::MAX;

/// A page whose sum is right.
struct Page {
    continues: bool,
    begins: bool,
    ends: bool,
    granule: u64,
    serial: u32,
    number: u32,
    /// The lengths of its pieces; one of 255 goes on in the next.
    pieces: Vec<u8>,
    body: Vec<u8>,
}

/// Pages of one stream, and their packets.
struct Pages<'s> {
    source: Source<'s>,
    bytes: VecDeque<u8>,
    serial: u32,
    /// The number that the next page should have.
    due: u32,
    /// A packet that goes on.
    part: Vec<u8>,
    /// Packets of the page, and its mark.
    ready: VecDeque<Next>,
    ended: bool,
}

/// Opens an Ogg whose first stream is Vorbis or Opus.
pub(super) fn ogg(source: Source<'_>) -> Result<Opened<'_>, Error> {
    let mut pages = Pages {
        source,
        bytes: VecDeque::new(),
        serial: 0,
        due: 0,
        part: Vec::new(),
        ready: VecDeque::new(),
        ended: false,
    };
    let first = pages.page()?.ok_or_else(broken)?;
    let (decoder, start) = pages.begin(first)?;
    Ok(Opened {
        packets: Box::new(pages),
        decoder,
        start,
        note: None,
        units_per_s: None,
    })
}

impl Pages<'_> {
    /// Goes to the sound of a stream that begins with this page, past its headers.
    fn begin(&mut self, first: Page) -> Result<(Decoder, Start), Error> {
        self.serial = first.serial;
        self.due = first.number;
        self.ended = false;
        self.part.clear();
        self.unpack(first);
        let head = self.header()?;
        // The second packet is a comment.
        self.header()?;
        let mut params = AudioCodecParameters::new();
        if head.starts_with(opus::MAGIC) {
            let hidden = opus::hidden(&head).ok_or_else(broken)?;
            params.for_codec(CODEC_ID_OPUS).with_extra_data(head);
            let later = Start::default().later;
            return Ok((Decoder::new(&params, "opus")?, Start { later, hidden }));
        }
        let setup = self.header()?;
        let both = [head, setup].concat();
        params
            .for_codec(CODEC_ID_VORBIS)
            .with_extra_data(both.into());
        Ok((Decoder::new(&params, "ogg")?, Start::default()))
    }

    /// The next packet before the sound.
    fn header(&mut self) -> Result<Box<[u8]>, Error> {
        loop {
            match self.ready.pop_front() {
                Some(Next::Packet { packet, .. }) => return Ok(packet.data),
                Some(Next::Mark(_)) => {}
                Some(_) => return Err(broken()),
                None => match self.page()? {
                    Some(page) if page.serial == self.serial && !page.begins => self.unpack(page),
                    // Beside it, another stream is not listened to.
                    Some(_) if !self.ended => {}
                    _ => return Err(broken()),
                },
            }
        }
    }

    /// Has so many bytes to look at; fewer at the end.
    fn look(&mut self, count: usize) -> Result<&[u8], Error> {
        if self.bytes.len() < count {
            let mut block = vec![0; MOST_BYTES];
            let got = fill(&mut self.source, &mut block)?;
            self.bytes.extend(&block[..got]);
        }
        let there = self.bytes.len().min(count);
        Ok(&self.bytes.make_contiguous()[..there])
    }

    /// The next page whose sum is right; none at the end.
    fn page(&mut self) -> Result<Option<Page>, Error> {
        loop {
            let bytes = self.look(MOST_BYTES)?;
            if bytes.len() < HEADER_BYTES {
                return Ok(None);
            }
            if let Some((page, length)) = read(bytes) {
                self.bytes.drain(..length);
                return Ok(Some(page));
            }
            let next = bytes[1..].windows(4).position(|four| four == b"OggS");
            let skipped = next.map_or(bytes.len() - 3, |at| at + 1);
            self.bytes.drain(..skipped);
        }
    }

    /// Queues the packets of a page.
    fn unpack(&mut self, page: Page) {
        if page.number != self.due {
            self.ready.push_back(Next::Lost);
            self.part.clear();
        }
        self.due = page.number.wrapping_add(1);
        // What goes on here from a page that was lost is lost.
        let mut torn = page.continues && self.part.is_empty();
        if !page.continues {
            self.part.clear();
        }
        let mut rest = page.body.as_slice();
        for piece in page.pieces {
            let (bytes, left) = rest.split_at(usize::from(piece).min(rest.len()));
            rest = left;
            if !torn && self.part.len() < MOST_PACKET {
                self.part.extend(bytes);
            }
            if piece < 255 {
                let data = std::mem::take(&mut self.part);
                if !torn && !data.is_empty() {
                    let packet = Packet::new(0, Timestamp::ZERO, Duration::ZERO, data);
                    self.ready.push_back(Next::Packet { packet, lost: 0 });
                }
                torn = false;
            }
        }
        if page.granule != NOWHERE {
            self.ready.push_back(Next::Mark(page.granule));
        }
        self.ended |= page.ends;
    }
}

fn broken() -> Error {
    unreadable("the header of its Vorbis or Opus is damaged")
}

/// A page at the beginning of these bytes, and its length.
fn read(bytes: &[u8]) -> Option<(Page, usize)> {
    let header: &[u8; HEADER_BYTES] = bytes.first_chunk()?;
    let number = |at: usize| {
        let four = header.get(at..at + 4)?.first_chunk()?;
        Some(u32::from_le_bytes(*four))
    };
    if !header.starts_with(b"OggS\0") || header[5] > 7 {
        return None;
    }
    let body_from = HEADER_BYTES + usize::from(header[26]);
    let pieces = bytes.get(HEADER_BYTES..body_from)?.to_vec();
    let length = body_from + pieces.iter().copied().map(usize::from).sum::<usize>();
    let body = bytes.get(body_from..length)?.to_vec();
    let mut sum = Crc32::new(0);
    sum.process_buf_bytes(&header[..22]);
    // The sum is over a page in which it stands as zero.
    sum.process_buf_bytes(&[0; 4]);
    sum.process_buf_bytes(&bytes[26..length]);
    let page = Page {
        continues: header[5] & 1 != 0,
        begins: header[5] & 2 != 0,
        ends: header[5] & 4 != 0,
        granule: u64::from(number(6)?) | u64::from(number(10)?) << 32,
        serial: number(14)?,
        number: number(18)?,
        pieces,
        body,
    };
    (number(22)? == sum.crc()).then_some((page, length))
}

impl Packets for Pages<'_> {
    fn next(&mut self) -> Result<Next, Error> {
        loop {
            if let Some(next) = self.ready.pop_front() {
                return Ok(next);
            }
            match self.page()? {
                // Another stream after the end of this one goes on with it; beside it, it is not listened to.
                Some(page) if page.begins && self.ended => {
                    return Ok(match self.begin(page) {
                        Ok((decoder, start)) => Next::Anew {
                            decoder: Box::new(decoder),
                            start,
                        },
                        Err(_) => Next::Changed,
                    });
                }
                Some(page) if page.serial == self.serial => self.unpack(page),
                Some(_) => {}
                None if self.ended => return Ok(Next::End),
                None => return Ok(Next::Cut),
            }
        }
    }
}
