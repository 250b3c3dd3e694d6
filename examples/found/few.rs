//! Balls that are caught after a few impacts.

use bounce_audio::Settings;

use super::parallel::each;
use super::trial::{BALLS, HEAD, heard_with, line};

/// Drops of each ball.
const SEEDS: u64 = 5;

pub(crate) fn table() {
    println!("{HEAD} | least and median nats");
    for impacts in 1..=5 {
        for with_height in [false, true] {
            let trials = BALLS
                .iter()
                .flat_map(|ball| (1..=SEEDS).map(move |seed| (ball, seed)));
            let trials: Vec<_> = trials.collect();
            let heard = each(&trials, |(ball, seed)| {
                let mut scene = ball.scene(Some(impacts));
                scene.drops[0].height_spread = 0.0;
                let height_m = with_height.then_some(ball.height_m);
                heard_with(&scene, *seed, &Settings::default().height_m(height_m))
            });
            let height = if with_height { ", height known" } else { "" };
            let mut nats: Vec<f64> = heard.iter().filter_map(|h| h.evidence_nats).collect();
            nats.sort_by(f64::total_cmp);
            let nats = |share: f64| {
                let place = (share * nats.len() as f64) as usize;
                nats.get(place)
                    .map_or_else(|| "-".to_owned(), |n| format!("{n:.1}"))
            };
            println!(
                "{} | {}, {}",
                line(&format!("{impacts} impacts{height}"), &heard),
                nats(0.0),
                nats(0.5)
            );
        }
    }
}
