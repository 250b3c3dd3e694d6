//! The first alignment: from the loudest impact along the drop, each impact matched with those next to it.

use super::place::best;
use super::{BEFORE_S, Impact, Joint, LONGEST_S};
use crate::signal::correlate::Correlator;
use crate::signal::interpolate::{KERNEL, shifted};
use crate::signal::template::Template;
use crate::signal::template::aligned::{Aligned, SHORTEST_S, mean};
use crate::units::{real, samples_in, whole};

/// Impacts are first aligned by this much of their sound at most, in seconds.
const FIRST_S: f64 = 12e-3;
/// Neighbours whose mean an impact is matched with.
const NEIGHBOURS: usize = 3;
/// The detector's times are off by as much as it says, and at least by this share of the sound's period (one standard
/// deviation) within these bounds in seconds.
const JITTER_PERIODS: f64 = 0.3;
const JITTER_S: (f64, f64) = (0.5e-3, 1.5e-3);
/// Nor is an impact off by more than this share of a flight (one standard deviation): it was found where the flights
/// before it want it.
const FLIGHT_SHARE: f64 = 0.05;

/// The impacts aligned, and the template that they give; `coarse` are the detector's times and their standard deviations in
/// samples.
pub(super) fn start(sound: Vec<f64>, rate: f64, coarse: &[(f64, f64)]) -> Option<Joint> {
    let before = samples_in(BEFORE_S, rate);
    let flights: Vec<f64> = coarse.windows(2).map(|w| w[1].0 - w[0].0).collect();
    let longest = longest(&flights, rate, before);
    let first = longest.min(samples_in(FIRST_S, rate));
    let cut =
        |position: f64, length: usize| shifted(&sound, position - real(before), before + length);
    let alone = |i: usize| flights.get(i).is_none_or(|&f| f > real(first));
    let energy = |i: usize| cut(coarse[i].0, first).iter().map(|x| x * x).sum::<f64>();
    let loudest = (0..coarse.len())
        .filter(|&i| alone(i))
        .max_by(|&a, &b| energy(a).total_cmp(&energy(b)))?;
    let jitter = jitter(&cut(coarse[loudest].0, first), rate);
    let mut impacts: Vec<Impact> = (0..coarse.len())
        .map(|i| Impact {
            position: coarse[i].0,
            amplitude: 1.0,
            coarse: coarse[i].0,
            jitter: jitter
                .max(coarse[i].1)
                .min(FLIGHT_SHARE * shortest_flight(&flights, i)),
            slowness: 0.0,
            likeness: 1.0,
            doubt: 0.0,
            knocks: Vec::new(),
        })
        .collect();
    let mut correlator = Correlator::default();
    let mut aligned = vec![loudest];
    for i in (loudest + 1..coarse.len()).chain((0..loudest).rev()) {
        let near = nearest(&aligned, i);
        let heads: Vec<Aligned> = near
            .iter()
            .map(|&j| impacts[j].aligned(|p| cut(p, first)))
            .collect();
        let shape = mean(&heads);
        let power: f64 = near.iter().map(|&j| impacts[j].amplitude.powi(2)).sum();
        let noise = vec![1.0 / power; shape.len()];
        let head = Template::new(shape, noise, before);
        let usual = (power / real(near.len())).sqrt();
        let farthest = FLIGHT_SHARE * shortest_flight(&flights, i);
        let found = placed(&mut correlator, &sound, &impacts[i], &head, usual, farthest);
        if let Some(found) = found {
            impacts[i] = found;
            aligned.push(i);
        } else {
            impacts[i].amplitude = FAINT;
        }
    }
    let template = long_template(&impacts, &flights, (longest, first), before, rate, cut)?;
    Some(Joint {
        sound,
        rate,
        impacts,
        template,
        correlator,
    })
}

/// A match of less than this share of its neighbours' size is sought again, so many times farther from its coarse time …
const LOST: f64 = 0.5;
const WIDER: f64 = 4.0;
/// … and is taken there if it is so many times larger.
const LOUDER: f64 = 2.0;

/// An impact where it matches, of about the usual amplitude. Where a sound rises slowly the detector can be off by more than
/// it says, but at most by `farthest`.
fn placed(
    correlator: &mut Correlator,
    sound: &[f64],
    impact: &Impact,
    head: &Template,
    usual: f64,
    farthest: f64,
) -> Option<Impact> {
    let mut at = |jitter: f64| {
        let impact = Impact {
            jitter,
            ..impact.clone()
        };
        let (position, amplitude) = matched(correlator, sound, &impact, head)?;
        Some(Impact {
            position,
            amplitude,
            ..impact
        })
    };
    let near = at(impact.jitter);
    let loud = near.as_ref().map_or(0.0, |n| n.amplitude);
    if loud > LOST * usual {
        return near;
    }
    let far = at((WIDER * impact.jitter).min(farthest));
    far.filter(|f| f.amplitude > (LOST * usual).max(LOUDER * loud))
        .or(near)
}

/// An impact that matches nothing is taken to be this loud until it does.
pub(super) const FAINT: f64 = 1e-3;

/// Samples after the onset that three impacts at least sound alone.
fn longest(flights: &[f64], rate: f64, before: usize) -> usize {
    let mut sorted = flights.to_vec();
    sorted.sort_by(|a, b| b.total_cmp(a));
    let third = sorted.get(2).or(sorted.last()).copied().unwrap_or(0.0);
    let alone = whole(0.9 * third - real(before));
    alone.clamp(samples_in(SHORTEST_S, rate), samples_in(LONGEST_S, rate))
}

/// How exactly the detector can tell when such a sound begins, in samples.
fn jitter(sound: &[f64], rate: f64) -> f64 {
    let energy: f64 = sound.iter().map(|x| x * x).sum();
    let change: f64 = sound.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum();
    let period = std::f64::consts::TAU * (energy / change.max(f64::MIN_POSITIVE)).sqrt();
    (JITTER_PERIODS * period).clamp(JITTER_S.0 * rate, JITTER_S.1 * rate)
}

/// The shorter of the flights on both sides of an impact, in samples.
fn shortest_flight(flights: &[f64], i: usize) -> f64 {
    let before = i.checked_sub(1).and_then(|i| flights.get(i));
    let near = before.into_iter().chain(flights.get(i));
    near.copied().fold(f64::INFINITY, f64::min)
}

/// The aligned impacts next to one.
fn nearest(aligned: &[usize], i: usize) -> Vec<usize> {
    let mut near = aligned.to_vec();
    near.sort_by_key(|&j| j.abs_diff(i));
    near.truncate(NEIGHBOURS);
    near
}

/// Position and amplitude of an impact by the template's head.
fn matched(
    correlator: &mut Correlator,
    sound: &[f64],
    impact: &Impact,
    template: &Template,
) -> Option<(f64, f64)> {
    let (head, reach) = (template.head, impact.reach() + KERNEL);
    let begin = impact.coarse.round() - real(template.before + reach);
    let samples = shifted(sound, begin, head + 2 * reach);
    let noise = vec![1.0; samples.len()];
    let coarse = impact.coarse - begin - real(template.before);
    let shape = &template.mean()[..head];
    let fit = best(
        correlator,
        (&samples, &noise),
        shape,
        (coarse, impact.jitter),
        (reach, impact.likeness),
    )?;
    Some((begin + fit.position + real(template.before), fit.amplitude))
}

/// The template of the impacts that sound alone for long enough.
fn long_template(
    impacts: &[Impact],
    flights: &[f64],
    (longest, first): (usize, usize),
    before: usize,
    rate: f64,
    cut: impl Fn(f64, usize) -> Vec<f64>,
) -> Option<Template> {
    let alone = |length: usize| -> Vec<Aligned> {
        let each = impacts.iter().enumerate();
        let alone =
            each.filter(|&(i, _)| flights.get(i).is_none_or(|&f| f > real(length + before)));
        alone
            .map(|(_, impact)| impact.aligned(|p| cut(p, length)))
            .collect()
    };
    let mut of = alone(longest);
    if of.len() < 2 {
        of = alone(first);
    }
    Template::of_aligned(&of, before, rate)
}
