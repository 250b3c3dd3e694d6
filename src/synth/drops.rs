//! The impacts of a scene's drops, from the physics.

use super::channel::Channel;
use super::place::{Point, places};
use super::room::travel_s;
use super::scene::{BounceChange, BounceScene, DropScene, Scene, within};
use super::sound::Sound;
use super::voices::{Blow, Voices};
use crate::Error;
use crate::physics::{
    Air, Ball, Bounce, DropSetup, FlightLaw, Impact, LinearContact, Oscillator, Rebound,
    ReleaseRule, Restitution, RestitutionLaw, Scatter, Sphere,
};
use crate::random::SplitMix64;
use crate::units::real;

/// Flights shorter than this are not made: the drop ends there.
const SHORTEST_FLIGHT_S: f64 = 1e-3;

/// Impacts of one drop at most.
const MOST_IMPACTS: usize = 100_000;

/// One impact to be heard.
#[derive(Debug, Clone)]
pub(super) struct Strike {
    pub(super) impact: Impact,
    /// Which drop of the scene it belongs to.
    pub(super) drop: usize,
    /// The touch, in seconds from the recording's first sample.
    pub(super) touch_s: f64,
    /// Where on the surface.
    pub(super) place: Point,
    /// Arrival of the sound where the microphone is, before what differs between channels.
    pub(super) arrival_s: f64,
    /// e before scatter.
    pub(super) nominal: f64,
    /// Whether this bounce alone deviates from the law.
    pub(super) odd: bool,
    /// Whether e changes for good here.
    pub(super) changed: bool,
    /// Standard deviation of ln level of each mode.
    pub(super) level_scatter: f64,
    /// Its sound at the loudness that its speed gives.
    pub(super) sound: Sound,
}

impl Strike {
    /// When a microphone hears it, in seconds from the recording's first sample.
    pub(super) fn onset_s(&self, channel: Channel) -> f64 {
        self.arrival_s + channel.later_s(self.place)
    }
}

/// A drop as it happens with one seed.
#[derive(Debug, Clone)]
pub(super) struct Dropped {
    pub(super) height_m: f64,
    pub(super) contact_time_s: f64,
    pub(super) strikes: Vec<Strike>,
}

/// Drops all balls of a scene; copies of a drop take the random numbers of the first.
///
/// # Errors
/// [`Error::Argument`] naming what is out of range.
pub(super) fn all(
    scene: &Scene,
    followed_s: f64,
    rng: &mut SplitMix64,
) -> Result<Vec<Dropped>, Error> {
    let mut dropped = Vec::new();
    for one in &scene.drops {
        let before = *rng;
        let (count, every_s) = one.copies.map_or((1, 0.0), |c| (c.count, c.every_s));
        for copy in 0..count {
            *rng = before;
            let later = DropScene {
                first_impact_s: one.first_impact_s + real(copy) * every_s,
                ..one.clone()
            };
            let made = drop(scene, &later, dropped.len(), followed_s, rng)?;
            if count * made.strikes.len() > MOST_IMPACTS {
                return Err(Error::Argument {
                    argument: "copies",
                    got: format!("{count} of {} impacts", made.strikes.len()),
                    expected: "100000 impacts at most in all",
                });
            }
            dropped.push(made);
        }
    }
    Ok(dropped)
}

/// Drops a ball of a scene: all its impacts, those outside the recording too. Their sounds are followed for so long
/// at most.
///
/// # Errors
/// [`Error::Argument`] naming what is out of range.
fn drop(
    scene: &Scene,
    drop: &DropScene,
    index: usize,
    followed_s: f64,
    rng: &mut SplitMix64,
) -> Result<Dropped, Error> {
    let seed = rng.next_u64();
    // What only some scenes vary has its own stream, so that turning it on changes nothing else.
    let mut variety = SplitMix64::new(!seed);
    let height_m = drop.height_m * (1.0 + drop.height_spread * (2.0 * variety.uniform() - 1.0));
    let setup = setup(drop, scene.gravity_m_per_s2, height_m, seed)?;
    let impacts = impacts(drop, &setup)?;
    if impacts.len() > MOST_IMPACTS {
        return Err(Error::Argument {
            argument: "bounce",
            got: "so lively that more than 100000 impacts follow".to_owned(),
            expected: "a lower restitution, or most_impacts",
        });
    }
    let first_s = impacts.first().map_or(0.0, |i| i.time_s);
    // The first impact falls between two samples, elsewhere for every seed.
    let shift_s = drop.first_impact_s + rng.uniform() / f64::from(scene.sample_rate_hz)
        - first_s
        - scene.recorder.start_s;
    let contact_time_s = impacts
        .iter()
        .find_map(|i| i.contact_time_s)
        .unwrap_or(1e-3);
    within("contact_time_s", contact_time_s, 1e-9..=1.0, "1 ns to 1 s")?;
    let fastest = impacts.first().map_or(1.0, |i| i.impact_speed_m_per_s);
    let places = places(
        &impacts,
        drop.sideways,
        SplitMix64::new(seed.rotate_left(48)),
    );
    let mut voices = Voices::new(drop, seed, variety);
    let strikes = (1..).zip(impacts.into_iter().zip(places));
    let strikes = strikes.map(|(number, (impact, place))| {
        let speed = impact.impact_speed_m_per_s;
        let rolled_m = drop.leaving_m_per_s * (impact.time_s - first_s);
        let distance_m = drop.microphone_distance_m + rolled_m;
        let blow = Blow {
            speed_m_per_s: speed,
            of_first: speed / fastest,
            // Within a hand's breadth of the microphone the level does not grow any more.
            fading: drop.microphone_distance_m.max(0.1) / distance_m.max(0.1),
            contact_time_s,
        };
        let here = || drop.changes.iter().filter(|c| c.impact == number);
        let lasting = drop
            .changes
            .iter()
            .filter(|c| c.lasting && c.impact <= number);
        let lasting: f64 = lasting.map(|c| c.restitution_factor).product();
        Ok(Strike {
            drop: index,
            odd: here().any(|c| !c.lasting),
            changed: here().any(|c| c.lasting),
            place,
            level_scatter: voices.level_scatter(),
            touch_s: impact.time_s + shift_s,
            arrival_s: impact.time_s + shift_s + travel_s(distance_m),
            nominal: (nominal(&setup, speed)? * lasting).min(1.0),
            sound: voices.next(blow, rng).at_most(followed_s),
            impact,
        })
    });
    Ok(Dropped {
        height_m,
        contact_time_s,
        strikes: strikes.collect::<Result<_, Error>>()?,
    })
}

/// The impacts of a drop with its deviations, and one more than are allowed.
fn impacts(drop: &DropScene, setup: &DropSetup) -> Result<Vec<Impact>, Error> {
    let mut left = setup.impacts()?;
    let numbers = 1..=MOST_IMPACTS + 1;
    Ok(numbers
        .map_while(|number| left.next_with(factor(drop, number)))
        .collect())
}

/// The factor on the rebound speed at an impact, by its number from 1.
fn factor(drop: &DropScene, number: usize) -> f64 {
    let now = |c: &&BounceChange| c.impact == number || c.lasting && c.impact < number;
    let changes = drop.changes.iter().filter(now);
    let half = if number % 2 == 1 { 0.5 } else { -0.5 };
    changes.map(|c| c.restitution_factor).product::<f64>() * libm::exp(half * drop.alternation)
}

fn setup(drop: &DropScene, gravity: f64, height_m: f64, seed: u64) -> Result<DropSetup, Error> {
    let flight = if drop.drag {
        let sphere = Sphere {
            mass_kg: drop.mass_kg,
            diameter_m: drop.diameter_m,
        };
        FlightLaw::in_air(gravity, sphere, Air::default())?
    } else {
        FlightLaw::without_air(gravity)?
    };
    let mut setup = DropSetup::new(height_m, flight, bounce(drop)?);
    setup.shortest_flight_s = Some(SHORTEST_FLIGHT_S);
    setup.most_impacts = drop.most_impacts;
    setup.scatter = Some(Scatter {
        ln_restitution_std: drop.bounce_scatter,
        seed,
    });
    Ok(setup)
}

fn bounce(drop: &DropScene) -> Result<Bounce, Error> {
    let given = |restitution, contact_time_s| Bounce::Given {
        restitution,
        contact_time_s,
    };
    let linear = |ball| Bounce::Linear {
        ball,
        release_rule: ReleaseRule::ZeroDisplacement,
    };
    Ok(match drop.bounce {
        BounceScene::Constant {
            restitution,
            contact_time_s,
        } => given(
            RestitutionLaw::Constant(Restitution::new(restitution)?),
            contact_time_s,
        ),
        BounceScene::Linear {
            restitution,
            contact_time_s,
        } => linear(Oscillator::from_contact(
            Restitution::new(restitution)?,
            contact_time_s,
        )?),
        BounceScene::Spring {
            stiffness_n_per_m,
            damping_n_s_per_m,
        } => linear(Ball::new(drop.mass_kg, stiffness_n_per_m, damping_n_s_per_m)?.oscillator()),
        BounceScene::Viscoelastic {
            gamma1,
            gamma2,
            contact_time_s,
        } => given(
            RestitutionLaw::Viscoelastic { gamma1, gamma2 },
            contact_time_s,
        ),
        BounceScene::Power {
            restitution,
            yield_speed_m_per_s,
            exponent,
            contact_time_s,
        } => given(
            RestitutionLaw::Power {
                restitution_at_yield: Restitution::new(restitution)?,
                yield_speed_m_per_s,
                exponent,
            },
            contact_time_s,
        ),
    })
}

/// e at a speed before scatter; 0 where the ball stays.
fn nominal(setup: &DropSetup, speed_m_per_s: f64) -> Result<f64, Error> {
    match setup.bounce {
        Bounce::Given { restitution, .. } => Ok(restitution.at(speed_m_per_s)?.value()),
        Bounce::Linear { ball, release_rule } => {
            let gravity = setup.flight.gravity_m_per_s2();
            let contact = LinearContact::new(ball, gravity, release_rule)?;
            Ok(match contact.rebound(speed_m_per_s)? {
                Rebound::Leaves(leaving) => leaving.restitution.value(),
                Rebound::Stays => 0.0,
            })
        }
    }
}
