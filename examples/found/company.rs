//! What other sounds cost a drop.

use bounce_audio::synth::scene::{Mode, Scene};
use bounce_audio::synth::taps::Taps;

use super::parallel::each;
use super::trial::{BALLS, Heard, heard};

/// Drops of each kind.
const SEEDS: u64 = 4;
/// Caught after so many impacts; none: never.
const IMPACTS: [Option<usize>; 5] = [Some(5), Some(6), Some(8), Some(13), None];

/// Adds three knocks as loud as the first hit, at intervals that grow, the first 2 s before it.
pub(crate) fn add_knocks(scene: &mut Scene, modes: &[Mode]) {
    scene.noise.taps.push(Taps {
        first_s: scene.drops[0].first_impact_s - 2.0,
        count: 3,
        interval_s: 0.45,
        interval_factor: 1.3,
        interval_scatter: 0.1,
        level_db: scene.peak_db,
        level_step_db: 0.0,
        level_scatter_db: 0.0,
        contact_time_s: 5e-4,
        modes: modes.to_vec(),
        level_scatter: 0.3,
        frequency_scatter: 0.01,
    });
}

/// A sound unlike that of the balls.
const OTHER: [Mode; 2] = [mode(750.0, 0.02), mode(1_900.0, 0.01)];

const fn mode(frequency_hz: f64, decay_s: f64) -> Mode {
    Mode {
        frequency_hz,
        decay_s,
        level: 1.0,
    }
}

/// Evidence of drops alone, after knocks that sound like them, and after knocks that do not.
pub(crate) fn knocks() {
    println!(
        "ball      | impacts | nats alone | like it | unlike it | impacts found alone, like, unlike"
    );
    for ball in BALLS {
        for impacts in IMPACTS {
            let mut alone = ball.scene(impacts);
            alone.drops[0].first_impact_s += 2.0;
            alone.duration_s += 2.0;
            let (mut alike, mut unlike) = (alone.clone(), alone.clone());
            add_knocks(&mut alike, &alone.drops[0].modes);
            add_knocks(&mut unlike, &OTHER);
            let scenes = [alone, alike, unlike].map(|scene| of_seeds(&scene));
            let impacts = impacts.map_or_else(|| "all".to_owned(), |n| n.to_string());
            let [alone, alike, unlike] = scenes.each_ref().map(|heard| nats(heard));
            let found = scenes.map(|heard| found(&heard)).join(", ");
            println!(
                "{:<9} | {impacts:>7} | {alone:>10} | {alike:>7} | {unlike:>9} | {found}",
                ball.preset
            );
        }
    }
}

fn of_seeds(scene: &Scene) -> Vec<Heard> {
    let seeds: Vec<u64> = (1..=SEEDS).collect();
    each(&seeds, |seed| heard(scene, *seed))
}

/// Mean evidence, 0 where there is no drop.
fn nats(heard: &[Heard]) -> String {
    let sum: f64 = heard.iter().map(|h| h.evidence_nats.unwrap_or(0.0)).sum();
    format!("{:.1}", sum / heard.len() as f64)
}

fn found(heard: &[Heard]) -> String {
    let sum = |of: fn(&Heard) -> usize| heard.iter().map(of).sum::<usize>();
    format!("{}/{}", sum(|h| h.found), sum(|h| h.there))
}
