//! The sound of a drop and the priors of its impacts, before any is matched.

use super::{BEFORE_S, LEAD_S, LONGEST_S, PRIOR_REACH, Place, Prior};
use crate::impact::Impact;
use crate::signal::interpolate::shifted;
use crate::signal::template::aligned::Cut;
use crate::signal::whiten::Whitened;
use crate::statistics::{sorted, upper_median};
use crate::units::{real, samples_in, whole};

/// Fewest impacts timed together. Derived: fewer have no mean to differ from.
const FEWEST: usize = 3;
/// Impacts are first aligned by this much of their sound at most, in seconds.
const FIRST_S: f64 = 12e-3;
/// The detector's times are off by as much as it says, and at least by this share of the sound's period (one standard
/// deviation) within these bounds in seconds.
const JITTER_PERIODS: f64 = 0.3;
const JITTER_S: (f64, f64) = (0.5e-3, 1.5e-3);
/// Greatest error of a detector's time as a share of a flight (one standard deviation): the impact was found where the
/// flights before it predict it.
const FLIGHT_SHARE: f64 = 0.05;
/// Exponent of the contact time of a solid sphere, `ΔT ∝ v^(−1/5)`. Derived: Hertz.
const EXPONENT: f64 = -0.2;

/// The whitened sound around a drop, and where its impacts are expected; constant from here on.
#[derive(Debug)]
pub(super) struct Started {
    pub sound: Vec<f64>,
    /// Samples per second.
    pub rate: f64,
    /// The sample of the recording that the sound begins at.
    pub first: usize,
    /// Samples of a template before the onset.
    pub before: usize,
    /// Samples after the onset that three impacts at least sound alone, and those that impacts are first aligned by.
    pub longest: usize,
    pub head: usize,
    /// Samples between the detector's times.
    pub flights: Vec<f64>,
    /// Position of each impact by the detector.
    pub priors: Vec<Prior>,
    /// Contact stretch of each impact: `(v/v₁)^(−1/5)` less its mean.
    pub contact_stretches: Vec<f64>,
    /// The loudest of the impacts that nothing follows too soon.
    pub loudest: usize,
    /// Position of the impact after the last one found, which is not among these: from there on the sound is of both.
    pub next: f64,
}

impl Started {
    /// From coarse times in ascending order; none of fewer than three, or where the recording is too short.
    pub(super) fn of(whitened: &Whitened<'_>, coarse: &[Impact]) -> Option<Self> {
        if coarse.len() < FEWEST {
            return None;
        }
        let (rate, range) = (whitened.sample_rate_hz(), whitened.range());
        let (first_s, last_s) = (coarse.first()?.time_s, coarse.last()?.time_s);
        let recorded = whitened.sound();
        let first = recorded.sample_at(first_s - LEAD_S).max(range.start);
        let end = recorded.sample_at(last_s + LONGEST_S).min(range.end);
        let sound = whitened.between(first, end)?;
        let seen = coarse.iter().map(|t| Prior {
            position: recorded.position(t.time_s) - real(first),
            std: t.std_s * rate,
        });
        let mut priors: Vec<Prior> = seen.collect();
        let pairs = priors.windows(2);
        let flights: Vec<f64> = pairs.map(|w| w[1].position - w[0].position).collect();
        let before = samples_in(BEFORE_S, rate);
        let longest = longest(&flights, rate, before);
        let head = longest.min(samples_in(FIRST_S, rate));
        let heads = priors
            .iter()
            .map(|prior| shifted(&sound, prior.position - real(before), before + head));
        let heads: Vec<Vec<f64>> = heads.collect();
        let loudest = loudest(&heads, &flights, head, rate)?;
        let jitter = jitter(&heads[loudest], rate);
        for (i, prior) in priors.iter_mut().enumerate() {
            prior.std = jitter.max(prior.std).min(farthest(&flights, i));
        }
        Some(Self {
            sound,
            rate,
            first,
            before,
            longest,
            head,
            contact_stretches: contact_stretches(&flights),
            next: next(&priors, &flights),
            flights,
            priors,
            loudest,
        })
    }

    /// The same where the ball is taken to bounce no more after the last impact found.
    pub(super) fn heard_to_its_end(self) -> Self {
        Self {
            next: f64::INFINITY,
            ..self
        }
    }

    /// The sound of an onset at a position: `length` samples after it, and those before it.
    pub(super) fn cut(&self, position: f64, length: usize) -> Vec<f64> {
        shifted(
            &self.sound,
            position - real(self.before),
            self.before + length,
        )
    }

    /// The sound of an impact at its place.
    pub(super) fn cut_at(&self, place: &Place, length: usize) -> Cut {
        Cut {
            amplitude: place.amplitude,
            sound: self.cut(place.position, length),
        }
    }

    /// The mean contact over that of the first impact: what its contact stretch lacks to 1.
    pub(super) fn mean_contact(&self) -> f64 {
        1.0 - self.contact_stretches.first().copied().unwrap_or(0.0)
    }

    /// [`farthest`] for impact `i`.
    pub(super) fn farthest(&self, i: usize) -> f64 {
        farthest(&self.flights, i)
    }
}

/// Greatest standard deviation of an impact's detected position, in samples: by the shorter of the flights on both sides.
fn farthest(flights: &[f64], i: usize) -> f64 {
    let before = i.checked_sub(1).and_then(|i| flights.get(i));
    let near = before.into_iter().chain(flights.get(i));
    FLIGHT_SHARE * near.copied().fold(f64::INFINITY, f64::min)
}

/// Where the impact after the last one is expected: a flight on that is to the last as, in the median, each is to the one before.
fn next(priors: &[Prior], flights: &[f64]) -> f64 {
    let ratio = upper_median(flights.windows(2).map(|w| w[1] / w[0]));
    let after = flights.last().zip(ratio).map(|(last, ratio)| last * ratio);
    let last = priors.last().zip(after);
    last.map_or(f64::INFINITY, |(last, after)| last.position + after)
}

/// The sound of most energy among those that nothing follows too soon and that the detector saw begin where it saw most begin: no
/// other is found by one that it saw farther from there than a search reaches, such as at the noise that a codec puts before it.
fn loudest(heads: &[Vec<f64>], flights: &[f64], length: usize, rate: f64) -> Option<usize> {
    let alone = |i: &usize| flights.get(*i).is_none_or(|&f| f > real(length));
    let tops: Vec<f64> = heads.iter().map(|h| real(top(h))).collect();
    let usual = upper_median((0..heads.len()).filter(alone).map(|i| tops[i]))?;
    let near = |&i: &usize| (tops[i] - usual).abs() <= PRIOR_REACH * JITTER_S.0 * rate;
    let energies: Vec<f64> = heads
        .iter()
        .map(|h| h.iter().map(|x| x * x).sum())
        .collect();
    let as_usual = (0..heads.len()).filter(alone).filter(near);
    as_usual.max_by(|&a, &b| energies[a].total_cmp(&energies[b]))
}

/// The loudest sample of a sound.
fn top(sound: &[f64]) -> usize {
    let louder = |&a: &usize, &b: &usize| sound[a].abs().total_cmp(&sound[b].abs());
    (0..sound.len()).max_by(louder).unwrap_or(0)
}

/// Samples after the onset that three impacts at least sound alone.
fn longest(flights: &[f64], rate: f64, before: usize) -> usize {
    let flights = sorted(flights.iter().copied());
    let third = flights.iter().rev().take(3).next_back().copied();
    let alone = whole(0.9 * third.unwrap_or(0.0) - real(before));
    alone.min(samples_in(LONGEST_S, rate))
}

/// Standard deviation of the detector's time of a sound like this, in samples.
fn jitter(sound: &[f64], rate: f64) -> f64 {
    (JITTER_PERIODS * period(sound)).clamp(JITTER_S.0 * rate, JITTER_S.1 * rate)
}

/// Mean period of a sound in samples: that of a sine with its energy and the energy of its changes.
pub(super) fn period(sound: &[f64]) -> f64 {
    let energy: f64 = sound.iter().map(|x| x * x).sum();
    let change: f64 = sound.windows(2).map(|w| (w[1] - w[0]).powi(2)).sum();
    std::f64::consts::TAU * (energy / change.max(f64::MIN_POSITIVE)).sqrt()
}

/// Contact stretches `(v/v₁)^(−1/5)` less their mean, an impact's speed being that of the flight before it; the first is as
/// much faster than the second as the second than the third.
fn contact_stretches(flights: &[f64]) -> Vec<f64> {
    let [first, second, ..] = flights else {
        return vec![0.0; flights.len() + 1];
    };
    let before = first * first / second;
    let speeds = std::iter::once(&before).chain(flights);
    let slow: Vec<f64> = speeds
        .map(|flight| (flight / before).powf(EXPONENT))
        .collect();
    let mean = slow.iter().sum::<f64>() / real(slow.len());
    slow.iter().map(|s| s - mean).collect()
}
