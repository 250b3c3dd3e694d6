//! A smooth departure of ln e from any law: a Gaussian process in the logarithm of the speed, by its leading functions.

use std::f64::consts::PI;

/// Functions of the process. Derived: 1.75·L/ℓ of them leave less than a hundredth of its variance out where half the range of
/// ln v is below 2.4 ℓ (Riutort-Mayol, Bürkner, Andersen, Solin and Vehtari 2023, Statistics and Computing 33:17, 4.2).
pub(super) const BENDS: usize = 6;
/// ℓ, the length in ln v over which a departure lasts: a factor of 2.5 in speed. Convention: a bend that is shorter is seen as
/// scatter by a drop of a few bounces for each factor, one that is longer as a power of the speed.
const LENGTH: f64 = 0.9;
/// Half the width of the box in which the functions live, at least, in ℓ and in half ranges of ln v (the same paper).
const BOX_IN_LENGTHS: f64 = 3.2;
const BOX_IN_RANGES: f64 = 1.2;

/// The process `f(x) − f(x₀)` of unit amplitude, x = ln v, x₀ that of the speed where ln e is θ.
///
/// # Formula
/// ```text
/// f(x) = Σ_j w_j·√S_j·sin(ω_j·(x − c + L))/√L,   ω_j = π·j/2L,   S_j = √(2π)·ℓ·exp(−½·ℓ²·ω_j²),   w_j ~ N(0, 1)
/// ```
/// It has the covariance `exp(−½·(x − x′)²/ℓ²)` within the box from c − L to c + L (Solin and Särkkä 2020).
#[derive(Debug, Clone, Copy)]
pub(super) struct Bends {
    from: f64,
    half_width: f64,
    at_reference: [f64; BENDS],
}

impl Bends {
    /// Over these ln speeds, about a reference.
    pub(super) fn over(ln_speeds: &[f64], reference: f64) -> Self {
        let ends = ln_speeds.iter().chain([&reference]);
        let (low, high) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| {
            (low.min(x), high.max(x))
        });
        let half_range = 0.5 * (high - low);
        let half_width = (BOX_IN_LENGTHS * LENGTH).max(BOX_IN_RANGES * half_range);
        let mut bends = Self {
            from: low + half_range - half_width,
            half_width,
            at_reference: [0.0; BENDS],
        };
        bends.at_reference = bends.at(reference);
        bends
    }

    /// The functions at an ln speed; 0 at the reference.
    pub(super) fn at(&self, ln_speed: f64) -> [f64; BENDS] {
        let first = PI / (2.0 * self.half_width);
        let angle = first * (ln_speed - self.from);
        let mut values = self.at_reference.map(|x| -x);
        // sin((j + 1)·α) = 2·cos α·sin(j·α) − sin((j − 1)·α).
        let (mut before, mut sine) = (0.0, angle.sin());
        let twice_cosine = 2.0 * angle.cos();
        for (order, value) in (1_u32..).zip(&mut values) {
            let frequency = f64::from(order) * first * LENGTH;
            let root_density = (-0.25 * frequency * frequency).exp();
            let scale = ((2.0 * PI).sqrt() * LENGTH / self.half_width).sqrt();
            *value += scale * root_density * sine;
            (before, sine) = (sine, twice_cosine * sine - before);
        }
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_functions_have_the_covariance_of_the_process() {
        // At the ends of a long drop the box is near, and a sixth of the variance is lost.
        for (range, reference, allowed) in [(0.2, 0.1, 0.02), (2.0, 0.5, 0.02), (4.0, 2.2, 0.16)] {
            let places: Vec<f64> = (0..9).map(|i| range / 8.0 * f64::from(i)).collect();
            let bends = Bends::over(&places, reference);
            let kernel = |d: f64| (-0.5 * (d / LENGTH).powi(2)).exp();
            for &a in &places {
                for &b in &places {
                    let pairs = bends.at(a).into_iter().zip(bends.at(b));
                    let found: f64 = pairs.map(|(x, y)| x * y).sum();
                    let expected = kernel(a - b) - kernel(a - reference) - kernel(b - reference);
                    let off = found - expected - 1.0;
                    assert!(off.abs() < allowed, "{range}: {a} {b}: {off}");
                }
            }
        }
    }

    #[test]
    fn no_bend_moves_e_at_the_reference() {
        let at = Bends::over(&[-1.0, 2.0], 0.3).at(0.3);
        assert!(at.iter().all(|f| f.abs() < 1e-12), "{at:?}");
    }
}
