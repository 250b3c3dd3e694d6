//! Band-limited sequences between their samples.

use std::sync::LazyLock;

use pulp::{Arch, Simd, WithSimd};

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
    if position.fract() == 0.0 {
        // At a sample the kernel is 1 there and 0 at all others.
        return padded(samples, first + KERNEL.cast_signed() - 1, length);
    }
    // Inside, all weights lie within the samples; beside that the few that do are summed.
    let inside = samples.len().cast_signed() - kernel.len().cast_signed() + 1 - first;
    let begin = usize::try_from(-first).unwrap_or(0).min(length);
    let end = usize::try_from(inside).unwrap_or(0).clamp(begin, length);
    let beside = |i: usize| weighted(samples, first + i.cast_signed(), &kernel);
    let mut out = Vec::with_capacity(length);
    out.extend((0..begin).map(beside));
    if let Ok(from) = usize::try_from(first + begin.cast_signed())
        && end > begin
    {
        let inside = &samples[from..from + (end - begin) + kernel.len() - 1];
        correlate_into(&mut out, inside, &kernel);
    }
    out.extend((end..length).map(beside));
    out
}

/// `length` samples from an index on; zero where there are none.
pub(crate) fn padded(samples: &[f64], first: isize, length: usize) -> Vec<f64> {
    let skip = usize::try_from(-first).unwrap_or(0).min(length);
    let from = usize::try_from(first).unwrap_or(0).min(samples.len());
    let mut padded = vec![0.0; length];
    for (y, x) in padded[skip..].iter_mut().zip(&samples[from..]) {
        *y = *x;
    }
    padded
}

/// Outputs that are computed side by side, in the machine's vectors.
const BLOCK: usize = 16;

/// `Σ_k weights[k]·samples[i + k]` for every i at which all weights lie within the samples.
pub(crate) fn correlated<T: Copy + Into<f64>>(samples: &[T], weights: &[f64]) -> Vec<f64> {
    let mut out = Vec::new();
    correlate_into(&mut out, samples, weights);
    out
}

/// Appends what [`correlated`] gives.
fn correlate_into<T: Copy + Into<f64>>(out: &mut Vec<f64>, samples: &[T], weights: &[f64]) {
    Arch::new().dispatch(Correlation {
        samples,
        weights,
        out,
    });
}

/// A correlation that is compiled for several kinds of vectors. The sums are the same to the last digit with all: products and
/// sums are rounded one by one, in the same order.
struct Correlation<'a, T> {
    samples: &'a [T],
    weights: &'a [f64],
    out: &'a mut Vec<f64>,
}

impl<T: Copy + Into<f64>> WithSimd for Correlation<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self {
            samples,
            weights,
            out,
        } = self;
        let count = (samples.len() + 1).saturating_sub(weights.len());
        out.reserve(count);
        let whole = count - count % BLOCK;
        for start in (0..whole).step_by(BLOCK) {
            out.extend_from_slice(&block::<T, BLOCK>(&samples[start..], weights));
        }
        match count.checked_sub(BLOCK) {
            // The last block begins where it ends with the last output.
            Some(start) if whole < count => {
                let sums: [f64; BLOCK] = block(&samples[start..], weights);
                out.extend_from_slice(&sums[whole - start..]);
            }
            Some(_) => {}
            None => out.extend((0..count).flat_map(|i| block::<T, 1>(&samples[i..], weights))),
        }
    }
}

/// The first outputs of [`correlated`].
#[inline(always)]
fn block<T: Copy + Into<f64>, const N: usize>(samples: &[T], weights: &[f64]) -> [f64; N] {
    let mut sums = [0.0; N];
    for (window, &weight) in samples.windows(N).zip(weights) {
        for (sum, &x) in sums.iter_mut().zip(window) {
            *sum += weight * x.into();
        }
    }
    sums
}

/// Derivative of a band-limited sequence at its samples, per sample; zero outside.
///
/// # Formula
/// `y'(i) = Σ_n (−1)^(n+1)/n·(1 − (n/K)²)²·(y(i + n) − y(i − n))`: the derivative of the interpolating kernel.
#[must_use]
pub fn slope(values: &[f64]) -> Vec<f64> {
    let mut slopes = vec![0.0; values.len()];
    for n in 1..KERNEL.min(values.len()) {
        let weight = slope_weight(n);
        for (y, later) in slopes.iter_mut().zip(&values[n..]) {
            *y += weight * later;
        }
        for (y, earlier) in slopes[n..].iter_mut().zip(values) {
            *y -= weight * earlier;
        }
    }
    slopes
}

/// `(−1)^(n+1)/n·(1 − (n/K)²)²`.
fn slope_weight(n: usize) -> f64 {
    let share = 1.0 - (real(n) / real(KERNEL)).powi(2);
    let sign = if n.is_multiple_of(2) { -1.0 } else { 1.0 };
    sign * share * share / real(n)
}

/// The variance of the [`slope`] of white noise of variance 1, away from the ends: the sum of the squares of its weights.
pub(crate) fn slope_gain() -> f64 {
    let squares = (1..KERNEL).map(|n| slope_weight(n).powi(2));
    2.0 * squares.sum::<f64>()
}

/// Places that a maximum is first sought at, for each sample.
const PLACES: usize = 8;
/// The kernels at those between two samples.
static EIGHTHS: LazyLock<[[f64; 2 * KERNEL]; PLACES - 1]> =
    LazyLock::new(|| std::array::from_fn(|k| kernel(real(k + 1) / real(PLACES)).1));
/// Distances of the three values that a parabola is laid through after that, in samples: at the last one its vertex is
/// wrong by `h²/6·y‴/y″`, a few hundred-thousandths of a sample.
const PARABOLAS: [f64; 2] = [0.1, 0.01];

/// Position and height of the maximum of a band-limited sequence near its local maximum `top`: the highest of places
/// within a sample of it, then twice the vertex of a parabola, `x + h/2·(y₋ − y₊)/(y₋ − 2y + y₊)`.
#[must_use]
pub fn maximum(values: &[f64], top: usize) -> (f64, f64) {
    let mut best = (real(top), values.get(top).copied().unwrap_or(0.0));
    for (k, weights) in EIGHTHS.iter().enumerate() {
        let after = real(k + 1) / real(PLACES);
        for (x, first) in [(real(top) - 1.0 + after, 0), (real(top) + after, 1)] {
            let first = top.cast_signed() + first - KERNEL.cast_signed();
            let height = weighted(values, first, weights);
            if height > best.1 {
                best = (x, height);
            }
        }
    }
    for h in PARABOLAS {
        let (x, height) = best;
        let [left, right] = [x - h, x + h].map(|x| interpolated(values, x));
        if let Some(moved) = vertex([left, height, right]) {
            best = higher(values, best, x + h * moved.clamp(-1.0, 1.0));
        }
    }
    best
}

/// Vertex of the parabola through three values a step apart, in steps from the middle one:
/// `½·(y₋ − y₊)/(y₋ − 2y + y₊)`; none where it has no top.
pub(crate) fn vertex([left, middle, right]: [f64; 3]) -> Option<f64> {
    let curvature = left - 2.0 * middle + right;
    (curvature < 0.0).then(|| 0.5 * (left - right) / curvature)
}

/// A place and its height, or another one if that is higher.
fn higher(values: &[f64], best: (f64, f64), x: f64) -> (f64, f64) {
    let height = interpolated(values, x);
    if height > best.1 { (x, height) } else { best }
}

/// A sinc under the window (1 − (x/K)²)² around a position, and the index that its first weight belongs to.
///
/// `sin(π(x − i))` changes only its sign from one sample to the next.
fn kernel(position: f64) -> (isize, [f64; 2 * KERNEL]) {
    use std::f64::consts::PI;
    let whole = position.floor();
    let fraction = position - whole;
    let sine = (PI * fraction).sin() / PI;
    #[expect(
        clippy::cast_possible_truncation,
        reason = "positions lie within a window of samples"
    )]
    let first = whole as isize + 1 - KERNEL.cast_signed();
    // The distances are fraction + (KERNEL − 1 − i): the sine of the whole part is its parity.
    let mut weights: [f64; 2 * KERNEL] = std::array::from_fn(|i| {
        let x = fraction + real(KERNEL) - 1.0 - real(i);
        let share = 1.0 - (x / real(KERNEL)).powi(2);
        let sign = if i % 2 == KERNEL % 2 { -1.0 } else { 1.0 };
        sign * sine / x * share * share
    });
    // At a sample itself the sinc is 0/0.
    if fraction < AT_SAMPLE {
        weights[KERNEL - 1] = 1.0;
    } else if fraction > 1.0 - AT_SAMPLE {
        weights[KERNEL] = 1.0;
    }
    (first, weights)
}

/// Distance from a sample, in samples, at which the sinc is 1 to the last digit.
const AT_SAMPLE: f64 = 1e-9;

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
    use crate::random::SplitMix64;

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

    #[test]
    fn the_slope_of_white_noise_scatters_by_its_gain() {
        let mut rng = SplitMix64::new(4);
        let noise: Vec<f64> = (0..20_000).map(|_| rng.normal()).collect();
        let squares: f64 = slope(&noise).iter().map(|s| s * s).sum();
        // The sum of these squares scatters by a hundredth, neighbours being alike.
        assert!((squares / 20_000.0 / slope_gain() - 1.0).abs() < 0.05);
    }

    #[test]
    fn a_vertex_is_that_of_the_parabola() {
        let parabola = |x: f64| 3.0 - 0.7 * (x - 0.3).powi(2);
        let top = vertex([-1.0, 0.0, 1.0].map(parabola)).unwrap();
        assert!((top - 0.3).abs() < 1e-14);
        assert_eq!(vertex([1.0, 0.0, 1.0]), None);
        assert_eq!(vertex([0.0, 1.0, 2.0]), None);
    }

    #[test]
    fn a_maximum_is_higher_than_all_places_around_it() {
        let mut rng = SplitMix64::new(5);
        let noise: Vec<f64> = (0..300).map(|_| rng.normal()).collect();
        let values: Vec<f64> = noise.windows(8).map(|w| w.iter().sum()).collect();
        let mut tried = 0;
        for top in 20..270 {
            if values[top] > values[top - 1].max(values[top + 1]) {
                let (x, height) = maximum(&values, top);
                assert!((x - real(top)).abs() <= 1.0 && height >= values[top]);
                assert!((height - interpolated(&values, x)).abs() < 1e-12);
                for step in [1e-3, 1e-2, 0.05] {
                    let around =
                        interpolated(&values, x - step).max(interpolated(&values, x + step));
                    assert!(around < height, "{top}: {x} is no maximum by {step}");
                }
                tried += 1;
            }
        }
        assert!(tried > 20, "{tried} maxima");
    }

    #[test]
    fn a_shift_is_interpolation_at_each_sample_and_zero_beyond_the_ends() {
        let mut rng = SplitMix64::new(6);
        let values: Vec<f64> = (0..50).map(|_| rng.normal()).collect();
        for (position, length) in [(15.3, 9), (20.0, 1), (-20.7, 100), (40.2, 30), (60.9, 5)] {
            let fast = shifted(&values, position, length);
            assert_eq!(fast.len(), length);
            for (k, y) in fast.iter().enumerate() {
                let slow = interpolated(&values, position + real(k));
                assert!((y - slow).abs() < 1e-12, "{position} + {k}: {y} vs {slow}");
            }
        }
    }
}
