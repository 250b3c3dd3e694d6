//! How often chance offers an event as strong as this one and not much stronger: what a match is worth.

use super::Event;
use crate::units::real;

/// Length of the bins in which strengths are sorted, in seconds.
const BIN_S: f64 = 0.25;
/// Bins looked at on each side: surroundings of a second or two, in which a scene changes little.
const REACH: usize = 3;
/// What is stronger than an event by this factor is nothing that could be taken for it. Strengths of neighbouring impacts
/// spread by a factor of two; this is two such spreads.
const LOUDER: f64 = 4.0;
/// What the whole recording says of its events counts as much as this many seconds of surroundings.
const WHOLE_S: f64 = 2.0;
/// Events that noise may have offered had the recording been longer.
const UNSEEN: f64 = 0.5;
/// Knocks per second that happen where balls are dropped, whatever the noise: two a minute.
const KNOCKS_PER_S: f64 = 0.03;

/// The rate of events by strength, near each moment of a recording.
#[derive(Debug)]
pub struct Clutter {
    /// Strengths in each bin, ascending.
    bins: Vec<Vec<f64>>,
    /// All strengths, ascending.
    all: Vec<f64>,
    start_s: f64,
    duration_s: f64,
}

/// Events that are no clutter, because a chain explains them.
#[derive(Debug, Clone, Default)]
pub struct Associated {
    /// In order of time.
    events: Vec<Event>,
    /// Their strengths, ascending.
    strengths: Vec<f64>,
}

impl Associated {
    /// These events, in order of time.
    #[must_use]
    pub fn new(events: Vec<Event>) -> Self {
        let mut strengths: Vec<f64> = events.iter().map(|e| e.strength).collect();
        strengths.sort_by(f64::total_cmp);
        Self { events, strengths }
    }

    /// How many at least as strong as this lie in an interval of time.
    fn near(&self, strength: f64, from_s: f64, to_s: f64) -> usize {
        let first = self.events.partition_point(|e| e.time_s < from_s);
        let near = self.events[first..].iter();
        let near = near.take_while(|e| e.time_s < to_s);
        near.filter(|e| (strength..LOUDER * strength).contains(&e.strength))
            .count()
    }

    fn contains(&self, event: &Event) -> bool {
        let first = self.events.partition_point(|e| e.time_s < event.time_s);
        self.events[first..].starts_with(std::slice::from_ref(event))
    }
}

impl Clutter {
    /// Learns the rates from all events, which are in order of time.
    #[must_use]
    pub fn new(events: &[Event]) -> Self {
        let start_s = events.first().map_or(0.0, |e| e.time_s);
        let duration_s = events.last().map_or(0.0, |e| e.time_s) - start_s;
        let mut bins = vec![Vec::new(); bin_of(duration_s) + 1];
        for event in events {
            bins[bin_of(event.time_s - start_s)].push(event.strength);
        }
        let mut all: Vec<f64> = events.iter().map(|e| e.strength).collect();
        for strengths in bins.iter_mut().chain([&mut all]) {
            strengths.sort_by(f64::total_cmp);
        }
        Self {
            bins,
            all,
            start_s,
            duration_s,
        }
    }

    /// Seconds from the first event to the last, at least one.
    #[must_use]
    pub const fn duration_s(&self) -> f64 {
        self.duration_s.max(1.0)
    }

    /// Clutter per second as strong as this event or up to `LOUDER` times as strong, near its time; it does not count
    /// itself.
    ///
    /// # Formula
    /// ```text
    /// rate = (n + λ·W) / (t + W),   λ = (N + ½·min(1, exp(−(s − s_max)/θ))) / D + κ
    /// ```
    /// n in the t seconds around it, N in all D seconds of the recording, W = 2 s: the mean of a Poisson rate
    /// whose prior is what the whole recording says. What is stronger than all clutter (by s − `s_max`) noise offers
    /// the less often, as its tail falls with θ nats; what is left is κ, the rate of knocks.
    #[must_use]
    pub fn rate_per_s(&self, event: &Event, associated: &Associated) -> f64 {
        let strength = event.strength;
        let centre = bin_of(event.time_s - self.start_s);
        let (first, last) = (
            centre.saturating_sub(REACH),
            (centre + REACH).min(self.bins.len() - 1),
        );
        // An event that a chain owns does not count anyhow; any other is not its own clutter.
        let itself = usize::from(!associated.contains(event));
        let border_s = |bin: usize| self.start_s + real(bin) * BIN_S;
        let known_near = itself + associated.near(strength, border_s(first), border_s(last + 1));
        let known = itself + alike(&associated.strengths, strength);
        let all_near: usize = self.bins[first..=last]
            .iter()
            .map(|bin| alike(bin, strength))
            .sum();
        let near = real(all_near.saturating_sub(known_near));
        let unseen = UNSEEN
            * (-(strength - self.strongest(associated)).max(0.0) / self.tail(associated)).exp();
        let others = real(alike(&self.all, strength).saturating_sub(known));
        let whole = (others + unseen) / self.duration_s() + KNOCKS_PER_S;
        let span_s =
            ((real(last + 1) * BIN_S).min(self.duration_s) - real(first) * BIN_S).max(BIN_S);
        (near + whole * WHOLE_S) / (span_s + WHOLE_S)
    }

    /// Strength of the strongest clutter.
    fn strongest(&self, associated: &Associated) -> f64 {
        let pairs = self.all.iter().rev().zip(associated.strengths.iter().rev());
        let known = pairs.take_while(|(a, e)| a <= e).count();
        self.all
            .len()
            .checked_sub(known + 1)
            .map_or(0.0, |i| self.all[i])
    }

    /// θ of an exponential tail: between the 0.9 and the 0.99 quantile of the clutter it falls tenfold. The associated
    /// events are taken to be stronger than that.
    fn tail(&self, associated: &Associated) -> f64 {
        let last = self
            .all
            .len()
            .saturating_sub(associated.strengths.len() + 1);
        let at = |share: f64| {
            self.all
                .get(crate::units::whole(share * real(last)))
                .copied()
                .unwrap_or(0.0)
        };
        ((at(0.99) - at(0.9)) / std::f64::consts::LN_10).max(LEAST_TAIL)
    }
}

/// θ is not taken below this, in nats: where all clutter is alike, the next may still be stronger.
const LEAST_TAIL: f64 = 0.1;

/// How many of the ascending strengths are as strong as this, or up to [`LOUDER`] times as strong.
fn alike(strengths: &[f64], strength: f64) -> usize {
    let below = |limit: f64| strengths.partition_point(|&s| s < limit);
    below(LOUDER * strength) - below(strength)
}

fn bin_of(after_start_s: f64) -> usize {
    crate::units::whole((after_start_s / BIN_S).floor().max(0.0))
}

/// Rates of clutter at the events of a scene, each computed when it is first asked for: hypotheses meet at the same
/// events again and again.
#[derive(Debug)]
pub struct Rates<'a> {
    events: &'a [Event],
    clutter: &'a Clutter,
    associated: Associated,
    ln_per_s: Vec<Option<f64>>,
}

impl<'a> Rates<'a> {
    /// The rates at some events among clutter where some of them, indices in order, are associated and so no clutter.
    #[must_use]
    pub fn new(events: &'a [Event], clutter: &'a Clutter, associated: &[usize]) -> Self {
        Self {
            events,
            clutter,
            associated: Associated::new(associated.iter().map(|&i| events[i]).collect()),
            ln_per_s: vec![None; events.len()],
        }
    }

    /// ln of the rate of clutter at least as strong as this event, per second.
    pub(super) fn ln_per_s(&mut self, event: usize) -> f64 {
        *self.ln_per_s[event].get_or_insert_with(|| {
            self.clutter
                .rate_per_s(&self.events[event], &self.associated)
                .ln()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stronger_an_event_the_rarer_its_like() {
        let events: Vec<Event> = (0..1_000)
            .map(|i| Event {
                time_s: 0.02 * real(i),
                jitter_s: 1e-4,
                strength: if i % 100 == 0 { 50.0 } else { real(i % 10) },
                loudness: 0.0,
            })
            .collect();
        let clutter = Clutter::new(&events);
        let strong = clutter.rate_per_s(&events[500], &Associated::default());
        let faint = Event {
            time_s: 10.0,
            jitter_s: 1e-4,
            strength: 3.0,
            loudness: 0.0,
        };
        let weak = clutter.rate_per_s(&faint, &Associated::default());
        assert!((0.1..0.6).contains(&strong), "{strong}");
        assert!((weak - 35.0).abs() < 2.0, "{weak}");
        let own: Vec<Event> = events
            .iter()
            .copied()
            .filter(|e| e.strength > 40.0)
            .collect();
        let alone = clutter.rate_per_s(&events[500], &Associated::new(own));
        assert!(alone < 0.25 * strong, "{alone} {strong}");
    }

    #[test]
    fn knocks_much_louder_than_an_event_are_no_clutter_to_it() {
        let knocks = |strength: f64| -> f64 {
            let events = (0..400).map(|i| Event {
                time_s: 5e-3 * real(i),
                jitter_s: 1e-4,
                strength: if i == 200 { 100.0 } else { strength },
                loudness: 0.0,
            });
            let events: Vec<Event> = events.collect();
            Clutter::new(&events).rate_per_s(&events[200], &Associated::default())
        };
        let (alike, louder) = (knocks(0.9 * LOUDER * 100.0), knocks(1.1 * LOUDER * 100.0));
        assert!(louder < 0.01 * alike, "{louder} {alike}");
    }
}
