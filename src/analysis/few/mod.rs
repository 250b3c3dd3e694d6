//! Drops of two or three impacts, which are sought where no chain was found.

mod onset;
mod rebound;
mod sounds;

pub(super) use rebound::{answer, complete};

use super::Settings;
use super::drop::{self, Measured};
use super::stretch::Stretch;
use super::tail;
use crate::Error;
use crate::detect::Detector;
use crate::event::Event;
use crate::impact::{Impact, Status};
use crate::physics::BounceSeries;
use crate::sequence::few::{FewImpacts, few_impacts};
use crate::sequence::{self, Chain};
use crate::units::real;

/// Two or three impacts that stand out in a scene.
#[derive(Debug)]
pub(super) struct Heard {
    pub found: FewImpacts,
    pub measured: Measured,
}

impl Heard {
    /// The better of two scenes, to which the other is a rival.
    pub(super) fn or_better(self, other: Self) -> Self {
        let (mut best, worse) = if other.found.nats > self.found.nats {
            (other, self)
        } else {
            (self, other)
        };
        best.found.rival_nats = best.found.rival_nats.max(worse.found.nats);
        best
    }

    /// Whether they are a drop.
    pub(super) fn is_enough(&self) -> bool {
        self.found.are_enough()
    }
}

/// The two or three sounds of a scene that a ball explains best, of those before `until_s`.
///
/// # Errors
/// [`Error::Argument`] for a setting out of range.
pub(super) fn heard(
    stretch: &Stretch<'_>,
    events: &[Event],
    detector: &Detector,
    until_s: f64,
    channel: usize,
    settings: &Settings,
) -> Result<Option<Heard>, Error> {
    let sounds = sounds::clear_sounds(&stretch.sound, detector, events);
    let before = &sounds[..sounds.partition_point(|s| s.time_s < until_s)];
    let duration_s = stretch.sound.end_s() - stretch.sound.start_s;
    let longest_s = longest_flight_s(settings)?;
    let Some(found) = few_impacts(before, duration_s, longest_s) else {
        return Ok(None);
    };
    // What sounds after is for the next scene to tell, and its drops.
    let events = &events[..events.partition_point(|e| e.time_s < until_s)];
    if let Some(chain) = longer(&found, events) {
        let followed = tail::follow(stretch, chain);
        let mut measured = drop::measure(stretch, followed, channel, settings)?;
        measured.evidence_nats = measured.evidence_nats.max(found.nats);
        return Ok(Some(Heard { found, measured }));
    }
    let nats = found.nats / real(found.impacts.len());
    let impact = |sound: &_| {
        let &sequence::few::ClearSound {
            time_s, jitter_s, ..
        } = sound;
        Impact {
            time_s,
            std_s: jitter_s,
            status: Status::Heard,
            nats,
        }
    };
    let chain = Chain {
        impacts: found.impacts.iter().map(impact).collect(),
        rejected: Vec::new(),
    };
    let sound = stretch.whitened(&chain);
    let timed = stretch.timed(&chain, &sound, settings.timing);
    let timed = timed
        .into_iter()
        .map(|impact| onset::doubted(stretch, impact));
    let chain = Chain {
        impacts: timed.collect(),
        ..chain
    };
    let measured = drop::fit(stretch, chain, channel, settings)?;
    Ok(Some(Heard { found, measured }))
}

/// Three impacts that are a drop, with those that follow as its flights would have it: a chain of its own would need more
/// evidence, as any sounds can begin one. None where nothing follows, or another chain would hold them better.
fn longer(found: &FewImpacts, events: &[Event]) -> Option<Chain> {
    if !found.are_enough() {
        return None;
    }
    let known: Vec<(f64, f64)> = found
        .impacts
        .iter()
        .map(|i| (i.time_s, i.jitter_s.max(LEAST_JITTER_S)))
        .collect();
    let chain = sequence::follow_again(events, &known)?;
    let is_in = |&(time_s, off_s): &(f64, f64)| {
        let mut heard = chain.impacts.iter().filter(|i| i.is_heard());
        heard.any(|i| (i.time_s - time_s).abs() <= off_s)
    };
    (chain.heard() > known.len() && known.iter().all(is_in)).then_some(chain)
}

/// An event may be this far from the sound that stands out, in seconds.
const LEAST_JITTER_S: f64 = 3e-3;

/// The first flight of a ball that loses nothing, from the height as far as it is known: `2√(2h/g)`.
fn longest_flight_s(settings: &Settings) -> Result<Option<f64>, Error> {
    let Some(height_m) = settings.height_m else {
        return Ok(None);
    };
    let highest_m = height_m + HEIGHT_REACH * settings.height_std_m;
    let series = BounceSeries::new(highest_m, settings.gravity_m_per_s2)?;
    Ok(Some(2.0 * series.first_fall_s()))
}

/// A height may be off by so many standard errors.
const HEIGHT_REACH: f64 = 2.0;

#[cfg(test)]
mod tests;
