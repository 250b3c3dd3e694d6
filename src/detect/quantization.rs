//! Quantization noise: a recorder rounds samples to steps of its own.

use crate::signal::filterbank::Filterbank;

/// Coarsest step believed. Derived: that of 8 bits; larger differences are clicks in digital silence.
const COARSEST_STEP: f32 = 1.0 / 128.0;

/// Energy of the quantization noise per Hz.
///
/// # Formula
/// `q²/12` over half the rate, q being the recording's step: the smallest difference of neighbouring samples. Between
/// the sounds of a coarse recording a few samples toggle by one step and the rest are equal, so no quantile of its
/// energy knows this.
pub(super) fn quantization_density(samples: &[f32], bank: &Filterbank) -> f64 {
    // Lanes without branches: this loop runs over every sample.
    let mut least = [f32::INFINITY; LANES];
    let next = samples.get(1..).unwrap_or_default();
    let (chunks, rest) = next.as_chunks::<LANES>();
    for (later, earlier) in chunks.iter().zip(samples.as_chunks::<LANES>().0) {
        for (least, (b, a)) in least.iter_mut().zip(later.iter().zip(earlier)) {
            *least = smaller_step(*least, b - a);
        }
    }
    let tail = samples[samples.len() - samples.len().min(rest.len() + 1)..].windows(2);
    let least = tail.map(|w| w[1] - w[0]).chain(least);
    let step = least.fold(f32::INFINITY, smaller_step);
    if step <= COARSEST_STEP {
        f64::from(step).powi(2) / 12.0 / (0.5 * bank.sample_rate_hz())
    } else {
        0.0
    }
}

/// Lanes that run side by side in the machine's vectors.
const LANES: usize = 8;

/// The smaller of a step and the size of a difference that is not 0.
fn smaller_step(step: f32, difference: f32) -> f32 {
    let size = difference.abs();
    let size = if size > 0.0 { size } else { f32::INFINITY };
    if size < step { size } else { step }
}
