//! From dead balls to lively ones, by the number of impacts.

use bounce_audio::synth::scene::Scene;

use super::parallel::each;
use super::trial::{Ball, Heard, heard};

/// e and the height it is dropped from, so that lively balls do not bounce for minutes.
const BALLS: [(f64, f64); 10] = [
    (0.2, 1.0),
    (0.3, 1.0),
    (0.5, 1.0),
    (0.7, 0.5),
    (0.9, 0.3),
    (0.97, 0.1),
    (0.985, 0.05),
    (0.99, 0.05),
    (0.9935, 0.05),
    (0.995, 0.05),
];
/// Caught after so many impacts; none: never.
const IMPACTS: [Option<usize>; 5] = [Some(4), Some(8), Some(20), Some(80), None];
/// Drops of each.
const SEEDS: u64 = 3;

pub(crate) fn table() {
    let cells = BALLS.iter().flat_map(|&(e, height_m)| {
        IMPACTS.map(|impacts| (e, impacts, Ball::new("steel", e, height_m).scene(impacts)))
    });
    let cells: Vec<(f64, Option<usize>, Scene)> = cells.collect();
    let trials = cells
        .iter()
        .flat_map(|cell| (1..=SEEDS).map(move |seed| (&cell.2, seed)));
    let trials: Vec<(&Scene, u64)> = trials.collect();
    let heard = each(&trials, |(scene, seed)| heard(scene, *seed));
    println!(
        "e      | impacts | one drop | drops   | found of those there    | whole | e held | e found"
    );
    for ((e, impacts, _), heard) in cells.iter().zip(heard.chunks(SEEDS as usize)) {
        println!("{}", line(*e, *impacts, heard));
    }
}

fn line(e: f64, impacts: Option<usize>, heard: &[Heard]) -> String {
    let impacts = impacts.map_or_else(|| "all".to_owned(), |n| n.to_string());
    let count = |of: fn(&Heard) -> bool| heard.iter().filter(|h| of(h)).count();
    let list = |of: fn(&Heard) -> String| heard.iter().map(of).collect::<Vec<_>>().join(" ");
    format!(
        "{e:<6} | {impacts:>7} | {:>6}/{} | {:<7} | {:<23} | {:>3}/{} | {:>4}/{} | {}",
        count(|h| h.drops == 1),
        heard.len(),
        list(|h| h.drops.to_string()),
        list(|h| format!("{}/{}", h.found, h.there)),
        count(Heard::is_whole),
        heard.len(),
        count(|h| h.held),
        heard.len(),
        list(|h| h
            .restitution
            .map_or_else(|| "-".to_owned(), |e| format!("{e:.5}"))),
    )
}
