//! A filter after which the noise of this recording is white, by linear prediction.

use crate::units::{real, samples_in};

/// Coefficients of the predictor: enough to flatten the slope of a room's noise and the hum below it.
const ORDER: usize = 24;
/// Length of the frames among which the quiet ones are sought, in seconds.
const FRAME_S: f64 = 10e-3;
/// The noise is looked for this far around the impacts, in seconds.
const AROUND_S: f64 = 0.5;
/// Share of the frames that are quiet.
const QUIET_SHARE: f64 = 0.2;
/// White noise added before solving, as a share of the power: without it a pure hum has no inverse.
const REGULARISATION: f64 = 1e-6;
/// Noise is taken to be at least this share of full scale: half a step of a 16-bit recording.
const LEAST_NOISE: f64 = 1e-5;

/// `y[n] = (x[n] − Σ a_k·x[n−k]) / σ`, with unit variance where the recording is quiet.
#[derive(Debug, Clone)]
pub struct Whitener {
    predictor: [f64; ORDER],
    scale: f64,
}

impl Whitener {
    /// Learns the noise from the quietest frames around the impacts.
    #[must_use]
    pub fn learn(samples: &[f32], sample_rate_hz: f64, impacts_s: &[f64]) -> Self {
        let quiet = quiet_frames(samples, sample_rate_hz, impacts_s);
        let mut correlation = [0.0; ORDER + 1];
        let mut count = 0;
        for frame in &quiet {
            for (lag, sum) in correlation.iter_mut().enumerate() {
                *sum += frame[lag..]
                    .iter()
                    .zip(*frame)
                    .map(|(&a, &b)| f64::from(a) * f64::from(b))
                    .sum::<f64>();
            }
            count += frame.len();
        }
        for sum in &mut correlation {
            *sum /= real(count.max(1));
        }
        correlation[0] = correlation[0] * (1.0 + REGULARISATION) + LEAST_NOISE * LEAST_NOISE;
        let (predictor, error) = levinson(&correlation);
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
        let needed: Vec<f64> = samples
            .get(past..end)?
            .iter()
            .copied()
            .map(f64::from)
            .collect();
        let mut white: Vec<f64> = needed
            .get(ORDER..)?
            .iter()
            .map(|x| self.scale * x)
            .collect();
        // Tap by tap over all samples, for the machine's vectors.
        for (k, a) in self.predictor.iter().enumerate() {
            let weight = self.scale * a;
            for (y, x) in white.iter_mut().zip(&needed[ORDER - 1 - k..]) {
                *y -= weight * x;
            }
        }
        Some(white)
    }
}

fn quiet_frames<'a>(samples: &'a [f32], sample_rate_hz: f64, impacts_s: &[f64]) -> Vec<&'a [f32]> {
    let at = |time_s: f64| samples_in(time_s, sample_rate_hz).min(samples.len());
    let (first, last) = (
        impacts_s.first().copied().unwrap_or(0.0),
        impacts_s.last().copied().unwrap_or(0.0),
    );
    let region = &samples[at(first - AROUND_S)..at(last + AROUND_S)];
    let frame = samples_in(FRAME_S, sample_rate_hz).max(2 * ORDER);
    let energy = |f: &[f32]| f.iter().map(|x| x * x).sum::<f32>();
    // Digital silence says nothing of the noise.
    let mut frames: Vec<(f32, &[f32])> = region
        .chunks_exact(frame)
        .map(|f| (energy(f), f))
        .filter(|(e, _)| *e > 0.0)
        .collect();
    frames.sort_by(|a, b| a.0.total_cmp(&b.0));
    let keep = samples_in(QUIET_SHARE, real(frames.len()))
        .max(4)
        .min(frames.len());
    frames.truncate(keep);
    frames.into_iter().map(|(_, f)| f).collect()
}

/// Levinson's recursion: the best predictor for an autocorrelation, and the variance it leaves.
fn levinson(correlation: &[f64; ORDER + 1]) -> ([f64; ORDER], f64) {
    let mut a = [0.0; ORDER];
    let mut error = correlation[0];
    for i in 0..ORDER {
        let missing = correlation[i + 1] - (0..i).map(|k| a[k] * correlation[i - k]).sum::<f64>();
        let reflection = missing / error;
        let before = a;
        a[i] = reflection;
        for k in 0..i {
            a[k] = before[k] - reflection * before[i - 1 - k];
        }
        error *= 1.0 - reflection * reflection;
    }
    (a, error)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

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
        let whitener = Whitener::learn(&noise, 48_000.0, &[1.0]);
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
}
