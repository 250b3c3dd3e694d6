//! Blocks of bytes into samples of each channel.

use std::ops::Range;

use super::container::{Container, SampleKind};

/// Full scale of 32-bit integers.
const FULL_SCALE_32: f32 = 65_536.0 * 32_768.0;

/// Adds the samples of whole frames, full scale being ±1, of some channels to those of each; gives how many were not
/// finite.
///
/// Full scale of each integer width is a power of two, so scaling is exact; 32-bit integers are rounded to the
/// 24 bits of an `f32`, which is below the noise of any microphone, and so are 64-bit floats.
#[expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    reason = "an f32 keeps 24 bits, more than a microphone gives"
)]
pub(super) fn decode(
    bytes: &[u8],
    container: &Container,
    channels: &Range<usize>,
    out: &mut [Vec<f32>],
) -> usize {
    let frames = Frames {
        bytes,
        channels: usize::from(container.channels),
        wanted: channels.clone(),
    };
    match (container.kind, container.bytes_per_sample) {
        (SampleKind::Unsigned8, _) => {
            frames.spread(out, |&[b]| (f32::from(b) - 128.0) * (1.0 / 128.0));
        }
        (SampleKind::Signed, 2) => frames.spread(out, |&b| {
            f32::from(i16::from_le_bytes(b)) * (1.0 / 32_768.0)
        }),
        (SampleKind::Signed, 3) => frames.spread(out, |&[a, b, c]| {
            i32::from_le_bytes([0, a, b, c]) as f32 * (1.0 / FULL_SCALE_32)
        }),
        (SampleKind::Signed, _) => frames.spread(out, |&b| {
            i32::from_le_bytes(b) as f32 * (1.0 / FULL_SCALE_32)
        }),
        (SampleKind::ALaw, _) => {
            frames.spread(out, |&[b]| f32::from(a_law(b)) * (1.0 / 32_768.0));
        }
        (SampleKind::MuLaw, _) => {
            frames.spread(out, |&[b]| f32::from(mu_law(b)) * (1.0 / 32_768.0));
        }
        (SampleKind::Float32, _) => {
            return frames.spread_finite(out, |&b| f32::from_le_bytes(b));
        }
        (SampleKind::Float64, _) => {
            return frames.spread_finite(out, |&b| f64::from_le_bytes(b) as f32);
        }
    }
    0
}

/// A sample of ITU-T G.711 A-law as one of 16 bits: sign, 3 bits that say which power of two, 4 bits within it, with
/// every other bit turned over.
fn a_law(code: u8) -> i16 {
    let code = code ^ 0x55;
    let (power, within) = ((code >> 4) & 7, i16::from(code & 15) << 4);
    let size = match power {
        // The two lowest stretches have steps of one size.
        0 => within + 0x008,
        _ => (within + 0x108) << (power - 1),
    };
    if code & 0x80 == 0 { -size } else { size }
}

/// A sample of ITU-T G.711 µ-law as one of 16 bits: as A-law, with every bit turned over and 132 added before the
/// power was taken.
fn mu_law(code: u8) -> i16 {
    let code = !code;
    let size = (((i16::from(code & 15) << 3) + 132) << ((code >> 4) & 7)) - 132;
    if code & 0x80 == 0 { size } else { -size }
}

/// Interleaved samples, and the channels that are wanted of them.
struct Frames<'a> {
    bytes: &'a [u8],
    channels: usize,
    wanted: Range<usize>,
}

impl Frames<'_> {
    /// Deals samples of `N` bytes out to their channels. One and two channels are most of what there is, and have loops
    /// that the compiler can turn into the machine's vectors.
    fn spread<const N: usize>(&self, out: &mut [Vec<f32>], sample: impl Fn(&[u8; N]) -> f32) {
        let samples = self.bytes.as_chunks::<N>().0;
        match (self.channels, out) {
            (1, [only]) => only.extend(samples.iter().map(sample)),
            (2, [left, right]) => {
                let pairs = samples.as_chunks::<2>().0;
                left.extend(pairs.iter().map(|[l, _]| sample(l)));
                right.extend(pairs.iter().map(|[_, r]| sample(r)));
            }
            (_, out) => {
                for (c, out) in self.wanted.clone().zip(out) {
                    out.extend(samples.iter().skip(c).step_by(self.channels).map(&sample));
                }
            }
        }
    }

    /// As [`spread`](Self::spread) for floats; gives how many were not finite.
    fn spread_finite<const N: usize>(
        &self,
        out: &mut [Vec<f32>],
        sample: impl Fn(&[u8; N]) -> f32,
    ) -> usize {
        let known: Vec<usize> = out.iter().map(Vec::len).collect();
        self.spread(out, sample);
        let new = out.iter_mut().zip(known);
        new.map(|(out, known)| zero_what_is_not_finite(&mut out[known..]))
            .sum()
    }
}

/// A NaN would reach every sum that touches it; a zero is a sample of silence. Gives how many there were.
pub(in crate::audio) fn zero_what_is_not_finite(samples: &mut [f32]) -> usize {
    let mut marked = 0;
    for x in samples {
        if !x.is_finite() {
            *x = 0.0;
            marked += 1;
        }
    }
    marked
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decoded(
        kind: SampleKind,
        bytes_per_sample: u16,
        channels: u16,
        bytes: &[u8],
    ) -> Vec<Vec<f32>> {
        let container = Container {
            kind,
            bytes_per_sample,
            channels,
            sample_rate_hz: 44_100,
            claimed_bytes: None,
            warnings: Vec::new(),
        };
        let mut out = vec![Vec::new(); usize::from(channels)];
        decode(bytes, &container, &(0..out.len()), &mut out);
        out
    }

    #[test]
    fn every_width_has_its_full_scale() {
        for (kind, width, bytes, value) in [
            (SampleKind::Unsigned8, 1, &[0][..], -1.0),
            (SampleKind::Signed, 2, &[0, 0x80], -1.0),
            (SampleKind::Signed, 3, &[0, 0, 0x40], 0.5),
            (SampleKind::Signed, 4, &[0, 0, 0, 0xC0], -0.5),
            (SampleKind::Float32, 4, &[0, 0, 0x80, 0x3E], 0.25),
            (
                SampleKind::Float64,
                8,
                &[0, 0, 0, 0, 0, 0, 0xD0, 0x3F],
                0.25,
            ),
        ] {
            assert_eq!(
                decoded(kind, width, 1, bytes),
                [[value]],
                "{kind:?} {width}"
            );
        }
    }

    /// Values of the tables of G.711: the largest, the smallest and what is between them.
    #[test]
    fn companded_samples_are_those_of_the_standard() {
        for (code, value) in [
            (0xD5, 8),
            (0x55, -8),
            (0xAA, 32_256),
            (0x2A, -32_256),
            (0xC5, 264),
            (0x80, 5_504),
        ] {
            assert_eq!(a_law(code), value, "A-law {code:#x}");
        }
        for (code, value) in [
            (0xFF, 0),
            (0x7F, 0),
            (0x80, 32_124),
            (0x00, -32_124),
            (0xEF, 132),
            (0x8F, 16_764),
        ] {
            assert_eq!(mu_law(code), value, "µ-law {code:#x}");
        }
        let of = |law: fn(u8) -> i16| (0..=255_u8).map(move |c| f32::from(law(c)) / 32_768.0);
        let codes: Vec<u8> = (0..=255).collect();
        assert_eq!(
            decoded(SampleKind::ALaw, 1, 1, &codes)[0],
            of(a_law).collect::<Vec<_>>()
        );
        assert_eq!(
            decoded(SampleKind::MuLaw, 1, 1, &codes)[0],
            of(mu_law).collect::<Vec<_>>()
        );
    }

    #[test]
    fn each_channel_gets_its_own_samples() {
        for channels in 1..=5_u16 {
            let samples = (0..3 * channels).flat_map(|i| i.cast_signed().to_le_bytes());
            let bytes: Vec<u8> = samples.collect();
            let out = decoded(SampleKind::Signed, 2, channels, &bytes);
            for (c, channel) in (0..channels).zip(&out) {
                let expected: Vec<f32> = (0..3)
                    .map(|frame| f32::from(frame * channels + c) / 32_768.0)
                    .collect();
                assert_eq!(channel, &expected, "channel {c} of {channels}");
            }
        }
    }
}
