//! Recordings made from the model, with their true impact times beside them.
//!
//! [`scene`] says what is dropped and how it is recorded, [`sound`] gives one impact's sound in closed form at any
//! instant, `voices` how the sounds of a drop differ, `place` where on the surface each of them is, [`room`] its reflections,
//! [`ambience`], [`bursts`], [`taps`] and [`babble`] what is heard besides, [`channel`] what a microphone makes of it, [`recorder`]
//! what becomes of that, [`hearing`] what can be made out. The same scene and seed give the same samples on every machine: all
//! functions come from `libm`, all random numbers from `random`.

pub mod ambience;
pub mod babble;
pub mod bursts;
pub mod channel;
mod drop_scene;
mod drops;
mod gaps;
mod half_sine;
pub mod hearing;
mod place;
pub mod presets;
pub mod recorder;
pub mod room;
pub mod scene;
pub mod sound;
pub mod taps;
pub mod truth;
mod voices;

use std::borrow::Cow;

use crate::Error;
use crate::random::SplitMix64;
use crate::units::{real, samples_in};
use channel::Channel;
use drops::Strike;
use hearing::{Background, Heard, Variety};
use room::{Arrival, Room};
use scene::Scene;
use sound::{Rendered, Sound};
use truth::Truth;

/// A recording made from a scene.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Synthetic {
    /// Samples of the first channel, full scale being ±1, as the recorder stores them.
    pub samples: Vec<f32>,
    /// Those of the other channels.
    pub more_channels: Vec<Vec<f32>>,
    /// What is true about them.
    pub truth: Truth,
}

/// Makes the recording of a scene.
///
/// # Errors
/// [`Error::Argument`] if a number of the scene is out of range.
pub fn render(scene: &Scene, seed: u64) -> Result<Synthetic, Error> {
    scene.check()?;
    let mut rng = SplitMix64::new(seed);
    // The room, and what all channels hear alike, have streams of their own.
    let mut surroundings = SplitMix64::new(!seed);
    let rate = f64::from(scene.sample_rate_hz);
    let end_s = scene.recorder.stop_s.unwrap_or(scene.duration_s);
    let count = samples_in(end_s - scene.recorder.start_s, rate);
    let followed_s = followed_s(count, rate);
    let drops = drops::all(scene, followed_s, &mut rng)?;
    let mut strikes: Vec<&Strike> = drops.iter().flat_map(|d| &d.strikes).collect();
    strikes.sort_by(|a, b| a.arrival_s.total_cmp(&b.arrival_s));
    // Each channel's own way of hearing has a stream of its own too.
    let mut ears = SplitMix64::new(seed.rotate_left(32));
    let channels = scene.recorder.channels.iter();
    let sounds: Vec<_> = channels
        .map(|c| c.sounds(&strikes, SplitMix64::new(ears.next_u64())))
        .collect();
    let stage = Stage {
        scene,
        rate,
        count,
        gain: gain(scene, &strikes, &sounds, rate, real(count) / rate),
        room: SplitMix64::new(surroundings.next_u64()),
        shared: SplitMix64::new(surroundings.next_u64()),
    };
    let mut heard = vec![Heard::NOTHING; strikes.len()];
    let mut channels = Vec::new();
    for (channel, sounds) in scene.recorder.channels.iter().zip(&sounds) {
        let (sound, here) = stage.listen(*channel, &strikes, sounds, rng);
        rng = SplitMix64::new(surroundings.next_u64());
        channels.push(sound);
        heard = heard.iter().zip(here).map(|(a, b)| a.or(b)).collect();
    }
    let truths = (0..drops.len()).map(|index| {
        let own = strikes.iter().zip(&heard).filter(|(s, _)| s.drop == index);
        stage.truth(
            &drops[index],
            &own.map(|(s, h)| (*s, *h)).collect::<Vec<_>>(),
        )
    });
    let recorded = scene.recorder.record(&channels, rate);
    let truth = Truth {
        scene: scene.name.clone(),
        seed,
        sample_rate_hz: scene.sample_rate_hz,
        duration_s: real(recorded.first().map_or(0, Vec::len)) / rate,
        drops: truths.collect(),
        parameters: scene.clone(),
    };
    let mut recorded = recorded.into_iter();
    Ok(Synthetic {
        samples: recorded.next().unwrap_or_default(),
        more_channels: recorded.collect(),
        truth,
    })
}

/// The factor that brings the loudest impact before the end to a peak; 0 if there is none to be heard.
fn gain(
    scene: &Scene,
    strikes: &[&Strike],
    sounds: &[Vec<Cow<'_, Sound>>],
    rate: f64,
    end_s: f64,
) -> f64 {
    let channels = scene.recorder.channels.iter().zip(sounds);
    let peaks = channels.flat_map(|(channel, sounds)| {
        let strikes = strikes.iter().zip(sounds);
        strikes
            .filter(|(s, _)| s.arrival_s < end_s)
            .map(|(s, sound)| channel.fading(s.place) * sound.render(rate, s.arrival_s, 1.0).peak())
    });
    let loudest = peaks.fold(0.0, f64::max);
    if loudest > 0.0 {
        decibels(scene.peak_db) / loudest
    } else {
        0.0
    }
}

/// A scene about to be recorded.
struct Stage<'a> {
    scene: &'a Scene,
    rate: f64,
    /// Samples of the recording.
    count: usize,
    gain: f64,
    room: SplitMix64,
    shared: SplitMix64,
}

impl Stage<'_> {
    /// The sound at one microphone, and how each impact stands out there.
    fn listen(
        &self,
        channel: Channel,
        strikes: &[&Strike],
        sounds: &[Cow<'_, Sound>],
        own: SplitMix64,
    ) -> (Vec<f64>, Vec<Heard>) {
        let noise = &self.scene.noise;
        let mut ambience = noise.render(self.count, self.rate, own, self.shared);
        let steady = self.steady_autocorrelation(&ambience.steady);
        let room = Room::new(&self.scene.echoes, self.scene.tail, self.rate, self.room);
        let mut heard = Vec::with_capacity(strikes.len());
        // In order of time, so that an impact is heard against what came before it and not against its own echoes.
        for (i, (strike, sound)) in strikes.iter().zip(sounds).enumerate() {
            let onset_s = strike.onset_s(channel);
            if onset_s >= real(self.count) / self.rate {
                heard.push(Heard::NOTHING);
                continue;
            }
            let gain = self.gain * channel.gain(strike.place);
            let direct = sound.render(self.rate, onset_s, gain);
            let next = strikes.get(i + 1).map(|s| s.onset_s(channel));
            let until = next.map_or(self.count, |s| samples_in(s, self.rate));
            let modes = sound.modes(self.rate, onset_s, gain);
            let variety = Variety {
                modes: &modes,
                level_scatter: libm::hypot(
                    strike.level_scatter,
                    voices::level_scatter(channel.unlike),
                ),
            };
            heard.push(self.hear(&direct, variety, until, &ambience, &steady));
            let passing = &mut ambience.bursts;
            direct.add_to(passing, 0, 1.0);
            let arrival = Arrival {
                sound,
                direct: &direct,
                onset_s,
                gain,
            };
            let walls = self.scene.walls.iter();
            let of_walls = walls.filter_map(|w| w.reflection(strike.place, channel.at_m?));
            room.add(arrival, of_walls, self.rate, passing);
        }
        let sum = ambience.steady.iter().zip(&ambience.bursts);
        (sum.map(|(a, b)| a + b).collect(), heard)
    }

    fn hear(
        &self,
        direct: &Rendered,
        variety: Variety<'_>,
        until: usize,
        ambience: &ambience::Ambience,
        steady: &[f64; hearing::LAGS],
    ) -> Heard {
        let (Ok(first), until) = (usize::try_from(direct.first), until.min(self.count)) else {
            return Heard::NOTHING;
        };
        if first >= until {
            return Heard::NOTHING;
        }
        let mut all = ambience.steady[first..until].to_vec();
        for (x, y) in all.iter_mut().zip(&ambience.bursts[first..until]) {
            *x += y;
        }
        let background = Background {
            all: &all,
            passing: &ambience.bursts[first..until],
            steady,
            full_scale: self.full_scale(),
        };
        hearing::hear(direct, variety, background)
    }

    /// Pressure at which the recorder is at full scale.
    fn full_scale(&self) -> f64 {
        let recorder = &self.scene.recorder;
        match recorder.encoding.steps() {
            Some(_) if recorder.soft_limit_db.is_none() && recorder.automatic_gain.is_none() => {
                (1.0 - recorder.dc_offset.abs()) / decibels(recorder.gain_db)
            }
            _ => f64::INFINITY,
        }
    }

    /// Of the steady noise, with that of rounding to the recorder's steps: a twelfth of a step's square.
    fn steady_autocorrelation(&self, steady: &[f64]) -> [f64; hearing::LAGS] {
        let recorder = &self.scene.recorder;
        // Floating point has no steps, but no microphone is below -180 dB.
        let step = recorder.encoding.steps().map_or(1e-9, |steps| 1.0 / steps);
        let step = step / decibels(recorder.gain_db);
        let mut correlation = ambience::autocorrelation(steady);
        correlation[0] += step * step / 12.0;
        correlation
    }
}

/// `10^(x/20)`.
fn decibels(x: f64) -> f64 {
    libm::pow(10.0, x / 20.0)
}

/// Sounds are followed for so long even in a shorter recording: their energy and pitch are those of all of it.
const LEAST_FOLLOWED_S: f64 = 2.0;

/// How long a sound is followed in a recording of so many samples.
fn followed_s(count: usize, rate: f64) -> f64 {
    instant_s(count, rate).max(LEAST_FOLLOWED_S)
}

/// Seconds of a sample.
fn instant_s(sample: usize, rate: f64) -> f64 {
    real(sample) / rate
}

/// A sample and its time.
struct SampleAt {
    index: i64,
    instant_s: f64,
}

/// The first sample after a time, which may lie before the recording.
#[expect(
    clippy::cast_possible_truncation,
    reason = "`as` saturates, and scenes end within a day"
)]
fn sample_after(time_s: f64, rate: f64) -> SampleAt {
    let whole = libm::floor(time_s * rate) + 1.0;
    SampleAt {
        index: whole as i64,
        instant_s: whole / rate,
    }
}

#[cfg(test)]
mod place_tests;
#[cfg(test)]
mod tests;
