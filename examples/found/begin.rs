//! First impacts that are hard to find.

use bounce_audio::synth::recorder::Gap;
use bounce_audio::synth::scene::Scene;

use super::company::add_knocks;
use super::trial::{BALLS, Ball, FIRST_S, HEAD, row};

/// Drops of each kind.
const DROPS: u64 = 12;

fn kind(name: &str, balls: &[Ball], change: impl Fn(&mut Scene)) {
    let of_seed = (1..=DROPS).zip(balls.iter().cycle());
    let trials: Vec<(Scene, u64)> = of_seed
        .map(|(seed, ball)| {
            let mut scene = ball.scene(None);
            change(&mut scene);
            (scene, seed)
        })
        .collect();
    row(name, &trials);
}

pub(crate) fn table() {
    println!("{HEAD}");
    kind("quiet before", &BALLS, |_| ());
    for before_s in [0.0, 1e-3, 0.02, 0.1] {
        kind(&format!("{before_s} s before it"), &BALLS, |scene| {
            scene.recorder.start_s = FIRST_S - before_s;
        });
    }
    for length_s in [0.02, 0.2] {
        kind(&format!("{length_s} s drop-out to it"), &BALLS, |scene| {
            let at_s = FIRST_S - length_s;
            scene.recorder.drop_outs = vec![Gap { at_s, length_s }];
        });
    }
    kind("after three knocks", &BALLS, |scene| {
        let own = scene.drops[0].modes.clone();
        scene.drops[0].first_impact_s += 2.0;
        scene.duration_s += 2.0;
        add_knocks(scene, &own);
    });
    let high = BALLS.map(|ball| Ball {
        height_m: 10.0,
        ..ball
    });
    kind("from 10 m", &high, |scene| {
        scene.drops[0].height_spread = 0.0;
    });
}
