//! The rise of energy at an onset in one band: what all impacts have in common of it, learnt from them.

use super::bands::{AFTER_S, Band, FOOT_S, Window, Windows};
use super::focus::Focus;
use super::lesson::Lesson;
use crate::signal::logarithm::ln_from_one;
use crate::units::{real, samples_in};

/// Segments in which the rise is constant, …
const SEGMENTS: usize = 11;
/// … and their ends in seconds after the onset; the first begins at the foot. Convention: as long as a rise has details there.
const ENDS_S: [f64; SEGMENTS] = [
    -0.15e-3, 0.0, 0.06e-3, 0.12e-3, 0.2e-3, 0.3e-3, 0.45e-3, 0.7e-3, 1.1e-3, 1.7e-3, AFTER_S,
];
/// Those that lie before the onset.
const BEFORE: usize = 2;
/// Decay of the rise before any is seen, in seconds.
const DECAY_S: f64 = 0.6e-3;
/// Samples of the band's own noise that are added to each level: a level is never 0.
const NOISE_SAMPLES: f64 = 4.0;
/// Steps of scoring by which the size of a rise is found, each within these factors.
const SIZE_STEPS: usize = 3;
const SIZE_FACTORS: (f64, f64) = (0.3, 3.0);
/// Least size of a rise as a share of the level.
const LEAST_SIZE: f64 = 0.05;
/// Least rise before the onset and after it, of 1 at its greatest.
const LEAST_RISE: (f64, f64) = (1e-5, 1e-4);

/// The rise g in one band.
#[derive(Debug)]
pub(super) struct Rise {
    /// Ends of the segments in samples after the foot.
    ends: [usize; SEGMENTS],
    values: [f64; SEGMENTS],
    foot: usize,
}

/// What a band says of all impacts.
#[derive(Debug)]
pub(super) struct Likelihoods {
    /// κ of the band.
    pub kappa: f64,
    pub of: Vec<Likelihood>,
}

/// Log-likelihood with κ = 1 of each place of one impact's grid, and what fits there.
#[derive(Debug)]
pub(super) struct Likelihood {
    pub ln: Vec<f64>,
    pub fits: Vec<Fit>,
}

/// Size of a rise and the level before it, as variances.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fit {
    pub size: f64,
    pub level: f64,
}

/// Number and energy of the samples of each segment.
struct Segments {
    counts: [f64; SEGMENTS],
    energies: [f64; SEGMENTS],
}

impl Segments {
    /// For a foot at an index of the sums.
    fn at(sums: &[f64], foot: usize, ends: &[usize; SEGMENTS]) -> Self {
        let last = sums.len() - 1;
        let (mut counts, mut energies) = ([0.0; SEGMENTS], [0.0; SEGMENTS]);
        let mut from = foot;
        for (k, end) in ends.iter().enumerate() {
            let to = (foot + end).min(last);
            counts[k] = real(to - from);
            energies[k] = sums[to] - sums[from];
            from = to;
        }
        Self { counts, energies }
    }
}

impl Rise {
    /// The rise that is expected of an impact before any is seen.
    pub(super) fn expected(rate: f64) -> Self {
        let foot = samples_in(FOOT_S, rate);
        let mut last = 0;
        let ends = ENDS_S.map(|end| {
            last = samples_in(end + FOOT_S, rate).max(last);
            last
        });
        let mut from = -FOOT_S;
        let values = ENDS_S.map(|end| {
            let middle = 0.5 * (from + end);
            from = end;
            if middle < 0.0 {
                LEAST_RISE.1
            } else {
                (-middle / DECAY_S).exp()
            }
        });
        Self { ends, values, foot }
    }

    /// The likelihoods of all impacts.
    pub(super) fn likelihoods(&self, band: &Band, windows: &Windows) -> Likelihoods {
        let each = windows.of.iter().zip(&band.sums);
        let of = each.map(|(window, sums)| {
            let at = (0..=2 * window.reach).map(|place| {
                let onset = window.onset(place, windows);
                self.at((band.noise, window, sums), onset, None)
            });
            let (ln, fits) = at.unzip();
            Likelihood { ln, fits }
        });
        Likelihoods {
            kappa: band.kappa,
            of: of.collect(),
        }
    }

    /// The same at the places in focus, from the sizes that fitted before.
    pub(super) fn relook(
        &self,
        band: &Band,
        windows: &Windows,
        focus: &Focus,
        likelihoods: &mut Likelihoods,
    ) {
        let each = windows.of.iter().zip(&band.sums).zip(&focus.places);
        for (((window, sums), places), known) in each.zip(&mut likelihoods.of) {
            for place in places.clone() {
                let onset = window.onset(place, windows);
                let before = Some(known.fits[place].size);
                let (ln, fit) = self.at((band.noise, window, sums), onset, before);
                known.ln[place] = ln;
                known.fits[place] = fit;
            }
        }
    }

    /// Log-likelihood with κ = 1, and the fit, for an onset at an index of the sums, from the size that fitted before.
    fn at(
        &self,
        (noise, window, sums): (f64, &Window, &[f64]),
        onset: usize,
        before: Option<f64>,
    ) -> (f64, Fit) {
        let foot = onset - self.foot;
        let last = sums.len() - 1;
        let early = sums[foot] - sums[foot - window.before];
        let level = (early + NOISE_SAMPLES * noise) / (real(window.before) + NOISE_SAMPLES);
        let mut segments = Segments::at(sums, foot, &self.ends);
        // What is left of the window goes on at the last value.
        let end = (foot + self.ends[SEGMENTS - 1]).min(last);
        segments.counts[SEGMENTS - 1] += real(last - end);
        segments.energies[SEGMENTS - 1] += sums[last] - sums[end];
        let size = self.size(level, &segments, before);
        let mut logs = [0.0; SEGMENTS];
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a logarithm needs no more than an f32"
        )]
        for (log, value) in logs.iter_mut().zip(&self.values) {
            *log = ln_from_one((1.0 + size * value / level) as f32);
        }
        let mut ln = real(last) * level.ln() + sums[foot] / level;
        let inverses = self.inverses(level, size);
        for (k, log) in logs.iter().enumerate() {
            ln += segments.counts[k] * f64::from(*log) + segments.energies[k] * inverses[k];
        }
        (-0.5 * ln, Fit { size, level })
    }

    /// Inverse variances of the segments.
    fn inverses(&self, level: f64, size: f64) -> [f64; SEGMENTS] {
        self.values.map(|value| 1.0 / (level + size * value))
    }

    /// The size of greatest likelihood, by Fisher's scoring: from the one before a step, as rounds go on, and otherwise from
    /// the energy above the level.
    fn size(&self, level: f64, segments: &Segments, before: Option<f64>) -> f64 {
        if let Some(before) = before {
            return self.scored(level, segments, before);
        }
        let Segments { counts, energies } = segments;
        let count: f64 = counts.iter().sum();
        let weight: f64 = counts.iter().zip(&self.values).map(|(n, g)| n * g).sum();
        let above = energies.iter().sum::<f64>() - level * count;
        let first = above.max(LEAST_SIZE * level * count) / weight;
        (0..SIZE_STEPS).fold(first, |size, _| self.scored(level, segments, size))
    }

    /// One step of scoring.
    fn scored(&self, level: f64, segments: &Segments, size: f64) -> f64 {
        let inverses = self.inverses(level, size);
        let (mut gradient, mut information) = (0.0, 0.0);
        for (k, inverse) in inverses.iter().enumerate() {
            let weight = self.values[k] * inverse;
            gradient += weight * (segments.energies[k] * inverse - segments.counts[k]);
            information += segments.counts[k] * weight * weight;
        }
        let (least, most) = (SIZE_FACTORS.0 * size, SIZE_FACTORS.1 * size);
        (size + gradient / information).clamp(least, most)
    }

    /// Samples from the foot to the end.
    pub(super) fn length(&self) -> usize {
        self.ends[SEGMENTS - 1]
    }

    /// Learns the rise from what all impacts teach, as it is from this many samples after its foot on: a share of the way.
    pub(super) fn learn(&mut self, lesson: &Lesson, after: f64, share: f64) {
        let mut learnt = self.values;
        let mut from = after;
        for (value, end) in learnt.iter_mut().zip(self.ends) {
            let to = real(end) + after;
            if let Some(mean) = lesson.mean(from, to) {
                *value = mean.max(0.0);
            }
            from = to;
        }
        let greatest = learnt.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        for (k, (value, learnt)) in self.values.iter_mut().zip(learnt).enumerate() {
            let least = if k < BEFORE {
                LEAST_RISE.0
            } else {
                LEAST_RISE.1
            };
            let learnt = (learnt / greatest).max(least);
            *value = value.powf(1.0 - share) * learnt.powf(share);
        }
    }
}
