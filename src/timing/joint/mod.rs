//! All impacts of a drop timed together, by the sound that they have in common.
//!
//! # Model
//! ```text
//! x(t) = Σ_i a_i·s_i(t − τ_i) + noise,      s_i(t) = S₀(t) + u_i·S₁(t) + u_i²·S₂(t)
//! ```
//! x is the whitened recording; S₀ is what all impacts share, ring and echo included. Impacts are not quite alike: at
//! each moment after its onset an impact of amplitude a differs from the [template] by a²·v(t) in variance, learnt from
//! what is left over. That, and the same of all others that still sound, is added to the noise, so each sample counts
//! by what it knows. Template and times are [settled](settle) in turn, impact after impact. [`align`] finds the start.
//!
//! Where slow impacts last longer than fast ones, a match is late for them by half of what the contact takes longer.
//! The [beginning](drift) of the sound does not know yet how long the contact will last and gives that away; S₁, S₂
//! with `u = (v/v₁)^(−1/5)` (Hertz) are used in that case alone.

mod align;
mod drift;
mod place;
mod settle;
mod spread;
#[cfg(test)]
mod tests;

use super::Timed;
use crate::signal::correlate::Correlator;
use crate::signal::template::Template;
use crate::signal::template::aligned::Aligned;
use crate::signal::whiten::Whitened;
use crate::statistics::upper_median;
use crate::units::{real, samples_in, whole};

/// Windows begin this long before the onset, in seconds.
const BEFORE_S: f64 = 1e-3;
/// The template is at most this long, in seconds: rings and rooms that last longer are noise.
const LONGEST_S: f64 = 0.2;
/// Sound before the first impact that shows what noise does, in seconds.
const LEAD_S: f64 = 0.25;
/// Fewest impacts that have something in common.
const FEWEST: usize = 3;
/// Rounds in which impacts may jump to a better match, and rounds in which they only settle.
const SEARCHES: usize = 3;
const ROUNDS: usize = 3;

/// One impact.
#[derive(Debug, Clone)]
struct Impact {
    /// Onset in samples of the stretch, up to what is common to all.
    position: f64,
    /// Size in units of the template.
    amplitude: f64,
    /// Where the detector saw it, in samples, and the standard deviation of that.
    coarse: f64,
    jitter: f64,
    /// `(v/v₁)^(−1/5)` less its mean: how much longer than usual its contact lasts.
    slowness: f64,
    /// How many samples err alike.
    likeness: f64,
    /// Standard error by other places that match nearly as well.
    doubt: f64,
    /// Power of what nothing explains around it, where that stands out: knocks, voices, a hand.
    knocks: Vec<f64>,
}

impl Impact {
    /// Its sound where it stands, as `cut` cuts it at a position.
    fn aligned(&self, cut: impl Fn(f64) -> Vec<f64>) -> Aligned {
        Aligned {
            amplitude: self.amplitude,
            sound: cut(self.position),
        }
    }

    /// How far from its coarse time it is sought, in samples.
    fn reach(&self) -> usize {
        whole(settle::PRIOR_REACH * self.jitter).max(2)
    }
}

/// The impacts of a drop in the whitened sound around them.
#[derive(Debug)]
struct Joint {
    sound: Vec<f64>,
    rate: f64,
    impacts: Vec<Impact>,
    template: Template,
    correlator: Correlator,
}

/// Times of the impacts from coarse times in ascending order; an impact that does not resemble the others keeps the
/// detector's. None if there are fewer than three.
pub(super) fn times(sound: &Whitened<'_>, coarse: &[Timed]) -> Option<(Vec<Timed>, Template)> {
    let rate = sound.sample_rate_hz();
    let (start, mut joint) = started(sound, coarse)?;
    let late = drift::follow(&mut joint);
    let onset = joint.template.onset(rate);
    let in_recording = |position: f64| (real(start) + position + onset) / rate;
    let stds = spread::standard_errors(&joint);
    let usual = joint.usual_move();
    let timed = joint.impacts.iter().zip(stds).map(|(impact, std)| {
        let (position, std) = match std {
            Some(std) if impact.doubt <= impact.jitter => {
                let drift = late.std(impact.slowness);
                let position = impact.position + late.shift(impact.slowness);
                (position, std.hypot(drift).hypot(impact.doubt))
            }
            // It does not resemble the others, or rival places lie farther apart than the detector errs.
            _ => (impact.coarse + usual, impact.jitter),
        };
        Timed {
            time_s: in_recording(position),
            std_s: std / rate,
        }
    });
    Some((timed.collect(), joint.template))
}

/// The impacts in their first alignment, and the sample that their stretch begins at.
fn started(sound: &Whitened<'_>, coarse: &[Timed]) -> Option<(usize, Joint)> {
    if coarse.len() < FEWEST {
        return None;
    }
    let rate = sound.sample_rate_hz();
    let (start, sound) = stretch(sound, coarse)?;
    let in_samples = |t: &Timed| (t.time_s * rate - real(start), t.std_s * rate);
    let coarse: Vec<(f64, f64)> = coarse.iter().map(in_samples).collect();
    Some((start, align::start(sound, rate, &coarse)?))
}

/// The whitened sound from before the first impact to after the last, and the sample that it begins at.
fn stretch(sound: &Whitened<'_>, coarse: &[Timed]) -> Option<(usize, Vec<f64>)> {
    let (rate, range) = (sound.sample_rate_hz(), sound.range());
    let (first_s, last_s) = (coarse.first()?.time_s, coarse.last()?.time_s);
    let start = samples_in(first_s - LEAD_S, rate).max(range.start);
    let end = samples_in(last_s + LONGEST_S, rate).min(range.end);
    Some((start, sound.between(start, end)?))
}

impl Joint {
    /// How far matches usually stand after the detector's times, in samples: the median.
    fn usual_move(&self) -> f64 {
        let moves = self.impacts.iter().map(|i| i.position - i.coarse);
        upper_median(moves).unwrap_or(0.0)
    }
}
