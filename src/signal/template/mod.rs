//! The template: the sound that the impacts of a drop have in common, and how much they differ.

pub(crate) mod aligned;
pub(crate) mod average;
mod wiener;

use super::constant_fraction;
use super::interpolate::{KERNEL, slope};
use super::smooth::smoothed;
use crate::units::real;
use average::{half_means, mean_variances, sums, weighted_fit, weighted_mean, weights};
use wiener::Wiener;

/// Share of the template's energy that its head holds: the rest adds little information on the time.
const HEAD_SHARE: f64 = 0.95;
/// A template counts where its square, or its power around a frequency, exceeds its variance by this factor.
const CLEAR: f64 = 1.5;

/// The common sound of a drop's impacts: sample k of each component is `k − before` samples after the onset.
#[derive(Debug, Clone, Default)]
pub struct Template {
    /// `S_c`, of one length, less what is noise in them.
    pub(crate) components: Vec<Vec<f64>>,
    /// The same as they are heard.
    heard: Vec<Vec<f64>>,
    /// What the noise is taken out by; none where it is not known.
    wiener: Option<Wiener>,
    /// Samples that the filter, as it is now, is still to be taken to.
    unfiltered: usize,
    /// Variance of the difference between an impact of amplitude 1 and its template.
    pub(crate) misfit: Vec<f64>,
    pub(crate) before: usize,
    /// Samples that are matched.
    pub(crate) head: usize,
    /// The sound of each impact, where impacts differ by their speed.
    shapes: Vec<Vec<f64>>,
    /// The derivative of each, or of all, as far as the head.
    slopes: Vec<Vec<f64>>,
    /// Greatest of the smoothed squares of the mean from each sample on.
    tail: Vec<f64>,
    /// Variance of the mean.
    noise: Vec<f64>,
}

/// The sound of one impact, with its variance.
#[derive(Debug)]
pub(crate) struct Sample {
    pub amplitude: f64,
    pub contact_stretch: f64,
    /// Its sound, all others taken out.
    pub sound: Vec<f64>,
    /// Variance of that, misfit included, over the weights.
    pub noise: Vec<f64>,
    /// Weights, below 1 where more is heard than the impact.
    pub weights: Vec<f64>,
}

impl Template {
    /// A template of one component, with its variance; impacts are taken to be alike.
    pub(crate) fn new(mean: Vec<f64>, noise: Vec<f64>, before: usize) -> Self {
        let misfit = vec![0.0; mean.len()];
        let mut template = Self {
            components: vec![mean.clone()],
            heard: vec![mean],
            misfit,
            before,
            noise,
            ..Self::default()
        };
        template.measure(before / 8);
        template.learn_slopes(&[]);
        template
    }

    pub(crate) fn len(&self) -> usize {
        self.misfit.len()
    }

    /// S₀.
    pub(crate) fn mean(&self) -> &[f64] {
        &self.components[0]
    }

    /// The mean sound as far as it stands out of the noise in time; in frequency [`Wiener`] has seen to that. It buys little: of
    /// 301 recordings without it 11 lose some impacts and 7 gain some, two in a thousand in all.
    ///
    /// # Formula
    /// Each sample times `1 − n/s²`, or 0, for the power s² of the samples around it and the variance n of the mean there.
    pub(crate) fn audible(&self) -> Vec<f64> {
        let squares: Vec<f64> = self.heard[0].iter().map(|s| s * s).collect();
        let power = smoothed(&squares, self.before);
        let noise = smoothed(&self.noise, self.before);
        let held = power.into_iter().zip(noise);
        let held = held.map(|(power, noise)| (1.0 - noise / power.max(noise)).max(0.0));
        self.mean().iter().zip(held).map(|(s, h)| s * h).collect()
    }

    /// Onset of its sound, in samples after the nominal one: the constant fraction of its rise, of places between the samples
    /// too, since where it lies among these is chance.
    pub(crate) fn onset(&self, rate: f64) -> f64 {
        // As it is heard: a filter reaches before it.
        let heard = &self.heard[0];
        let begin = constant_fraction::between_samples(heard, self.before, rate);
        begin.map_or(0.0, |begin| begin - real(self.before))
    }

    /// The sound of impact `i` at amplitude 1.
    pub(crate) fn shape(&self, i: usize) -> &[f64] {
        self.shapes.get(i).unwrap_or(&self.components[0])
    }

    /// The head of that sound's derivative, per sample.
    pub(crate) fn slopes(&self, i: usize) -> &[f64] {
        let all_alike = self.slopes.first().map_or(&[][..], Vec::as_slice);
        self.slopes.get(i).map_or(all_alike, Vec::as_slice)
    }

    /// Samples that hold most of the template's energy, less what its own noise makes, where it stands out of that.
    fn head_length(&self) -> usize {
        let squares: Vec<f64> = self.heard[0].iter().map(|s| s * s).collect();
        let noise = smoothed(&self.noise, self.before);
        let known =
            smoothed(&squares, self.before)
                .into_iter()
                .zip(noise)
                .map(|(square, noise)| {
                    if square > CLEAR * noise {
                        square - noise
                    } else {
                        0.0
                    }
                });
        let known: Vec<f64> = known.collect();
        let total: f64 = known.iter().sum();
        let mut sum = 0.0;
        let held = known.iter().position(|s| {
            sum += s;
            sum >= HEAD_SHARE * total
        });
        held.map_or(self.len(), |k| k + 1)
            .clamp((2 * self.before).min(self.len()), self.len())
    }

    /// Samples after which an impact of an amplitude is not heard any more.
    pub(crate) fn sounding_length(&self, amplitude: f64) -> usize {
        let square = amplitude * amplitude;
        self.tail.partition_point(|t| square * t > INAUDIBLE)
    }

    /// Learns the first samples of all components anew from some impacts, as many samples as their sounds have;
    /// `contact_stretches` are those of all impacts.
    ///
    /// # Formula
    /// ```text
    /// S(t) minimises Σ_i w_i(t)·(x_i(t)/a_i − Σ_c u_iᶜ·S_c(t))²,   w_i(t) = a_i²/noise_i(t)
    /// ```
    pub(crate) fn learn_shape(&mut self, impacts: &[Sample], contact_stretches: &[f64]) {
        self.heard
            .resize(self.components.len(), vec![0.0; self.len()]);
        let length = impacts.first().map_or(0, |s| s.sound.len());
        let weights = weights(impacts);
        if self.components.len() == 1 {
            weighted_mean(impacts.iter().zip(&weights), &mut self.heard[0][..length]);
        } else {
            weighted_fit(impacts, &weights, &mut self.heard);
        }
        let changed = self.take_noise_out(length);
        if self.components.len() > 1 {
            self.learn_shapes(changed, contact_stretches);
        }
        self.learn_slopes(contact_stretches);
    }

    /// Learns how much impacts differ from the components, over as many samples as their sounds have; over all, its head too.
    pub(crate) fn learn_misfit(
        &mut self,
        impacts: &[Sample],
        contact_stretches: &[f64],
        smoothing: usize,
    ) {
        let length = impacts.first().map_or(0, |s| s.sound.len());
        let weights = weights(impacts);
        let (misfit, noise) = self.left_over(impacts, &weights);
        self.misfit[..length].copy_from_slice(&smoothed(&misfit, smoothing));
        self.noise[..length].copy_from_slice(&noise);
        if length == self.len() {
            self.measure(smoothing);
            self.learn_slopes(contact_stretches);
        }
    }

    /// Learns what is noise in it, from the impacts that it was learnt from.
    pub(crate) fn learn_noise(&mut self, impacts: &[Sample]) {
        let weights = weights(impacts);
        let variances = mean_variances(impacts, &weights);
        let head = &self.heard[0][..variances.len()];
        let halves = half_means(impacts, &weights);
        self.wiener = Some(Wiener::of(head, &halves, variances.iter().sum()));
        self.unfiltered = self.len();
    }

    /// Share of the noise in its slope that its filter leaves.
    pub(crate) fn slope_noise(&self) -> f64 {
        self.wiener.as_ref().map_or(1.0, Wiener::slope_noise)
    }

    /// What the components are of what is heard, where so many samples of that changed; gives how many of them did.
    fn take_noise_out(&mut self, changed: usize) -> usize {
        let Some(wiener) = &self.wiener else {
            self.components.clone_from(&self.heard);
            return changed;
        };
        let changed = (changed + wiener.reach()).max(self.unfiltered);
        let changed = changed.min(self.len());
        wiener.filter(&self.heard, changed, &mut self.components);
        self.unfiltered = 0;
        changed
    }

    /// The sound of each impact anew, up to where the components changed.
    fn learn_shapes(&mut self, changed: usize, contact_stretches: &[f64]) {
        let changed = if self.shapes.is_empty() {
            self.len()
        } else {
            changed
        };
        self.shapes
            .resize(contact_stretches.len(), vec![0.0; self.len()]);
        for (shape, &u) in self.shapes.iter_mut().zip(contact_stretches) {
            combine(&self.components, u, &mut shape[..changed]);
        }
    }

    /// The derivatives of the heads anew: a derivative of a sum is the sum of the derivatives.
    fn learn_slopes(&mut self, contact_stretches: &[f64]) {
        let (head, length) = (self.head, (self.head + KERNEL).min(self.len()));
        let slopes = self.components.iter().map(|c| {
            let mut slopes = slope(&c[..length]);
            slopes.truncate(head);
            slopes
        });
        let slopes: Vec<Vec<f64>> = slopes.collect();
        if let [_] = slopes[..] {
            self.slopes = slopes;
        } else {
            self.slopes.resize(contact_stretches.len(), Vec::new());
            for (own, &u) in self.slopes.iter_mut().zip(contact_stretches) {
                own.resize(head, 0.0);
                combine(&slopes, u, own);
            }
        }
    }

    /// Measures how long it is heard, and its head.
    fn measure(&mut self, smoothing: usize) {
        let squares: Vec<f64> = self.mean().iter().map(|s| s * s).collect();
        self.tail = smoothed(&squares, smoothing);
        let mut greatest: f64 = 0.0;
        for t in self.tail.iter_mut().rev() {
            greatest = greatest.max(*t);
            *t = greatest;
        }
        self.head = self.head_length();
    }

    /// Variance of the residuals above that of the known noise, for an amplitude of 1; and the variance of the mean that
    /// follows from them, `Σ w²·r²/a² / (Σ w)²`.
    ///
    /// The residual of an impact with the share h (leverage) in its own template is 1 − h of its difference.
    fn left_over(&self, impacts: &[Sample], weights: &[Vec<f64>]) -> (Vec<f64>, Vec<f64>) {
        let all = sums(weights);
        let (mut misfit, mut noise) = (vec![0.0; all.len()], vec![0.0; all.len()]);
        let mut powers = vec![f64::MIN_POSITIVE; all.len()];
        for (s, weights) in impacts.iter().zip(weights) {
            let square = s.amplitude * s.amplitude;
            let mut shape = vec![0.0; all.len()];
            combine(&self.components, s.contact_stretch, &mut shape);
            for t in 0..all.len() {
                let share = weights[t] / all[t];
                let left = s.sound[t] - s.amplitude * shape[t];
                let left = left * left / (1.0 - share.min(MOST_SHARE));
                let variance = s.noise[t] * s.weights[t];
                // Each tells the misfit as well as its own noise lets it.
                let weight = s.weights[t] * square / (variance * variance);
                misfit[t] += weight * (left - (variance - square * self.misfit[t]));
                powers[t] += weight * square;
                noise[t] += share * share * left / square;
            }
        }
        for (v, power) in misfit.iter_mut().zip(powers) {
            *v = (*v / power).max(0.0);
        }
        (misfit, noise)
    }
}

impl Sample {
    /// `a²/noise`: the information of the impact on the template.
    pub(crate) fn information(&self) -> Vec<f64> {
        let square = self.amplitude * self.amplitude;
        self.noise.iter().map(|n| square / n).collect()
    }
}

/// `Σ_c uᶜ·S_c` for components `S_c`, as far as it is wanted.
fn combine(components: &[Vec<f64>], contact_stretch: f64, sum: &mut [f64]) {
    sum.fill(0.0);
    for component in components.iter().rev() {
        for (s, c) in sum.iter_mut().zip(component) {
            *s = *s * contact_stretch + c;
        }
    }
}

/// Least power of a tail that is heard, noise being 1.
const INAUDIBLE: f64 = 0.02;

/// Greatest leverage that a residual is corrected for: an impact that is nearly all of its own template shows little of how
/// impacts differ.
pub(crate) const MOST_SHARE: f64 = 0.9;

#[cfg(test)]
mod tests;
