//! What is played: twenty drops in one stream, in each of four rooms.

use bounce_audio::synth::bursts::Steps;
use bounce_audio::synth::presets::preset;
use bounce_audio::synth::scene::Scene;

/// Balls that are dropped by turns.
const BALLS: [&str; 5] = ["pingpong", "steel", "golf", "rubber", "tennis"];
/// From the first impact of one drop to that of the next, in seconds.
const EVERY_S: f64 = 9.0;
/// The first impact of all, in seconds.
const FIRST_S: f64 = 3.0;
/// As of most sound cards.
pub(crate) const RATE_HZ: u32 = 48_000;
const DROPS: usize = 20;

/// Knocks of a knuckle on wood.
const KNOCKS: Steps = Steps {
    every_s: 1.0,
    jitter_s: 0.02,
    level_db: -12.0,
    frequency_hz: 900.0,
    decay_s: 0.01,
};

/// A room by its name.
pub(crate) const ROOMS: [&str; 4] = [
    "quiet",
    "pink noise",
    "a knock each second",
    "speech-like babble",
];

/// The stream of a room.
pub(crate) fn scene(room: &str) -> Scene {
    let mut scene = preset(BALLS[0]).unwrap();
    let balls = (0..DROPS).map(|i| {
        let mut drop = preset(BALLS[i % BALLS.len()]).unwrap().drops[0].clone();
        drop.first_impact_s = FIRST_S + EVERY_S * i as f64;
        drop.height_spread = 0.1;
        drop
    });
    scene.drops = balls.collect();
    scene.sample_rate_hz = RATE_HZ;
    scene.duration_s = FIRST_S + EVERY_S * DROPS as f64;
    scene.peak_db = -6.0;
    match room {
        "pink noise" => scene.noise.pink_db = -45.0,
        "a knock each second" => scene.noise.steps = Some(KNOCKS),
        "speech-like babble" => scene.noise.babble_db = -35.0,
        _ => {}
    }
    scene
}
