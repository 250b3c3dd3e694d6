//! Recordings made from the model, with their true impact times beside them.
//!
//! [`scene`] says what is dropped and how it is recorded, [`sound`] gives one impact's sound in closed form at any
//! instant, [`noise`] what is heard besides. The same scene and seed give the same samples on every machine.

pub mod noise;
pub mod scene;
pub mod sound;
pub mod truth;

use crate::Error;
use crate::physics::{Air, Impact, Sphere};
use crate::physics::{Bounce, DropSetup, FlightLaw, Restitution, RestitutionLaw, Scatter};
use crate::random::SplitMix64;
use crate::units::{real, samples_in};
use scene::{DropScene, Scene};
use truth::{DropTruth, Truth};

/// A recording made from a scene.
#[derive(Debug, Clone)]
pub struct Synthetic {
    /// Samples of full scale ±1, not yet rounded to the recorder's bits.
    pub samples: Vec<f32>,
    /// What is true about them.
    pub truth: Truth,
}

/// Flights shorter than this are not made: the drop ends there.
const SHORTEST_FLIGHT_S: f64 = 1e-3;
/// Gravity of all scenes.
const GRAVITY_M_PER_S2: f64 = 9.81;

/// Makes the recording of a scene.
///
/// # Errors
/// [`Error::Argument`] if a number of the scene is out of range.
pub fn render(scene: &Scene, seed: u64) -> Result<Synthetic, Error> {
    scene.check()?;
    let mut rng = SplitMix64::new(seed);
    let rate = f64::from(scene.sample_rate_hz);
    let mut samples = vec![0.0; samples_in(scene.duration_s, rate)];
    let mut drops = Vec::new();
    for drop in &scene.drops {
        drops.push(add_drop(drop, scene, rate, &mut rng, &mut samples)?);
    }
    // All drops are scaled alike, so that the loudest impact peaks where the scene wants it.
    let peak = samples.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let gain = if peak > 0.0 {
        decibels(scene.peak_db) / peak
    } else {
        0.0
    };
    let noise = noise::render(&scene.noise, samples.len(), rate, &mut rng);
    for drop in &mut drops {
        drop.scale(gain, decibels(scene.noise.white_db));
    }
    #[expect(
        clippy::cast_possible_truncation,
        reason = "samples are f32 from here on"
    )]
    let samples = samples
        .iter()
        .zip(&noise)
        .map(|(s, n)| (gain * s + n).clamp(-1.0, 1.0) as f32)
        .collect();
    Ok(Synthetic {
        samples,
        truth: Truth {
            scene: scene.name.clone(),
            seed,
            sample_rate_hz: scene.sample_rate_hz,
            drops,
        },
    })
}

/// Adds the sound of one drop, echoes included, and tells what is true of it.
fn add_drop(
    drop: &DropScene,
    scene: &Scene,
    rate: f64,
    rng: &mut SplitMix64,
    samples: &mut [f64],
) -> Result<DropTruth, Error> {
    let impacts: Vec<Impact> = setup(drop, rng.next_u64())?.impacts()?.collect();
    let first_s = impacts.first().map_or(0.0, |i| i.time_s);
    // The first impact falls between two samples, elsewhere for every seed.
    let shift_s = drop.first_impact_s + rng.uniform() / rate - first_s;
    let sound = sound::Sound::new(&drop.modes, drop.contact_time_s);
    let mut truth = DropTruth::new(drop, &impacts, shift_s);
    for impact in &impacts {
        let levels: Vec<f64> = drop
            .modes
            .iter()
            .map(|_| impact.impact_speed_m_per_s * libm::exp(drop.level_scatter * rng.normal()))
            .collect();
        let voice = sound.with_levels(&levels);
        let energy = voice.add(samples, rate, impact.time_s + shift_s, 1.0);
        truth.energies.push(energy);
        for echo in &scene.echoes {
            voice.add(
                samples,
                rate,
                impact.time_s + shift_s + echo.delay_s,
                decibels(echo.level_db),
            );
        }
    }
    Ok(truth)
}

fn setup(drop: &DropScene, seed: u64) -> Result<DropSetup, Error> {
    let flight = if drop.drag {
        let sphere = Sphere {
            mass_kg: drop.mass_kg,
            diameter_m: drop.diameter_m,
        };
        FlightLaw::in_air(GRAVITY_M_PER_S2, sphere, Air::default())?
    } else {
        FlightLaw::without_air(GRAVITY_M_PER_S2)?
    };
    let bounce = Bounce::Given {
        restitution: RestitutionLaw::Constant(Restitution::new(drop.restitution)?),
        contact_time_s: drop.contact_time_s,
    };
    let mut setup = DropSetup::new(drop.height_m, flight, bounce);
    setup.shortest_flight_s = Some(SHORTEST_FLIGHT_S);
    setup.scatter = Some(Scatter {
        ln_restitution_std: drop.bounce_scatter,
        seed,
    });
    Ok(setup)
}

/// `10^(x/20)`.
fn decibels(x: f64) -> f64 {
    libm::pow(10.0, x / 20.0)
}

/// Seconds of a sample.
fn instant_s(sample: usize, rate: f64) -> f64 {
    real(sample) / rate
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_same_seed_gives_the_same_samples_and_another_seed_others() {
        let scene = scene::preset("pingpong").unwrap();
        let (a, b, c) = (
            render(&scene, 1).unwrap(),
            render(&scene, 1).unwrap(),
            render(&scene, 2).unwrap(),
        );
        assert!(a.samples == b.samples && a.samples != c.samples);
        assert_eq!(a.truth.drops[0].impacts_s, b.truth.drops[0].impacts_s);
    }

    #[test]
    fn the_loudest_sample_is_where_the_scene_wants_it() {
        let scene = scene::preset("steel").unwrap();
        let peak = render(&scene, 1)
            .unwrap()
            .samples
            .iter()
            .fold(0.0_f32, |m, x| m.max(x.abs()));
        assert!((20.0 * f64::from(peak).log10() - scene.peak_db).abs() < 0.2);
    }

    #[test]
    fn nothing_is_heard_before_the_first_impact() {
        let mut scene = scene::preset("rubber").unwrap();
        scene.noise.white_db = f64::NEG_INFINITY;
        let made = render(&scene, 3).unwrap();
        let first = made.truth.drops[0].impacts_s[0];
        let sample =
            samples_in(first.floor(), 1.0) + samples_in(first, f64::from(scene.sample_rate_hz));
        assert!(made.samples[..sample - 2].iter().all(|&x| x == 0.0));
        assert!(
            made.samples[sample + 20..sample + 60]
                .iter()
                .any(|&x| x.abs() > 1e-3)
        );
    }
}
