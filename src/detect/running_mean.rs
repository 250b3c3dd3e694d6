//! Running means of the energy before and after each moment.

use crate::units::{narrow, real};

/// Values of equal weight that a window with linearly falling weights is worth. Derived: (Σw)²/Σw² = ¾ of its length.
pub(super) const FALLING_SHARE: f64 = 0.75;

/// `(A + floor)/(B + floor)` at each hop: A is the mean of the `after` energies from it on, with weights that fall
/// linearly to nothing, B the mean of the `before` energies before it.
///
/// The weights of A are greatest at the moment itself, so A peaks where a sound begins and not anywhere before it. The ratio
/// is 0 in the first instants of a recording, which have no past to rise from.
pub(super) fn mean_ratios(energies: &[f32], after: usize, before: usize, floor: f32) -> Vec<f32> {
    let mut ratios = falling_means(energies, after);
    let hops = ratios.len();
    ratios[..before.min(hops)].fill(0.0);
    let mean = 1.0 / real(before);
    let mut sum: f64 = energies.iter().take(before).copied().map(f64::from).sum();
    let newest = energies.get(before..).unwrap_or_default();
    let pairs = energies.chunks(AT_ONCE).zip(newest.chunks(AT_ONCE));
    let after = ratios.get_mut(before..).unwrap_or_default();
    for (ratios, (oldest, newest)) in after.chunks_mut(AT_ONCE).zip(pairs) {
        let mut past = [0.0; AT_ONCE];
        for (past, (&oldest, &newest)) in past.iter_mut().zip(oldest.iter().zip(newest)) {
            *past = narrow((sum * mean).max(0.0));
            sum += f64::from(newest) - f64::from(oldest);
        }
        for (ratio, past) in ratios.iter_mut().zip(past) {
            *ratio = (*ratio + floor) / (past + floor);
        }
    }
    ratios
}

/// Values of a block, whose ratios are computed side by side.
const AT_ONCE: usize = 64;

/// Mean of the `window` values from each one on, with weights that fall linearly to nothing.
fn falling_means(energies: &[f32], window: usize) -> Vec<f32> {
    let length = real(window);
    let scale = 2.0 / (length * real(window + 1));
    let (mut flat, mut falling) = (0.0, 0.0);
    let mut means = vec![0.0; energies.len()];
    let mut step_back = |mean: &mut f32, energy: f32, left: f32| {
        let energy = f64::from(energy);
        // One step earlier every weight but the newest falls by one.
        falling += length * energy - flat;
        flat += energy - f64::from(left);
        *mean = narrow((scale * falling).max(0.0));
    };
    // The value that leaves the window as it moves one step earlier: 0 while it reaches past the end.
    let whole = energies.len().saturating_sub(window);
    let past_end = means[whole..].iter_mut().zip(&energies[whole..]);
    for (mean, &energy) in past_end.rev() {
        step_back(mean, energy, 0.0);
    }
    let inside = means[..whole].iter_mut().zip(energies);
    for ((mean, &energy), &left) in inside.zip(&energies[energies.len() - whole..]).rev() {
        step_back(mean, energy, left);
    }
    means
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn running_means_are_those_of_the_definition() {
        let mut rng = crate::random::SplitMix64::new(4);
        let energies: Vec<f32> = (0..200).map(|_| narrow(rng.uniform())).collect();
        for window in [2, 3, 17, 199, 300] {
            let floor = 0.1;
            let (falling, ratios) = (
                falling_means(&energies, window),
                mean_ratios(&energies, window, window, floor),
            );
            for k in 0..200 {
                let weights: f64 = (1..=window).map(real).sum();
                let ahead = energies[k..].iter().take(window).enumerate();
                let slow: f64 = ahead
                    .map(|(j, &e)| real(window - j) * f64::from(e))
                    .sum::<f64>()
                    / weights;
                assert!(
                    (f64::from(falling[k]) - slow).abs() < 1e-6,
                    "window {window}, hop {k}"
                );
                let behind = &energies[k.saturating_sub(window)..k];
                let past = behind.iter().copied().map(f64::from).sum::<f64>() / real(window);
                let floor = f64::from(floor);
                let ratio = if k < window {
                    0.0
                } else {
                    (slow + floor) / (past + floor)
                };
                assert!(
                    (f64::from(ratios[k]) - ratio).abs() < 1e-6,
                    "window {window}, hop {k}"
                );
            }
        }
    }
}
