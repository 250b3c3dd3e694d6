//! All impacts of a drop timed together, by the sound that they have in common.
//!
//! # Model
//! ```text
//! x(t) = Σ_i a_i·s_i(t − τ_i) + noise,      s_i(t) = S₀(t) + u_i·S₁(t) + u_i²·S₂(t)
//! ```
//! x is the whitened recording; S₀ is what all impacts share, ring and echo included. Impacts are not quite alike: at
//! each moment after its onset an impact of amplitude a differs from the [template](crate::signal::template) by a²·v(t)
//! in variance, learnt from what is left over. That, and the same of all others that still sound, is added to the noise, so
//! each sample counts by what it knows.
//!
//! Where slow impacts last longer than fast ones, a match is late for them by half of what the contact takes longer:
//! [time walk](time_walk). The [leading edges](walk_by_edges) of the sounds depend least on it and reveal it; S₁, S₂ with the
//! contact stretch `u = (v/v₁)^(−1/5)` less its mean (Hertz) are used in that case alone.
//!
//! Where most of the sounds is not in common, as in most real recordings that were tried, no template times them: they are timed by
//! where they begin, each by itself ([`onset`]).
//!
//! # Phases
//! [`Started`] holds the sound and the priors before any impact is matched, [`Aligned`] the impacts in their first
//! alignment, [`Joint`](alternate::Joint) refines template and times in turn, impact after impact, and [`Corrected`] holds
//! them with their correction for time walk.

mod align;
mod alternate;
mod beginning;
mod curve;
mod damping;
mod independence;
mod interference;
mod leading_edge;
mod matched_search;
mod normal_equations;
mod rest;
mod standard_error;
mod start;
mod step;
#[cfg(test)]
mod tests;
mod time_walk;
mod walk_by_edges;

use super::onset;
use crate::impact::Impact;
use crate::signal::sound::Sound;
use crate::signal::template::Template;
use crate::signal::whiten::Whitened;
use crate::statistics::upper_median;
use crate::units::{real, whole};
use align::Aligned;
use alternate::Joint;
use start::Started;
use time_walk::Corrected;

/// Windows begin this long before the onset, in seconds.
const BEFORE_S: f64 = 1e-3;
/// The template is at most this long, in seconds: rings and rooms that last longer are noise.
const LONGEST_S: f64 = 0.2;
/// Sound before the first impact that the noise is measured in, in seconds.
const LEAD_S: f64 = 0.25;
/// The prior on a time reaches this many standard deviations.
const PRIOR_REACH: f64 = 4.0;

/// Sounds are timed together where no more than this share of their energy is not in their template. Derived: where most of it
/// is their own, what matches best is not where they began. Drops are far from it on either side: of the
/// suite's first scenes 0 to 0.3; of real ones 0.6 to 1, but for a tennis ball of 0.1.
const UNLIKE: f64 = 0.5;

/// Expected position of an impact, in samples of the sound, and its standard deviation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Prior {
    pub position: f64,
    pub std: f64,
}

impl Prior {
    /// Farthest search from its position, in samples.
    fn reach(self) -> usize {
        whole(PRIOR_REACH * self.std).max(2)
    }

    /// The same, counted from another sample.
    pub(super) fn from(self, begin: f64) -> Self {
        Self {
            position: self.position - begin,
            ..self
        }
    }

    /// The expected place, with an amplitude.
    const fn place(self, amplitude: f64) -> Place {
        Place {
            position: self.position,
            amplitude,
        }
    }
}

/// An impact where it fits.
#[derive(Debug, Clone, Copy)]
struct Place {
    /// Onset in samples of the sound, up to what is common to all.
    position: f64,
    /// Size in units of the template.
    amplitude: f64,
}

/// Times of the impacts from coarse times in ascending order; an impact that does not resemble the others keeps the
/// detector's time, and where most do not, all are timed by their [onsets](onset). None if there are fewer than three.
pub(super) fn times(whitened: &Whitened<'_>, coarse: &[Impact]) -> Option<Vec<Impact>> {
    let started = Started::of(whitened, coarse)?;
    let aligned = Aligned::of(&started)?;
    let mut joint = Joint::of(&started, aligned.clone(), 1);
    if joint.unlike() > UNLIKE {
        let onsets = onset::onsets(&started.sound, started.rate, &started.priors);
        let first = real(started.first);
        let begins = |(onset, &coarse): (&Prior, &Impact)| Impact {
            time_s: whitened.sound().time_s(first + onset.position),
            std_s: onset.std / started.rate,
            ..coarse
        };
        return Some(onsets.iter().zip(coarse).map(begins).collect());
    }
    let corrected = time_walk::correct(joint, &aligned);
    let begin = corrected.beginning();
    Some(timed(whitened.sound(), coarse, &corrected, begin))
}

/// The same with few jumps and without time walk, or as they are aligned where they are unlike, and their template: by it more
/// of them are found.
pub(super) fn sketch(
    whitened: &Whitened<'_>,
    coarse: &[Impact],
) -> Option<(Vec<Impact>, Template)> {
    let started = Started::of(whitened, coarse)?.heard_to_its_end();
    let aligned = Aligned::of(&started)?;
    let mut joint = Joint::of(&started, aligned.clone(), 1);
    if joint.unlike() <= UNLIKE {
        joint = Joint::of(&started, aligned, 1);
        joint.settle_whole();
    }
    let corrected = Corrected::without_walk(joint);
    // As its template is searched for: each by where that begins.
    let onset = corrected.joint.template.onset(started.rate);
    let timed = timed(whitened.sound(), coarse, &corrected, onset);
    Some((timed, corrected.joint.template))
}

/// The impacts with their times and standard errors in seconds of the recording; their sound begins so many samples after their places.
fn timed(
    recorded: &Sound<'_>,
    coarse: &[Impact],
    corrected: &Corrected<'_>,
    onset: f64,
) -> Vec<Impact> {
    let (joint, walk) = (&corrected.joint, &corrected.walk);
    let started = joint.started;
    let usual = usual_move(&joint.priors, &joint.places);
    let stds = standard_error::standard_errors(joint);
    let in_recording = |i: usize| {
        let (prior, contact_stretch, ambiguity) = (
            joint.priors[i],
            started.contact_stretches[i],
            corrected.ambiguities[i],
        );
        let (position, std) = match stds[i] {
            Some(std) => {
                let position = joint.places[i].position + walk.shift(contact_stretch);
                (
                    position,
                    std.hypot(walk.std(contact_stretch)).hypot(ambiguity),
                )
            }
            // An impact unlike the others.
            _ => (prior.position + usual, prior.std),
        };
        Impact {
            time_s: recorded.time_s(real(started.first) + position + onset),
            std_s: std / started.rate,
            ..coarse[i]
        }
    };
    (0..stds.len()).map(in_recording).collect()
}

/// Median of matched positions less the detector's, in samples.
fn usual_move(priors: &[Prior], places: &[Place]) -> f64 {
    let pairs = places.iter().zip(priors);
    upper_median(pairs.map(|(place, prior)| place.position - prior.position)).unwrap_or(0.0)
}
