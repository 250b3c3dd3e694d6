//! Change-point evidence: the generalised log-likelihood ratio, at each moment, of a rise of the energy against none.

use std::ops::Range;

use super::quantization::quantization_density;
use super::running_mean::{FALLING_SHARE, mean_ratios};
use crate::event::Profile;
use crate::signal::filterbank::{Band, Filterbank};
use crate::signal::logarithm::ln_from_one;
use crate::signal::sound::heard;
use crate::units::{narrow, real};

/// Shortest window after the moment, in seconds: the ring of one impact lasts longer.
const AFTER_S: f64 = 1e-3;
/// Shortest window before the moment, in seconds: the ordinary level is worth knowing better than the new one.
const BEFORE_S: f64 = 1.6e-3;
/// Independent values that a window holds at least, after and before the moment: a band of width B has about 2B a second.
const VALUES_AFTER: f64 = 5.0;
const VALUES_BEFORE: f64 = 6.0;
/// The floor of a band's ordinary level is this quantile of its own energy …
const FLOOR_QUANTILE: f64 = 0.1;
/// … times this: between digital silence and the first sound there would be infinite evidence.
const FLOOR_SHARE: f32 = 0.3;
/// Least floor as a share of the band's greatest energy. Derived: 100 dB, the range of a 16-bit recording.
const FLOOR_RANGE: f32 = 1e-10;
/// Evidence above this quantile is unusual for the band.
const USUAL_QUANTILE: f64 = 0.9;

/// The evidence of one stretch, band by band.
#[derive(Debug)]
pub struct Evidence {
    /// Nats for a rise at the start of each hop, summed over bands.
    pub total: Vec<f32>,
    bands: Vec<BandEvidence>,
    hop_s: f64,
}

/// The evidence of one band.
#[derive(Debug)]
struct BandEvidence {
    band: Band,
    /// Nats before scaling.
    own: Vec<f32>,
    scale: f32,
    /// Length of the window after, in hops.
    after: usize,
    floor: f32,
}

impl Evidence {
    /// Evidence that the energy rose at the start of each hop.
    ///
    /// # Formula
    /// ```text
    /// G = ½ [ (a + b) ln((a·A + b·B)/(a + b)) − a ln A − b ln B ]   for A > B, else 0
    /// ```
    /// is the log-likelihood ratio of "variance A over a values after, B over b values before" against one variance
    /// throughout, for Gaussian noise: A and B are mean energies, a and b = 2·width·window the values they rest on.
    /// Each band is divided by its own 0.9 quantile where that exceeds 1: what fluctuates of itself (speech, rumble)
    /// counts less, so the bands in which this recording's transients stand out decide.
    #[must_use]
    pub fn of(bank: &Filterbank, samples: &[f32]) -> Self {
        let mut total = vec![0.0; samples.len().div_ceil(bank.hop())];
        let quantization = quantization_density(samples, bank);
        let heard = heard(samples);
        let heard = heard.start / bank.hop()..heard.end.div_ceil(bank.hop());
        let mut copy = Vec::new();
        let bands: Vec<BandEvidence> = bank
            .split(samples)
            .into_iter()
            .map(|mut band| {
                // Digital silence before the sound says nothing of the level that it began at.
                if heard.start > 0 {
                    let usual = quantile(&band.energies[heard.clone()], 0.5, &mut copy);
                    band.energies[..heard.start].fill(usual);
                }
                let quantization = narrow(quantization * band.width_hz);
                BandEvidence::of(band, bank.hop_s(), quantization, &heard, &mut copy)
            })
            .collect();
        for band in &bands {
            for (t, g) in total.iter_mut().zip(&band.own) {
                *t += band.scale * g;
            }
        }
        Self {
            total,
            bands,
            hop_s: bank.hop_s(),
        }
    }

    /// The hop, with its fraction, at which the sound of a peak begins.
    ///
    /// The evidence of a low band is broad: a window earlier it is nearly as high. So the change point is sought between
    /// fixed ends, where each value on the wrong side costs its whole likelihood:
    /// ```text
    /// L(k) = −½ Σ_bands [ n₁ ln E₁ + n₂ ln E₂ ],   n₁, E₁ values and mean energy before k, n₂, E₂ from k on
    /// ```
    #[must_use]
    pub fn begin(&self, peak: usize) -> f64 {
        let reach = self.reach(peak);
        // The onset can lie anywhere on the ridge of high evidence: past it the sound counts as the level before.
        let high = 0.5 * self.total[peak];
        let ridge = self.total[peak..].iter().take_while(|&&g| g > high).count();
        let (from, to) = (
            peak.saturating_sub(reach),
            (peak + ridge + reach).min(self.total.len()),
        );
        if to < from + 4 {
            return real(peak);
        }
        let mut likelihood = vec![0.0; to - from];
        for rise in &self.bands {
            let weight = 0.5 * f64::from(rise.scale) * 2.0 * rise.band.width_hz * self.hop_s;
            rise.add_change_likelihood(from, to, weight, &mut likelihood);
        }
        let inside = 2..likelihood.len() - 1;
        let best = inside
            .max_by(|&a, &b| likelihood[a].total_cmp(&likelihood[b]))
            .unwrap_or(0);
        real(from + best)
    }

    /// How the evidence of a peak is spread over the bands.
    #[must_use]
    pub fn profile(&self, peak: usize) -> Profile {
        Profile::new(self.bands.iter().map(|band| band.scale * band.own[peak]))
    }

    /// Standard deviation of the time of a peak, in seconds.
    #[must_use]
    pub fn jitter_s(&self, peak: usize) -> f64 {
        self.hop_s * (JITTER_SHARE * real(self.reach(peak))).max(0.5)
    }

    /// Hops that the quickest band that contributes to a peak looks ahead.
    ///
    /// Slow sounds are heard by low bands alone, and a quick band contributes to them by chance. So where the evidence lies
    /// in slow bands, the quickest is the one up to which the sum of the evidence is more than chance.
    fn reach(&self, peak: usize) -> usize {
        let nats = |rise: &BandEvidence| rise.scale * rise.own[peak];
        let loudest = self.bands.iter().map(nats).fold(0.0, f32::max);
        let contributing = self
            .bands
            .iter()
            .filter(|rise| nats(rise) >= CONTRIBUTING * loudest);
        let quickest = contributing.map(|rise| rise.after).min().unwrap_or(2);
        let slow = self.reach_of_evidence(peak);
        if real(slow) * self.hop_s > SLOW_S {
            slow
        } else {
            quickest
        }
    }

    /// Hops that the quickest band looks ahead up to which the evidence of a peak is more than chance, or half of all.
    fn reach_of_evidence(&self, peak: usize) -> usize {
        let needed = (0.5 * self.total[peak]).min(BEYOND_CHANCE);
        let mut held = 0.0;
        // The highest band comes first, and is the quickest.
        let enough = self.bands.iter().find(|rise| {
            held += rise.scale * rise.own[peak];
            held >= needed
        });
        enough.map_or(2, |rise| rise.after)
    }
}

/// A change is located to about this share of the window that it was found with.
const JITTER_SHARE: f64 = 0.1;

/// A band contributes to a peak if its evidence is at least this share of the greatest among the bands.
const CONTRIBUTING: f32 = 0.25;

/// Evidence in nats, over all bands together, that noise hardly ever reaches.
const BEYOND_CHANCE: f32 = 10.0;
/// Bands that look farther ahead than this, in seconds, are slow.
const SLOW_S: f64 = 10e-3;

/// Energy of a sound before its onset, as a share of that after it, that symmetric filters leak; levels below it count as it.
const LEAKAGE: f32 = 1e-3;

impl BandEvidence {
    fn of(
        band: Band,
        hop_s: f64,
        quantization: f32,
        heard: &Range<usize>,
        copy: &mut Vec<f32>,
    ) -> Self {
        let window = |shortest_s: f64, values: f64| {
            crate::units::samples_in(shortest_s.max(values / (2.0 * band.width_hz)), 1.0 / hop_s)
                .max(2)
        };
        let (after, before) = (
            window(AFTER_S, VALUES_AFTER),
            window(BEFORE_S, VALUES_BEFORE),
        );
        let greatest = band.energies.iter().copied().fold(0.0, f32::max);
        let low = quantile(&band.energies[heard.clone()], FLOOR_QUANTILE, copy);
        let floor = (FLOOR_SHARE * low)
            .max(FLOOR_RANGE * greatest)
            .max(quantization);
        let own = if floor > 0.0 {
            let per_hop = 2.0 * band.width_hz * hop_s;
            let ratio = LogRatio::new(
                per_hop * FALLING_SHARE * real(after),
                per_hop * real(before),
            );
            let mut ratios = mean_ratios(&band.energies, after, before, floor);
            ratio.apply(&mut ratios);
            ratios
        } else {
            vec![0.0; band.energies.len()]
        };
        let usual = quantile(&own[heard.clone()], USUAL_QUANTILE, copy);
        let scale = 1.0 / usual.max(1.0);
        Self {
            band,
            own,
            scale,
            after,
            floor,
        }
    }

    /// Adds `−weight·[n₁ ln E₁ + n₂ ln E₂]` for a change before each hop of a stretch.
    fn add_change_likelihood(&self, from: usize, to: usize, weight: f64, likelihood: &mut [f64]) {
        if self.floor <= 0.0 {
            return;
        }
        let energies = &self.band.energies[from..to];
        let loudest = energies.iter().copied().fold(0.0, f32::max);
        // In units of the floor every level is at least 1; the unit adds the same to all k.
        let unit = 1.0 / f64::from(self.floor.max(LEAKAGE * loudest));
        let total: f64 = energies.iter().copied().map(f64::from).sum();
        let count = real(energies.len());
        let (mut n1, mut before) = (0.0, 0.0);
        for (value, &energy) in likelihood.iter_mut().zip(energies) {
            if n1 > 0.0 {
                let n2 = count - n1;
                let e1 = narrow(before * unit / n1 + 1.0);
                let e2 = narrow((total - before).max(0.0) * unit / n2 + 1.0);
                *value -=
                    weight * (n1 * f64::from(ln_from_one(e1)) + n2 * f64::from(ln_from_one(e2)));
            }
            n1 += 1.0;
            before += f64::from(energy);
        }
    }
}

/// The formula of [`Evidence::of`] as a function of A/B alone.
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

    /// Puts the evidence in the place of the ratios.
    fn apply(self, ratios: &mut [f32]) {
        for ratio in ratios {
            let rise = ratio.max(1.0);
            let pooled = 1.0 + self.share_after * (rise - 1.0);
            let nats = self.half_values * ln_from_one(pooled) - self.half_after * ln_from_one(rise);
            *ratio = nats.max(0.0);
        }
    }
}

/// The value below which this share of the values lies; 0 of none. It is sought in a copy of them.
fn quantile(values: &[f32], share: f64, copy: &mut Vec<f32>) -> f32 {
    if values.is_empty() {
        return 0.0;
    }
    copy.clear();
    copy.extend_from_slice(values);
    let index = crate::units::whole(share * real(values.len() - 1));
    *copy.select_nth_unstable_by(index, f32::total_cmp).1
}

#[cfg(test)]
mod tests;
