//! Sounds before a drop that are as loud as its first impacts and like them: the ball's earlier impacts, or knocks.

use crate::event::Event;
use crate::report::{Warning, WarningCode};
use crate::sequence::Chain;
use crate::units::real;

/// Longest time from such a sound to the first impact, in seconds: the longest flight that is followed.
const WITHIN_S: f64 = 4.0;
/// The last of them is at most so many first flights before the first impact. Derived: the flight of a ball that keeps a fifth
/// of its speed, the least that is measured.
const LONGEST_FLIGHTS: f64 = 5.0;
/// Impacts at the start of a drop that its sound is known by: later ones are fainter, and their profiles worse known. With the
/// fewest impacts of a drop, all. Convention.
const KNOWN_BY: usize = 4;
/// An impact is its nearest event within this time, in seconds: a few hops of the detector's grid.
const SAME_S: f64 = 2e-3;
/// What follows a louder onset within this time, in seconds, is its echo or its ring: 17 m to a wall.
const OWN_S: f64 = 0.1;
/// Before a louder one within this time, in seconds, an onset is the beginning of the same sound.
const EARLY_S: f64 = 0.02;

/// The warning that a drop may have begun earlier, if sounds say so.
///
/// They lie after `from_s`, up to which other drops explain what is heard, and at least the first flight before the first
/// impact, as every flight is longer than the next; nearer ones are the release.
pub(super) fn warning(chain: &Chain, events: &[Event], from_s: f64) -> Option<Warning> {
    let heard = chain.impacts.iter().filter(|i| i.is_heard());
    let first_impacts = heard.take(KNOWN_BY).map(|i| event_at(events, i.time_s));
    let first_impacts: Vec<&Event> = first_impacts.collect::<Option<_>>()?;
    let [first, second, ..] = first_impacts.as_slice() else {
        return None;
    };
    let flight_s = second.time_s - first.time_s;
    let known = Known::by(&first_impacts);
    let from_s = (from_s + OWN_S).max(first.time_s - WITHIN_S);
    let before = between(events, from_s, first.time_s - flight_s).iter();
    let louder: Vec<&Event> = before
        .filter(|e| known.may_be(e) && is_of_its_own(e, events))
        .collect();
    let (at_s, last_s) = (louder.first()?.time_s, louder.last()?.time_s);
    let start_s = 0.5 * (last_s + first.time_s);
    let message = message(louder.len(), at_s, start_s);
    (first.time_s - last_s <= LONGEST_FLIGHTS * flight_s)
        .then(|| Warning::new(WarningCode::LouderBefore, message))
}

fn message(count: usize, at_s: f64, start_s: f64) -> String {
    let sounds = if count == 1 {
        format!(
            "a sound as loud as the first impacts and like them stands before this drop, at {at_s:.3} s"
        )
    } else {
        format!(
            "{count} sounds as loud as the first impacts and like them stand before this drop, the first at {at_s:.3} s"
        )
    };
    format!(
        "{sounds}: the drop may have begun there, or something else struck. If it was the ball, give its impacts as \
         labels; if not, listen from {start_s:.2} s on"
    )
}

/// How the first impacts of a drop sound.
#[derive(Debug)]
struct Known<'a> {
    impacts: &'a [&'a Event],
    /// Their mean loudness: single ones scatter by a factor of 1.4.
    loudness: f64,
    /// The greatest unlikeness of neighbours.
    most_unlike: f64,
}

impl<'a> Known<'a> {
    fn by(impacts: &'a [&'a Event]) -> Self {
        let neighbours = impacts.windows(2);
        let unlike = neighbours.map(|pair| pair[0].profile.unlikeness(&pair[1].profile));
        Self {
            impacts,
            loudness: impacts.iter().map(|e| e.loudness).sum::<f64>() / real(impacts.len()),
            most_unlike: unlike.fold(0.0, f64::max),
        }
    }

    /// Whether an event is as loud as they are, and as like one of them as they are alike.
    fn may_be(&self, event: &Event) -> bool {
        let is_like = |i: &&Event| i.profile.unlikeness(&event.profile) <= self.most_unlike;
        event.loudness >= self.loudness && self.impacts.iter().any(is_like)
    }
}

/// Whether an onset is neither the beginning of a louder sound nor its echo or ring.
fn is_of_its_own(event: &Event, events: &[Event]) -> bool {
    let near = between(events, event.time_s - OWN_S, event.time_s + EARLY_S);
    near.iter().all(|other| other.loudness <= event.loudness)
}

/// The event nearest to a time.
fn event_at(events: &[Event], time_s: f64) -> Option<&Event> {
    let off = |e: &&Event| (e.time_s - time_s).abs();
    let near = between(events, time_s - SAME_S, time_s + SAME_S).iter();
    near.min_by(|a, b| off(a).total_cmp(&off(b)))
}

fn between(events: &[Event], from_s: f64, to_s: f64) -> &[Event] {
    let at = |time_s: f64| events.partition_point(|e| e.time_s < time_s);
    &events[at(from_s)..at(to_s).max(at(from_s))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::event::Profile;
    use crate::impact::Impact;

    /// First impact of the drop, and its flights.
    const FIRST_S: f64 = 5.0;
    const FLIGHTS_S: [f64; 4] = [0.5, 0.4, 0.32, 0.256];

    /// A sound whose lowest band is so much weaker than its highest.
    fn sound(time_s: f64, loudness: f64, lowest: f32) -> Event {
        Event {
            time_s,
            jitter_s: 1e-4,
            strength: loudness.exp(),
            loudness,
            profile: Profile::new([1.0, lowest].into_iter()),
        }
    }

    /// What is said of a drop among other sounds, of which drops explain those up to `from_s`.
    fn said(others: &[Event], from_s: f64) -> Option<String> {
        let mut time_s = FIRST_S;
        let mut events = vec![sound(time_s, 5.0, 0.30)];
        for (i, flight_s) in FLIGHTS_S.into_iter().enumerate() {
            time_s += flight_s;
            events.push(sound(time_s, 4.8 - 0.2 * real(i), 0.25));
        }
        let impacts = events.iter().map(|e| Impact::heard(e.time_s, 1e-4));
        let chain = Chain {
            impacts: impacts.collect(),
            rejected: Vec::new(),
        };
        events.extend(others);
        events.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
        warning(&chain, &events, from_s).map(|w| w.message)
    }

    fn is_said(other: Event) -> bool {
        said(&[other], f64::NEG_INFINITY).is_some()
    }

    #[test]
    fn the_first_of_the_sounds_like_the_impacts_is_named_and_they_are_counted() {
        let others = [sound(3.593, 5.2, 0.30), sound(4.375, 5.1, 0.28)];
        let said = said(&others, f64::NEG_INFINITY).unwrap();
        assert!(
            said.starts_with("2 sounds") && said.contains("the first at 3.593 s"),
            "{said}"
        );
        assert!(
            said.contains("as labels") && said.contains("from 4.69 s on"),
            "{said}"
        );
    }

    #[test]
    fn softer_sounds_and_sounds_of_another_kind_are_not_named() {
        assert!(is_said(sound(4.375, 5.1, 0.28)));
        assert!(!is_said(sound(4.375, 4.2, 0.28)));
        assert!(!is_said(sound(4.375, 5.1, 2.0)));
    }

    #[test]
    fn sounds_nearer_than_the_first_flight_or_farther_than_any_are_not_named() {
        assert!(!is_said(sound(4.6, 5.1, 0.28)));
        assert!(is_said(sound(2.6, 5.1, 0.28)));
        assert!(!is_said(sound(2.4, 5.1, 0.28)));
    }

    #[test]
    fn what_another_drop_explains_is_not_named_nor_its_echo() {
        let other = [sound(4.375, 5.1, 0.28)];
        assert!(said(&other, 4.0).is_some());
        assert!(said(&other, 4.3).is_none());
    }

    #[test]
    fn the_echo_and_the_beginning_of_a_louder_sound_are_not_named() {
        let knock = sound(4.3, 6.0, 2.0);
        assert!(said(&[knock, sound(4.36, 5.1, 0.28)], 0.0).is_none());
        assert!(said(&[knock, sound(4.29, 5.1, 0.28)], 0.0).is_none());
        assert!(said(&[knock, sound(4.42, 5.1, 0.28)], 0.0).is_some());
    }
}
