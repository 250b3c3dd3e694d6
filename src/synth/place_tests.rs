//! Microphones and walls with a place, and a ball that wanders before them.

use super::*;
use channel::Channel;
use scene::{Wall, preset};
use truth::DropTruth;

/// Steel that sounds the same each time, before two microphones and walls if so, and wanders by a share of its speed.
fn scene(sideways: f64, walls: bool) -> Scene {
    let mut scene = preset("steel").unwrap();
    scene.noise.white_db = f64::NEG_INFINITY;
    scene.drops[0].level_scatter = 0.0;
    scene.drops[0].sideways = sideways;
    let channel = |at_m| Channel {
        at_m: Some(at_m),
        ..Channel::default()
    };
    scene.recorder.channels = vec![channel([0.4, 0.0, 0.1]), channel([-0.3, 0.2, 0.1])];
    let wall = |bearing_deg, distance_m| Wall {
        bearing_deg,
        distance_m,
        level_db: 0.0,
    };
    if walls {
        scene.walls = vec![wall(90.0, 0.25), wall(270.0, 0.25)];
    }
    scene
}

fn truth(scene: &Scene) -> DropTruth {
    render(scene, 1).unwrap().truth.drops.remove(0)
}

/// Differences between the channels' own onsets.
fn delays_s(truth: &DropTruth) -> Vec<f64> {
    let both = truth.onsets_s.iter().zip(&truth.more_onsets_s[0]);
    both.map(|(a, b)| b - a).collect()
}

#[test]
fn a_ball_that_wanders_is_heard_with_a_delay_that_does_and_flies_as_before() {
    let (still, wandering) = (truth(&scene(0.0, false)), truth(&scene(0.005, false)));
    assert_eq!(still.impacts_s, wandering.impacts_s);
    let expected = (0.14_f64.sqrt() - 0.17_f64.sqrt()) / 343.0;
    assert!(
        delays_s(&still)
            .iter()
            .all(|d| (d - expected).abs() < 1e-12)
    );
    let moved: Vec<f64> = delays_s(&wandering).iter().map(|d| d - expected).collect();
    // The first impact is where it was; 0.5 % of 1.5 m/s are millimetres a flight and centimetres in all.
    assert!(moved[0].abs() < 1e-12);
    let farthest = moved.iter().fold(0.0, |m: f64, d| m.max(d.abs()));
    assert!((1e-5..1e-3).contains(&farthest), "{farthest}");
}

/// Correlation of two sounds.
fn correlation(a: &[f32], b: &[f32]) -> f64 {
    let dot = |a: &[f32], b: &[f32]| -> f64 {
        let products = a.iter().zip(b).map(|(x, y)| f64::from(x * y));
        products.sum()
    };
    dot(a, b) / (dot(a, a) * dot(b, b)).sqrt()
}

/// That of the first impact and of the seventh, 15 ms long.
fn likeness(scene: &Scene) -> f64 {
    let made = render(scene, 1).unwrap();
    let onsets_s = &made.truth.drops[0].onsets_s;
    let rate = f64::from(scene.sample_rate_hz);
    let [a, b] = [0, 6].map(|i| {
        let at = samples_in(onsets_s[i], rate);
        &made.samples[at..at + samples_in(0.015, rate)]
    });
    correlation(a, b)
}

#[test]
fn a_channel_that_hears_otherwise_does_so_alone() {
    let heard = |unlike| {
        let mut scene = scene(0.0, false);
        scene.recorder.channels[1] = Channel {
            unlike,
            ..scene.recorder.channels[0]
        };
        let mut made = render(&scene, 1).unwrap();
        (made.samples, made.more_channels.remove(0))
    };
    let (first, same) = heard(0.0);
    assert!(first == same);
    let (again, half) = heard(0.5);
    let (_, other) = heard(1.0);
    // The loudest of both channels has the peak of the scene, so that the first may be quieter than before.
    assert!(correlation(&first, &again) > 0.999);
    let (half, whole) = (correlation(&again, &half), correlation(&first, &other));
    assert!((0.2..0.9).contains(&half), "{half}");
    assert!(whole.abs() < 0.3, "{whole}");
}

#[test]
fn the_early_part_of_a_room_differs_with_the_place_of_the_impact() {
    let of = |sideways, walls| {
        let mut scene = scene(sideways, walls);
        // So that likeness is no question of where between two samples an onset falls.
        scene.sample_rate_hz *= 8;
        likeness(&scene)
    };
    // A ball in one place sounds alike before walls too, and one that wanders where there are none.
    for (sideways, walls) in [(0.0, true), (0.02, false)] {
        assert!(of(sideways, walls) > 0.95, "{}", of(sideways, walls));
    }
    assert!(of(0.02, true) < 0.9, "{}", of(0.02, true));
}

#[test]
fn a_wall_or_a_distance_without_its_microphone_is_refused() {
    let mut nowhere = scene(0.0, true);
    nowhere.recorder.channels[1].at_m = None;
    let mut twice = scene(0.0, false);
    twice.drops[0].microphone_distance_m = 0.5;
    for (scene, name) in [(nowhere, "walls"), (twice, "at_m")] {
        let error = render(&scene, 1).unwrap_err().to_string();
        assert!(error.starts_with(name), "{error}");
    }
}
