//! What holds for every recording that is made.

use super::*;
use scene::preset;

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
