//! The first alignment: from the loudest impact along the drop, each impact matched with those next to it.

use super::interference::{JUDGED_S, UNKNOWN};
use super::matched_search::{Search, Window, best_match};
use super::start::Started;
use super::{Place, Prior};
use crate::order::sort_by_number;
use crate::signal::correlate::Correlator;
use crate::signal::interpolate::{KERNEL, shifted};
use crate::signal::template::Template;
use crate::signal::template::aligned::{Cut, mean};
use crate::units::{real, samples_in, whole};

/// Neighbours whose mean an impact is matched with.
const NEIGHBOURS: usize = 3;

/// The impacts in their first alignment, and the template that they give.
#[derive(Debug, Clone)]
pub(super) struct Aligned {
    /// Prior of each for the search from now on.
    pub priors: Vec<Prior>,
    pub places: Vec<Place>,
    pub template: Template,
}

impl Aligned {
    /// None where nothing stands out of the noise.
    pub(super) fn of(started: &Started) -> Option<Self> {
        let (loudest, count) = (started.loudest, started.priors.len());
        let mut priors = started.priors.clone();
        let mut places: Vec<Place> = priors.iter().map(|p| p.place(1.0)).collect();
        let mut correlator = Correlator::default();
        let mut aligned = vec![loudest];
        for i in (loudest + 1..count).chain((0..loudest).rev()) {
            let near: Vec<Place> = nearest(&aligned, i).iter().map(|&j| places[j]).collect();
            let head = Head::of(started, &near);
            if let Some((prior, place)) = head.placed(started, i, &mut correlator) {
                (priors[i], places[i]) = (prior, place);
                aligned.push(i);
            } else {
                places[i].amplitude = FAINT;
            }
        }
        Some(Self {
            template: template(started, &places)?,
            priors,
            places,
        })
    }
}

/// Amplitude of an impact without a match, until it has one.
const FAINT: f64 = 1e-3;

/// The aligned impacts next to one.
fn nearest(aligned: &[usize], i: usize) -> Vec<usize> {
    let mut near = aligned.to_vec();
    sort_by_number(&mut near, |&j| real(j.abs_diff(i)));
    near.truncate(NEIGHBOURS);
    near
}

/// The mean head of the sounds of some impacts.
struct Head {
    template: Template,
    /// Their root mean square amplitude.
    usual: f64,
}

/// A match of less than this share of its neighbours' amplitude is sought again, `WIDER` times as far from its coarse time …
const LOST: f64 = 0.5;
const WIDER: f64 = 4.0;
/// … and is taken there if its amplitude is `LOUDER` times as large.
const LOUDER: f64 = 2.0;

impl Head {
    fn of(started: &Started, near: &[Place]) -> Self {
        let heads: Vec<Cut> = near
            .iter()
            .map(|place| started.cut_at(place, started.head))
            .collect();
        let shape = mean(&heads);
        let power: f64 = near.iter().map(|place| place.amplitude.powi(2)).sum();
        let noise = vec![1.0 / power; shape.len()];
        Self {
            template: Template::new(shape, noise, started.before),
            usual: (power / real(near.len())).sqrt(),
        }
    }

    /// The match of impact `i` with about the usual amplitude, and the prior that it was found with. Of sounds that rise
    /// slowly the detector's time can be off by more than its stated jitter, up to a share of the flight.
    fn placed(
        &self,
        started: &Started,
        i: usize,
        correlator: &mut Correlator,
    ) -> Option<(Prior, Place)> {
        let prior = started.priors[i];
        let mut at = |std: f64| {
            let prior = Prior { std, ..prior };
            Some((prior, self.matched(started, i, prior, correlator)?))
        };
        let near = at(prior.std);
        let loud = near.map_or(0.0, |(_, place)| place.amplitude);
        if loud > LOST * self.usual {
            return near;
        }
        let far = at((WIDER * prior.std).min(started.farthest(i)));
        far.filter(|(_, place)| place.amplitude > (LOST * self.usual).max(LOUDER * loud))
            .or(near)
    }

    /// The best place near where an impact is expected.
    fn matched(
        &self,
        started: &Started,
        i: usize,
        prior: Prior,
        correlator: &mut Correlator,
    ) -> Option<Place> {
        let (head, before) = (self.template.head, real(self.template.before));
        let reach = prior.reach() + KERNEL;
        let begin = prior.position.round() - before - real(reach);
        let sound = shifted(&started.sound, begin, head + 2 * reach);
        let mut noise = vec![1.0; sound.len()];
        // From the next impact on the sound is of both.
        let next = started
            .priors
            .get(i + 1)
            .map_or(started.next, |next| next.position);
        let alone = whole(next - before - begin).min(noise.len());
        noise[alone..].fill(UNKNOWN);
        let window = Window {
            noise: &noise,
            sound: &sound,
        };
        let search = Search {
            prior: prior.from(begin).from(before),
            reach,
            judged: samples_in(JUDGED_S, started.rate),
        };
        let found = best_match(correlator, window, &self.template.mean()[..head], search)?;
        Some(Place {
            position: begin + found.position + before,
            amplitude: found.amplitude,
        })
    }
}

/// The template of the impacts that sound alone for long enough.
fn template(started: &Started, places: &[Place]) -> Option<Template> {
    let alone = |length: usize| -> Vec<Cut> {
        let apart = real(length + started.before);
        let is_alone = |i: usize| started.flights.get(i).is_none_or(|&f| f > apart);
        let alone = places.iter().enumerate().filter(|&(i, _)| is_alone(i));
        alone
            .map(|(_, place)| started.cut_at(place, length))
            .collect()
    };
    let mut of = alone(started.longest);
    if of.len() < 2 {
        of = alone(started.head);
    }
    Template::of_aligned(&of, started.before, started.rate)
}
