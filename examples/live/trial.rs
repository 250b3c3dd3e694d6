//! A stream that is listened to live, and each drop of it once more from what would be saved.

use std::fs;

use bounce_audio::synth::render;
use bounce_audio::{Drop, Live, Settings, Told, analyze};

use super::stage::{RATE_HZ, scene};

/// Samples that are handed over at once, a tenth of a second.
const BLOCK: usize = 4_800;
/// Sound before the first impact that is saved, in seconds.
const BEFORE_S: f64 = 1.0;
/// A drop is that which begins within this of the true first impact, in seconds: one impact may be missed.
const BEGINS_WITHIN_S: f64 = 0.7;

/// A drop of the stage.
pub(crate) struct Played {
    /// The true e.
    pub truth: f64,
    /// Each time that it was told: after its last impact, in seconds, and as what.
    pub told: Vec<(f64, Told)>,
    /// What `analyze` finds in the sound that is saved then.
    pub saved: Option<Drop>,
}

/// A stream.
pub(crate) struct Trial {
    pub drops: Vec<Played>,
    /// Drops told where there is none.
    pub false_drops: usize,
    /// Processor time over time; none where it is not known.
    pub cost: Option<f64>,
}

pub(crate) fn played(room: &str) -> Trial {
    let made = render(&scene(room), 1).unwrap();
    let rate_hz = f64::from(RATE_HZ);
    let truth = made.truth.drops.iter();
    let mut drops: Vec<Played> = truth
        .map(|d| Played {
            truth: d.restitution,
            told: Vec::new(),
            saved: None,
        })
        .collect();
    let begins: Vec<f64> = made.truth.drops.iter().map(|d| d.onsets_s[0]).collect();
    let mut live = Live::new(1, rate_hz, &Settings::default()).unwrap();
    let (mut false_drops, mut cpu_s) = (0, Some(0.0));
    for (i, block) in made.samples.chunks(BLOCK).enumerate() {
        let before_s = processor_s();
        let told = live.hear(&[block]).unwrap();
        let spent_s = processor_s()
            .zip(before_s)
            .map(|(after, before)| after - before);
        cpu_s = cpu_s.zip(spent_s).map(|(sum, spent)| sum + spent);
        let now_s = ((i + 1) * BLOCK) as f64 / rate_hz;
        for told in told {
            let first_s = told.drop.impacts[0].time_s;
            let of = |begin: &f64| (first_s - begin).abs() < BEGINS_WITHIN_S;
            let Some(place) = begins.iter().position(of) else {
                false_drops += 1;
                continue;
            };
            let (_, sound) = live.since(first_s - BEFORE_S);
            let saved = analyze(sound[0], rate_hz, &Settings::default()).unwrap();
            let most = saved.drops.into_iter().max_by_key(|d| d.bounces);
            let after_s = now_s - told.drop.impacts.last().unwrap().time_s;
            drops[place].saved = most;
            drops[place].told.push((after_s, told));
        }
    }
    Trial {
        drops,
        false_drops,
        cost: cpu_s.map(|s| s / (made.samples.len() as f64 / rate_hz)),
    }
}

/// Processor time of this thread, in seconds.
fn processor_s() -> Option<f64> {
    let text = fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds: f64 = text.split(' ').next()?.parse().ok()?;
    Some(1e-9 * nanoseconds)
}
