//! How surely the energy went up at each moment.

use super::filterbank::{Band, Filterbank};
use crate::units::real;

/// Shortest window after the moment, in seconds: the ring of one impact lasts longer.
const AFTER_S: f64 = 0.8e-3;
/// Shortest window before the moment, in seconds: the ordinary level is worth knowing better than the new one.
const BEFORE_S: f64 = 1.6e-3;
/// A band of width B tells apart about 2B values a second; windows hold at least this many before and after.
const VALUES_AFTER: f64 = 4.0;
const VALUES_BEFORE: f64 = 6.0;
/// The ordinary level of a band is not taken below this quantile of its own energy …
const FLOOR_QUANTILE: f64 = 0.1;
/// … times this: between digital silence and the first sound there would be infinite evidence.
const FLOOR_SHARE: f32 = 0.3;
/// Nor below this share of its greatest energy: 100 dB, the range of a 16-bit recording.
const FLOOR_RANGE: f32 = 1e-10;
/// Evidence above this quantile is unusual for the band.
const USUAL_QUANTILE: f64 = 0.9;

/// Evidence that the energy rose at the start of each hop, in nats, summed over bands.
///
/// # Formula
/// ```text
/// G = ½ [ (a + b) ln((a·A + b·B)/(a + b)) − a ln A − b ln B ]   for A > B, else 0
/// ```
/// is the log-likelihood ratio of "variance A over a values, then B over b" against one variance throughout, for
/// Gaussian noise: A and B are the mean energies after and before, a = 2·width·window the values they rest on. Each
/// band is divided by its own 0.9 quantile where that exceeds 1: what fluctuates of itself (speech, rumble) counts
/// less, so the bands in which this recording's transients stand out decide.
#[must_use]
pub fn evidence(bank: &Filterbank, samples: &[f32]) -> Vec<f32> {
    let mut total = vec![0.0; samples.len().div_ceil(bank.hop())];
    for band in bank.split(samples) {
        let own = band_evidence(&band, bank.hop_s());
        let scale = 1.0 / quantile(&own, USUAL_QUANTILE).max(1.0);
        for (t, g) in total.iter_mut().zip(own) {
            *t += scale * g;
        }
    }
    total
}

fn band_evidence(band: &Band, hop_s: f64) -> Vec<f32> {
    let window = |shortest_s: f64, values: f64| {
        crate::units::samples_in(shortest_s.max(values / (2.0 * band.width_hz)), 1.0 / hop_s).max(2)
    };
    let (after, before) = (
        window(AFTER_S, VALUES_AFTER),
        window(BEFORE_S, VALUES_BEFORE),
    );
    let sums = running_sums(&band.energies);
    let n = band.energies.len();
    let mean = |from: usize, to: usize| {
        if to > from {
            narrow((sums[to] - sums[from]) / real(to - from))
        } else {
            0.0
        }
    };
    let greatest = band.energies.iter().copied().fold(0.0, f32::max);
    let floor =
        (FLOOR_SHARE * quantile(&band.energies, FLOOR_QUANTILE)).max(FLOOR_RANGE * greatest);
    if floor <= 0.0 {
        return vec![0.0; n];
    }
    let ratio = LogRatio::new(
        2.0 * band.width_hz * hop_s * real(after),
        2.0 * band.width_hz * hop_s * real(before),
    );
    (0..n)
        .map(|k| {
            // The recording's first instants have no past: nothing can be said to have risen.
            if k < before {
                return 0.0;
            }
            let later = mean(k, (k + after).min(n)) + floor;
            let earlier = mean(k - before, k) + floor;
            ratio.of(later / earlier)
        })
        .collect()
}

/// The formula of [`evidence`] as a function of A/B alone.
#[derive(Debug, Clone, Copy)]
struct LogRatio {
    half_values: f32,
    half_after: f32,
    share_after: f32,
}

impl LogRatio {
    fn new(after: f64, before: f64) -> Self {
        Self {
            half_values: narrow(0.5 * (after + before)),
            half_after: narrow(0.5 * after),
            share_after: narrow(after / (after + before)),
        }
    }

    fn of(self, ratio: f32) -> f32 {
        if ratio <= 1.0 {
            return 0.0;
        }
        let pooled = 1.0 + self.share_after * (ratio - 1.0);
        (self.half_values * pooled.ln() - self.half_after * ratio.ln()).max(0.0)
    }
}

fn running_sums(energies: &[f32]) -> Vec<f64> {
    let mut sum = 0.0;
    std::iter::once(0.0)
        .chain(energies.iter().map(|&e| {
            sum += f64::from(e);
            sum
        }))
        .collect()
}

/// The value below which this share of the values lies; 0 of none.
fn quantile(values: &[f32], share: f64) -> f32 {
    let mut sorted = values.to_vec();
    if sorted.is_empty() {
        return 0.0;
    }
    let index = crate::units::samples_in(share, real(sorted.len() - 1));
    *sorted.select_nth_unstable_by(index, f32::total_cmp).1
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "evidence and energies need no more than an f32"
)]
const fn narrow(x: f64) -> f32 {
    x as f32
}
