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
                "at least 4 times the lowest frequency",
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
        let mut low = samples.to_vec();
        low.resize(hops * self.hop, 0.0);
        let mut per_hop = self.hop;
        let mut dilation = 1;
        let mut padded = Vec::new();
        self.widths_hz
            .iter()
            .map(|&width_hz| {
                let energies = if per_hop > 1 {
                    per_hop /= 2;
                    let mut squares = self.decimate(&mut low, &mut padded);
                    average(&mut squares, per_hop);
                    squares
                } else {
                    let squares = self.divide(&mut low, dilation, &mut padded);
                    dilation *= 2;
                    squares
                };
                Band { width_hz, energies }
            })
            .collect()
    }

    /// Splits at a quarter of the rate and keeps every second sample: `low` becomes the low half, the squares of the
    /// high half are returned. Output `m` stands at the time of input `2m`.
    fn decimate(&self, low: &mut Vec<f32>, odd: &mut Vec<f32>) -> Vec<f32> {
        let half = low.len() / 2;
        // Odd samples with TAP_PAIRS of silence before them, and enough after them for whole blocks.
        odd.clear();
        odd.resize(TAP_PAIRS, 0.0);
        odd.extend(low.as_chunks::<2>().0.iter().map(|pair| pair[1]));
        odd.resize(half + 2 * TAP_PAIRS + BLOCK, 0.0);
        let mut squares = vec![0.0; half];
        for (block, squares) in squares.chunks_mut(BLOCK).enumerate() {
            let start = BLOCK * block;
            let side = self.sides(|k| (start + TAP_PAIRS - 1 - k, start + TAP_PAIRS + k), odd);
            for (i, (square, side)) in squares.iter_mut().zip(side).enumerate() {
                let centre = 0.5 * low[2 * (start + i)];
                low[start + i] = centre + side;
                *square = (centre - side) * (centre - side);
            }
        }
        low.truncate(half);
        squares
    }

    /// Splits at a quarter of `rate / dilation` without decimation: `low` becomes the low half, the squares of the high
    /// half are returned.
    fn divide(&self, low: &mut [f32], dilation: usize, padded: &mut Vec<f32>) -> Vec<f32> {
        // The reach of the filter in silence on both sides.
        let reach = (2 * TAP_PAIRS - 1) * dilation;
        padded.clear();
        padded.resize(reach, 0.0);
        padded.extend_from_slice(low);
        padded.resize(low.len() + 2 * reach + BLOCK, 0.0);
        let mut squares = vec![0.0; low.len()];
        let blocks = low.chunks_mut(BLOCK).zip(squares.chunks_mut(BLOCK));
        for (block, (low, squares)) in blocks.enumerate() {
            let centre = BLOCK * block + reach;
            let shift = |k: usize| (2 * k + 1) * dilation;
            let side = self.sides(|k| (centre - shift(k), centre + shift(k)), padded);
            for ((low, square), side) in low.iter_mut().zip(squares).zip(side) {
                let centre = 0.5 * *low;
                *low = centre + side;
                *square = (centre - side) * (centre - side);
            }
        }
        squares
    }

    /// `Σ h_k (x[before_k + i] + x[after_k + i])` for a block of i; `at` gives `before_k` and `after_k`.
    ///
    /// Block by block, so that sums of neighbours run side by side in the machine's vectors.
    fn sides(&self, at: impl Fn(usize) -> (usize, usize), x: &[f32]) -> [f32; BLOCK] {
        let mut sums = [0.0; BLOCK];
        for (k, h) in self.taps.iter().enumerate() {
            let (before, after) = at(k);
            let pairs = x[before..before + BLOCK]
                .iter()
                .zip(&x[after..after + BLOCK]);
            for (sum, (b, a)) in sums.iter_mut().zip(pairs) {
                *sum += h * (b + a);
            }
        }
        sums
    }
}

/// Outputs that are computed at once.
const BLOCK: usize = 16;

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

/// Replaces every `count` values by their mean.
fn average(values: &mut Vec<f32>, count: usize) {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "a hop is a few dozen samples"
    )]
    let scale = 1.0 / real(count) as f32;
    if count > 1 {
        let means = values.len() / count;
        for m in 0..means {
            values[m] = scale * values[m * count..(m + 1) * count].iter().sum::<f32>();
        }
        values.truncate(means);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATE_HZ: f64 = 48_000.0;

    fn tone(hz: f64) -> Vec<f32> {
        #[expect(clippy::cast_possible_truncation, reason = "test signal")]
        (0..48_000)
            .map(|i| (std::f64::consts::TAU * hz * real(i) / RATE_HZ).sin() as f32)
            .collect()
    }

    fn bank() -> Filterbank {
        Filterbank::new(RATE_HZ, 0.25e-3, 60.0).unwrap()
    }

    fn mean(band: &Band) -> f64 {
        let middle = &band.energies[500..2500];
        middle.iter().copied().map(f64::from).sum::<f64>() / real(middle.len())
    }

    #[test]
    fn a_tone_lands_in_its_octave_with_its_energy() {
        let bank = bank();
        for (index, hz) in [
            (0, 17_000.0),
            (1, 8_500.0),
            (2, 4_200.0),
            (3, 2_100.0),
            (5, 530.0),
            (7, 132.0),
        ] {
            let bands = bank.split(&tone(hz));
            assert!(hz > bands[index].width_hz && hz < 2.0 * bands[index].width_hz);
            // Decimated bands hold all samples of a slower signal: the mean square of a full-scale sine is a half.
            let own = mean(&bands[index]);
            assert!((own - 0.5).abs() < 0.02, "{hz} Hz: {own}");
            for (other, band) in bands
                .iter()
                .enumerate()
                .filter(|&(other, _)| other != index)
            {
                assert!(mean(band) < 1e-3, "{hz} Hz in band {other}: {}", mean(band));
            }
        }
    }

    #[test]
    fn no_band_is_late() {
        let mut click = vec![0.0; 48_000];
        click[24_000] = 1.0;
        let bank = bank();
        for band in bank.split(&click) {
            let total: f64 = band.energies.iter().copied().map(f64::from).sum();
            let centre: f64 = band
                .energies
                .iter()
                .enumerate()
                .map(|(i, &e)| (real(i) + 0.5) * f64::from(e))
                .sum::<f64>()
                / total;
            let off = (centre * real(bank.hop()) - 24_000.0).abs();
            assert!(
                off < real(bank.hop()),
                "{} Hz: {off} samples",
                band.width_hz
            );
        }
    }

    #[test]
    fn a_rate_without_an_octave_is_refused() {
        assert!(Filterbank::new(200.0, 0.25e-3, 60.0).is_err());
    }
}
