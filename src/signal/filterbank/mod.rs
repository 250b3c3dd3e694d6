//! Octave bands by a pyramid of half-band filters, as energies on one time grid.

use crate::Error;
use crate::units::real;

/// Pairs of taps of the half-band filter: 23 taps in all, a transition of a third of an octave.
const TAP_PAIRS: usize = 6;

/// Splits a signal into octaves and gives the energy of each on a common grid of hops.
///
/// Each level divides what it gets at a quarter of its rate into a high and a low half. While there is more than one
/// sample to a hop the halves are decimated; below that the filter is dilated instead, so that every band keeps the
/// time resolution of a hop. All filters are symmetric: no band is late.
#[derive(Debug, Clone)]
pub struct Filterbank {
    hop: usize,
    sample_rate_hz: f64,
    taps: [f32; TAP_PAIRS],
    widths_hz: Vec<f64>,
}

/// The energy of one octave.
#[derive(Debug, Clone)]
pub struct Band {
    /// Bandwidth in Hz; the octave reaches from this to twice this.
    pub width_hz: f64,
    /// Mean square of each hop.
    pub energies: Vec<f32>,
}

impl Filterbank {
    /// A bank for this rate with a grid of about `hop_s`, down to `lowest_hz`.
    ///
    /// # Errors
    /// [`Error::Argument`] if the rate holds no octave above `lowest_hz`.
    pub fn new(sample_rate_hz: f64, hop_s: f64, lowest_hz: f64) -> Result<Self, Error> {
        let widths_hz: Vec<f64> =
            std::iter::successors(Some(sample_rate_hz / 4.0), |w| Some(w / 2.0))
                .take_while(|&width| width >= lowest_hz)
                .collect();
        if widths_hz.is_empty() || !sample_rate_hz.is_finite() {
            return Err(Error::argument(
                "sample rate",
                sample_rate_hz,
                "160 Hz or more by default, 4 times the lowest frequency that is listened to",
            ));
        }
        let mut hop = 1;
        while real(2 * hop) <= hop_s * sample_rate_hz * std::f64::consts::SQRT_2 {
            hop *= 2;
        }
        Ok(Self {
            hop,
            sample_rate_hz,
            taps: half_band_taps(),
            widths_hz,
        })
    }

    /// Samples per hop, a power of two.
    #[must_use]
    pub const fn hop(&self) -> usize {
        self.hop
    }

    /// Samples per second of what it splits.
    #[must_use]
    pub const fn sample_rate_hz(&self) -> f64 {
        self.sample_rate_hz
    }

    /// Seconds per hop.
    #[must_use]
    pub fn hop_s(&self) -> f64 {
        real(self.hop) / self.sample_rate_hz
    }

    /// The energies of all bands, highest first, each with one value for every hop begun in `samples`.
    #[must_use]
    pub fn split(&self, samples: &[f32]) -> Vec<Band> {
        let hops = samples.len().div_ceil(self.hop);
        let mut low = Vec::with_capacity(hops * self.hop);
        low.extend_from_slice(samples);
        low.resize(hops * self.hop, 0.0);
        let mut per_hop = self.hop;
        let mut dilation = 1;
        let mut scratch = Scratch::default();
        self.widths_hz
            .iter()
            .map(|&width_hz| {
                let energies = if per_hop > 1 {
                    per_hop /= 2;
                    self.decimate(&mut low, per_hop, &mut scratch)
                } else {
                    let squares = self.divide(&mut low, dilation, &mut scratch);
                    dilation *= 2;
                    squares
                };
                Band { width_hz, energies }
            })
            .collect()
    }

    /// Splits at a quarter of the rate and keeps every second sample: `low` becomes the low half, the mean squares of
    /// the high half are returned, of `per_hop` samples each. Output `m` stands at the time of input `2m`.
    fn decimate(&self, low: &mut Vec<f32>, per_hop: usize, scratch: &mut Scratch) -> Vec<f32> {
        let half = low.len() / 2;
        // Silence before and after, and enough of it for whole blocks.
        let length = half.next_multiple_of(BLOCK);
        let Scratch {
            centre: even,
            around: odd,
            squares,
        } = scratch;
        clear(even, length);
        clear(odd, length + 2 * TAP_PAIRS);
        let (pairs, _) = low.as_chunks::<2>();
        for ((even, odd), pair) in even.iter_mut().zip(&mut odd[TAP_PAIRS..]).zip(pairs) {
            (*even, *odd) = (pair[0], pair[1]);
        }
        low.resize(length, 0.0);
        clear(squares, length);
        let blocks = low.as_chunks_mut::<BLOCK>().0.iter_mut();
        let centres = even.as_chunks::<BLOCK>().0;
        let squares_of = squares.as_chunks_mut::<BLOCK>().0;
        for (i, ((low, square), centre)) in blocks.zip(squares_of).zip(centres).enumerate() {
            let Some(near) = odd[BLOCK * i..].first_chunk::<NEAR>() else {
                break;
            };
            let side = self.sides(|k| {
                (
                    &near[TAP_PAIRS - 1 - k..][..BLOCK],
                    &near[TAP_PAIRS + k..][..BLOCK],
                )
            });
            halves(centre, &side, low, square);
        }
        low.truncate(half);
        squares.truncate(half);
        average(squares, per_hop);
        squares.clone()
    }

    /// Splits at a quarter of `rate / dilation` without decimation: `low` becomes the low half, the squares of the high
    /// half are returned.
    fn divide(&self, low: &mut Vec<f32>, dilation: usize, scratch: &mut Scratch) -> Vec<f32> {
        // The reach of the filter in silence on both sides.
        let reach = (2 * TAP_PAIRS - 1) * dilation;
        let count = low.len();
        let length = count.next_multiple_of(BLOCK);
        let padded = &mut scratch.around;
        clear(padded, length + 2 * reach);
        padded[reach..reach + count].copy_from_slice(low);
        low.resize(length, 0.0);
        let mut squares = vec![0.0; length];
        let blocks = low.as_chunks_mut::<BLOCK>().0.iter_mut();
        let squares_of = squares.as_chunks_mut::<BLOCK>().0;
        for (i, (low, square)) in blocks.zip(squares_of).enumerate() {
            let centre = BLOCK * i + reach;
            let shift = |k: usize| (2 * k + 1) * dilation;
            let side = self.sides(|k| {
                (
                    &padded[centre - shift(k)..][..BLOCK],
                    &padded[centre + shift(k)..][..BLOCK],
                )
            });
            halves(&low.clone(), &side, low, square);
        }
        low.truncate(count);
        squares.truncate(count);
        squares
    }

    /// `Σ h_k (before_k[i] + after_k[i])` for a block of i.
    ///
    /// Block by block, so that sums of neighbours run side by side in the machine's vectors.
    #[inline]
    fn sides<'a>(&self, at: impl Fn(usize) -> (&'a [f32], &'a [f32])) -> [f32; BLOCK] {
        let mut sums = [0.0; BLOCK];
        for (k, h) in self.taps.iter().enumerate() {
            let (before, after) = at(k);
            for ((sum, b), a) in sums.iter_mut().zip(before).zip(after) {
                *sum += h * (b + a);
            }
        }
        sums
    }
}

/// The low half of a block, and the squares of the high half, from its centre taps and the sums of the others.
fn halves(
    centre: &[f32; BLOCK],
    side: &[f32; BLOCK],
    low: &mut [f32; BLOCK],
    squares: &mut [f32; BLOCK],
) {
    for i in 0..BLOCK {
        let half = 0.5 * centre[i];
        low[i] = half + side[i];
        squares[i] = (half - side[i]) * (half - side[i]);
    }
}

/// Buffers of the filters, reused by each band.
#[derive(Debug, Default)]
struct Scratch {
    centre: Vec<f32>,
    around: Vec<f32>,
    squares: Vec<f32>,
}

fn clear(values: &mut Vec<f32>, length: usize) {
    values.clear();
    values.resize(length, 0.0);
}

/// Outputs that are computed at once: as many as the machine's vector registers hold, with room for their inputs.
const BLOCK: usize = 32;
/// Odd samples that the outputs of a block depend on.
const NEAR: usize = BLOCK + 2 * TAP_PAIRS;

/// `h_k = sin(π(2k+1)/2) / (π(2k+1))`, the ideal half-band filter, under a Blackman window, scaled to pass 0 Hz whole.
fn half_band_taps() -> [f32; TAP_PAIRS] {
    use std::f64::consts::PI;
    let ideal = |k: usize| {
        let offset = real(2 * k + 1);
        let phase = PI * offset / real(2 * TAP_PAIRS + 1);
        let window = 0.42 + 0.5 * phase.cos() + 0.08 * (2.0 * phase).cos();
        let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        window * sign / (PI * offset)
    };
    let sum: f64 = (0..TAP_PAIRS).map(ideal).sum();
    #[expect(
        clippy::cast_possible_truncation,
        reason = "filter taps need no more than an f32"
    )]
    std::array::from_fn(|k| (0.25 * ideal(k) / sum) as f32)
}

/// Replaces every `count` values, a power of two, by their mean.
fn average(values: &mut Vec<f32>, count: usize) {
    let mut left = count;
    while left > 1 {
        // By halves, pair by pair: that runs side by side, a sum of some neighbours does not.
        let half = values.len() / 2;
        for m in 0..half {
            values[m] = 0.5 * (values[2 * m] + values[2 * m + 1]);
        }
        values.truncate(half);
        left /= 2;
    }
}

#[cfg(test)]
mod tests;
