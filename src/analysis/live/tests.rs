use super::*;
use crate::analysis::analyze;
use crate::fit::Estimate;
use crate::synth::presets::preset;
use crate::synth::render;
use crate::units::{narrow, real};

const RATE_HZ: f64 = 44_100.0;

/// Half a minute of hiss with a steel ball at 2 s and at 13 s, and a knock each second or none.
fn played(knocks: bool) -> Vec<f32> {
    let drop = render(&preset("steel").unwrap(), 1).unwrap().samples;
    let mut random = crate::random::SplitMix64::new(7);
    let mut samples: Vec<f32> = (0..30 * 44_100)
        .map(|_| narrow(3e-4 * random.normal()))
        .collect();
    for start_s in [2.0, 13.0] {
        let from = samples_in(start_s, RATE_HZ);
        for (x, y) in samples[from..].iter_mut().zip(&drop) {
            *x += 0.7 * y;
        }
    }
    for second in (0..30).filter(|_| knocks) {
        let from = samples_in(f64::from(second) + 0.37, RATE_HZ);
        for (i, x) in samples[from..].iter_mut().take(2_000).enumerate() {
            let ring = (0.13 * i as f32).sin() * (-(i as f32) / 300.0).exp();
            *x += 0.05 * ring;
        }
    }
    samples
}

fn live() -> Live {
    Live::new(1, RATE_HZ, &Settings::default()).unwrap()
}

/// What is told, and when.
fn heard(live: &mut Live, samples: &[f32]) -> Vec<(f64, Told)> {
    let mut told = Vec::new();
    for (n, block) in samples.chunks(2_048).enumerate() {
        let at_s = real((n + 1) * 2_048) / RATE_HZ;
        let new = live.hear(&[block]).unwrap();
        told.extend(new.into_iter().map(|t| (at_s, t)));
    }
    told
}

fn last_s(drop: &Drop) -> f64 {
    drop.impacts.last().unwrap().time_s
}

fn estimate(drop: &Drop) -> Estimate {
    drop.restitution.as_ref().unwrap().estimate
}

#[test]
fn each_drop_is_told_once_and_within_a_second() {
    for knocks in [false, true] {
        let samples = played(knocks);
        let whole = analyze(&samples, RATE_HZ, &Settings::default()).unwrap();
        assert_eq!(whole.drops.len(), 2);
        let mut live = live();
        let told = heard(&mut live, &samples);
        let numbers: Vec<usize> = told.iter().map(|(_, told)| told.number).collect();
        assert_eq!(numbers, [1, 2], "knocks: {knocks}");
        for ((at_s, told), drop) in told.iter().zip(&whole.drops) {
            let ours_s = last_s(&told.drop);
            assert!((ours_s - last_s(drop)).abs() < 0.05, "{ours_s}");
            assert!(at_s - ours_s < 1.0, "told after {}", at_s - ours_s);
            let [e, of_whole] = [&told.drop, drop].map(estimate);
            let off = (e.value - of_whole.value).abs();
            assert!(off < of_whole.std_error.unwrap(), "{e:?} {of_whole:?}");
        }
        assert_eq!(live.finish().unwrap(), [], "knocks: {knocks}");
    }
}

/// Faint last impacts are found in measuring alone, and a drop that then goes on is told once it is over.
#[test]
fn drops_whose_ends_are_faint_are_told() {
    for ball in ["golf", "rubber", "tennis"] {
        let mut scene = preset(ball).unwrap();
        scene.duration_s += 4.0;
        scene.noise.pink_db = -45.0;
        let played = render(&scene, 1).unwrap();
        let rate_hz = f64::from(scene.sample_rate_hz);
        let mut live = Live::new(1, rate_hz, &Settings::default()).unwrap();
        let told = heard(&mut live, &played.samples);
        assert_eq!(told.len(), 1, "{ball}");
    }
}

#[test]
fn what_is_heard_goes_from_nothing_to_a_drop_and_back() {
    let mut live = live();
    let samples = played(false);
    let mut states = vec![live.hears()];
    for block in samples.chunks(4_410) {
        live.hear(&[block]).unwrap();
        if states.last() != Some(&live.hears()) {
            states.push(live.hears());
        }
    }
    let drops = states.iter().filter(|s| **s == Hears::Drop).count();
    assert_eq!(drops, 2, "{states:?}");
    assert_eq!(states.last(), Some(&Hears::Nothing), "{states:?}");
}

#[test]
fn the_end_of_the_sound_ends_a_drop() {
    let samples = played(false);
    let mut live = live();
    // The last flights are still to come.
    let early = samples_in(4.5, RATE_HZ);
    assert!(heard(&mut live, &samples[..early]).is_empty());
    let told = live.finish().unwrap();
    assert_eq!(told.len(), 1);
    assert!(told[0].drop.bounces > 5 && last_s(&told[0].drop) < 4.5);
}

#[test]
fn two_impacts_alone_count_once_it_is_quiet() {
    let mut scene = preset("two-impacts").unwrap();
    scene.duration_s = 8.0;
    let made = render(&scene, 1).unwrap();
    let height_m = made.truth.drops[0].height_m;
    let rate_hz = f64::from(made.truth.sample_rate_hz);
    let settings = Settings::default().height_m(height_m);
    let whole = analyze(&made.samples, rate_hz, &settings).unwrap();
    let mut live = Live::new(1, rate_hz, &settings).unwrap();
    let mut told = Vec::new();
    for block in made.samples.chunks(2_000) {
        told.extend(live.hear(&[block]).unwrap());
    }
    assert_eq!((told.len(), whole.drops.len()), (1, 1));
    assert_eq!(told[0].drop.bounces, 2);
    assert_eq!(live.finish().unwrap(), []);
}

#[test]
fn the_clearest_channel_is_listened_to_and_its_sound_is_held() {
    let samples = played(false);
    let noise = vec![0.0; samples.len()];
    let mut live = Live::new(2, RATE_HZ, &Settings::default()).unwrap();
    let mut told = Vec::new();
    for (quiet, loud) in noise.chunks(4_410).zip(samples.chunks(4_410)) {
        told.extend(live.hear(&[quiet, loud]).unwrap());
    }
    let channels: Vec<usize> = told.iter().map(|t| t.drop.channel).collect();
    assert_eq!(channels, [2, 2]);
    let (from_s, held) = live.since(14.0);
    let from = samples_in(from_s, RATE_HZ);
    assert!((from_s - 14.0).abs() < 1e-4 && held[1] == &samples[from..]);
    assert!(live.hear(&[&samples]).is_err());
}

#[test]
fn silence_is_not_searched() {
    let mut live = live();
    assert!(live.hear(&[vec![0.0; 44_100 * 50]]).unwrap().is_empty());
    assert_eq!((live.searched, live.hears()), (0, Hears::Nothing));
    assert!(live.held[0].len() <= 2 * samples_in(WINDOW_S, RATE_HZ));
}
