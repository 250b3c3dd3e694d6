//! Recordings that are no WAV: MP4, Matroska and `WebM`, ADTS (AAC), MP3, FLAC, Ogg (Vorbis, Opus), AIFF and CAF, in blocks.
//!
//! The crate symphonia has the decoders but that of Opus ([`opus`]), and takes MP4, Matroska, FLAC, AIFF and CAF apart. Frames of MP3 and ADTS ([`frames`]) and pages of Ogg
//! ([`pages`]) are found here: where some are damaged, it has to be known how much sound they held, so that what comes
//! later keeps its time. What is lost becomes silence ([`stream`]).
//!
//! Encoders put a little before the first sample (of MP3 576 samples and more, of AAC 1024 or 2112). Where an MP3, an Ogg or
//! the edit list of an MP4 ([`edits`]) says how much, it is left out; frames of AAC by themselves keep it, and all their times
//! are later by so much. What was added at the end stays, but for what the sum of a page of Ogg vouches for.

mod atoms;
mod codec;
mod edits;
mod frames;
mod guard;
mod header;
mod index;
mod indexed;
mod losses;
mod names;
mod opening;
mod opus;
mod overlaid;
mod pages;
mod pictures;
mod source;
mod start;
mod stream;
mod tracks;

pub use guard::is_guarded;
pub(super) use source::Source;
pub(super) use stream::Stream;

use symphonia::core::packet::Packet;

use crate::Error;
use codec::Decoder;
use start::Start;

/// Takes a container apart.
trait Packets: Send + Sync {
    /// What comes next.
    ///
    /// # Errors
    /// [`Error::Io`] if reading fails.
    fn next(&mut self) -> Result<Next, Error>;
}

/// What comes next in a container.
enum Next {
    /// A packet, after as many frames as were lost just before it.
    Packet { packet: Packet, lost: u64 },
    /// Something was lost here, and a mark will say how much.
    Lost,
    /// What came since the last mark ends at so many frames from some origin.
    Mark(u64),
    /// Another stream follows, with a decoder and a beginning of its own.
    Anew { decoder: Box<Decoder>, start: Start },
    /// The end.
    End,
    /// The end, too early.
    Cut,
    /// The end of what has one sample rate and one number of channels.
    Changed,
}

/// A container and what decodes its packets.
struct Opened<'s> {
    packets: Box<dyn Packets + 's>,
    decoder: Decoder,
    start: Start,
    /// What is to be said of the choice of a track.
    note: Option<String>,
    /// Units per second of what packets say of how long they last, if they say so.
    units_per_s: Option<u32>,
}
