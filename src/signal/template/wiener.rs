//! What of a template is sound: Wiener's filter.
//!
//! The mean of a dozen sounds holds a dozenth of their noise, at all frequencies. Matched by it as it is, a thud is timed by the
//! noise of the loudest impact, which matches nothing so well as itself: its times are right to what the noise says, off by
//! twenty times that, and slow to come to rest.

use std::sync::Arc;

use rustfft::num_complex::Complex;

use super::CLEAR;
use crate::signal::fourier::{Fourier, Workspace};
use crate::signal::interpolate::padded;
use crate::units::{real, whole};

/// The power at a frequency is that of the frequencies around it, this share of it either way, and as many lines of the
/// spectrum at least (convention).
const AROUND: f64 = 0.1;
const LINES: f64 = 3.0;

/// Gains by frequency of a template, between 0 and 1.
#[derive(Debug, Clone)]
pub(super) struct Wiener {
    /// Of all lines of a spectrum, the negative frequencies after the positive ones.
    gains: Vec<f64>,
    /// How far it reaches either way, in samples: half of the sound that it was learnt from, since the power of that changes no
    /// faster with the frequency, and is smoothed.
    reach: usize,
    fourier: Arc<Fourier>,
}

impl Wiener {
    /// Learnt from the head of a template, the heads of its halves, each the mean of half of the impacts, and the energy of
    /// white noise in it.
    ///
    /// # Formula
    /// `1 − N/P(f)` for the power P around a frequency, or 0 where no sound stands out of N. That is the noise at each, or what
    /// the halves do not have in common there, `P − Re ⟨A·B*⟩`, whichever is less: where the recorder turns itself down while
    /// it is loud there is less noise in a sound than before it, and impacts that are not yet aligned differ by more.
    pub(super) fn of(head: &[f64], halves: &[Vec<f64>; 2], noise: f64) -> Self {
        let reach = head.len() / 2 + 1;
        let fourier = Fourier::of((head.len() + 2 * reach).next_power_of_two());
        let size = fourier.len();
        let half = size / 2 + 1;
        let whole_head = fourier.spectrum(head);
        let [a, b] = halves.each_ref().map(|mean| fourier.spectrum(mean));
        let powers = summed(whole_head[..half].iter().map(Complex::norm_sqr));
        let common = summed(a[..half].iter().zip(&b).map(|(a, b)| (a * b.conj()).re));
        let lines = LINES * real(size) / real(head.len().max(1));
        let gain = |k: usize| {
            let reach = whole((AROUND * real(k)).max(lines));
            let (from, to) = (k.saturating_sub(reach), (k + reach + 1).min(half));
            let around = |sums: &[f64]| (sums[to] - sums[from]) / real(to - from);
            let power = around(&powers);
            let noise = noise.min((power - around(&common)).max(0.0));
            if power > CLEAR * noise {
                1.0 - noise / power
            } else {
                0.0
            }
        };
        let mut gains: Vec<f64> = (0..half).map(gain).collect();
        gains.extend((1..size - half + 1).rev().map(gain));
        Self {
            gains,
            reach,
            fourier: Arc::new(fourier),
        }
    }

    /// Makes so many samples of each sequence what is heard less what is noise in it, in stretches that overlap.
    pub(super) fn filter(&self, heard: &[Vec<f64>], length: usize, filtered: &mut [Vec<f64>]) {
        let (size, reach) = (self.fourier.len(), self.reach);
        let step = size - 2 * reach;
        let starts = |c| (0..length).step_by(step).map(move |start| (c, start));
        let stretches: Vec<(usize, usize)> = (0..heard.len()).flat_map(starts).collect();
        let around = |&(c, start): &(usize, usize)| {
            let first = start.cast_signed() - reach.cast_signed();
            padded(&heard[c], first, size)
        };
        let mut work = Workspace::default();
        for pair in stretches.chunks(2) {
            let sounds = pair.iter().map(around).collect::<Vec<_>>();
            let other = sounds.get(1).map_or(&[][..], Vec::as_slice);
            let both = self
                .fourier
                .filtered(&sounds[0], other, &self.gains, &mut work);
            let parts: [fn(&Complex<f64>) -> f64; 2] = [|z| z.re, |z| z.im];
            for (&(c, start), part) in pair.iter().zip(parts) {
                let end = (start + step).min(length);
                for (x, z) in filtered[c][start..end].iter_mut().zip(&both[reach..]) {
                    *x = part(z);
                }
            }
        }
    }

    /// Samples after the last one that changed in which it changes anything.
    pub(super) fn reach(&self) -> usize {
        self.reach
    }

    /// Share of the variance of the slope of white noise that the filter leaves: `Σ f²·g² / Σ f²`.
    pub(super) fn slope_noise(&self) -> f64 {
        let half = self.gains.len() / 2 + 1;
        let squares = (0..half).map(|k| real(k) * real(k));
        let left = squares.clone().zip(&self.gains).map(|(f, g)| f * g * g);
        left.sum::<f64>() / squares.sum::<f64>()
    }
}

/// The sum of the values before each, and of all.
fn summed(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let sums = values.scan(0.0, |sum, value| {
        *sum += value;
        Some(*sum)
    });
    std::iter::once(0.0).chain(sums).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    const LENGTH: usize = 4_000;

    /// A tone of a thousandth of the sampling rate that decays, and two of it in noise of variance 2.
    fn tone_in_noise() -> (Vec<f64>, [Vec<f64>; 2]) {
        let mut rng = SplitMix64::new(11);
        let tone = (0..LENGTH).map(|t| {
            let phase = 1e-3 * std::f64::consts::TAU * real(t);
            30.0 * (-real(t) / 1_500.0).exp() * phase.sin()
        });
        let tone: Vec<f64> = tone.collect();
        let halves = [0, 1].map(|_| {
            let noisy = tone.iter().map(|s| s + 2.0_f64.sqrt() * rng.normal());
            noisy.collect()
        });
        (tone, halves)
    }

    fn mean([a, b]: &[Vec<f64>; 2]) -> Vec<f64> {
        a.iter().zip(b).map(|(a, b)| 0.5 * (a + b)).collect()
    }

    fn filtered(wiener: &Wiener, sound: &[f64]) -> Vec<f64> {
        let mut filtered = [vec![0.0; sound.len()]];
        wiener.filter(&[sound.to_vec()], sound.len(), &mut filtered);
        let [filtered] = filtered;
        filtered
    }

    #[test]
    fn a_tone_stays_and_the_noise_around_it_goes() {
        let (tone, halves) = tone_in_noise();
        let noisy = mean(&halves);
        let wiener = Wiener::of(&noisy, &halves, real(LENGTH));
        let filtered = filtered(&wiener, &noisy);
        let square_off = |of: &[f64]| -> f64 {
            let off = of.iter().zip(&tone).map(|(x, s)| (x - s).powi(2));
            off.sum::<f64>() / real(LENGTH)
        };
        let (before, after) = (square_off(&noisy), square_off(&filtered));
        assert!(after < 0.05 * before, "{before} to {after}");
        assert!(wiener.slope_noise() < 0.05, "{}", wiener.slope_noise());
    }

    #[test]
    fn stretches_join_and_components_do_not_mix() {
        let (tone, halves) = tone_in_noise();
        let (noisy, head) = (mean(&halves), 500);
        let heads = halves.each_ref().map(|half| half[..head].to_vec());
        let wiener = Wiener::of(&noisy[..head], &heads, real(head));
        let alone = [filtered(&wiener, &noisy), filtered(&wiener, &tone)];
        let mut both = [vec![0.0; LENGTH], vec![0.0; LENGTH]];
        wiener.filter(&[noisy.clone(), tone], LENGTH, &mut both);
        for (a, b) in both.iter().flatten().zip(alone.iter().flatten()) {
            assert!((a - b).abs() < 1e-9, "{a} {b}");
        }
        // From the middle of what was the second stretch, all is as it was.
        let later = filtered(&wiener, &noisy[1_000..]);
        for (a, b) in later[head..].iter().zip(&alone[0][1_000 + head..]) {
            assert!((a - b).abs() < 0.1, "{a} {b}");
        }
    }

    #[test]
    fn what_halves_have_in_common_stays_whatever_the_noise_and_all_that_is_louder_than_the_noise() {
        let (tone, halves) = tone_in_noise();
        let alike = [tone.clone(), tone.clone()];
        let unlike = [tone.clone(), vec![0.0; LENGTH]];
        for (halves, noise) in [(alike, 1e9), (unlike, 0.0), (halves, 0.0)] {
            let wiener = Wiener::of(&tone, &halves, noise);
            for (a, b) in filtered(&wiener, &tone).iter().zip(&tone) {
                assert!((a - b).abs() < 1e-9, "{a} {b}");
            }
            assert!((wiener.slope_noise() - 1.0).abs() < 1e-9);
        }
    }
}
