use super::*;
use crate::report::WarningCode;
use crate::synth::presets::preset;
use crate::synth::render;
use crate::workers::Task;

const RATE_HZ: f64 = 44_100.0;

/// A drop of a steel ball from 0.5 s on, 4 s long, and hiss as faint as its own.
fn drop_and_hiss() -> (Vec<f32>, Vec<f32>) {
    let drop = render(&preset("steel").unwrap(), 1).unwrap().samples;
    let mut hiss = preset("noise").unwrap();
    hiss.noise.white_db = -70.0;
    (drop, render(&hiss, 1).unwrap().samples)
}

/// Hiss of some seconds, in which drops begin at these times.
fn recording(length_s: f64, drops_s: &[f64]) -> Vec<f32> {
    let (drop, hiss) = drop_and_hiss();
    let mut samples: Vec<f32> = hiss
        .iter()
        .copied()
        .cycle()
        .take(samples_in(length_s, RATE_HZ))
        .collect();
    for &start_s in drops_s {
        let from = samples_in(start_s, RATE_HZ);
        for (x, y) in samples[from..].iter_mut().zip(&drop) {
            *x += 0.7 * y;
        }
    }
    samples
}

fn listener() -> Listener {
    Listener::new(1, RATE_HZ, &Settings::default()).unwrap()
}

fn heard(mut listener: Listener, samples: &[f32], block: usize) -> Analysis {
    for block in samples.chunks(block) {
        listener.push(&[block]).unwrap();
    }
    listener.finish().unwrap().1
}

/// Times of the impacts of each drop.
fn impacts_s(analysis: &Analysis) -> Vec<Vec<f64>> {
    let drops = analysis.drops.iter();
    drops
        .map(|d| d.impacts.iter().map(|i| i.time_s).collect())
        .collect()
}

#[test]
fn blocks_of_any_length_give_the_same() {
    let samples = recording(20.0, &[2.0, 12.3]);
    let whole = heard(listener(), &samples, samples.len());
    assert_eq!(whole.drops.len(), 2);
    for block in [1, 333, 44_100] {
        assert_eq!(
            heard(listener(), &samples, block),
            whole,
            "blocks of {block}"
        );
    }
}

#[test]
fn a_drop_is_found_wherever_the_borders_of_units_are() {
    let unit_s = real(ActivityGate::new(RATE_HZ).unit()) / RATE_HZ;
    for offset in [0.0, 0.01, 0.5, 0.98] {
        let start_s = (40.0 + offset) * unit_s;
        let found = heard(listener(), &recording(20.0, &[start_s]), 8_192);
        let alone = heard(listener(), &recording(20.0, &[0.0]), 8_192);
        let (found, alone) = (impacts_s(&found), impacts_s(&alone));
        assert_eq!((found.len(), alone.len()), (1, 1), "offset {offset}");
        // The faintest ones lean on the noise around them, which is not the same here.
        for (a, b) in found[0].iter().zip(&alone[0]).take(30) {
            assert!((a - b - start_s).abs() < 1e-5, "offset {offset}: {a} {b}");
        }
        assert!(
            found[0].len().abs_diff(alone[0].len()) <= 1,
            "offset {offset}"
        );
    }
}

#[test]
fn the_first_and_the_last_samples_count() {
    // Hardly anything is left before the first impact: the longest of the detector's windows.
    let (drop, _) = drop_and_hiss();
    let first = samples_in(impacts_s(&heard(listener(), &drop, 8_192))[0][0], RATE_HZ);
    let found = heard(listener(), &drop[first - 2_205..first + 100_000], 8_192);
    let times = &impacts_s(&found)[0];
    assert!((times[0] - 0.05).abs() < 1e-3, "{times:?}");
    let codes: Vec<&str> = found.drops[0]
        .warnings
        .iter()
        .map(|w| w.code.word())
        .collect();
    assert!(
        codes.contains(&"late_start") && codes.contains(&"cut_end"),
        "{codes:?}"
    );
}

#[test]
fn silence_before_a_drop_costs_nothing_of_it() {
    let drop = recording(6.0, &[1.0]);
    let mut late = vec![0.0; samples_in(30.0, RATE_HZ)];
    late.extend(&drop);
    let (plain, late) = (
        heard(listener(), &drop, 4_096),
        heard(listener(), &late, 4_096),
    );
    assert_eq!((plain.drops.len(), late.drops.len()), (1, 1));
    assert_eq!(plain.drops[0].bounces, late.drops[0].bounces);
}

#[test]
fn a_scene_that_is_cut_loses_no_drop_and_tells_none_twice() {
    let starts: Vec<f64> = (0..12).map(|i| 4.3 * real(i)).collect();
    let samples = recording(54.0, &starts);
    let whole = impacts_s(&heard(listener(), &samples, 8_192));
    assert_eq!(whole.len(), starts.len());
    for most_s in [11.0, 13.7, 20.0] {
        let mut short = listener();
        short.most_held = samples_in(most_s, RATE_HZ);
        let found = heard(short, &samples, 8_192);
        let times = impacts_s(&found);
        let starts: Vec<f64> = times.iter().map(|t| t[0]).collect();
        assert_eq!(times.len(), whole.len(), "{most_s} s held: {starts:?}");
        for (a, b) in times.iter().zip(&whole) {
            assert!(
                (a[0] - b[0]).abs() < 1e-4,
                "{most_s} s held: {} for {}",
                a[0],
                b[0]
            );
            assert!(
                a.len().abs_diff(b.len()) <= 2,
                "{most_s} s held: {} for {}",
                a.len(),
                b.len()
            );
        }
        assert!(found.warnings.is_empty(), "{:?}", found.warnings);
    }
}

#[test]
fn a_drop_longer_than_the_memory_is_split_and_that_is_said() {
    let mut short = listener();
    short.most_held = samples_in(2.0, RATE_HZ);
    let found = heard(short, &recording(10.0, &[1.0]), 8_192);
    assert!(!found.drops.is_empty());
    assert!(
        found.warnings.iter().any(|w| w.code == WarningCode::Torn),
        "{:?}",
        found.warnings
    );
}

#[test]
fn what_is_held_does_not_grow() {
    let samples = recording(10.0, &[0.0, 4.3]);
    let mut listener = listener();
    listener.most_held = samples_in(12.0, RATE_HZ);
    let mut longest = 0;
    for _ in 0..6 {
        for block in samples.chunks(8_192) {
            listener.push(&[block]).unwrap();
            longest = longest.max(listener.held.channels[0].len());
        }
    }
    assert!(longest < samples_in(12.5, RATE_HZ), "{longest}");
}

#[test]
fn scenes_that_wait_for_each_other_give_the_same_in_the_same_memory() {
    // Alone, one behind another in one scene, and again.
    let samples = recording(70.0, &[1.0, 14.0, 18.3, 22.6, 36.0, 49.0, 53.3, 62.0]);
    let one_by_one = |tasks: Vec<Task<'_>>| tasks.into_iter().rev().for_each(|task| task());
    for most_s in [11.0, 30.0, 100.0] {
        let short = || Listener {
            most_held: samples_in(most_s, RATE_HZ),
            ..listener()
        };
        let mut many = short().with_workers(Workers::new(one_by_one));
        let (mut longest, mut most_waiting) = (0, 0);
        for block in samples.chunks(8_192) {
            many.push(&[block]).unwrap();
            let waiting = many.waiting.iter().map(|scene| &scene.held);
            let held = waiting.chain([&many.held]).map(|h| h.channels[0].len());
            longest = longest.max(held.sum());
            most_waiting = most_waiting.max(many.waiting.len());
        }
        assert!(longest < samples_in(most_s + 0.5, RATE_HZ), "{most_s} s");
        assert!(most_waiting >= 1, "{most_s} s");
        let (one, many) = (heard(short(), &samples, 8_192), many.finish().unwrap().1);
        assert_eq!(one, many, "{most_s} s");
        assert!(one.drops.len() >= 8, "{} drops", one.drops.len());
    }
}

#[test]
fn a_stream_of_more_than_two_days_is_listened_to() {
    let samples = recording(10.0, &[2.0]);
    let first = 1_u64 << 33;
    let mut late = listener();
    // As it stands after silence of that length, which is too long to be pushed.
    late.listened.start = first;
    (late.position, late.held) = (first, Held::new(1, first));
    let (late, early) = (
        heard(late, &samples, 8_192),
        heard(listener(), &samples, 8_192),
    );
    let (late, early) = (&impacts_s(&late)[0], &impacts_s(&early)[0]);
    assert_eq!(late.len(), early.len());
    let gone_s = frame_time_s(first, RATE_HZ);
    for (a, b) in late.iter().zip(early) {
        assert!((a - gone_s - b).abs() < 1e-6, "{a} {b}");
    }
}

#[test]
fn the_channel_is_chosen_for_each_drop() {
    let (first, second) = (recording(20.0, &[1.0]), recording(20.0, &[11.0]));
    let mut listener = Listener::new(2, RATE_HZ, &Settings::default()).unwrap();
    listener.push(&[first, second]).unwrap();
    let drops = listener.finish().unwrap().1.drops;
    let channels: Vec<usize> = drops.iter().map(|d| d.channel).collect();
    assert_eq!(channels, [1, 2]);
}

#[test]
fn channels_have_to_be_as_announced() {
    assert!(listener().push(&[[0.0_f32], [0.0]]).is_err());
    assert!(Listener::new(0, RATE_HZ, &Settings::default()).is_err());
}

#[test]
fn more_than_fits_the_memory_is_refused_at_once() {
    let one = "sample rate is 4000000000, expected 1536000 Hz or less: resample it";
    let of_them = "expected 1536000 Hz or less: listen to one of them, or resample it";
    for (channels, rate_hz, said) in [
        (1, 4e9, one),
        (65_535, 44_100.0, of_them),
        (33, 48_000.0, of_them),
    ] {
        let error = Listener::new(channels, rate_hz, &Settings::default()).unwrap_err();
        assert!(error.to_string().ends_with(said), "{error}");
    }
    assert!(Listener::new(32, 48_000.0, &Settings::default()).is_ok());
}

#[test]
fn a_part_without_a_sample_is_named_by_its_end() {
    let settings = Settings {
        start_s: Some(0.5),
        end_s: Some(0.5 + 1e-9),
        ..Settings::default()
    };
    let mut listener = Listener::new(1, RATE_HZ, &settings).unwrap();
    listener.push(&[vec![0.1; 44_100]]).unwrap();
    let error = listener.finish().unwrap_err().to_string();
    assert!(error.starts_with("end is 0.5"), "{error}");
}
