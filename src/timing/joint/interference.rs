//! Interference at an impact: the other impacts, the misfit of single impacts, and the power that neither explains.

use super::alternate::Joint;
use crate::signal::interpolate::{KERNEL, shifted};
use crate::signal::smooth::smoothed;
use crate::signal::template::Sample;
use crate::units::{real, samples_in, whole};

/// The power that is left is judged over this time either way, in seconds, and stands out by about this factor: of the few
/// independent values in that time the mean is seldom twice too large by chance.
pub(super) const JUDGED_S: f64 = 1e-3;
const STANDS_OUT: f64 = 4.0;
/// Variance of samples that were not recorded.
pub(super) const UNKNOWN: f64 = 1e30;

impl Joint<'_> {
    /// Weights of the samples of an impact: 1 where the residual is as large as it should be, less where it is larger.
    ///
    /// # Formula
    /// `1/w = 1 + z·z²/(z² + z₀²)` for the mean z of r²/V around the sample: what stands out is noise of its power.
    pub(super) fn weights_of(&self, i: usize, head: &Sample) -> Vec<f64> {
        let reach = samples_in(JUDGED_S, self.started.rate);
        let shape = self.template.shape(i);
        let left = head.sound.iter().zip(shape).zip(&head.noise);
        let left = left.map(|((x, s), n)| (x - head.amplitude * s).powi(2) / n);
        let means = smoothed(&left.collect::<Vec<f64>>(), reach);
        let weight = |z: f64| (1.0 + z.powi(3) / (z * z + STANDS_OUT * STANDS_OUT)).recip();
        means.into_iter().map(weight).collect()
    }

    /// Begin of the window of an impact, in samples of the stretch.
    pub(super) fn begin(&self, i: usize) -> f64 {
        self.places[i].position - real(self.template.before)
    }

    /// Takes the sounds of all other impacts out of samples that begin at a position.
    pub(super) fn take_out_others(&self, i: usize, begin: f64, samples: &mut [f64]) {
        let longest = self.template.len();
        for (j, other) in self.places.iter().enumerate() {
            let offset = begin - self.begin(j);
            let near = offset < real(longest) && offset + real(samples.len() + KERNEL) > 0.0;
            if j == i || !near {
                continue;
            }
            let heard = self.template.sounding_length(other.amplitude);
            if offset < real(heard) {
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

    /// The sound that begins `back` samples before the window of an impact, and its variance; none where the impact before
    /// still rings or nothing was recorded.
    pub(super) fn before(
        &self,
        i: usize,
        back: f64,
        length: usize,
    ) -> Option<(Vec<f64>, Vec<f64>)> {
        let begin = self.begin(i) - back;
        let heard = |j: usize| real(self.template.sounding_length(self.places[j].amplitude));
        let quiet = i
            .checked_sub(1)
            .is_none_or(|j| self.begin(j) + heard(j) < begin);
        if begin < 0.0 || !quiet {
            return None;
        }
        let sound = shifted(&self.started.sound, begin, length);
        Some((sound, self.noise(begin, length, None)))
    }

    /// Variance at samples from a position on: noise, and the misfit of all impacts, or of all but one. Endless where the next
    /// impact is expected, which is in no template's place.
    pub(super) fn noise(&self, begin: f64, length: usize, without: Option<usize>) -> Vec<f64> {
        let mut noise = vec![UNKNOWN; length];
        let first = begin.round();
        let (skip, from) = (whole(-first), whole(first));
        let heard = real(self.started.sound.len()).min(self.started.next);
        for n in noise
            .iter_mut()
            .skip(skip)
            .take(whole(heard).saturating_sub(from))
        {
            *n = 1.0;
        }
        for (j, other) in self.places.iter().enumerate() {
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

    /// The sound of an impact as it stands, the others taken out, with the noise that is held for its head.
    pub(super) fn sample(&self, i: usize, length: usize) -> Sample {
        let begin = self.begin(i);
        let mut sound = shifted(&self.started.sound, begin, length);
        self.take_out_others(i, begin, &mut sound);
        let held = self.noise[i].len().min(length);
        let mut noise = self.noise[i][..held].to_vec();
        if held < length {
            noise.extend_from_slice(&self.noise(begin, length, None)[held..]);
        }
        let mut weights = self.weights[i].clone();
        weights.resize(length, 1.0);
        Sample {
            amplitude: self.places[i].amplitude,
            contact_stretch: self.started.contact_stretches[i],
            sound,
            noise,
            weights,
        }
    }
}
