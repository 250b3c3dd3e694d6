//! How often chance offers an event as strong as this one: what a match is worth.

use super::Event;
use crate::units::real;

/// Length of the bins in which strengths are sorted, in seconds.
const BIN_S: f64 = 0.25;
/// Bins looked at on each side: surroundings of a second or two, in which a scene changes little.
const REACH: usize = 3;
/// Events that may have been missed by looking at so short a time.
const UNSEEN: f64 = 0.5;

/// The rate of events by strength, near each moment of a recording.
#[derive(Debug)]
pub struct Clutter {
    /// Strengths in each bin, ascending.
    bins: Vec<Vec<f64>>,
    start_s: f64,
    duration_s: f64,
}

impl Clutter {
        /// Learns the rates from the events, which are in order of time, that are not explained already.
    #[must_use]
    pub fn new(events: &[Event], explained: &[bool]) -> Self {
        let start_s = events.first().map_or(0.0, |e| e.time_s);
        let duration_s = events.last().map_or(0.0, |e| e.time_s) - start_s;
        let mut bins = vec![Vec::new(); bin_of(duration_s) + 1];
                for (event, _) in events.iter().zip(explained).filter(|(_, explained)| !**explained) {
            bins[bin_of(event.time_s - start_s)].push(event.strength);
        }
        for bin in &mut bins {
            bin.sort_by(f64::total_cmp);
        }
        Self {
            bins,
            start_s,
            duration_s,
        }
    }

    /// Seconds from the first event to the last, at least one.
    #[must_use]
    pub const fn duration_s(&self) -> f64 {
        self.duration_s.max(1.0)
    }

    /// Events per second at least as strong as this one of them, near its time; it does not count itself.
    #[must_use]
    pub fn rate_per_s(&self, event: &Event) -> f64 {
        let centre = bin_of(event.time_s - self.start_s);
        let (first, last) = (
            centre.saturating_sub(REACH),
            (centre + REACH).min(self.bins.len() - 1),
        );
        let count: usize = self.bins[first..=last]
            .iter()
            .map(|bin| bin.len() - bin.partition_point(|&s| s < event.strength))
            .sum();
        let span_s = (real(last + 1) * BIN_S).min(self.duration_s) - real(first) * BIN_S;
                (real(count.saturating_sub(1)) + UNSEEN) / span_s.max(BIN_S)
    }
}

fn bin_of(after_start_s: f64) -> usize {
    crate::units::samples_in((after_start_s / BIN_S).floor().max(0.0), 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stronger_an_event_the_rarer_its_like() {
        let events: Vec<Event> = (0..1_000)
            .map(|i| Event {
                time_s: 0.02 * real(i),
                strength: if i % 100 == 0 { 50.0 } else { real(i % 10) },
            })
            .collect();
        let clutter = Clutter::new(&events, &vec![false; events.len()]);
        let strong = clutter.rate_per_s(&events[500]);
        let weak = clutter.rate_per_s(&Event {
            time_s: 10.0,
            strength: 0.0,
        });
                assert!((0.2..0.6).contains(&strong), "{strong}");
        assert!((weak - 50.0).abs() < 2.0, "{weak}");
    }
}
