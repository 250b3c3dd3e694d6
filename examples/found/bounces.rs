//! Bounces that do not go by one e.

use bounce_audio::synth::recorder::Gap;
use bounce_audio::synth::scene::{BounceChange, DropScene, Scene};

use super::trial::{BALLS, FIRST_S, HEAD, row};

/// Drops of each kind.
const DROPS: u64 = 30;

/// Drops of balls with 15 impacts and more that are changed alike.
fn trials(change: impl Fn(&mut Scene)) -> Vec<(Scene, u64)> {
    let lively = BALLS[1..].iter().cycle();
    let of_seed = (1..=DROPS).zip(lively).map(|(seed, ball)| {
        let mut scene = ball.scene(None);
        change(&mut scene);
        (scene, seed)
    });
    of_seed.collect()
}

fn kind(name: &str, change: impl Fn(&mut DropScene)) {
    row(name, &trials(|scene| change(&mut scene.drops[0])));
}

/// e that scatters from bounce to bounce.
pub(crate) fn scatter() {
    println!("{HEAD}");
    for percent in [0.3, 1.0, 3.0, 5.0, 8.0] {
        kind(&format!("scatter {percent} %"), |drop| {
            drop.bounce_scatter = 0.01 * percent;
        });
    }
}

/// e that is higher and lower by turns, by so much in all.
pub(crate) fn alternating() {
    println!("{HEAD}");
    for percent in [4.0, 8.0, 12.0] {
        kind(&format!("alternation {percent} %"), |drop| {
            drop.alternation = 0.01 * percent;
        });
    }
}

/// Single odd bounces, splices and changes of the surface.
pub(crate) fn odd() {
    println!("{HEAD}");
    let change = |impact, restitution_factor, lasting| BounceChange {
        impact,
        restitution_factor,
        lasting,
    };
    for impact in [2, 3, 5, 8, 12, 16] {
        kind(&format!("a fifth less at {impact}"), |drop| {
            drop.changes = vec![change(impact, 0.8, false)];
        });
    }
    kind("a fifth less at 8 and 11", |drop| {
        drop.changes = vec![change(8, 0.8, false), change(11, 0.8, false)];
    });
    kind("a tenth less at 6", |drop| {
        drop.changes = vec![change(6, 0.9, false)];
    });
    for (impact, factor) in [(5, 0.94), (10, 0.94), (16, 0.94), (8, 0.85), (8, 1.04)] {
        kind(&format!("e times {factor} from {impact} on"), |drop| {
            drop.changes = vec![change(impact, factor, true)];
        });
    }
    for after_s in [0.2, 1.0, 1.6] {
        let gap = Gap {
            at_s: FIRST_S + after_s,
            length_s: 0.026,
        };
        let name = format!("26 ms cut after {after_s} s");
        row(&name, &trials(|scene| scene.recorder.splices = vec![gap]));
    }
}
