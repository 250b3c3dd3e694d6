//! The variants of `examples/invariance` are what they say, and differences are counted one to one.

#[path = "../../examples/invariance/compare.rs"]
mod compare;
#[path = "../../examples/invariance/recording.rs"]
mod recording;
#[path = "../../examples/invariance/variants.rs"]
mod variants;

use bounce_audio::Settings;
use bounce_audio::analyze;
use bounce_audio::random::SplitMix64;
use bounce_audio::synth::render;
use bounce_audio::synth::scene::preset;
use bounce_audio::units::narrow;

use compare::{Difference, difference};
use recording::Recording;
use variants::{CHANGES, Change, Pauses, Variant};

const RATE: f64 = 8_000.0;
/// When each click is, in samples: a ball of e = 0.8.
const CLICKS: [usize; 7] = [16_000, 19_200, 21_760, 23_808, 25_446, 26_757, 27_806];
const NOISE: f64 = 1e-4;

/// Six seconds of two channels with clicks in noise, the second one louder.
fn original() -> Recording {
    let mut rng = SplitMix64::new(5);
    let mut first: Vec<f32> = (0..48_000).map(|_| narrow(NOISE * rng.normal())).collect();
    for click in CLICKS {
        first[click] = 0.25;
    }
    let second = first.iter().map(|x| 1.5 * x).collect();
    Recording {
        channels: vec![first, second],
        rate: RATE,
    }
}

fn pauses(original: &Recording) -> Pauses {
    let drops = CLICKS[0]..CLICKS[6];
    let quiet = original.quietest(std::slice::from_ref(&drops));
    Pauses {
        drops: Some(drops),
        quiet,
    }
}

fn variants() -> Vec<(Change, Variant)> {
    let original = original();
    let pauses = pauses(&original);
    let variants = CHANGES
        .iter()
        .map(|&change| (change, change.of(&original, &pauses)));
    variants
        .map(|(change, variant)| (change, variant.unwrap_or_else(|| panic!("no {change}"))))
        .collect()
}

#[test]
fn every_click_is_in_every_variant_where_the_shift_says() {
    for (change, variant) in variants() {
        for channel in &variant.recording.channels {
            assert_eq!(channel.len(), variant.recording.len(), "{change}");
            let clicks = (0..channel.len().min(variant.until)).filter(|&i| channel[i].abs() > 0.01);
            let expected = CLICKS.map(|c| c.strict_add_signed(variant.shift));
            assert_eq!(clicks.collect::<Vec<_>>(), expected, "{change}");
        }
    }
}

#[test]
fn a_variant_is_the_original_but_for_a_factor_far_above_its_rounding() {
    let original = original();
    for (change, variant) in variants() {
        let channel = &variant.recording.channels[0];
        let at = |i: usize| f64::from(channel[i.strict_add_signed(variant.shift)]);
        let factor = at(CLICKS[0]) / f64::from(original.channels[0][CLICKS[0]]);
        let middle = 17_000..25_000;
        let off = middle.map(|i| (at(i) - factor * f64::from(original.channels[0][i])).powi(2));
        let rms = (off.sum::<f64>() / 8_000.0).sqrt();
        assert!(rms < 0.11 * factor.abs() * NOISE, "{change}: {rms}");
    }
}

#[test]
fn nothing_is_cut_where_something_sounds() {
    let mut loud = original();
    loud.channels[1][50] = 0.1;
    let pauses = pauses(&loud);
    assert_eq!(Change::CutFront(100).of(&loud, &pauses), None);
    assert!(Change::CutFront(1).of(&loud, &pauses).is_some());
    // The first click is less than 0.3 s later.
    assert_eq!(Change::CutFront(13_700).of(&original(), &pauses), None);
}

#[test]
fn rounding_that_is_as_loud_as_the_noise_is_no_variant() {
    let original = original();
    let pauses = pauses(&original);
    assert!(Change::Rounded(-1.0, 16).of(&original, &pauses).is_some());
    assert_eq!(Change::Rounded(-1.0, 12).of(&original, &pauses), None);
}

#[test]
fn what_is_lost_and_gained_is_counted_once() {
    let original = original();
    let heard = analyze(&original.channels[0], RATE, &Settings::default()).unwrap();
    assert_eq!(heard.drops.len(), 1);
    let same = difference(&heard, heard.drops.iter(), 0.0);
    let nothing = Difference {
        restitutions: vec![0.0],
        ..Difference::default()
    };
    assert_eq!(same, nothing);
    let none = difference(&heard, std::iter::empty(), 0.0);
    assert_eq!((none.drops_lost, none.drops_gained), (1, 0));
    let twice = difference(&heard, heard.drops.iter().chain(&heard.drops), 0.0);
    assert_eq!((twice.drops_lost, twice.drops_gained), (0, 1));
    let mut other = heard.clone();
    let drop = &mut other.drops[0];
    drop.impacts.remove(3);
    drop.impacts[0].time_s -= 2.0 * heard.drops[0].impacts[0].time_std_s.unwrap();
    let other = difference(&heard, other.drops.iter(), 0.0);
    assert_eq!((other.impacts_lost, other.impacts_gained), (1, 0));
    assert!((other.time - 2.0).abs() < 1e-6, "{}", other.time);
    assert!(other.restitution() == 0.0);
}

/// A scene of the program.
fn scene(name: &str) -> Recording {
    let made = render(&preset(name).unwrap(), 1).unwrap();
    Recording {
        channels: vec![made.samples],
        rate: f64::from(made.truth.sample_rate_hz),
    }
}

#[test]
fn the_same_sound_gives_the_same_answer_wherever_and_however_loud_it_is() {
    // Balls of few impacts were lost behind zeros, and the last impacts of others came and went with the phase of the grid.
    for name in ["dead", "squash", "golf", "pingpong"] {
        let original = scene(name);
        let answer = analyze(&original.channels[0], original.rate, &Settings::default()).unwrap();
        assert_eq!(answer.drops.len(), 1, "{name}");
        // Without pauses: what changes the noise is left out.
        let pauses = Pauses {
            drops: None,
            quiet: None,
        };
        for change in CHANGES {
            let Some(variant) = change.of(&original, &pauses) else {
                continue;
            };
            let channel = &variant.recording.channels[0];
            let other = analyze(channel, original.rate, &Settings::default()).unwrap();
            let shift_s = variant.shift as f64 / original.rate;
            let off = difference(&answer, other.drops.iter(), shift_s);
            let counts = (
                off.impacts_lost,
                off.impacts_gained,
                off.drops_lost,
                off.drops_gained,
            );
            assert_eq!(counts, (0, 0, 0, 0), "{name}, {change}");
            assert!(off.restitution() < 0.02, "{name}, {change}: {off:?}");
            assert!(off.time < 0.5, "{name}, {change}: {off:?}");
        }
    }
}
