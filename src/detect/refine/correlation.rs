//! Correlation with the mean impact of the drop: all of the sound says when it came.

use super::Window;
use super::interpolate::{KERNEL, maximum, shifted};
use crate::detect::voice::dot;
use crate::units::{real, samples_in};

/// Where an impact matches the mean of the others, in samples of its window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Match {
    /// Position of the onset between samples.
    pub position: f64,
    /// Standard error by what the mean impact leaves unexplained.
    pub std: f64,
}

/// The mean impact reaches this far before and after its onset, in seconds: shorter than the shortest flight.
const BEFORE_S: f64 = 0.4e-3;
const AFTER_S: f64 = 2.4e-3;
/// A match may lie this far from the constant-fraction time, in seconds: more would be another cycle of the ring.
const SEARCH_S: f64 = 0.35e-3;
/// Rounds of averaging and matching; the times move less than a hundredth of a sample after the third.
const ROUNDS: usize = 4;
/// A match worse than this correlation coefficient is none.
const WORST_MATCH: f64 = 0.25;
/// Fewest impacts that have a mean worth matching.
const FEWEST: usize = 3;

/// Matches each impact with the mean of all others, from first positions of their onsets.
///
/// Gives for each window its match, or none where it does not resemble the others; none for all if there are fewer
/// than three. What is common to all (the mean impact's own onset) comes from the first positions.
#[must_use]
pub fn align(impacts: &[(&Window, f64)], sample_rate_hz: f64) -> Vec<Option<Match>> {
    if impacts.len() < FEWEST {
        return vec![None; impacts.len()];
    }
    let before = samples_in(BEFORE_S, sample_rate_hz);
    let length = before + samples_in(AFTER_S, sample_rate_hz);
    let search = samples_in(SEARCH_S, sample_rate_hz).max(2);
    let mut positions: Vec<f64> = impacts.iter().map(|&(_, p)| p).collect();
    let mut matches = vec![None; impacts.len()];
    for _ in 0..ROUNDS {
        let cuts: Vec<Vec<f64>> = impacts
            .iter()
            .zip(&positions)
            .map(|((w, _), &p)| shifted(&w.samples, p - real(before), length))
            .collect();
        let sum = total(&cuts, length);
        for (i, (window, first)) in impacts.iter().enumerate() {
            // Without its own sound, or every impact would match itself where it already is.
            let others: Vec<f64> = sum.iter().zip(&cuts[i]).map(|(s, c)| s - c).collect();
            matches[i] =
                best(&window.samples, &others, *first - real(before), search).map(|m| Match {
                    position: m.position + real(before),
                    ..m
                });
        }
        // The mean offset is not measured by matching one another: keep it where the fractions put it.
        let moves: Vec<f64> = matches
            .iter()
            .zip(impacts)
            .filter_map(|(m, (_, first))| Some(m.as_ref()?.position - first))
            .collect();
        let drift = median(moves);
        for ((m, p), (_, first)) in matches.iter_mut().zip(&mut positions).zip(impacts) {
            if let Some(m) = m {
                m.position -= drift;
                *p = m.position;
            } else {
                *p = *first;
            }
        }
    }
    matches
}

/// Sum of the impacts. A loud one counts by its amplitude, as it should: the noise in each has unit variance.
fn total(cuts: &[Vec<f64>], length: usize) -> Vec<f64> {
    let mut sum = vec![0.0; length];
    for cut in cuts {
        for (s, c) in sum.iter_mut().zip(cut) {
            *s += c;
        }
    }
    sum
}

/// The position in `samples` near `first` at which `shape` fits best.
fn best(samples: &[f64], shape: &[f64], first: f64, search: usize) -> Option<Match> {
    let base = samples_in(first, 1.0);
    // Correlation at whole lags, with room for the kernel on both sides; between them it is interpolated.
    let reach = search + KERNEL;
    let start = base.checked_sub(reach)?;
    let needed = samples.get(start..base + reach + shape.len() + 1)?;
    let products: Vec<f64> = needed.windows(shape.len()).map(|w| dot(w, shape)).collect();
    let inside = KERNEL..products.len() - KERNEL;
    let top = inside.max_by(|&a, &b| products[a].total_cmp(&products[b]))?;
    let (offset, height) = maximum(&products, top);
    let energy: f64 = shape.iter().map(|s| s * s).sum();
    let matched = shifted(samples, real(start) + offset, shape.len());
    let own: f64 = matched.iter().map(|x| x * x).sum();
    if height <= WORST_MATCH * (energy * own).sqrt() {
        return None;
    }
    let amplitude = height / energy;
    let left: f64 = matched
        .iter()
        .zip(shape)
        .map(|(x, s)| (x - amplitude * s).powi(2))
        .sum();
    let slopes: f64 = shape.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum();
    // σ_t = σ / √(Σ (a·ds/dt)²): σ is the noise, or what the mean impact does not explain where that is more.
    let noise = (left / real(shape.len())).max(1.0).sqrt();
    Some(Match {
        position: real(start) + offset,
        std: noise / (amplitude * slopes.sqrt()),
    })
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    /// A damped tone that starts between samples, as a microphone would sample it.
    fn impact(onset: f64, amplitude: f64, rng: &mut SplitMix64) -> Window {
        let samples = (0..384)
            .map(|i| {
                let t = real(i) - onset;
                let tone = if t > 0.0 {
                    (-t / 30.0).exp() * (t / 4.0).min(1.0) * (0.9 * t).sin()
                } else {
                    0.0
                };
                amplitude * tone + rng.normal()
            })
            .collect();
        Window {
            samples,
            start: 0,
            coarse: 144,
        }
    }

    #[test]
    fn times_between_samples_are_found_within_their_errors() {
        let mut rng = SplitMix64::new(1);
        let onsets: Vec<f64> = (0..20)
            .map(|i| 144.0 + 0.37 * real(i % 7) + rng.uniform())
            .collect();
        let windows: Vec<Window> = onsets.iter().map(|&o| impact(o, 60.0, &mut rng)).collect();
        let first: Vec<(&Window, f64)> = windows
            .iter()
            .zip(&onsets)
            .map(|(w, o)| (w, o + 0.8 * (rng.uniform() - 0.5)))
            .collect();
        let matches = align(&first, 48_000.0);
        let errors: Vec<f64> = matches
            .iter()
            .zip(&onsets)
            .map(|(m, o)| m.unwrap().position - o)
            .collect();
        let mean = errors.iter().sum::<f64>() / 20.0;
        let rms = (errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / 20.0).sqrt();
        let stated = matches.iter().map(|m| m.unwrap().std).sum::<f64>() / 20.0;
        assert!(rms < 0.05, "{rms}");
        assert!(
            (0.5..2.0).contains(&(rms / stated)),
            "rms {rms}, stated {stated}"
        );
    }

    #[test]
    fn what_resembles_no_other_has_no_match() {
        let mut rng = SplitMix64::new(2);
        let mut windows: Vec<Window> = (0..6).map(|_| impact(144.0, 60.0, &mut rng)).collect();
        windows.push(impact(144.0, 0.0, &mut rng));
        let first: Vec<(&Window, f64)> = windows.iter().map(|w| (w, 144.0)).collect();
        let matches = align(&first, 48_000.0);
        assert!(
            matches[..6].iter().all(Option::is_some) && matches[6].is_none(),
            "{matches:?}"
        );
    }
}
