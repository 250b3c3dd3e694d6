//! Standard errors of the times, corrected for the correlation of neighbouring samples.

use super::alternate::Joint;
use super::normal_equations::NormalEquations;
use crate::signal::interpolate::slope_gain;
use crate::signal::template::average::{mean_variances, sums, weights};
use crate::signal::template::{MOST_SHARE, Sample};
use crate::units::real;

/// Blocks of equal information that a sound is cut into; two parameters are fitted to them (derived: amplitude and time).
const BLOCKS: usize = 8;
const FITTED: usize = 2;
/// Neighbours on each side over which overdispersion is averaged: one impact alone gives it within a third.
const NEIGHBOURS: usize = 3;
/// Weakest match, in standard deviations.
const FAINTEST: f64 = 3.0;

/// Standard error of each position in samples; none where an impact does not resemble the template.
///
/// # Formula
/// The time is moved by `Σ h(t)·r(t)`, h the pull of each sample and r the residual. Where r lasts as long as a mode does,
/// its samples are correlated; the sums over blocks of equal information are more nearly independent:
/// ```text
/// σ² = B/(B − 2)·Σ_blocks (Σ_t h(t)·r(t)/√(1 − share))²
/// ```
/// Its ratio to the variance of independent samples, the overdispersion, varies slowly along the drop and is averaged over
/// neighbours. The excess of the noise just before each impact over white noise, under the same pulls, is added: residual
/// hum and rumble last longer than a block. The standard error is divided by the [`attenuation`].
pub(super) fn standard_errors(joint: &Joint<'_>) -> Vec<Option<f64>> {
    let samples = joint.heads();
    let weights = weights(&samples);
    let error_pairs = error_pairs(joint, &samples, &sums(&weights));
    let excess = noise_excess(joint, &samples);
    let variances = mean_variances(&samples, &weights);
    let slope_noise = slope_gain() * joint.template.slope_noise();
    let std = |i: usize| {
        let (independent, _) = error_pairs[i]?;
        let (shape, slopes) = (joint.template.shape(i), joint.template.slopes(i));
        let noise = variances.iter().zip(&samples[i].noise).map(|(v, n)| v / n);
        let noise = slope_noise * noise.sum::<f64>();
        let known = attenuation(&samples[i], shape, slopes, noise);
        Some(independent / known * (overdispersion(&error_pairs, i) + excess).sqrt())
    };
    (0..error_pairs.len()).map(std).collect()
}

/// Overdispersion of each impact: variance of its match over that by independent samples, at least 1.
pub(super) fn overdispersions(joint: &Joint<'_>, heads: &[Sample]) -> Vec<f64> {
    let error_pairs = error_pairs(joint, heads, &sums(&weights(heads)));
    let overdispersion = |i: usize| overdispersion(&error_pairs, i).max(1.0);
    (0..error_pairs.len()).map(overdispersion).collect()
}

/// Standard errors of all impacts, by independent samples and by blocks; `weights` are those of all in the template.
fn error_pairs(joint: &Joint<'_>, samples: &[Sample], weights: &[f64]) -> Vec<Option<(f64, f64)>> {
    let template = &joint.template;
    let each = samples.iter().enumerate();
    each.map(|(i, s)| errors(s, template.shape(i), template.slopes(i), weights))
        .collect()
}

/// Mean ratio of both variances among an impact and its neighbours; 1 if none is known.
fn overdispersion(error_pairs: &[Option<(f64, f64)>], i: usize) -> f64 {
    let near = i.saturating_sub(NEIGHBOURS)..(i + NEIGHBOURS + 1).min(error_pairs.len());
    let ratios = error_pairs[near]
        .iter()
        .flatten()
        .map(|(a, b)| (b / a).powi(2));
    let (sum, count) = ratios.fold((0.0, 0), |(s, n), r| (s + r, n + 1));
    if count == 0 { 1.0 } else { sum / real(count) }
}

/// Stretches of noise before each impact that the pulls are applied to, each half a head earlier than the next.
const STRETCHES: usize = 3;

/// Excess of the noise over white noise in the variance of a match: the mean of (Σ h·n)²/Σ h²·noise, less 1.
fn noise_excess(joint: &Joint<'_>, samples: &[Sample]) -> f64 {
    let head = joint.template.head;
    let (mut sum, mut count) = (0.0, 0);
    for (i, sample) in samples.iter().enumerate() {
        let slopes = joint.template.slopes(i);
        let shape = joint.template.shape(i);
        let alone = vec![1.0; head];
        let normal = NormalEquations::of(&sample.sound, &alone, shape, slopes);
        let pull = |t: usize| normal.pull(1.0, shape[t], slopes[t], 1.0);
        let pulls: Vec<f64> = (0..head).map(pull).collect();
        for stretch in 0..STRETCHES {
            let back = real(head) * (1.0 + 0.5 * real(stretch));
            let Some((noise, variance)) = joint.before(i, back, head) else {
                continue;
            };
            let moved: f64 = pulls.iter().zip(&noise).map(|(h, n)| h * n).sum();
            let expected: f64 = pulls.iter().zip(&variance).map(|(h, v)| h * h * v).sum();
            sum += (moved * moved / expected.max(f64::MIN_POSITIVE)).min(MOST_EXCESS);
            count += 1;
        }
    }
    if count == 0 {
        return 0.0;
    }
    // Of white noise the mean scatters by √(2/count) around 1.
    let mean = sum / real(count);
    let scatter = (2.0 / real(count)).sqrt();
    if mean > 1.0 + 2.0 * scatter {
        mean - 1.0
    } else {
        0.0
    }
}

/// Greatest excess of one stretch that counts: a knock in it is no property of the noise.
const MOST_EXCESS: f64 = 1e4;

/// Least attenuation: smaller values are scatter of the noise.
const LEAST_ATTENUATION: f64 = 0.02;

/// Attenuation by errors in variables: the share of the information on time in a template's slope that is not its own noise.
/// A match follows the impact by this share of its move.
///
/// # Formula
/// `1 − Σ w·G·v / (Σ w·s′² − (Σ w·s·s′)²/Σ w·s²)`, w one over the noise, v the variance of a
/// template of one component at each sample, `G·v` that of its slope as it is filtered.
fn attenuation(sample: &Sample, shape: &[f64], slopes: &[f64], noise: f64) -> f64 {
    let normal = NormalEquations::of(&sample.sound, &sample.noise, shape, slopes);
    (1.0 - noise / normal.slope_information()).max(LEAST_ATTENUATION)
}

/// Standard error of one position by independent samples and by blocks.
fn errors(sample: &Sample, shape: &[f64], slopes: &[f64], weights: &[f64]) -> Option<(f64, f64)> {
    let normal = NormalEquations::of(&sample.sound, &sample.noise, shape, slopes);
    let (amplitude, _, independent) = normal.solve(sample.amplitude);
    if !independent.is_finite() || normal.clearness(amplitude) < FAINTEST {
        return None;
    }
    let information: f64 = slopes
        .iter()
        .zip(&sample.noise)
        .map(|(d, n)| d * d / n)
        .sum();
    let (mut sums, mut known, mut block) = ([0.0; BLOCKS], 0.0, 0);
    for t in 0..slopes.len() {
        let noise = sample.noise[t];
        let share = (sample.amplitude.powi(2) / noise / weights[t]).min(MOST_SHARE);
        let left = (sample.sound[t] - sample.amplitude * shape[t]) / (1.0 - share).sqrt();
        let pull = normal.pull(sample.amplitude, shape[t], slopes[t], noise);
        while block + 1 < BLOCKS && known * real(BLOCKS) >= information * real(block + 1) {
            block += 1;
        }
        sums[block] += pull * left;
        known += slopes[t].powi(2) / noise;
    }
    let squares: f64 = sums.iter().map(|s| s * s).sum();
    let blocks = (squares * real(BLOCKS) / real(BLOCKS - FITTED)).sqrt();
    Some((independent, blocks))
}
