//! Clips without a ball: how often a drop is found in them.

use std::fs;
use std::path::{Path, PathBuf};

use bounce_audio::audio::read_file;
use bounce_audio::random::SplitMix64;
use bounce_audio::synth::babble::Words;
use bounce_audio::synth::bursts::{Knocks, Steps};
use bounce_audio::synth::render;
use bounce_audio::synth::scene::{Mode, Scene};
use bounce_audio::synth::taps::Taps;
use bounce_audio::{Analysis, Settings, analyze, analyze_clearest};

use super::parallel::each;

/// Clips of each kind.
const CLIPS: u64 = 25;

/// What makes a clip from a scene with nothing but noise.
type Change = fn(&mut Scene, &mut SplitMix64);

const KINDS: [(&str, Change); 20] = [
    ("talk", talk),
    ("words that quicken", words),
    ("a game of bats", play),
    ("balls that are dribbled", dribbling),
    ("claps", claps),
    ("a keyboard", keyboard),
    ("steps", steps),
    ("doors", doors),
    ("knocks at random", knocks),
    ("handling", handling),
    ("a few claps", few_claps),
    ("a call and steps", call_and_steps),
    ("words with pauses", few_words),
    ("taps, equal", |s, r| {
        taps(s, r, [1.0, 1.0], 0.02, 0.0);
    }),
    ("taps, equal and fading", |s, r| {
        taps(s, r, [1.0, 1.0], 0.02, -2.0);
    }),
    ("taps that slow down", |s, r| {
        taps(s, r, [1.05, 1.3], 0.03, 0.0);
    }),
    ("taps that quicken", |s, r| {
        taps(s, r, [0.75, 0.95], 0.03, 0.0);
    }),
    ("taps quicker and louder", |s, r| {
        taps(s, r, [0.75, 0.95], 0.03, 1.5);
    }),
    ("a metronome", |s, r| {
        taps(s, r, [1.0, 1.0], 0.0, 0.0);
    }),
    ("a clock", clock),
];

/// Sounds that come in twos and threes and then no more: little tells them from a ball that is caught.
const PAIRS: [(&str, Change); 4] = [
    ("three claps", |s, r| {
        claps(s, r);
        s.noise.taps[0].count = 3;
    }),
    ("two knocks", |s, r| pair(s, r, 300.0, 4_000.0)),
    ("two claps", |s, r| pair(s, r, 700.0, 1_500.0)),
    ("a door, open and shut", open_and_shut),
];

/// The clips of seeds from `first` on, and the recordings of a folder.
pub(crate) fn table(first: u64, folder: Option<&Path>) {
    println!("kind                     | with a drop | of them: impacts, e, nats");
    let mut all = (0, 0);
    for with_height in [false, true] {
        println!(
            "{}",
            if with_height {
                "a height given"
            } else {
                "no height given"
            }
        );
        for (name, change) in KINDS {
            add(name, &clips(change, first, with_height), &mut all);
        }
    }
    if let Some(folder) = folder {
        add("recordings", &recordings(folder), &mut all);
    }
    println!("{:<24} | {:>4} of {}", "all", all.0, all.1);
    for with_height in [false, true] {
        println!(
            "\n{}",
            if with_height {
                "twos and threes, a height given"
            } else {
                "twos and threes, no height given"
            }
        );
        for (name, change) in PAIRS {
            add(name, &clips(change, first, with_height), &mut (0, 0));
        }
    }
}

/// Clips of a kind, listened to with a height of 0.1 to 2 m or none.
fn clips(change: Change, first: u64, with_height: bool) -> Vec<Analysis> {
    let seeds: Vec<u64> = (first..first + CLIPS).collect();
    each(&seeds, |seed| {
        let made = render(&scene(change, *seed), *seed).unwrap();
        let rate = f64::from(made.truth.sample_rate_hz);
        let mut rng = SplitMix64::new(*seed);
        let height_m = 0.1 * 20.0_f64.powf(rng.uniform());
        let settings = Settings::default().height_m(with_height.then_some(height_m));
        analyze(&made.samples, rate, &settings).unwrap()
    })
}

fn add(name: &str, found: &[Analysis], all: &mut (usize, usize)) {
    let with: Vec<&Analysis> = found.iter().filter(|a| !a.drops.is_empty()).collect();
    let drops = with.iter().flat_map(|a| &a.drops).map(|drop| {
        let e = drop.restitution.as_ref().map(|r| r.estimate.value);
        let e = e.map_or_else(|| "-".to_owned(), |e| format!("{e:.3}"));
        format!("{} {e} {:.1}", drop.impacts.len(), drop.evidence_nats)
    });
    let drops: Vec<String> = drops.collect();
    println!(
        "{name:<24} | {:>4} of {:<3} | {}",
        with.len(),
        found.len(),
        drops.join("; ")
    );
    *all = (all.0 + with.len(), all.1 + found.len());
}

fn recordings(folder: &Path) -> Vec<Analysis> {
    let entries = fs::read_dir(folder).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let found = each(&paths, |path| {
        let recording = read_file(path).ok()?;
        let rate = f64::from(recording.sample_rate_hz);
        let found = analyze_clearest(&recording.channels, rate, &Settings::default()).ok()?;
        Some(found.1)
    });
    found.into_iter().flatten().collect()
}

/// A clip of 8 s.
fn scene(change: Change, seed: u64) -> Scene {
    let empty =
        "name = 'nothing'\nduration_s = 8.0\nsample_rate_hz = 32000\nnoise.white_db = -65.0";
    let mut scene = Scene::from_toml(empty).unwrap();
    let mut rng = SplitMix64::new(!seed);
    change(&mut scene, &mut rng);
    scene
}

fn between(low: f64, high: f64, rng: &mut SplitMix64) -> f64 {
    low + (high - low) * rng.uniform()
}

/// A row of sounds like a knock on some thing.
fn thing(rng: &mut SplitMix64, low_hz: f64, high_hz: f64, decay_s: f64) -> Taps {
    let lowest_hz = low_hz * (high_hz / low_hz).powf(rng.uniform());
    let modes = [1.0, 1.83, 3.1].map(|overtone| Mode {
        frequency_hz: lowest_hz * overtone,
        decay_s: decay_s * between(0.6, 1.4, rng),
        level: between(0.3, 1.0, rng),
    });
    Taps {
        first_s: between(0.2, 1.0, rng),
        count: 1_000,
        interval_s: 0.5,
        interval_factor: 1.0,
        interval_scatter: 0.0,
        level_db: between(-12.0, -3.0, rng),
        level_step_db: 0.0,
        level_scatter_db: 2.0,
        contact_time_s: 0.3 / lowest_hz,
        modes: modes.to_vec(),
        level_scatter: 0.2,
        frequency_scatter: 0.01,
    }
}

fn talk(scene: &mut Scene, rng: &mut SplitMix64) {
    scene.noise.babble_db = between(-30.0, -12.0, rng);
}

fn words(scene: &mut Scene, rng: &mut SplitMix64) {
    scene.noise.words = Some(Words {
        level_db: between(-25.0, -12.0, rng),
        every_s: between(0.5, 1.5, rng),
    });
}

fn play(scene: &mut Scene, rng: &mut SplitMix64) {
    let [bat, table] = [between(0.5, 1.0, rng), between(0.5, 1.0, rng)].map(|interval_s| Taps {
        interval_s,
        interval_scatter: 0.35,
        level_scatter_db: 4.0,
        ..thing(rng, 800.0, 3_000.0, 4e-3)
    });
    scene.noise.taps = vec![bat, table];
}

fn dribbling(scene: &mut Scene, rng: &mut SplitMix64) {
    scene.noise.taps = vec![Taps {
        interval_s: between(0.3, 0.8, rng),
        interval_scatter: 0.08,
        ..thing(rng, 150.0, 400.0, 10e-3)
    }];
}

fn claps(scene: &mut Scene, rng: &mut SplitMix64) {
    scene.noise.taps = vec![Taps {
        interval_s: between(0.2, 0.6, rng),
        interval_scatter: 0.1,
        level_scatter_db: 3.0,
        level_scatter: 0.6,
        frequency_scatter: 0.1,
        ..thing(rng, 700.0, 1_500.0, 3e-3)
    }];
}

fn keyboard(scene: &mut Scene, rng: &mut SplitMix64) {
    let keys = Taps {
        interval_s: between(0.12, 0.3, rng),
        interval_scatter: 0.4,
        level_scatter_db: 3.0,
        level_scatter: 0.4,
        frequency_scatter: 0.05,
        level_db: -20.0,
        ..thing(rng, 1_500.0, 3_000.0, 2e-3)
    };
    let space = Taps {
        interval_s: between(0.6, 1.2, rng),
        interval_scatter: 0.4,
        level_db: -14.0,
        ..thing(rng, 400.0, 900.0, 5e-3)
    };
    scene.noise.taps = vec![keys, space];
}

fn steps(scene: &mut Scene, rng: &mut SplitMix64) {
    scene.noise.steps = Some(Steps {
        every_s: between(0.35, 0.7, rng),
        jitter_s: between(0.005, 0.04, rng),
        level_db: between(-20.0, -6.0, rng),
        frequency_hz: between(90.0, 900.0, rng),
        decay_s: between(5e-3, 30e-3, rng),
    });
}

/// Slams, each of which rattles.
fn doors(scene: &mut Scene, rng: &mut SplitMix64) {
    let slams = [
        between(0.5, 1.5, rng),
        between(3.0, 4.0, rng),
        between(5.5, 6.5, rng),
    ];
    scene.noise.taps = slams
        .map(|first_s| Taps {
            first_s,
            count: 5,
            interval_s: between(0.06, 0.2, rng),
            interval_factor: between(0.7, 1.2, rng),
            interval_scatter: 0.2,
            level_step_db: -3.0,
            level_scatter: 0.5,
            frequency_scatter: 0.1,
            ..thing(rng, 70.0, 300.0, 30e-3)
        })
        .to_vec();
}

fn knocks(scene: &mut Scene, rng: &mut SplitMix64) {
    scene.noise.knocks = Some(Knocks {
        per_s: between(1.0, 4.0, rng),
        level_db: -3.0,
    });
}

/// Things that are put down, taken up and rubbed: sounds of all kinds, at random.
fn handling(scene: &mut Scene, rng: &mut SplitMix64) {
    scene.noise.knocks = Some(Knocks {
        per_s: between(0.3, 1.5, rng),
        level_db: between(-20.0, -3.0, rng),
    });
    let things = 1 + (3.0 * rng.uniform()) as usize;
    for _ in 0..things {
        let taps = Taps {
            first_s: between(0.3, 5.0, rng),
            count: 1 + (4.0 * rng.uniform()) as usize,
            interval_s: between(0.15, 1.5, rng),
            interval_scatter: 0.6,
            level_scatter_db: 6.0,
            level_scatter: 0.6,
            frequency_scatter: 0.1,
            ..thing(rng, 150.0, 3_000.0, 8e-3)
        };
        scene.noise.taps.push(taps);
    }
}

/// Four to seven claps.
fn few_claps(scene: &mut Scene, rng: &mut SplitMix64) {
    claps(scene, rng);
    scene.noise.taps[0].count = 4 + (4.0 * rng.uniform()) as usize;
}

fn call_and_steps(scene: &mut Scene, rng: &mut SplitMix64) {
    steps(scene, rng);
    words(scene, rng);
}

/// Words now and then.
fn few_words(scene: &mut Scene, rng: &mut SplitMix64) {
    scene.noise.words = Some(Words {
        level_db: between(-25.0, -8.0, rng),
        every_s: between(2.0, 4.0, rng),
    });
}

/// Two sounds of one thing.
fn pair(scene: &mut Scene, rng: &mut SplitMix64, low_hz: f64, high_hz: f64) {
    let two = Taps {
        first_s: between(0.5, 5.0, rng),
        count: 2,
        interval_s: between(0.15, 1.5, rng),
        level_scatter_db: 3.0,
        level_scatter: 0.4,
        frequency_scatter: 0.05,
        ..thing(rng, low_hz, high_hz, 5e-3)
    };
    scene.noise.taps = vec![two];
}

/// A latch, and a slam a while later.
fn open_and_shut(scene: &mut Scene, rng: &mut SplitMix64) {
    let latch = Taps {
        first_s: between(0.5, 2.0, rng),
        count: 1,
        ..thing(rng, 400.0, 1_500.0, 8e-3)
    };
    let slam = Taps {
        first_s: latch.first_s + between(0.4, 4.0, rng),
        count: 1,
        ..thing(rng, 70.0, 300.0, 30e-3)
    };
    scene.noise.taps = vec![latch, slam];
}

/// A row of taps whose intervals change by a factor between two.
fn taps(scene: &mut Scene, rng: &mut SplitMix64, factors: [f64; 2], scatter: f64, step_db: f64) {
    let interval_factor = between(factors[0], factors[1], rng);
    scene.noise.taps = vec![Taps {
        count: (6.0 + 14.0 * rng.uniform()) as usize,
        interval_s: between(0.2, 0.7, rng),
        interval_factor,
        interval_scatter: scatter,
        level_step_db: step_db,
        ..thing(rng, 300.0, 4_000.0, 5e-3)
    }];
}

/// A clock that does not hang straight: ticks and tocks.
fn clock(scene: &mut Scene, rng: &mut SplitMix64) {
    let every_s = [0.5, 1.0, 2.0][(3.0 * rng.uniform() - 1e-9) as usize];
    let late_s = every_s * (0.5 + 0.05 * rng.normal());
    let tick = Taps {
        interval_s: every_s,
        level_db: between(-40.0, -15.0, rng),
        level_scatter_db: 0.5,
        ..thing(rng, 2_000.0, 4_000.0, 3e-3)
    };
    let tock = Taps {
        first_s: tick.first_s + late_s,
        level_db: tick.level_db - 2.0,
        ..tick.clone()
    };
    scene.noise.taps = vec![tick, tock];
}
