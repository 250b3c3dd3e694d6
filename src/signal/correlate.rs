//! Correlations.

use rustfft::num_complex::Complex;

use super::fourier::{Fourier, Workspace};
use super::interpolate::correlated;

/// Transforms are this many times as long as the shorter sequence, or a little longer: most of each is then of use, and
/// it fits the cache.
const TRANSFORM_LENGTHS: usize = 6;
/// So few products are summed sooner one by one than by transforms: of 50, 150, 400 and 1,000 dense drops are fastest with this.
const FEW: usize = 400;

/// Correlates sequences by Fourier transforms, which it keeps, with the memory that they work in.
#[derive(Debug, Default)]
pub(crate) struct Correlator {
    transforms: Vec<Fourier>,
    work: Workspace,
}

/// [`Correlator::correlate`] for once.
pub(crate) fn correlate(a: &[f64], b: &[f64]) -> Option<Vec<f64>> {
    Correlator::default().correlate(a, b)
}

impl Correlator {
    /// `Σ_j a[k + j]·b[j]` for every k at which b lies within a, by Fourier transforms of stretches of a that overlap by b,
    /// two in each; where few are wanted, by their definition.
    pub(crate) fn correlate(&mut self, a: &[f64], b: &[f64]) -> Option<Vec<f64>> {
        let count = a.len().checked_sub(b.len())? + 1;
        if count <= FEW {
            return Some(correlated(a, b));
        }
        let length = (TRANSFORM_LENGTHS * b.len())
            .min(a.len())
            .next_power_of_two();
        let known = self.transform(length);
        let fourier = &self.transforms[known];
        let spectrum: Vec<_> = fourier.spectrum(b).iter().map(Complex::conj).collect();
        let mut out = Vec::with_capacity(count + 2 * length);
        // Of each stretch the last values wrap around.
        let step = length - b.len() + 1;
        let stretch = |start: usize| &a[start.min(a.len())..(start + length).min(a.len())];
        for start in (0..count).step_by(2 * step) {
            let both = fourier.filtered(
                stretch(start),
                stretch(start + step),
                &spectrum,
                &mut self.work,
            );
            out.extend(both[..step].iter().map(|z| z.re));
            out.extend(both[..step].iter().map(|z| z.im));
        }
        out.truncate(count);
        Some(out)
    }

    /// Power of every line of the spectrum of some samples.
    pub(crate) fn powers(&mut self, samples: &[f64]) -> Vec<f64> {
        let known = self.transform(samples.len().next_power_of_two());
        let lines = self.transforms[known].spectrum(samples);
        lines.iter().map(Complex::norm_sqr).collect()
    }

    /// Which of the transforms is of this length.
    fn transform(&mut self, length: usize) -> usize {
        let known = self.transforms.iter().position(|t| t.len() == length);
        known.unwrap_or_else(|| {
            self.transforms.push(Fourier::of(length));
            self.transforms.len() - 1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::dot;
    use crate::random::SplitMix64;

    #[test]
    fn correlation_is_that_of_the_definition() {
        let mut rng = SplitMix64::new(2);
        let a: Vec<f64> = (0..999).map(|_| rng.normal()).collect();
        for width in [1, 2, 7, 64, 500, 700, 990, 999] {
            let b: Vec<f64> = (0..width).map(|_| rng.normal()).collect();
            let fast = correlate(&a, &b).unwrap();
            assert_eq!(fast.len(), 1_000 - width);
            for (k, (f, window)) in fast.iter().zip(a.windows(width)).enumerate() {
                let s = dot(window, &b);
                // A thousand terms of size 1 in double precision.
                assert!((f - s).abs() < 1e-11, "width {width}, lag {k}: {f} vs {s}");
            }
        }
        assert!(correlate(&a[..3], &a[..4]).is_none());
    }
}
