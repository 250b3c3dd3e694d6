//! A whitening filter, by linear prediction of the noise of this recording.

use super::interpolate::correlated;
use super::sound::{Sound, heard, loudest};
use crate::linalg::{Cholesky, dot};
use crate::order::sort_by_number;
use crate::units::{real, samples_in, whole};

/// Coefficients of the predictor: enough to flatten the slope of a room's noise and the hum below it.
const ORDER: usize = 24;
/// Length of the frames among which the quiet ones are sought, in seconds.
const FRAME_S: f64 = 10e-3;
/// The noise is learnt this far around the impacts, in seconds.
const AROUND_S: f64 = 0.5;
/// Share of the frames that are quiet.
const QUIET_SHARE: f64 = 0.2;
/// White noise added before solving, as a share of the power: without it a pure hum has no inverse.
const REGULARISATION: f64 = 1e-9;
/// Least noise as a share of the loudest sample, so that a recording without noise has a finite error, and one that is quiet
/// is timed as a loud one is. Derived: a tenth of the quantization noise of 16 bits at full scale.
const LEAST_NOISE: f64 = 1e-6;
/// Frames begin this share of their length apart, so that the quiet is found wherever it lies among them (convention).
const FRAME_STEP: f64 = 0.25;
/// A time of the span is off by less than this, in seconds: the sound is loudest within it.
const ANCHOR_S: f64 = 5e-3;

/// `y[n] = (x[n] − Σ a_k·x[n−k]) / σ`, with unit variance where the recording is quiet.
#[derive(Debug, Clone)]
pub struct Whitener {
    predictor: [f64; ORDER],
    scale: f64,
}

impl Whitener {
    /// Learns the noise from the quietest frames from half a second before a span of the recording to half a second after.
    #[must_use]
    pub fn learn(sound: &Sound<'_>, span_s: (f64, f64)) -> Self {
        let (quiet, peak) = quiet_frames(sound, span_s);
        let mut products = [[0.0; ORDER + 1]; ORDER + 1];
        let mut count = 0;
        for frame in &quiet {
            let frame: Vec<f64> = frame.iter().copied().map(f64::from).collect();
            add_products(&frame, &mut products);
            count += frame.len() - ORDER;
        }
        let scale = 1.0 / real(count.max(1));
        products.iter_mut().flatten().for_each(|p| *p *= scale);
        let least =
            REGULARISATION * products[0][0] + (LEAST_NOISE * peak).powi(2).max(f64::MIN_POSITIVE);
        for (lag, row) in products.iter_mut().enumerate() {
            row[lag] += least;
        }
        let (predictor, error) = predictor(&products);
        Self {
            predictor,
            scale: 1.0 / error.sqrt(),
        }
    }

    /// Samples that have to come before the first one that is whitened.
    #[must_use]
    pub const fn past(&self) -> usize {
        ORDER
    }

    /// Whitens `samples[start..end]`; none if the recording does not reach that far, with the filter's own past.
    #[must_use]
    pub fn apply(&self, samples: &[f32], start: usize, end: usize) -> Option<Vec<f64>> {
        let past = start.checked_sub(ORDER)?;
        let needed = samples.get(past..end)?;
        // From the oldest sample to the newest, which is not predicted.
        let mut weights = [self.scale; ORDER + 1];
        for (weight, a) in weights.iter_mut().zip(self.predictor.iter().rev()) {
            *weight = -self.scale * a;
        }
        Some(correlated(needed, &weights))
    }
}

/// A recording as it sounds through the whitener of one drop.
#[derive(Debug, Clone)]
pub struct Whitened<'a> {
    sound: Sound<'a>,
    whitener: Whitener,
}

impl<'a> Whitened<'a> {
    /// Learns the whitener from the quiet around a span of the recording, in seconds: the drop's.
    #[must_use]
    pub fn around(sound: Sound<'a>, span_s: (f64, f64)) -> Self {
        Self {
            sound,
            whitener: Whitener::learn(&sound, span_s),
        }
    }

    /// The sound as it was recorded, whose clock this has too.
    #[must_use]
    pub const fn sound(&self) -> &Sound<'a> {
        &self.sound
    }

    /// Samples per second.
    #[must_use]
    pub const fn sample_rate_hz(&self) -> f64 {
        self.sound.sample_rate_hz
    }

    /// The whitened samples from one sample to before another; none if the recording does not reach that far, with the
    /// filter's own past.
    #[must_use]
    pub fn between(&self, start: usize, end: usize) -> Option<Vec<f64>> {
        self.whitener.apply(self.sound.samples, start, end)
    }

    /// The samples that can be whitened: from the first that has the filter's past before it to the end.
    #[must_use]
    pub const fn range(&self) -> std::ops::Range<usize> {
        self.whitener.past()..self.sound.samples.len()
    }
}

/// The quietest frames around a span, and the loudest sample there.
///
/// They lie at whole steps from the loudest samples at both ends of the span: so neither the phase of its times, nor silence
/// before or after the recording, nor its gain, changes what is found.
fn quiet_frames<'a>(sound: &Sound<'a>, span_s: (f64, f64)) -> (Vec<&'a [f32]>, f64) {
    let rate = sound.sample_rate_hz;
    let frame = samples_in(FRAME_S, rate).max(2 * ORDER);
    let step = whole(FRAME_STEP * real(frame)).max(1);
    let heard = heard(sound.samples);
    let ends = [span_s.0, span_s.1].map(|time_s| loudest_near(sound, time_s));
    let around = samples_in(AROUND_S, rate) / step;
    // Whole frames that begin whole steps before the first anchor and reach as far behind the second.
    let before = around.min((ends[0].saturating_sub(heard.start)) / step);
    let first = ends[0].clamp(heard.start, heard.end) - before * step;
    let last = (ends[1] + around * step).min(heard.end);
    let energy = |f: &[f32]| f.iter().map(|x| f64::from(*x).powi(2)).sum::<f64>();
    let region = sound.samples.get(first..last).unwrap_or_default();
    let peak = region.iter().fold(0.0, |peak: f32, x| peak.max(x.abs()));
    // Digital silence says nothing of the noise.
    let mut frames: Vec<(f64, &[f32])> = (0..=region.len().saturating_sub(frame) / step)
        .filter_map(|k| region.get(k * step..k * step + frame))
        .map(|f| (energy(f), f))
        .filter(|(e, _)| *e > 0.0)
        .collect();
    sort_by_number(&mut frames, |(energy, _)| *energy);
    let keep = whole(QUIET_SHARE * real(frames.len()))
        .max(4)
        .min(frames.len());
    frames.truncate(keep);
    let frames = frames.into_iter().map(|(_, f)| f).collect();
    (frames, f64::from(peak))
}

/// The loudest sample near a time.
fn loudest_near(sound: &Sound<'_>, time_s: f64) -> usize {
    let near = sound.between(time_s - ANCHOR_S, time_s + ANCHOR_S);
    sound.sample_at(time_s - ANCHOR_S) + loudest(near)
}

/// Adds `Σ_n x[n − i]·x[n − j]` over the samples that have their whole past in the frame.
///
/// From the first row the others follow along the diagonals, as the sums lose a last term and gain a first.
fn add_products(frame: &[f64], products: &mut [[f64; ORDER + 1]; ORDER + 1]) {
    let length = frame.len() - ORDER;
    let mut own = [[0.0; ORDER + 1]; ORDER + 1];
    for lag in 0..=ORDER {
        own[0][lag] = dot(&frame[ORDER..], &frame[ORDER - lag..ORDER - lag + length]);
        own[lag][0] = own[0][lag];
    }
    for i in 0..ORDER {
        for j in 0..ORDER {
            let gained = frame[ORDER - 1 - i] * frame[ORDER - 1 - j];
            let lost = frame[frame.len() - 1 - i] * frame[frame.len() - 1 - j];
            own[i + 1][j + 1] = own[i][j] + gained - lost;
        }
    }
    for (sum, own) in products.iter_mut().flatten().zip(own.iter().flatten()) {
        *sum += own;
    }
}

/// The predictor of least squares for sums of products with their lags, and the variance that it leaves.
///
/// Unlike the recursion for an autocorrelation it takes no sample beyond a frame for zero, so a hum whose period is
/// longer than the frame is predicted as well as any: `x[n] = Σ a_k·x[n−k]` holds in every part of it.
/// Products that have no inverse predict nothing.
fn predictor(products: &[[f64; ORDER + 1]; ORDER + 1]) -> ([f64; ORDER], f64) {
    let covariance = std::array::from_fn(|i| std::array::from_fn(|j| products[i + 1][j + 1]));
    let right = std::array::from_fn(|i| products[i + 1][0]);
    let Some(factors) = Cholesky::of(&covariance, ORDER) else {
        return ([0.0; ORDER], products[0][0]);
    };
    let least = REGULARISATION * products[0][0];
    let left = products[0][0] - factors.quadratic(&right);
    (factors.solve(&right), left.max(least))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    #[test]
    fn a_hum_longer_than_the_frames_is_taken_out() {
        let mut rng = SplitMix64::new(5);
        #[expect(clippy::cast_possible_truncation, reason = "test noise")]
        let hum: Vec<f32> = (0..96_000)
            .map(|i| {
                let turn = std::f64::consts::TAU * 50.0 * real(i) / 48_000.0;
                (0.1 * turn.sin() + 0.05 * (3.0 * turn + 1.0).sin() + 1e-4 * rng.normal()) as f32
            })
            .collect();
        let whitener = Whitener::learn(&Sound::from_start(&hum, 48_000.0), (1.0, 1.0));
        let white = whitener.apply(&hum, 1_000, 90_000).unwrap();
        let power = white.iter().map(|x| x * x).sum::<f64>() / real(white.len());
        assert!((0.7..1.5).contains(&power), "{power}");
    }

    #[test]
    fn coloured_noise_comes_out_white_with_unit_variance() {
        let mut rng = SplitMix64::new(3);
        let mut y = 0.0;
        #[expect(clippy::cast_possible_truncation, reason = "test noise")]
        let noise: Vec<f32> = (0..96_000)
            .map(|_| {
                y = 0.95 * y + 0.01 * rng.normal();
                y as f32
            })
            .collect();
        let whitener = Whitener::learn(&Sound::from_start(&noise, 48_000.0), (1.0, 1.0));
        let white = whitener.apply(&noise, 1_000, 90_000).unwrap();
        let mean_product = |lag: usize| {
            white
                .iter()
                .zip(&white[lag..])
                .map(|(a, b)| a * b)
                .sum::<f64>()
                / real(white.len())
        };
        // The quietest fifth of the frames holds a little less than the mean power.
        assert!((0.8..1.6).contains(&mean_product(0)), "{}", mean_product(0));
        for lag in 1..10 {
            assert!(
                (mean_product(lag) / mean_product(0)).abs() < 0.05,
                "lag {lag}"
            );
        }
    }

    #[test]
    fn what_is_learnt_does_not_depend_on_silence_in_front_nor_gain_nor_the_phase_of_the_span() {
        let mut rng = SplitMix64::new(7);
        let (rate, mut y) = (48_000.0, 0.0);
        #[expect(clippy::cast_possible_truncation, reason = "test noise")]
        let noise: Vec<f32> = (0..96_000)
            .map(|i| {
                y = 0.9 * y + 0.01 * rng.normal();
                let knock = if i == 40_000 || i == 60_000 { 0.8 } else { 0.0 };
                (y + knock) as f32
            })
            .collect();
        let span_s = (40_000.0 / rate, 60_000.0 / rate);
        let learnt = Whitener::learn(&Sound::from_start(&noise, rate), span_s);
        for zeros in [1, 100, 777, 3_001] {
            let mut later = vec![0.0; zeros];
            later.extend(noise.iter().map(|x| 0.25 * x));
            // The detector's grid is a quarter of a millisecond.
            let late_s = real(zeros) / rate + 0.2e-3;
            let span_s = (span_s.0 + late_s, span_s.1 + late_s);
            let again = Whitener::learn(&Sound::from_start(&later, rate), span_s);
            assert_eq!(learnt.predictor, again.predictor, "{zeros}");
            assert!((again.scale / learnt.scale - 4.0).abs() < 1e-9);
        }
    }
}
