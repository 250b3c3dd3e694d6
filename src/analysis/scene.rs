//! A scene, the part of a recording from a first rise to a last: which channel hears it best, and the drops in it.

use super::candidate::Candidate;
use super::drop::{self, Measured};
use super::stretch::Stretch;
use super::tail::{self, Followed};
use super::{Settings, few, louder_before, rejected};
use crate::Error;
use crate::detect::{Detector, clarity};
use crate::event::Event;
use crate::order::sort_by_number;
use crate::report::Rejected;
use crate::sequence::{self, Chain, Found, is_echo_of};
use crate::signal::sound::Sound;
use crate::units::frame_time_s;
use crate::workers::Workers;

/// Range of a scene in its recording.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    /// Its first frame.
    pub first: u64,
    /// First frame of the recording that was listened to.
    pub listened_from: u64,
    /// Whether it goes on, because there was no room for all of it.
    pub cut: bool,
}

/// The drops and events of a scene.
#[derive(Debug)]
pub(super) struct SceneResult {
    /// The drops, in order of time.
    pub drops: Vec<Measured>,
    /// Two or three impacts, where there is no drop.
    pub few: Option<few::Heard>,
    /// The chain that comes nearest to a drop, where there is none.
    pub candidate: Option<Candidate>,
    /// Strong events outside the drops, with their strengths.
    pub rejected: Vec<(f64, Rejected)>,
    /// Number of weaker ones.
    pub weak: usize,
    /// Strengths of all events on the channel that was listened to.
    pub strengths: Vec<f64>,
    /// Clarity of each channel.
    pub clarities: Vec<f64>,
    /// Whether there was any sound.
    pub sound: bool,
    /// Drops that were cut in two.
    pub split: usize,
    /// Results before this time are final; the audio after it is heard again with the rest of the recording.
    pub final_until_s: f64,
}

/// A scene whose chains were found, on the channel in which impacts stand out most, and not measured.
#[derive(Debug)]
pub(super) struct Chained<'a> {
    stretch: Stretch<'a>,
    channel: usize,
    clarities: Vec<f64>,
    /// Whether there was any sound.
    sound: bool,
    events: Vec<Event>,
    /// The chains, and what belongs to none of them.
    pub found: Found,
    edge: Edge,
}

impl<'a> Chained<'a> {
    pub(super) fn of(
        channels: &[&'a [f32]],
        bounds: &Bounds,
        detector: &Detector,
        workers: Workers,
    ) -> Self {
        let rate = detector.sample_rate_hz();
        let sound = |channel: usize| Sound {
            samples: channels[channel],
            sample_rate_hz: rate,
            start_s: frame_time_s(bounds.first, rate),
        };
        let sounds = (0..channels.len()).map(sound).collect();
        let mut heard = workers.map(sounds, |sound| detector.events(&sound));
        let clarities: Vec<f64> = heard.iter().map(|events| clarity(events)).collect();
        let channel = clearest(&clarities);
        let stretch = Stretch {
            sound: sound(channel),
            listened_from_s: frame_time_s(bounds.listened_from, rate),
        };
        let events = heard.swap_remove(channel);
        let by_sound = |chain: &Chain| tail::follow(&stretch, chain.clone()).chain.evidence();
        let found = sequence::find(&events, by_sound);
        let edge = Edge::of(&stretch, bounds.cut, &found);
        Self {
            stretch,
            channel,
            clarities,
            sound: channels.iter().any(|c| c.iter().any(|x| *x != 0.0)),
            events,
            found,
            edge,
        }
    }

    /// Measures the chains.
    ///
    /// `reported_s` are the times of impacts in the scene that were reported already, with its first part.
    pub(super) fn measured(
        self,
        reported_s: &[f64],
        detector: &Detector,
        settings: &Settings,
        workers: Workers,
    ) -> Result<SceneResult, Error> {
        let Self {
            stretch,
            channel,
            events,
            mut found,
            edge,
            ..
        } = self;
        let few = if found.drops.is_empty() {
            few::heard(
                &stretch,
                &events,
                detector,
                edge.final_until_s,
                channel,
                settings,
            )?
        } else {
            None
        };
        let candidate = found.candidate.take();
        let candidate = candidate.map(|c| Candidate::of_chain(&stretch, c, channel, settings));
        let rejected = rejected_before(edge.final_until_s, reported_s, &events, &found);
        let weak = weak_before(edge.final_until_s, &events, &found);
        let new = found.drops.into_iter();
        let new = new.filter(|chain| !edge.is_deferred(chain) && !is_reported(chain, reported_s));
        let kept = followed(&stretch, new.collect(), workers);
        let spans_s: Vec<(f64, f64)> = kept.iter().map(|k| k.chain.span_s()).collect();
        let drops = workers.map(kept.into_iter().enumerate().collect(), |(i, followed)| {
            let from_s = explained_until_s(i, &spans_s, reported_s);
            let louder = louder_before::warning(&followed.chain, &events, from_s);
            let mut measured = drop::measure(&stretch, followed, channel, settings)?;
            measured.warnings.extend(louder);
            Ok(measured)
        });
        let drops = drops
            .into_iter()
            .collect::<Result<Vec<Measured>, Error>>()?;
        Ok(SceneResult {
            drops,
            few,
            candidate: candidate.transpose()?,
            rejected,
            weak,
            strengths: events.iter().map(|e| e.strength).collect(),
            sound: self.sound,
            clarities: self.clarities,
            split: edge.split,
            final_until_s: edge.final_until_s,
        })
    }
}

/// Chains with their ends, in order of time, but for those that turn out to be the echo of another.
fn followed<'a>(stretch: &Stretch<'a>, chains: Vec<Chain>, workers: Workers) -> Vec<Followed<'a>> {
    let mut followed = workers.map(chains, |chain| tail::follow(stretch, chain));
    sort_by_number(&mut followed, |f| -f.chain.evidence());
    let mut kept: Vec<Followed<'a>> = Vec::new();
    for new in followed {
        if !kept.iter().any(|k| is_echo_of(&new.chain, &k.chain)) {
            kept.push(new);
        }
    }
    sort_by_number(&mut kept, |f| f.chain.span_s().0);
    kept
}

/// The first of the channels that hear most clearly.
pub(super) fn clearest(clarities: &[f64]) -> usize {
    let best = clarities.iter().enumerate().rev();
    best.max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(c, _)| c)
}

/// The cut of a scene that goes on.
#[derive(Debug, Clone, Copy)]
struct Edge {
    /// Drops that begin before this are not deferred: they have lasted for half of the audio that can be held.
    oldest_s: f64,
    /// Drops whose next impacts would be later than this may go on.
    end_s: f64,
    final_until_s: f64,
    split: usize,
}

/// A drop is open if this many flights like its last do not fit before the cut, as some impacts may be too faint …
const OPEN_FLIGHTS: f64 = 5.0;
/// … or this much time, in seconds.
const OPEN_S: f64 = 0.1;
/// Audio before the cut that is heard again, in seconds: flights of a drop that has not made four impacts yet.
const AGAIN_S: f64 = 6.0;
/// Audio before its first impact that a drop is heard again with, in seconds.
const LEAD_S: f64 = 1.0;

impl Edge {
    fn of(stretch: &Stretch<'_>, cut: bool, found: &Found) -> Self {
        let end_s = stretch.sound.end_s();
        let mut edge = Self {
            oldest_s: 0.5 * (stretch.sound.start_s + end_s),
            end_s,
            final_until_s: f64::INFINITY,
            split: 0,
        };
        if !cut {
            edge.end_s = f64::INFINITY;
            return edge;
        }
        let (deferred, reported): (Vec<&Chain>, Vec<&Chain>) = found
            .drops
            .iter()
            .partition(|chain| edge.is_deferred(chain));
        let first_s = deferred.iter().map(|chain| chain.span_s().0 - LEAD_S);
        edge.final_until_s = first_s.fold((end_s - AGAIN_S).max(edge.oldest_s), f64::min);
        // Drops longer than the audio that can be held are split: their later parts are reported as drops of their own.
        let split = reported.iter().filter(|chain| edge.is_open(chain));
        let split_s: Vec<f64> = split.map(|chain| chain.span_s().1).collect();
        edge.split = split_s.len();
        edge.final_until_s = split_s.into_iter().fold(edge.final_until_s, f64::max);
        edge
    }

    /// Whether a drop may go on past the cut.
    fn is_open(&self, chain: &Chain) -> bool {
        let last_s = chain.span_s().1;
        let before_s = chain.impacts.iter().rev().nth(1).map_or(0.0, |i| i.time_s);
        last_s + OPEN_FLIGHTS * (last_s - before_s) + OPEN_S > self.end_s
    }

    /// Whether a drop is heard again with the rest of the recording.
    fn is_deferred(&self, chain: &Chain) -> bool {
        self.is_open(chain) && chain.span_s().0 - LEAD_S > self.oldest_s
    }
}

/// The time up to which other drops explain what is heard before one of them: the end of those that begin before it.
fn explained_until_s(drop: usize, spans_s: &[(f64, f64)], reported_s: &[f64]) -> f64 {
    let first_s = spans_s[drop].0;
    let earlier = spans_s[..drop].iter().map(|span_s| span_s.1);
    let reported = reported_s.iter().copied().filter(|&t| t < first_s);
    earlier.chain(reported).fold(f64::NEG_INFINITY, f64::max)
}

/// Greatest distance of an impact from one reported already that is the same, in seconds.
const SAME_S: f64 = 2e-3;

pub(super) fn is_known(time_s: f64, reported_s: &[f64]) -> bool {
    let at = reported_s.partition_point(|&t| t < time_s - SAME_S);
    reported_s.get(at).is_some_and(|&t| t <= time_s + SAME_S)
}

/// Whether a chain is the later part of a drop that was reported already.
fn is_reported(chain: &Chain, reported_s: &[f64]) -> bool {
    let known = chain
        .impacts
        .iter()
        .filter(|i| is_known(i.time_s, reported_s));
    2 * known.count() > chain.impacts.len()
}

fn rejected_before(
    final_until_s: f64,
    reported_s: &[f64],
    events: &[Event],
    found: &Found,
) -> Vec<(f64, Rejected)> {
    let before = found.rejected.iter().filter(|r| r.time_s < final_until_s);
    let new = before.filter(|r| !is_known(r.time_s, reported_s));
    new.map(|r| {
        let event = events.partition_point(|e| e.time_s < r.time_s);
        let strength = events.get(event).map_or(0.0, |e| e.strength);
        (strength, rejected(r))
    })
    .collect()
}

/// Events before a time that are neither an impact nor named.
fn weak_before(final_until_s: f64, events: &[Event], found: &Found) -> usize {
    let named = |chain: &Chain| {
        let heard = chain.impacts.iter().filter(|i| i.is_heard());
        let times = heard.map(|i| i.time_s);
        let rejected = chain.rejected.iter().map(|r| r.time_s);
        times.chain(rejected).filter(|&t| t < final_until_s).count()
    };
    let before = events.partition_point(|e| e.time_s < final_until_s);
    let outside = found.rejected.iter().filter(|r| r.time_s < final_until_s);
    let in_drops: usize = found.drops.iter().map(named).sum();
    before.saturating_sub(in_drops + outside.count())
}
