//! Templates learnt from made sounds.

use super::*;
use crate::random::SplitMix64;

#[test]
fn components_and_misfit_are_those_that_the_sounds_were_made_of() {
    let mut rng = SplitMix64::new(8);
    let shapes = [|t: f64| (0.3 * t).sin(), |t: f64| 0.2 * (0.5 * t).cos()];
    let impacts: Vec<Sample> = (0..400)
        .map(|i| {
            let (amplitude, contact_stretch) = (50.0 + real(i % 7), 0.01 * real(i % 100) - 0.5);
            let sound = (0..60).map(|t| {
                let shape = shapes[0](real(t)) + contact_stretch * shapes[1](real(t));
                // Impacts differ by 2 % from sample 30 on.
                let differs = if t < 30 { 0.0 } else { 0.02 * rng.normal() };
                amplitude * (shape + differs) + rng.normal()
            });
            Sample {
                amplitude,
                contact_stretch,
                sound: sound.collect(),
                noise: vec![1.0; 60],
                weights: vec![1.0; 60],
            }
        })
        .collect();
    let mut template = Template::new(vec![0.0; 60], vec![0.0; 60], 10);
    template.components.push(vec![0.0; 60]);
    let contact_stretches: Vec<f64> = impacts.iter().map(|s| s.contact_stretch).collect();
    template.learn_shape(&impacts, &contact_stretches);
    template.learn_misfit(&impacts, &contact_stretches, 2);
    for t in 0..60 {
        for (component, shape) in template.components.iter().zip(shapes) {
            let off = component[t] - shape(real(t));
            assert!(off.abs() < 0.02, "sample {t}: off by {off}");
        }
    }
    assert!(template.misfit[..25].iter().all(|&v| v < 1e-4));
    let late = template.misfit[35..].iter().sum::<f64>() / 25.0;
    assert!((late / 4e-4 - 1.0).abs() < 0.15, "{late}");
}

#[test]
fn heads_learnt_again_change_each_sound_and_its_derivative_as_learning_all_does() {
    let mut rng = SplitMix64::new(9);
    let contact_stretches: Vec<f64> = (0..12).map(|i| 0.1 * real(i) - 0.5).collect();
    let mut sounds = |length: usize| -> Vec<Sample> {
        let sample = |&contact_stretch: &f64| Sample {
            amplitude: 20.0 + contact_stretch,
            contact_stretch,
            sound: (0..length).map(|_| 20.0 * rng.normal()).collect(),
            noise: (0..length).map(|_| 1.0 + rng.normal().powi(2)).collect(),
            weights: vec![1.0; length],
        };
        contact_stretches.iter().map(sample).collect()
    };
    let mut template = Template::new(vec![0.0; 90], vec![0.0; 90], 10);
    template.components.resize(3, vec![0.0; 90]);
    for length in [90, template.head, template.head] {
        let sounds = sounds(length.min(90));
        template.learn_shape(&sounds, &contact_stretches);
        template.learn_misfit(&sounds, &contact_stretches, 2);
        let head = template.head;
        for (i, u) in contact_stretches.iter().enumerate() {
            let mut shape = vec![0.0; 90];
            combine(&template.components, *u, &mut shape);
            assert_eq!(template.shape(i), shape);
            let slopes = slope(&shape[..(head + KERNEL).min(90)]);
            assert_eq!(template.slopes(i).len(), head);
            for (fast, slow) in template.slopes(i).iter().zip(slopes) {
                assert!((fast - slow).abs() < 1e-10, "impact {i}: {fast} vs {slow}");
            }
        }
    }
}

#[test]
fn what_has_little_weight_teaches_no_misfit() {
    let mut rng = SplitMix64::new(5);
    let sample = |i: usize, rng: &mut SplitMix64| {
        // One of them with a knock a hundred times as loud as the noise, known as such.
        let knock = if i == 7 { 100.0 } else { 1.0 };
        let at = |t: usize| 20.0 * (0.3 * real(t)).sin() + knock * rng.normal();
        Sample {
            amplitude: 20.0,
            contact_stretch: 0.0,
            sound: (0..60).map(at).collect(),
            noise: vec![knock * knock; 60],
            weights: vec![knock.powi(-2); 60],
        }
    };
    let impacts: Vec<Sample> = (0..40).map(|i| sample(i, &mut rng)).collect();
    let mut template = Template::new(vec![0.0; 60], vec![0.0; 60], 10);
    template.learn_shape(&impacts, &[]);
    template.learn_misfit(&impacts, &[], 2);
    // Of noise of variance 1 in 400, a tenth is left by chance.
    let greatest = template.misfit.iter().copied().fold(0.0, f64::max);
    assert!(greatest < 1e-3, "{greatest}");
}

#[test]
fn the_onset_moves_as_the_sound_does_between_the_samples_too() {
    // A wave of 8 kHz that begins within a fifth of a millisecond, at 48 kHz.
    let sound = |begin: f64| -> Vec<f64> {
        let level = |t: f64| t.max(0.0).powi(2) * (-t / 8.0).exp();
        let each = (0..400).map(|i| real(i) - begin);
        each.map(|t| level(t) * (1.05 * t).sin()).collect()
    };
    let off = (0..20).map(|k| {
        let moved = 0.05 * real(k);
        Template::new(sound(100.0 + moved), vec![0.0; 400], 100).onset(48_000.0) - moved
    });
    let off: Vec<f64> = off.collect();
    let range = |by: fn(f64, f64) -> f64| off.iter().copied().reduce(by).unwrap();
    let spread = range(f64::max) - range(f64::min);
    assert!(spread < 0.03, "{spread} samples");
}
