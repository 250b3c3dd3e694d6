//! Opus (RFC 6716) of one or two channels, which symphonia does not decode.

#[cfg(feature = "opus")]
use opus_pure::OpusDecoder;
#[cfg(not(feature = "opus"))]
use without::OpusDecoder;

use super::codec::refused_kind;
use super::start::Span;
use crate::Error;
use crate::audio::content::Refused;
use crate::audio::unreadable;

/// Opus counts time by this rate, whatever it was made from, and is decoded to it.
pub(super) const RATE_HZ: u32 = 48_000;
/// Frames of a packet at most: 120 ms.
const MOST_FRAMES: usize = 5_760;
/// What the header begins with.
pub(super) const MAGIC: &[u8] = b"OpusHead";

/// A decoder, and what the header says that it has to do beside.
pub(super) struct Opus {
    inner: OpusDecoder,
    channels: usize,
    gain: f32,
    interleaved: Vec<f32>,
}

/// The header (RFC 7845, 5.1).
struct Head {
    channels: usize,
    /// Frames that the encoder put before the first.
    skip: u16,
    /// Gain in 1/256 dB.
    gain: i16,
    /// How channels are put together; 0 for one or two.
    family: u8,
}

impl Head {
    /// In an MP4 (version 0) the high byte of a number comes first, elsewhere the low one.
    fn of(bytes: &[u8]) -> Option<Self> {
        let bytes = bytes.strip_prefix(MAGIC)?;
        let [version, channels, rest @ ..] = bytes.first_chunk::<11>()?;
        let is_mp4 = *version == 0;
        let number = |at: usize| {
            let two = [rest[at], rest[at + 1]];
            if is_mp4 {
                u16::from_be_bytes(two)
            } else {
                u16::from_le_bytes(two)
            }
        };
        (version >> 4 == 0).then_some(Self {
            channels: usize::from(*channels),
            skip: number(0),
            gain: number(6).cast_signed(),
            family: rest[8],
        })
    }
}

/// What the encoder put before the first sample, by the header.
pub(super) fn hidden(head: &[u8]) -> Option<Span> {
    Span::new(Head::of(head)?.skip.into(), RATE_HZ)
}

impl Opus {
    /// The decoder that a header asks for.
    ///
    /// # Errors
    /// [`Error::Recording`] with the command that converts it if the header is broken or has more channels, or the feature
    /// `opus` is off.
    pub(super) fn new(head: &[u8], ending: &'static str) -> Result<Self, Error> {
        if cfg!(not(feature = "opus")) {
            return Err(unreadable(Refused::new("Opus", ending).sentence()));
        }
        let of = Head::of(head).filter(|head| head.family == 0 && matches!(head.channels, 1 | 2));
        let made = of.and_then(|head| {
            let rate_hz = RATE_HZ.cast_signed();
            let inner = OpusDecoder::new(rate_hz, head.channels).ok()?;
            Some(Self {
                inner,
                channels: head.channels,
                gain: 10_f32.powf(f32::from(head.gain) / (20.0 * 256.0)),
                interleaved: vec![0.0; MOST_FRAMES * head.channels],
            })
        });
        made.ok_or_else(|| refused_kind("Opus", "with 1 or 2 channels", ending))
    }

    /// The samples of each channel in a packet; none if it is damaged.
    pub(super) fn decode(&mut self, packet: &[u8]) -> Option<Vec<Vec<f32>>> {
        // An empty packet asks the decoder to make up what was lost.
        if packet.is_empty() {
            return None;
        }
        let room = &mut self.interleaved;
        let frames = self.inner.decode(packet, MOST_FRAMES, room).ok()?;
        let of_channel = |channel| {
            let each = room[..frames * self.channels].iter();
            let each = each.skip(channel).step_by(self.channels);
            each.map(|x| x * self.gain).collect()
        };
        Some((0..self.channels).map(of_channel).collect())
    }

    /// Forgets what came before.
    pub(super) fn reset(&mut self) {
        // It fails for settings that the decoder was not made with.
        self.inner.reset_state().ok();
    }
}

/// What stands in the decoder's place where it is left out: there is none of it.
#[cfg(not(feature = "opus"))]
mod without {
    pub(super) enum OpusDecoder {}

    impl OpusDecoder {
        pub(super) const fn new(_: i32, _: usize) -> Result<Self, ()> {
            Err(())
        }

        pub(super) const fn decode(
            &mut self,
            _: &[u8],
            _: usize,
            _: &mut [f32],
        ) -> Result<usize, ()> {
            match *self {}
        }

        pub(super) const fn reset_state(&mut self) -> Result<(), ()> {
            match *self {}
        }
    }
}

#[cfg(all(test, feature = "opus"))]
mod tests {
    use super::*;

    #[test]
    fn a_header_is_read_in_both_orders_of_bytes() {
        let little = b"OpusHead\x01\x02\x38\x01\x80\xBB\0\0\0\xFF\0";
        let big = b"OpusHead\0\x02\x01\x38\0\0\xBB\x80\xFF\0\0";
        for bytes in [little, big] {
            let head = Head::of(bytes).unwrap();
            assert_eq!(
                (head.channels, head.skip, head.gain, head.family),
                (2, 312, -256, 0)
            );
            assert_eq!(hidden(bytes), Span::new(312, 48_000));
            assert!(Opus::new(bytes, "opus").is_ok() && Opus::new(&bytes[..18], "opus").is_err());
        }
        let surround = b"OpusHead\x01\x06\x38\x01\x80\xBB\0\0\0\0\x01";
        let error = Opus::new(surround, "opus").err().unwrap().to_string();
        assert!(
            error.contains("Opus of another kind than with 1 or 2 channels"),
            "{error}"
        );
    }
}
