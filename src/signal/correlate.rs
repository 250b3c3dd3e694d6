//! Correlations.

use crate::units::real;

/// Transforms are this many times as long as the shorter sequence, or a little longer: most of each is then of use, and
/// it fits the cache.
const TRANSFORM_LENGTHS: usize = 6;

/// Correlates sequences by Fourier transforms, which it remembers the plans of.
#[derive(Default)]
pub(crate) struct Correlator {
    planner: realfft::RealFftPlanner<f64>,
}

impl std::fmt::Debug for Correlator {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Correlator").finish_non_exhaustive()
    }
}

/// [`Correlator::correlate`] for once.
pub(crate) fn correlate(a: &[f64], b: &[f64]) -> Option<Vec<f64>> {
    Correlator::default().correlate(a, b)
}

impl Correlator {
    /// `Σ_j a[k + j]·b[j]` for every k at which b lies within a, by Fourier transforms of stretches of a that overlap by b.
    pub(crate) fn correlate(&mut self, a: &[f64], b: &[f64]) -> Option<Vec<f64>> {
        let count = a.len().checked_sub(b.len())? + 1;
        let length = (TRANSFORM_LENGTHS * b.len())
            .min(a.len())
            .next_power_of_two();
        let forward = self.planner.plan_fft_forward(length);
        let inverse = self.planner.plan_fft_inverse(length);
        let (mut stretch, mut spectrum) = (forward.make_input_vec(), forward.make_output_vec());
        let (mut ahead, mut back) = (forward.make_scratch_vec(), inverse.make_scratch_vec());
        let mut sound = forward.make_output_vec();
        stretch[..b.len()].copy_from_slice(b);
        forward
            .process_with_scratch(&mut stretch, &mut spectrum, &mut ahead)
            .ok()?;
        for x in &mut spectrum {
            *x = x.conj() / real(length);
        }
        let mut out = Vec::with_capacity(count);
        // Of each stretch the last values wrap around.
        let step = length - b.len() + 1;
        for start in (0..count).step_by(step) {
            let end = (start + length).min(a.len());
            stretch[..end - start].copy_from_slice(&a[start..end]);
            stretch[end - start..].fill(0.0);
            forward
                .process_with_scratch(&mut stretch, &mut sound, &mut ahead)
                .ok()?;
            for (x, y) in sound.iter_mut().zip(&spectrum) {
                *x *= y;
            }
            // Rounding leaves a trace of an imaginary part where a real signal has none.
            sound.first_mut()?.im = 0.0;
            sound.last_mut()?.im = 0.0;
            inverse
                .process_with_scratch(&mut sound, &mut stretch, &mut back)
                .ok()?;
            out.extend_from_slice(&stretch[..step.min(count - start)]);
        }
        Some(out)
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
        for width in [1, 2, 7, 64, 500, 999] {
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
