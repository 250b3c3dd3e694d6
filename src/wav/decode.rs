//! Blocks of bytes into samples of each channel.

use std::ops::Range;

use super::container::{Container, SampleKind};

/// Full scale of 32-bit integers.
const FULL_SCALE_32: f32 = 65_536.0 * 32_768.0;

/// Adds the samples of whole frames, full scale being ±1, of some channels to those of each; gives how many were not
/// finite.
///
/// Full scale of each integer width is a power of two, so scaling is exact; 32-bit integers are rounded to the
/// 24 bits of an `f32`, which is below the noise of any microphone.
#[expect(
    clippy::cast_precision_loss,
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
        (SampleKind::Float32, _) => {
            let known: Vec<usize> = out.iter().map(Vec::len).collect();
            frames.spread(out, |&b| f32::from_le_bytes(b));
            let new = out
                .iter_mut()
                .zip(known)
                .map(|(out, known)| &mut out[known..]);
            return new.map(zero_what_is_not_finite).sum();
        }
    }
    0
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
}

/// A NaN would reach every sum that touches it; a zero is a sample of silence. Gives how many there were.
fn zero_what_is_not_finite(samples: &mut [f32]) -> usize {
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
        ] {
            assert_eq!(
                decoded(kind, width, 1, bytes),
                [[value]],
                "{kind:?} {width}"
            );
        }
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
