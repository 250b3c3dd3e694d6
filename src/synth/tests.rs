//! What holds for every recording that is made.

use super::*;
use scene::preset;
use truth::DropTruth;

#[test]
fn the_same_seed_gives_the_same_samples_and_another_seed_others() {
    let scene = preset("pingpong").unwrap();
    let (a, b, c) = (
        render(&scene, 1).unwrap(),
        render(&scene, 1).unwrap(),
        render(&scene, 2).unwrap(),
    );
    assert!(a.samples == b.samples && a.samples != c.samples);
    assert_eq!(a.truth.drops[0].impacts_s, b.truth.drops[0].impacts_s);
}

#[test]
fn the_loudest_sample_is_where_the_scene_wants_it() {
    let scene = preset("steel").unwrap();
    let made = render(&scene, 1).unwrap();
    let peak = made.samples.iter().fold(0.0_f32, |m, x| m.max(x.abs()));
    assert!((20.0 * f64::from(peak).log10() - scene.peak_db).abs() < 0.2);
}

#[test]
fn nothing_is_heard_before_the_first_impact() {
    let mut scene = preset("rubber").unwrap();
    scene.noise.white_db = f64::NEG_INFINITY;
    let made = render(&scene, 3).unwrap();
    let rate = f64::from(scene.sample_rate_hz);
    let sample = samples_in(made.truth.drops[0].impacts_s[0], rate);
    assert!(made.samples[..sample - 2].iter().all(|&x| x == 0.0));
    assert!(
        made.samples[sample + 20..sample + 60]
            .iter()
            .any(|&x| x.abs() > 1e-3)
    );
}

#[test]
fn a_late_start_and_an_early_stop_cut_the_recording_and_its_truth() {
    let whole = preset("steel").unwrap();
    let mut cut = whole.clone();
    cut.recorder.start_s = 1.0;
    cut.recorder.stop_s = Some(2.5);
    let (whole, cut) = (render(&whole, 4).unwrap(), render(&cut, 4).unwrap());
    assert_eq!(cut.samples.len(), 66_150);
    let (all, kept) = (&whole.truth.drops[0], &cut.truth.drops[0]);
    let counts = kept.impacts_before + kept.impacts_s.len() + kept.impacts_after;
    assert!(kept.impacts_before > 0 && kept.impacts_after > 0);
    assert_eq!(counts, all.impacts_s.len());
    for (i, t) in kept.impacts_s.iter().enumerate() {
        assert!((t + 1.0 - all.impacts_s[kept.impacts_before + i]).abs() < 1e-12);
    }
}

#[test]
fn channels_differ_by_their_delay() {
    let mut scene = preset("steel").unwrap();
    scene.noise.white_db = f64::NEG_INFINITY;
    let later = Channel {
        delay_s: 100.0 / f64::from(scene.sample_rate_hz),
        inverted: true,
        ..Channel::default()
    };
    scene.recorder.channels.push(later);
    let made = render(&scene, 1).unwrap();
    let second = &made.more_channels[0];
    let worst = made
        .samples
        .iter()
        .zip(&second[100..])
        .map(|(a, b)| (a + b).abs());
    // A hundredth of a step may turn the rounding of a sample.
    assert!(worst.fold(0.0, f32::max) <= 1.0 / 32_768.0);
}

#[test]
fn less_is_audible_in_more_noise_and_the_limit_grows_with_it() {
    let mut scene = preset("steel").unwrap();
    scene.noise.white_db = -80.0;
    let quiet = render(&scene, 1).unwrap().truth.drops.remove(0);
    scene.noise.white_db = -20.0;
    let noisy = render(&scene, 1).unwrap().truth.drops.remove(0);
    let heard = |d: &DropTruth| d.audible.iter().filter(|&&a| a).count();
    assert!(heard(&noisy) + 5 < heard(&quiet));
    let worse = noisy.timing_limit_s[0] / quiet.timing_limit_s[0];
    assert!((worse / 1_000.0 - 1.0).abs() < 0.1, "{worse}");
}

#[test]
fn the_rolling_ball_is_heard_later_and_later() {
    let made = render(&preset("rolling").unwrap(), 1).unwrap();
    let drop = &made.truth.drops[0];
    let delays: Vec<f64> = (0..drop.onsets_s.len())
        .map(|i| drop.onsets_s[i] - drop.impacts_s[i])
        .collect();
    assert!(delays.windows(2).all(|w| w[1] > w[0]));
}

/// Ratio of the speed after each impact to that before, of the only drop.
fn ratios(scene: &Scene) -> Vec<f64> {
    let made = render(scene, 1).unwrap();
    made.truth.drops[0].restitution_each.clone()
}

/// Steel without scatter, so that every bounce has its nominal e.
fn even_bounces() -> Scene {
    let mut scene = preset("steel").unwrap();
    scene.drops[0].bounce_scatter = 0.0;
    scene
}

#[test]
fn one_odd_bounce_changes_this_bounce_alone_and_is_in_the_truth() {
    let mut scene = even_bounces();
    scene.drops[0].changes = vec![scene::BounceChange {
        impact: 5,
        restitution_factor: 0.8,
        lasting: false,
    }];
    let each = ratios(&scene);
    for (i, e) in each.iter().enumerate().take(12) {
        let expected = if i == 4 { 0.72 } else { 0.9 };
        assert!((e - expected).abs() < 1e-12, "{i}: {e}");
    }
    let truth = render(&scene, 1).unwrap().truth.drops.remove(0);
    assert_eq!((truth.irregular, truth.changes), (vec![4], vec![]));
    assert!((truth.restitution - 0.9).abs() < 1e-12);
}

#[test]
fn another_surface_changes_all_bounces_from_there_on() {
    let mut scene = even_bounces();
    scene.drops[0].changes = vec![scene::BounceChange {
        impact: 5,
        restitution_factor: 0.9,
        lasting: true,
    }];
    let truth = render(&scene, 1).unwrap().truth.drops.remove(0);
    for (i, e) in truth.restitution_each.iter().enumerate().take(12) {
        let expected = if i < 4 { 0.9 } else { 0.81 };
        assert!((e - expected).abs() < 1e-12, "{i}: {e}");
        assert!((truth.restitution_nominal_each[i] - expected).abs() < 1e-12);
    }
    assert_eq!((truth.irregular, truth.changes), (vec![], vec![4]));
}

#[test]
fn bounces_by_turns_keep_their_mean_and_no_bounce_makes_energy() {
    let mut scene = even_bounces();
    scene.drops[0].alternation = 0.1;
    let each = ratios(&scene);
    for pair in each.chunks_exact(2).take(6) {
        assert!(((pair[0] / pair[1]).ln() - 0.1).abs() < 1e-12);
        assert!((pair[0] * pair[1] - 0.81).abs() < 1e-12);
    }
    scene.drops[0].alternation = 0.5;
    assert!(ratios(&scene).iter().all(|&e| e <= 1.0));
}

#[test]
fn copies_are_the_same_drop_at_other_times() {
    let mut scene = preset("stone").unwrap();
    scene.noise.white_db = f64::NEG_INFINITY;
    scene.duration_s = 10.0;
    scene.drops[0].copies = Some(scene::Copies {
        count: 3,
        every_s: 3.0,
    });
    let made = render(&scene, 2).unwrap();
    let [first, second, third] = made.truth.drops.as_slice() else {
        panic!("{} drops", made.truth.drops.len());
    };
    for (i, t) in first.impacts_s.iter().enumerate() {
        assert!((second.impacts_s[i] - t - 3.0).abs() < 1e-12);
        assert!((third.impacts_s[i] - t - 6.0).abs() < 1e-12);
    }
    let samples = samples_in(3.0, f64::from(scene.sample_rate_hz));
    let (one, two) = (
        &made.samples[..samples],
        &made.samples[samples..2 * samples],
    );
    // Rounding of the instants may turn a step of the recorder.
    assert!(one.iter().zip(two).all(|(a, b)| (a - b).abs() < 4e-5));
}

#[test]
fn copies_of_more_impacts_than_are_made_are_refused() {
    let mut scene = preset("steel").unwrap();
    scene.duration_s = 100.0;
    scene.drops[0].copies = Some(scene::Copies {
        count: 5_000,
        every_s: 0.01,
    });
    let error = render(&scene, 1).unwrap_err().to_string();
    assert!(error.starts_with("copies"), "{error}");
}

#[test]
fn a_splice_brings_what_follows_forward_and_takes_out_what_it_covers() {
    let whole = preset("steel").unwrap();
    let mut cut = whole.clone();
    let second_s = render(&whole, 1).unwrap().truth.drops[0].onsets_s[1];
    cut.recorder.splices = vec![
        recorder::Gap {
            at_s: 0.7,
            length_s: 0.026,
        },
        recorder::Gap {
            at_s: second_s - 0.001,
            length_s: 0.002,
        },
    ];
    let (whole, cut) = (render(&whole, 1).unwrap(), render(&cut, 1).unwrap());
    let rate = f64::from(whole.truth.sample_rate_hz);
    let [first, both] = [1_147, 1_147 + 88];
    assert_eq!(cut.samples.len(), whole.samples.len() - both);
    assert_eq!(
        cut.samples[44_100..44_110],
        whole.samples[44_100 + both..44_110 + both]
    );
    let (all, kept) = (&whole.truth.drops[0], &cut.truth.drops[0]);
    assert_eq!((kept.impacts_cut, &kept.irregular), (1, &vec![0]));
    assert!((kept.impacts_s[0] - all.impacts_s[0]).abs() < 1e-12);
    assert!((kept.impacts_s[1] - all.impacts_s[2] + real(both) / rate).abs() < 1e-12);
    assert!(first < both && (cut.truth.duration_s - real(cut.samples.len()) / rate).abs() < 1e-12);
}

#[test]
fn nothing_is_heard_in_a_drop_out() {
    let mut scene = preset("steel").unwrap();
    let first_s = render(&scene, 1).unwrap().truth.drops[0].onsets_s[0];
    scene.recorder.drop_outs = vec![recorder::Gap {
        at_s: first_s - 0.01,
        length_s: 0.02,
    }];
    let made = render(&scene, 1).unwrap();
    let at = samples_in(first_s, 44_100.0);
    assert!(made.samples[at - 400..at + 400].iter().all(|&x| x == 0.0));
    let audible = &made.truth.drops[0].audible;
    assert!(!audible[0] && audible[1]);
}

#[test]
fn impacts_of_scattered_frequencies_are_unlike_each_other() {
    let likeness = |scatter: f64| {
        let mut scene = even_bounces();
        scene.noise.white_db = f64::NEG_INFINITY;
        scene.drops[0].level_scatter = 0.0;
        scene.drops[0].frequency_scatter = scatter;
        let made = render(&scene, 1).unwrap();
        let onsets = &made.truth.drops[0].onsets_s;
        let [a, b] = [0, 1].map(|i| {
            let at = samples_in(onsets[i], 44_100.0);
            made.samples[at..at + 400]
                .iter()
                .map(|&x| f64::from(x))
                .collect::<Vec<_>>()
        });
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        dot(&a, &b) / (dot(&a, &a) * dot(&b, &b)).sqrt()
    };
    assert!(likeness(0.1) < likeness(0.0) - 0.2);
}

#[test]
fn words_fall_off_from_syllable_to_syllable() {
    let text = "name = 'x'\nduration_s = 6.0\nnoise.white_db = -inf\nnoise.words = { level_db = -20.0, every_s = 9.0 }";
    let mut scene = Scene::from_toml(text).unwrap();
    let said = |scene: &Scene, seed| {
        let samples = render(scene, seed).unwrap().samples;
        samples.iter().filter(|x| x.abs() > 1e-3).count()
    };
    // One word at most, of half a second and more, at some time in the first nine.
    assert!((1..=20).any(|seed| said(&scene, seed) > 4_000));
    scene.noise.words = None;
    assert_eq!(said(&scene, 1), 0);
}
