//! Times and template in turn.

use super::place::best;
use super::spread::likenesses;
use super::{Joint, ROUNDS, SEARCHES};
use crate::signal::interpolate::{KERNEL, shifted};
use crate::signal::smooth::smoothed;
use crate::signal::template::Sample;
use crate::units::{real, samples_in, whole};

/// Smoothing of the misfit, either way, in seconds.
const MISFIT_S: f64 = 0.1e-3;
/// What nothing explains is judged over this time either way, in seconds, and stands out by this factor.
const KNOCK_S: f64 = 1e-3;
const KNOCK: f64 = 4.0;
/// Farthest that a match moves in one step, in samples.
const STEP: f64 = 1.0;
/// Variance of what was not recorded.
const UNKNOWN: f64 = 1e30;
/// The prior on a time reaches this many standard deviations.
pub(super) const PRIOR_REACH: f64 = 4.0;

impl Joint {
    /// Settles times and template in turn, `searches` rounds with jumps and as many more without as `rounds`.
    pub(super) fn settle(&mut self, searches: usize, rounds: usize) {
        for round in 0..searches + rounds {
            if round == searches && searches > 0 {
                self.learn_whole();
            }
            let jump = round < searches;
            if jump && round > 0 {
                // Likelihoods of places are only as far apart as samples err independently.
                let likenesses = likenesses(self);
                for (impact, likeness) in self.impacts.iter_mut().zip(likenesses) {
                    impact.likeness = likeness;
                }
            }
            let count = self.impacts.len();
            let heads = (0..count)
                .map(|i| self.settled(i, jump))
                .collect::<Vec<_>>();
            self.learn(&heads);
            for (i, head) in heads.iter().enumerate() {
                self.impacts[i].knocks = self.knocks(i, head);
            }
        }
    }

    /// The usual number of rounds.
    pub(super) fn settle_whole(&mut self) {
        self.settle(SEARCHES, ROUNDS);
    }

    fn settled(&mut self, i: usize, jump: bool) -> Sample {
        if jump {
            self.search(i);
        }
        self.step(i)
    }

    fn learn(&mut self, samples: &[Sample]) {
        let slownesses: Vec<f64> = self.impacts.iter().map(|i| i.slowness).collect();
        let smoothing = samples_in(MISFIT_S, self.rate);
        self.template.learn(samples, &slownesses, smoothing);
    }

    /// Learns the whole template from those impacts that sound alone, or from all if they are too few.
    pub(super) fn learn_whole(&mut self) {
        let length = self.template.len();
        let apart = real(length + self.template.before);
        let position = |i: usize| self.impacts[i].position;
        let alone = |&i: &usize| {
            let before = i
                .checked_sub(1)
                .is_none_or(|j| position(i) - position(j) > apart);
            before && (i + 1 == self.impacts.len() || position(i + 1) - position(i) > apart)
        };
        let mut of: Vec<usize> = (0..self.impacts.len()).filter(alone).collect();
        if of.len() < FEWEST_ALONE {
            of = (0..self.impacts.len()).collect();
        }
        let samples: Vec<Sample> = of.into_iter().map(|i| self.sample(i, length)).collect();
        self.learn(&samples);
    }

    /// The power that nothing explains in the sound of an impact, where it stands out.
    fn knocks(&self, i: usize, head: &Sample) -> Vec<f64> {
        let reach = samples_in(KNOCK_S, self.rate);
        let shape = self.template.shape(i);
        let left = head
            .sound
            .iter()
            .zip(shape)
            .map(|(x, s)| (x - head.amplitude * s).powi(2));
        let known = smoothed(&self.noise(self.begin(i), head.sound.len(), None), reach);
        let mut knocks = smoothed(&left.collect::<Vec<f64>>(), reach);
        for (knock, known) in knocks.iter_mut().zip(known) {
            if *knock < KNOCK * known {
                *knock = 0.0;
            }
        }
        knocks
    }

    /// Where the window of an impact begins, in samples of the stretch.
    fn begin(&self, i: usize) -> f64 {
        self.impacts[i].position - real(self.template.before)
    }

    /// Takes the sounds of all other impacts out of samples that begin at a position.
    fn take_out_others(&self, i: usize, begin: f64, samples: &mut [f64]) {
        for (j, other) in self.impacts.iter().enumerate() {
            let offset = begin - self.begin(j);
            let heard = self.template.sounding_length(other.amplitude);
            let overlaps = offset < real(heard) && offset + real(samples.len() + KERNEL) > 0.0;
            if j != i && overlaps {
                // From its first sample to its last, as far as they are among these.
                let skip = whole((-offset).floor()).saturating_sub(KERNEL);
                let last = whole((real(heard) - offset).ceil()).min(samples.len());
                let (from, count) = (offset + real(skip), last.saturating_sub(skip));
                let sounding = shifted(self.template.shape(j), from, count);
                for (x, s) in samples[skip.min(last)..].iter_mut().zip(sounding) {
                    *x -= other.amplitude * s;
                }
            }
        }
    }

    /// The sound from so many samples before each impact on, the others taken out.
    pub(super) fn surroundings(&self, before: usize, length: usize) -> Vec<Vec<f64>> {
        let around = |i: usize| {
            let begin = self.impacts[i].position - real(before);
            let mut sound = shifted(&self.sound, begin, length);
            self.take_out_others(i, begin, &mut sound);
            sound
        };
        (0..self.impacts.len()).map(around).collect()
    }

    /// What all impacts leave of the sound that begins so many samples before the window of an impact, and its variance;
    /// none where the impact before still rings or nothing was recorded.
    pub(super) fn before(
        &self,
        i: usize,
        back: f64,
        length: usize,
    ) -> Option<(Vec<f64>, Vec<f64>)> {
        let begin = self.begin(i) - back;
        let heard = |j: usize| real(self.template.sounding_length(self.impacts[j].amplitude));
        let quiet = i
            .checked_sub(1)
            .is_none_or(|j| self.begin(j) + heard(j) < begin);
        if begin < 0.0 || !quiet {
            return None;
        }
        let sound = shifted(&self.sound, begin, length);
        Some((sound, self.noise(begin, length, None)))
    }

    /// Variance at samples from a position on: noise, and the misfit of all impacts, or of all but one.
    fn noise(&self, begin: f64, length: usize, without: Option<usize>) -> Vec<f64> {
        let mut noise = vec![UNKNOWN; length];
        let first = begin.round();
        let (skip, from) = (whole(-first), whole(first));
        let recorded = self.sound.len().saturating_sub(from);
        for n in noise.iter_mut().skip(skip).take(recorded) {
            *n = 1.0;
        }
        for (j, other) in self.impacts.iter().enumerate() {
            let offset = (begin - self.begin(j)).round();
            let misfit = &self.template.misfit;
            if Some(j) == without || offset >= real(misfit.len()) || offset + real(length) <= 0.0 {
                continue;
            }
            let (skip, from) = (whole(-offset), whole(offset));
            let square = other.amplitude * other.amplitude;
            for (n, v) in noise[skip..].iter_mut().zip(&misfit[from..]) {
                *n += square * v;
            }
        }
        noise
    }

    /// Puts an impact where it fits best within its reach, in what the others leave.
    fn search(&mut self, i: usize) {
        let impact = &self.impacts[i];
        let (head, reach) = (self.template.head, impact.reach() + KERNEL);
        let begin = impact.coarse.round() - real(self.template.before + reach);
        let mut samples = shifted(&self.sound, begin, head + 2 * reach);
        self.take_out_others(i, begin, &mut samples);
        let noise = self.noise(begin, samples.len(), Some(i));
        let shape = &self.template.shape(i)[..head];
        let coarse = impact.coarse - begin - real(self.template.before);
        let prior = (coarse, impact.jitter);
        let found = best(
            &mut self.correlator,
            (&samples, &noise),
            shape,
            prior,
            (reach, impact.likeness),
        );
        if let Some(fit) = found {
            let impact = &mut self.impacts[i];
            impact.position = begin + fit.position + real(self.template.before);
            impact.amplitude = fit.amplitude;
            impact.doubt = fit.doubt;
        }
    }

    /// One step towards the best amplitude and time of an impact, by weighted least squares; gives its sound as it then
    /// stands.
    ///
    /// # Formula
    /// `x = a·s − a·δ·ds/dt` with weights `1/noise`, solved for a and δ.
    fn step(&mut self, i: usize) -> Sample {
        let head = self.template.head;
        let begin = self.begin(i);
        let mut wide = shifted(&self.sound, begin - real(KERNEL), head + 2 * KERNEL);
        self.take_out_others(i, begin - real(KERNEL), &mut wide);
        let noise = self.noise_and_knocks(i, head);
        let (shape, slopes) = (self.template.shape(i), self.template.slopes(i));
        let normal = Normal::of(&wide[KERNEL..KERNEL + head], &noise, shape, slopes);
        let impact = &mut self.impacts[i];
        let (amplitude, moved, _) = normal.solve(impact.amplitude);
        impact.amplitude = amplitude.max(LEAST_AMPLITUDE * impact.amplitude);
        let moved = moved.clamp(-STEP, STEP);
        impact.position += moved;
        Sample {
            amplitude: impact.amplitude,
            slowness: impact.slowness,
            sound: shifted(&wide, real(KERNEL) + moved, head),
            noise,
        }
    }

    /// Noise at the samples of an impact, with what nothing explains.
    fn noise_and_knocks(&self, i: usize, length: usize) -> Vec<f64> {
        let mut noise = self.noise(self.begin(i), length, None);
        for (n, k) in noise.iter_mut().zip(&self.impacts[i].knocks) {
            *n += k;
        }
        noise
    }

    /// The sound of an impact as it stands, the others taken out.
    pub(super) fn sample(&self, i: usize, length: usize) -> Sample {
        let begin = self.begin(i);
        let mut sound = shifted(&self.sound, begin, length);
        self.take_out_others(i, begin, &mut sound);
        Sample {
            amplitude: self.impacts[i].amplitude,
            slowness: self.impacts[i].slowness,
            sound,
            noise: self.noise_and_knocks(i, length),
        }
    }
}

/// Fewest impacts that the whole template is learnt from alone.
const FEWEST_ALONE: usize = 4;

/// An amplitude falls at most to this share in one step: it never vanishes or turns round.
const LEAST_AMPLITUDE: f64 = 0.1;

/// Sums of the weighted least squares for amplitude and time.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Normal {
    shape_shape: f64,
    shape_slope: f64,
    slope_slope: f64,
    shape_sound: f64,
    slope_sound: f64,
}

impl Normal {
    /// Sums over the samples of a sound.
    pub(super) fn of(sound: &[f64], noise: &[f64], shape: &[f64], slopes: &[f64]) -> Self {
        let mut sums = Self::default();
        for (((x, n), s), d) in sound.iter().zip(noise).zip(shape).zip(slopes) {
            let w = 1.0 / n;
            sums.shape_shape += w * s * s;
            sums.shape_slope += w * s * d;
            sums.slope_slope += w * d * d;
            sums.shape_sound += w * s * x;
            sums.slope_sound += w * d * x;
        }
        sums
    }

    /// Amplitude, time after the present one and its standard error, in samples.
    pub(super) fn solve(&self, amplitude: f64) -> (f64, f64, f64) {
        let determinant = self.shape_shape * self.slope_slope - self.shape_slope.powi(2);
        if determinant <= 0.0 || amplitude <= 0.0 {
            return (amplitude, 0.0, f64::INFINITY);
        }
        let size = (self.slope_slope * self.shape_sound - self.shape_slope * self.slope_sound)
            / determinant;
        let lean = (self.shape_shape * self.slope_sound - self.shape_slope * self.shape_sound)
            / determinant;
        let std = (self.shape_shape / determinant).sqrt() / amplitude;
        (size, -lean / amplitude, std)
    }

    /// What the samples tell of time for an amplitude of 1, the amplitude being unknown.
    pub(super) fn slope_information(&self) -> f64 {
        self.slope_slope - self.shape_slope.powi(2) / self.shape_shape
    }

    /// An amplitude in standard deviations of the noise.
    pub(super) fn clearness(&self, amplitude: f64) -> f64 {
        amplitude * self.shape_shape.sqrt()
    }

    /// How strongly each sample of the sound pulls the time, in samples of time, for an amplitude.
    pub(super) fn pull(&self, amplitude: f64, shape: f64, slope: f64, noise: f64) -> f64 {
        let determinant = self.shape_shape * self.slope_slope - self.shape_slope.powi(2);
        if determinant <= 0.0 {
            return 0.0;
        }
        (self.shape_slope * shape - self.shape_shape * slope) / (noise * determinant * amplitude)
    }
}
