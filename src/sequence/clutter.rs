//! How often chance offers an event as strong as another: what a match is worth.

use std::cell::OnceCell;

use super::Event;
use super::marks::{KERNEL_REACH, Kind, LOUDNESS_AT_LARGE, LOUDNESS_OF_ANOTHER};
use crate::order::sort_by_number;
use crate::units::real;

/// Surroundings of an event, in seconds each way, in which a scene changes little, and in which a sound still rings.
const NEAR_S: [f64; 2] = [0.875, 0.1];
/// Shape of the gamma distribution of the rate over a recording: sounds come in bursts, so what happens at other times says
/// little of the surroundings of an event.
const SHAPE: f64 = 0.2;
/// … of the rate of a burst of like sounds, which a chain is judged against. Derived: of a rate of which nothing but its mean is known
/// the exponential distribution has the most entropy.
const SHAPE_OF_BURSTS: f64 = 1.0;
/// Knocks per second that happen where balls are dropped, whatever the noise: two a minute, of any strength.
const KNOCKS_PER_S: f64 = 0.03;
/// Share of the events near one that is clutter at least, however many of them may be impacts of the chain that is followed.
const LEAST_SHARE: f64 = 0.25;
/// Shortest span over which a rate is taken, in seconds, where the recording begins or ends.
const LEAST_SPAN_S: f64 = 0.25;
/// Of the events of the whole recording this many are compared with one, evenly spread over their strengths.
const COMPARED: usize = 128;

/// The events of a recording, by time and by loudness, and how many of its kind lie around each: found when it is first asked for.
#[derive(Debug)]
pub struct Clutter<'a> {
    /// In order of time.
    events: &'a [Event],
    /// Their indices by loudness, ascending.
    by_loudness: Vec<usize>,
    duration_s: f64,
    around: Vec<OnceCell<Around>>,
}

/// How many events lie around one, each by how like it is in loudness and sound: in either surroundings, and in the whole recording.
#[derive(Debug, Clone, Copy, Default)]
struct Around {
    near: [f64; 2],
    at_large: f64,
}

impl<'a> Clutter<'a> {
    /// Learns the rates from all events, which are in order of time.
    #[must_use]
    pub fn new(events: &'a [Event]) -> Self {
        let mut by_loudness: Vec<usize> = (0..events.len()).collect();
        sort_by_number(&mut by_loudness, |&i| events[i].loudness);
        let (first, last) = (events.first(), events.last());
        let duration_s = last.map_or(0.0, |e| e.time_s) - first.map_or(0.0, |e| e.time_s);
        Self {
            events,
            by_loudness,
            duration_s,
            around: vec![OnceCell::new(); events.len()],
        }
    }

    /// Seconds from the first event to the last, at least one.
    #[must_use]
    pub const fn duration_s(&self) -> f64 {
        self.duration_s.max(1.0)
    }

    /// What lies around an event, itself not counted.
    fn around(&self, event: usize) -> Around {
        *self.around[event].get_or_init(|| Around {
            near: self.near(event),
            at_large: self.at_large(event),
        })
    }

    fn near(&self, event: usize) -> [f64; 2] {
        let this = &self.events[event];
        let first = (self.events).partition_point(|e| e.time_s < this.time_s - NEAR_S[0]);
        let last = (self.events).partition_point(|e| e.time_s <= this.time_s + NEAR_S[0]);
        let others = (first..last).filter(|&i| i != event);
        let kind = Kind::of(this);
        let mut near = [0.0; 2];
        for other in others.map(|i| &self.events[i]) {
            add_where_near(&mut near, kind.density_near(other), other, this);
        }
        near
    }

    /// What some of the events have around one, itself not counted.
    fn around_among(&self, event: usize, some: &[usize]) -> Around {
        let this = &self.events[event];
        let kind = Kind::of(this);
        let mut around = Around::default();
        for other in some.iter().filter(|&&i| i != event) {
            let other = &self.events[*other];
            let like = kind.density_near(other);
            around.at_large += like;
            add_where_near(&mut around.near, like, other, this);
        }
        around
    }

    /// How many seconds lie within so many of an event.
    fn span_s(&self, event: usize, near_s: f64) -> f64 {
        let time_s = self.events[event].time_s;
        let (from_s, to_s) = (time_s - near_s, time_s + near_s);
        let begin_s = self.events.first().map_or(from_s, |e| e.time_s.max(from_s));
        let end_s = self.events.last().map_or(to_s, |e| e.time_s.min(to_s));
        (end_s - begin_s).max(LEAST_SPAN_S.min(near_s))
    }

    fn at_large(&self, event: usize) -> f64 {
        let this = &self.events[event];
        let range = self.place_of(this.loudness - KERNEL_REACH)
            ..self.place_of(this.loudness + KERNEL_REACH);
        let step = range.len().div_ceil(COMPARED).max(1);
        let some = self.by_loudness[range].iter().step_by(step);
        let others = some.filter(|&&i| i != event);
        let kind = Kind::of(this);
        let likeness = others.map(|&i| kind.density_near(&self.events[i]));
        real(step) * likeness.sum::<f64>()
    }

    /// The place of the first event at least as loud among those by loudness.
    fn place_of(&self, loudness: f64) -> usize {
        self.by_loudness
            .partition_point(|&i| self.events[i].loudness < loudness)
    }
}

/// Rates of clutter at the events of a scene where some events are no clutter, because they belong to a chain: those are taken
/// from what lies around. Each is computed when it is first asked for: hypotheses meet at the same events again and again.
#[derive(Debug)]
pub struct Rates<'a> {
    clutter: &'a Clutter<'a>,
    /// The events that belong to a chain, in order of time.
    associated: Vec<usize>,
    known: Vec<Option<Local>>,
    /// Whether the impacts that a chain has yet to show count as its own.
    hopeful: bool,
}

/// What is known of the clutter at one event: how much of it is near and like it, and its rate at large.
#[derive(Debug, Clone, Copy)]
struct Local {
    /// How much, in how many seconds, of each surroundings.
    near: [(f64, f64); 2],
    mean_per_s: f64,
}

impl Local {
    /// The mean of a rate whose prior is gamma's with the mean of what lies around and one shape.
    ///
    /// # Formula
    /// `λ = (n + a)/(t + a/m)` for n events in t seconds, m per second on average, and shape a: of the wider surroundings with the
    /// mean of the whole recording, of the nearer ones with that of the wider.
    fn rate_per_s(&self, shape: f64, own: impl Fn(f64) -> f64) -> f64 {
        let surroundings = self.near.iter().zip(NEAR_S);
        surroundings.fold(self.mean_per_s, |mean, (&(near, span_s), near_s)| {
            let near = (near - own(near_s)).max(LEAST_SHARE * near);
            (near + shape) / (span_s + shape / mean)
        })
    }
}

impl<'a> Rates<'a> {
    /// The rates at some events among clutter where some of them, by their indices, belong to a chain.
    #[must_use]
    pub fn new(clutter: &'a Clutter<'a>, associated: &[usize]) -> Self {
        let mut associated = associated.to_vec();
        associated.sort_unstable();
        associated.dedup();
        Self {
            clutter,
            known: vec![None; clutter.events.len()],
            associated,
            hopeful: false,
        }
    }

    /// The same where the impacts that a chain has yet to show count as its own.
    #[must_use]
    pub const fn hopeful(mut self) -> Self {
        self.hopeful = true;
        self
    }

    /// ln of the rate of clutter like an event, itself not counted, after or before a flight: per second and per unit
    /// of ln loudness.
    ///
    /// # Formula
    /// Every event counts by how like it is in loudness and sound, `f = φ((l − l')/h)/h · min(1, L)`: those near the event, and of
    /// the whole recording `m = Σ f / D + κ/R`, κ a rate of knocks of any loudness in a range R.
    pub(super) fn ln_per_s(&mut self, event: usize, flight_s: f64) -> f64 {
        let local = self.known(event);
        let own = |near_s| {
            if self.hopeful {
                own(flight_s, near_s)
            } else {
                0.0
            }
        };
        local.rate_per_s(SHAPE, own).ln()
    }

    /// ln of the rate at an event of a burst of sounds like it, of which some came before, at other times of the recording too.
    ///
    /// Those of a chain are its impacts so far. So n like sounds without order cost what they would if nobody knew their rate,
    /// `Π (k + a)/(t + a/m)` for k from 0 to n − 1, and a sound of their kind that is no impact costs the chain `ln n` in all,
    /// and not something of each.
    pub(super) fn ln_per_s_in_burst(&mut self, event: usize, before: &[usize]) -> f64 {
        let mut local = self.known(event);
        let seen = self.clutter.around_among(event, before);
        for ((near, _), seen) in local.near.iter_mut().zip(seen.near) {
            *near += seen;
        }
        local.mean_per_s += seen.at_large / self.clutter.duration_s();
        local.rate_per_s(SHAPE_OF_BURSTS, |_| 0.0).ln()
    }

    fn known(&mut self, event: usize) -> Local {
        let local = self.known[event].unwrap_or_else(|| self.local(event));
        self.known[event] = Some(local);
        local
    }

    fn local(&self, event: usize) -> Local {
        let clutter = self.clutter;
        let around = clutter.around(event);
        let own = clutter.around_among(event, &self.associated);
        let near = |k: usize| {
            let left = (around.near[k] - own.near[k]).max(0.0);
            (left, clutter.span_s(event, NEAR_S[k]))
        };
        let at_large = (around.at_large - own.at_large).max(0.0);
        Local {
            near: [near(0), near(1)],
            mean_per_s: at_large / clutter.duration_s() + KNOCKS_PER_S * LOUDNESS_AT_LARGE,
        }
    }
}

/// Adds how like another event is to those surroundings that it lies in.
fn add_where_near(sums: &mut [f64; 2], like: f64, other: &Event, this: &Event) {
    for (sum, near_s) in sums.iter_mut().zip(NEAR_S) {
        if (other.time_s - this.time_s).abs() <= near_s {
            *sum += like;
        }
    }
}

/// How many impacts of its own a ball puts among the neighbours of one between flights of this length, per unit of ln
/// loudness.
fn own(flight_s: f64, near_s: f64) -> f64 {
    let ratio: f64 = 0.9;
    let before = (1.0 + near_s * (1.0 / ratio - 1.0) / flight_s).ln() / -ratio.ln();
    let left = 1.0 - near_s * (1.0 - ratio) / (ratio * flight_s);
    let audible = (flight_s / super::SHORTEST_FLIGHT_S).ln() / -ratio.ln();
    let after = if left > 0.0 {
        (left.ln() / ratio.ln()).min(audible)
    } else {
        audible
    };
    LOUDNESS_OF_ANOTHER * (before + after)
}
