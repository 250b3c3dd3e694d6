//! The rise of energy at an onset in one band: what all impacts have in common of it, learnt from them.

use super::bands::{AFTER_S, Band, FOOT_S, Window, Windows};
use super::focus::Focus;
use super::fusion::Posterior;
use crate::signal::logarithm::ln_from_one;
use crate::units::{real, samples_in};

/// Segments in which the rise is constant, …
const SEGMENTS: usize = 11;
/// … and their ends in seconds after the onset; the first begins at the foot. Convention: as long as a rise has details there.
const ENDS_S: [f64; SEGMENTS] = [
    -0.15e-3, 0.0, 0.06e-3, 0.12e-3, 0.2e-3, 0.3e-3, 0.45e-3, 0.7e-3, 1.1e-3, 1.7e-3, AFTER_S,
];
/// Those that lie before the onset, and those whose scatter tells how many samples err together: a millisecond.
const BEFORE: usize = 2;
const EARLY: usize = 9;
/// Decay of the rise before any is seen, in seconds, and κ then, and its bounds.
const DECAY_S: f64 = 0.6e-3;
const KAPPA: f64 = 0.2;
const KAPPAS: (f64, f64) = (0.02, 1.0);
/// Samples of the band's own noise that are added to each level: a level is never 0.
const NOISE_SAMPLES: f64 = 4.0;
/// Steps of scoring by which the size of a rise is found, each within these factors.
const SIZE_STEPS: usize = 3;
const SIZE_FACTORS: (f64, f64) = (0.3, 3.0);
/// Least size of a rise as a share of the level.
const LEAST_SIZE: f64 = 0.05;
/// Places below this share of an impact's posterior teach nothing.
const LEAST_SHARE: f64 = 0.01;
/// A level of this share of a size halves what an impact teaches.
const CLEAR: f64 = 0.3;
/// An onset that is known this well counts half, in seconds.
const CERTAIN_S: f64 = 0.1e-3;
/// Least rise before the onset and after it, of 1 at its greatest.
const LEAST_RISE: (f64, f64) = (1e-5, 1e-4);
/// Greatest energy of a segment over its variance that counts: more is another sound.
const MOST: f64 = 6.0;

/// The rise g in one band.
#[derive(Debug)]
pub(super) struct Rise {
    /// Ends of the segments in samples after the foot.
    ends: [usize; SEGMENTS],
    values: [f64; SEGMENTS],
    kappa: f64,
    foot: usize,
    /// [`CERTAIN_S`] in samples.
    certain: f64,
}

/// What a band says of all impacts.
#[derive(Debug)]
pub(super) struct Likelihoods {
    pub kappa: f64,
    pub of: Vec<Likelihood>,
}

/// Log-likelihood with κ = 1 of each place of one impact's grid, and what fits there.
#[derive(Debug)]
pub(super) struct Likelihood {
    pub ln: Vec<f64>,
    fits: Vec<Fit>,
}

/// Size of a rise and the level before it, as variances.
#[derive(Debug, Clone, Copy)]
struct Fit {
    size: f64,
    level: f64,
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
        Self {
            ends,
            values,
            kappa: KAPPA,
            foot,
            certain: CERTAIN_S * rate,
        }
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
            kappa: self.kappa,
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
        likelihoods.kappa = self.kappa;
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

    /// Learns the rise and κ from all impacts, each over its likely places (expectation and maximisation).
    ///
    /// # Formula
    /// `κ = 2/(m·var)`, the variance of means of m values of x²/V, over that of independent ones.
    pub(super) fn learn(
        &mut self,
        band: &Band,
        likelihoods: &Likelihoods,
        windows: &Windows,
        now: &[Posterior],
    ) {
        let mut lesson = Lesson::default();
        for (((l, w), sums), posterior) in
            (likelihoods.of.iter().zip(&windows.of).zip(&band.sums)).zip(now)
        {
            let sure = 1.0 / (1.0 + (posterior.std / self.certain).powi(2));
            let likely = posterior.p.iter().enumerate();
            for (place, &p) in likely.filter(|(_, p)| **p > LEAST_SHARE) {
                let foot = w.onset(place, windows) - self.foot;
                let segments = Segments::at(sums, foot, &self.ends);
                lesson.add(&segments, l.fits[place], &self.values, (p, sure));
            }
        }
        // Half of the way: more certain places make a steeper rise and the other way round.
        if let Some(kappa) = lesson.kappa() {
            self.kappa = (self.kappa * kappa.clamp(KAPPAS.0, KAPPAS.1)).sqrt();
        }
        let learnt = lesson.rise(&self.values);
        for (value, learnt) in self.values.iter_mut().zip(learnt) {
            *value = (*value * learnt).sqrt();
        }
    }
}

/// What impacts teach: sums over their likely places.
#[derive(Default)]
struct Lesson {
    above: [f64; SEGMENTS],
    weights: [f64; SEGMENTS],
    /// Of the means of x²/V: count, sum, sum of squares and number of samples.
    scatter: [f64; 4],
}

impl Lesson {
    /// Adds a place, by its probability and how sure the onset is.
    fn add(
        &mut self,
        segments: &Segments,
        fit: Fit,
        values: &[f64; SEGMENTS],
        (p, sure): (f64, f64),
    ) {
        let weight = p * sure / (fit.level / fit.size + CLEAR);
        for (k, value) in values.iter().enumerate() {
            let (count, energy) = (segments.counts[k], segments.energies[k]);
            self.above[k] += weight * (energy - fit.level * count) / fit.size;
            self.weights[k] += weight * count;
            if count > 0.0 && k < EARLY {
                let mean = (energy / count / (fit.level + fit.size * value)).min(MOST);
                let sums = [p, p * mean, p * mean * mean, p * count];
                for (sum, x) in self.scatter.iter_mut().zip(sums) {
                    *sum += x;
                }
            }
        }
    }

    fn kappa(&self) -> Option<f64> {
        let [count, sum, squares, samples] = self.scatter;
        let variance = squares / count - (sum / count).powi(2);
        (variance > 0.0).then(|| 2.0 * count / (samples * variance))
    }

    /// The rise, 1 at its greatest; as before where nothing was heard.
    fn rise(&self, before: &[f64; SEGMENTS]) -> [f64; SEGMENTS] {
        let mut values = *before;
        for (k, value) in values.iter_mut().enumerate() {
            if self.weights[k] > 0.0 {
                *value = (self.above[k] / self.weights[k]).max(0.0);
            }
        }
        let greatest = values.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        for (k, value) in values.iter_mut().enumerate() {
            let least = if k < BEFORE {
                LEAST_RISE.0
            } else {
                LEAST_RISE.1
            };
            *value = (*value / greatest).max(least);
        }
        values
    }
}
