//! Following a drop from three of its impacts, forwards and backwards in time.

use super::clutter::{Clutter, Rates};
use super::extend::{Extension, Hypothesis, Way};
use super::flight::{Doubt, FlightLaw};
use super::marks::{LOUDNESS_AT_LARGE, ln_sounds};
use super::{Event, LONGEST_FLIGHT_S, SHORTEST_FLIGHT_S};

/// Everything that tracking looks at and does not change.
#[derive(Debug)]
pub struct Scene<'a> {
    /// The events in order of time.
    pub events: &'a [Event],
    clutter: &'a Clutter<'a>,
}

impl<'a> Scene<'a> {
    /// Events and the rates that were learnt from them.
    #[must_use]
    pub const fn new(events: &'a [Event], clutter: &'a Clutter<'a>) -> Self {
        Self { events, clutter }
    }

    /// The rates of clutter where none of the events is associated.
    #[must_use]
    pub fn rates(&self) -> Rates<'_> {
        self.rates_without(&[])
    }

    /// The rates of clutter where some events, indices in order, are associated and so no clutter.
    #[must_use]
    pub fn rates_without(&self, associated: &[usize]) -> Rates<'_> {
        Rates::new(self.clutter, associated)
    }

    /// The length of the recording in seconds, at least one.
    pub(super) const fn duration_s(&self) -> f64 {
        self.clutter.duration_s()
    }

    /// The greatest jitter of three events.
    pub(super) fn jitter_s(&self, events: [usize; 3]) -> f64 {
        events
            .iter()
            .map(|&i| self.events[i].jitter_s)
            .fold(0.0, f64::max)
    }

    /// Indices of the events in an interval of time.
    pub(super) fn between(&self, from_s: f64, to_s: f64) -> std::ops::Range<usize> {
        let first = self.events.partition_point(|e| e.time_s < from_s);
        let last = self.events.partition_point(|e| e.time_s <= to_s);
        first..last.max(first)
    }
}

/// How many events chance would offer in a flight.
pub(super) fn chance(ln_rate_per_s: f64, flight_s: f64) -> f64 {
    ln_rate_per_s.exp() * flight_s
}

/// One impact of a chain: an event, or a time at which one is inferred.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// The event; none where the impact is inferred.
    pub event: Option<usize>,
    /// Seconds from the first sample.
    pub time_s: f64,
    /// How far off that may be, in seconds; 0 where the impact is inferred.
    pub jitter_s: f64,
    /// Nats this step earned …
    pub gain: f64,
    /// … among clutter of this rate: ln of events per second; 0 where the impact is inferred.
    pub ln_rate: f64,
    /// How many events as strong chance would offer in its flight.
    pub chance: f64,
}

/// Extends three impacts both ways and gives the whole chain in order of time.
#[must_use]
pub fn follow(scene: &Scene<'_>, rates: &mut Rates<'_>, seed: [usize; 3]) -> Vec<Step> {
    let t = seed.map(|i| scene.events[i].time_s);
    let (first, second) = (t[1] - t[0], t[2] - t[1]);
    let mut law = FlightLaw::prior();
    let doubt = Doubt {
        unheard: 0,
        jitter_s: scene.jitter_s(seed),
    };
    let expected = law.expect(first, second, doubt);
    let ratio_density = expected.ln_density((second / first).ln() - expected.mean) - second.ln();
    law.learn(first, second, doubt);
    let sounds = |a: usize, b: usize| ln_sounds(&scene.events[a], &scene.events[b], second / first);
    // The first impact may be anywhere in the recording, the second anywhere within the longest flight.
    let ln_rates = seed.map(|i| rates.ln_per_s(i, second));
    let profiles = seed.map(|i| scene.events[i].profile);
    let gains = [
        -ln_rates[0] - scene.duration_s().ln() + LOUDNESS_AT_LARGE.ln(),
        -ln_rates[1] - (second * (LONGEST_FLIGHT_S / SHORTEST_FLIGHT_S).ln()).ln()
            + sounds(seed[0], seed[1]),
        ratio_density - ln_rates[2] + sounds(seed[1], seed[2]),
    ];
    let middle: Vec<Step> = (0..3)
        .map(|i| Step {
            event: Some(seed[i]),
            time_s: t[i],
            jitter_s: scene.events[seed[i]].jitter_s,
            gain: gains[i],
            ln_rate: ln_rates[i],
            chance: chance(ln_rates[i], second),
        })
        .collect();
    // The mean loudness is that of the second impact; the others differ from it as their speeds do.
    let loudness = seed.iter().map(|&i| scene.events[i].loudness).sum::<f64>() / 3.0;
    let slower = (second / first).ln();
    let start = Hypothesis {
        last: None,
        law,
        time_s: t[2],
        flight_s: second,
        doubt,
        loudness: loudness + slower,
        profile: profiles[2],
        score: 0.0,
    };
    let forward = Extension::new(scene, rates, Way::Forward).from(start);
    let mut law_back = law;
    let late: Vec<f64> = std::iter::once(t[2])
        .chain(forward.iter().map(|s| s.time_s))
        .collect();
    relearn(&mut law_back, second, &late, doubt);
    let start = Hypothesis {
        law: law_back.at_large(),
        time_s: t[0],
        flight_s: first,
        loudness: loudness - slower,
        profile: profiles[0],
        ..start
    };
    let backward = Extension::new(scene, rates, Way::Backward).from(start);
    let before = backward.into_iter().rev();
    before.chain(middle).chain(forward).collect()
}

/// The flights found forwards sharpen the law before it is used backwards.
fn relearn(law: &mut FlightLaw, mut flight_s: f64, times_s: &[f64], doubt: Doubt) {
    for pair in times_s.windows(2) {
        let next = pair[1] - pair[0];
        law.learn(flight_s, next, doubt);
        flight_s = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::event::Profile;
    use crate::units::real;

    /// What the fourth impact, or the first, of a dead ball earns that is louder than its speed makes it by so much.
    fn gain(louder: f64, other: usize) -> f64 {
        let (mut time_s, mut events) = (1.0, Vec::new());
        for n in 0..4 {
            let flight_s = 0.6 * 0.5_f64.powi(n);
            let speed = flight_s.ln();
            events.push(Event {
                time_s,
                jitter_s: 1e-4,
                strength: 50.0,
                loudness: 4.0 + speed,
                profile: Profile::default(),
            });
            time_s += flight_s;
        }
        events[other].loudness += louder;
        let clutter = Clutter::new(&events);
        let scene = Scene::new(&events, &clutter);
        let seed: Vec<usize> = (0..4).filter(|n| *n != other).collect();
        let steps = follow(&scene, &mut scene.rates(), [seed[0], seed[1], seed[2]]);
        let step = steps.iter().find(|step| step.event == Some(other)).unwrap();
        // What the loudness says alone: the rate at which others are as loud is left out.
        step.gain + step.ln_rate
    }

    #[test]
    fn the_impact_beside_the_first_three_is_as_loud_as_its_speed_makes_it() {
        for other in [0, 3] {
            let exact = gain(0.0, other);
            for louder in [-0.3, 0.3] {
                assert!(exact > gain(louder, other) + 0.1, "{other} by {louder}");
            }
            let lost = (gain(-0.3, other) - gain(0.3, other)).abs();
            assert!(lost < 1e-9 * real(10), "{other}: {lost}");
        }
    }
}
