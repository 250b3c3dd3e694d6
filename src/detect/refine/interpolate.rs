//! Band-limited sequences between their samples.

use crate::units::real;

/// Half-width of the interpolating kernel in samples.
pub const KERNEL: usize = 12;

/// A band-limited sequence between its samples; zero outside.
#[must_use]
pub fn interpolated(values: &[f64], position: f64) -> f64 {
    let (first, kernel) = kernel(position);
    weighted(values, first, &kernel)
}

/// `length` samples from a position between samples on; zero where there are none.
#[must_use]
pub fn shifted(samples: &[f64], position: f64, length: usize) -> Vec<f64> {
    let (first, kernel) = kernel(position);
    let taps = kernel.len();
    let needed = length + taps - 1;
    let inside = usize::try_from(first)
        .ok()
        .and_then(|from| samples.get(from..from.checked_add(needed)?));
    let mut out = vec![0.0; length];
    if let Some(inside) = inside {
        convolve(inside, &kernel, &mut out);
    } else {
        // At the ends of the samples there are zeros.
        let skip = usize::try_from(-first).unwrap_or(0).min(needed);
        let from = usize::try_from(first).unwrap_or(0).min(samples.len());
        let mut padded = vec![0.0; needed];
        for (y, x) in padded[skip..].iter_mut().zip(&samples[from..]) {
            *y = *x;
        }
        convolve(&padded, &kernel, &mut out);
    }
    out
}

/// Outputs that are computed side by side, in the machine's vectors.
const BLOCK: usize = 8;

/// `out[i] = Σ_k kernel[k]·samples[i + k]`.
fn convolve(samples: &[f64], kernel: &[f64; 2 * KERNEL], out: &mut [f64]) {
    let (blocks, rest) = out.as_chunks_mut::<BLOCK>();
    let done = blocks.len() * BLOCK;
    for (b, block) in blocks.iter_mut().enumerate() {
        let samples = &samples[b * BLOCK..b * BLOCK + BLOCK + kernel.len() - 1];
        let mut sums = [0.0; BLOCK];
        for (k, weight) in kernel.iter().enumerate() {
            for (sum, x) in sums.iter_mut().zip(&samples[k..k + BLOCK]) {
                *sum += weight * x;
            }
        }
        *block = sums;
    }
    for (y, window) in rest.iter_mut().zip(samples[done..].windows(kernel.len())) {
        *y = window.iter().zip(kernel).map(|(x, k)| x * k).sum();
    }
}

/// Derivative of a band-limited sequence at its samples, per sample; zero outside.
///
/// # Formula
/// `y'(i) = Σ_n (−1)^(n+1)/n·(1 − (n/K)²)²·(y(i + n) − y(i − n))`: the derivative of the interpolating kernel.
#[must_use]
pub fn slope(values: &[f64]) -> Vec<f64> {
    let mut slopes = vec![0.0; values.len()];
    for n in 1..KERNEL.min(values.len()) {
        let share = 1.0 - (real(n) / real(KERNEL)).powi(2);
        let sign = if n.is_multiple_of(2) { -1.0 } else { 1.0 };
        let weight = sign * share * share / real(n);
        for (y, later) in slopes.iter_mut().zip(&values[n..]) {
            *y += weight * later;
        }
        for (y, earlier) in slopes[n..].iter_mut().zip(values) {
            *y -= weight * earlier;
        }
    }
    slopes
}

/// Maximum near index `top` of a band-limited sequence: bisection of the interval by thirds (golden section).
#[must_use]
pub fn maximum(values: &[f64], top: usize) -> (f64, f64) {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    const STEPS: usize = 30;
    let (mut a, mut b) = (real(top) - 1.0, real(top) + 1.0);
    for _ in 0..STEPS {
        let (c, d) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
        if interpolated(values, c) > interpolated(values, d) {
            b = d;
        } else {
            a = c;
        }
    }
    let x = 0.5 * (a + b);
    (x, interpolated(values, x))
}

/// A sinc under the window (1 − (x/K)²)² around a position, and the index that its first weight belongs to.
///
/// `sin(π(x − i))` changes only its sign from one sample to the next.
fn kernel(position: f64) -> (isize, [f64; 2 * KERNEL]) {
    use std::f64::consts::PI;
    let whole = position.floor();
    let fraction = position - whole;
    let sine = (PI * fraction).sin();
    #[expect(
        clippy::cast_possible_truncation,
        reason = "positions lie within a window of samples"
    )]
    let first = whole as isize + 1 - KERNEL.cast_signed();
    let weight = |i: usize| {
        let x = fraction + real(KERNEL) - 1.0 - real(i);
        if x.abs() < 1e-9 {
            return 1.0;
        }
        // x = fraction + (KERNEL − 1 − i): the sine of the whole part is its parity.
        let sign = if (KERNEL - 1).abs_diff(i).is_multiple_of(2) {
            1.0
        } else {
            -1.0
        };
        let share = 1.0 - (x / real(KERNEL)).powi(2);
        sign * sine / (PI * x) * share * share
    };
    (first, std::array::from_fn(weight))
}

fn weighted(values: &[f64], first: isize, kernel: &[f64]) -> f64 {
    let skip = usize::try_from(-first).unwrap_or(0);
    let start = usize::try_from(first).unwrap_or(0).min(values.len());
    kernel
        .iter()
        .skip(skip)
        .zip(&values[start..])
        .map(|(k, v)| k * v)
        .sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slow_wave_is_interpolated_exactly_and_samples_are_kept() {
        let wave = |x: f64| (0.4 * x).sin() + 0.3 * (1.1 * x).cos();
        let samples: Vec<f64> = (0..100).map(|i| wave(real(i))).collect();
        for position in [30.0, 41.25, 50.5, 59.999_999, 60.0] {
            assert!(
                (interpolated(&samples, position) - wave(position)).abs() < 2e-3,
                "{position}"
            );
        }
        for (i, slope) in slope(&samples).iter().enumerate().take(70).skip(30) {
            let exact = 0.4 * (0.4 * real(i)).cos() - 0.33 * (1.1 * real(i)).sin();
            assert!((slope - exact).abs() < 2e-3, "slope {i}");
        }
        assert!((interpolated(&samples, 30.0) - samples[30]).abs() < 1e-12);
        assert!(
            interpolated(&samples, -3.0).is_finite() && interpolated(&samples, 104.5).is_finite()
        );
    }
}
