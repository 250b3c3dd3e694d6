//! Made impacts that have nothing in common but that they begin.

use super::*;
use crate::random::SplitMix64;
use crate::units::{real, whole};

const RATE: f64 = 48_000.0;

/// Noise of variance 1, and at each onset a burst of its own noise that rises within 0.1 ms and decays within 2 ms, of modes
/// of its own.
fn recorded(onsets_s: &[f64], loudness: f64, seed: u64) -> Vec<f64> {
    let mut rng = SplitMix64::new(seed);
    let length = whole((onsets_s.last().unwrap() + 0.3) * RATE);
    let mut sound: Vec<f64> = (0..length).map(|_| rng.normal()).collect();
    for onset in onsets_s {
        let modes: Vec<(f64, f64, f64)> = (0..12)
            .map(|_| {
                let hz = 400.0 * (3.6 * rng.uniform()).exp();
                (hz, std::f64::consts::TAU * rng.uniform(), rng.normal())
            })
            .collect();
        let first = whole((onset * RATE).ceil());
        for (k, x) in sound[first..first + 1_200].iter_mut().enumerate() {
            let t_s = real(first + k) / RATE - onset;
            let envelope = (1.0 - (-t_s / 0.1e-3).exp()) * (-t_s / 2e-3).exp();
            let sum = modes
                .iter()
                .map(|(hz, phase, size)| size * (std::f64::consts::TAU * hz * t_s + phase).sin());
            *x += loudness * envelope * sum.sum::<f64>();
        }
    }
    sound
}

fn flights(count: usize) -> Vec<f64> {
    let at = |k: usize| 0.3 + 0.2 * (1.0 - 0.93_f64.powi(i32::try_from(k).unwrap())) / 0.07;
    (0..count).map(at).collect()
}

/// Errors of the onsets, less their median, and their standard deviations, in µs; the priors are off by up to 0.4 ms.
fn errors(sound: &[f64], onsets_s: &[f64], seed: u64) -> Vec<(f64, f64)> {
    let mut rng = SplitMix64::new(seed);
    let priors: Vec<Prior> = onsets_s
        .iter()
        .map(|t| Prior {
            position: (t + 4e-4 * (2.0 * rng.uniform() - 1.0)) * RATE,
            std: 0.5e-3 * RATE,
        })
        .collect();
    let found = onsets(sound, RATE, &priors);
    let late = |(p, t): (&Prior, &f64)| p.position - t * RATE;
    let common = upper_median(found.iter().zip(onsets_s).map(late)).unwrap();
    let each = found.iter().zip(onsets_s);
    each.map(|(p, t)| (1e6 / RATE * (late((p, t)) - common), 1e6 / RATE * p.std))
        .collect()
}

#[test]
fn sounds_unlike_each_other_are_timed_by_their_beginnings_with_errors_that_are_true() {
    let onsets_s = flights(24);
    let (mut off, mut z) = (Vec::new(), Vec::new());
    for seed in 1..=4 {
        let sound = recorded(&onsets_s, 12.0, seed);
        for (error, std) in errors(&sound, &onsets_s, seed) {
            off.push(error.abs());
            z.push((error / std).abs());
        }
    }
    off.sort_by(f64::total_cmp);
    z.sort_by(f64::total_cmp);
    let (half, nine) = (off.len() / 2, 9 * off.len() / 10);
    assert!(
        off[half] < 30.0 && off[nine] < 120.0,
        "{} {} µs",
        off[half],
        off[nine]
    );
    // 0.67 and 1.64 if they were normal.
    assert!(z[half] < 0.9 && z[nine] < 2.2, "z {} {}", z[half], z[nine]);
}

#[test]
fn onsets_do_not_depend_on_where_they_were_expected() {
    let onsets_s = flights(16);
    let sound = recorded(&onsets_s, 12.0, 9);
    let (one, other) = (errors(&sound, &onsets_s, 1), errors(&sound, &onsets_s, 2));
    let pairs = one.iter().zip(&other);
    let mut off: Vec<f64> = pairs
        .map(|((a, std), (b, _))| (a - b).abs() / std)
        .collect();
    off.sort_by(f64::total_cmp);
    // One of them has two likely places.
    assert!(off[8] < 0.5 && off[15] < 3.0, "{off:?} standard deviations");
}

#[test]
fn only_moves_against_the_others_count() {
    let at = |means: &[f64]| -> Vec<Posterior> {
        let posterior = |&mean: &f64| Posterior {
            mean,
            std: 2.0,
            p: Vec::new(),
        };
        means.iter().map(posterior).collect()
    };
    let moved = moves(&at(&[1.0, 2.0, 3.0]), &at(&[6.0, 7.0, 8.1]));
    assert!(moved.iter().all(|z| z.abs() < 0.051), "{moved:?}");
    assert_eq!(
        moves(&at(&[1.0, 2.0, 3.0]), &at(&[1.0, 2.0, 3.5])),
        [0.0, 0.0, 0.25]
    );
}

#[test]
fn a_step_is_too_long_where_what_moves_most_turns_back() {
    assert!(turns_back(&[0.1, -1.0], &[0.1, 0.8]));
    assert!(!turns_back(&[0.1, -1.0], &[0.1, 0.3]));
    assert!(!turns_back(&[0.1, 1.0], &[-0.1, 0.8]));
    assert!(!turns_back(&[], &[]));
}

#[test]
fn onsets_have_come_to_rest() {
    let onsets_s = flights(24);
    for seed in 1..=3 {
        let sound = recorded(&onsets_s, 12.0, seed);
        let each = onsets_s.iter();
        let priors: Vec<Prior> = each
            .map(|t| Prior {
                position: t * RATE,
                std: 0.5e-3 * RATE,
            })
            .collect();
        let windows = Windows::of(&sound, RATE, &priors, &priors);
        let (once, learnt) = Learnt::nothing(&windows, RATE).settled(&windows, RATE);
        let (again, _) = learnt.settled(&windows, RATE);
        let moved = moves(&once, &again);
        assert!(
            moved.iter().all(|z| z.abs() < 0.5),
            "seed {seed}: {moved:?}"
        );
    }
}
