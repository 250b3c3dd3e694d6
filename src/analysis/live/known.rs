//! What was measured before, so that each drop is measured and told once.

use crate::report::Drop;
use crate::sequence::Chain;
use crate::statistics::sorted;

/// Impacts of two searches are one if they are nearer than this share of the flight between them and the next. Derived: times
/// of one impact differ by some ms at most, in noise; of unlike drops one impact in five is so near to another by chance.
const SAME_SHARE: f64 = 0.1;
/// … or nearer than this, in seconds: the flights of what was found may be too long, where an impact was missed.
const SAME_S: f64 = 1e-3;

/// Times of impacts, ascending, in seconds.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Times(Vec<f64>);

impl Times {
    /// Those of a chain that were heard.
    pub(super) fn of_chain(chain: &Chain) -> Self {
        let heard = chain.impacts.iter().filter(|i| i.is_heard());
        Self(heard.map(|i| i.time_s).collect())
    }

    pub(super) fn of_drop(drop: &Drop) -> Self {
        Self(drop.impacts.iter().map(|i| i.time_s).collect())
    }

    pub(super) fn all_s(&self) -> &[f64] {
        &self.0
    }

    fn span_s(&self) -> (f64, f64) {
        let at = |time: Option<&f64>| time.copied().unwrap_or(f64::NAN);
        (at(self.0.first()), at(self.0.last()))
    }

    /// Whether both are of one drop: half of the impacts of the shorter are those of the other.
    pub(super) fn is_same(&self, other: &Self) -> bool {
        let common = self.0.iter().filter(|t| other.has(**t)).count();
        2 * common >= self.0.len().min(other.0.len())
    }

    fn has(&self, time_s: f64) -> bool {
        let after = self.0.partition_point(|t| *t < time_s);
        let flight_s = self.0[after.saturating_sub(1)..].windows(2).next();
        let share_s = flight_s.map_or(0.0, |ends| SAME_SHARE * (ends[1] - ends[0]));
        let near = |t: Option<&f64>| t.is_some_and(|t| (t - time_s).abs() < share_s.max(SAME_S));
        near(self.0.get(after)) || near(after.checked_sub(1).and_then(|before| self.0.get(before)))
    }
}

/// A chain that was measured.
#[derive(Debug)]
pub(super) struct Known {
    /// Its number and impacts as they were told; none for what turned out to be no drop.
    told: Option<(usize, Times)>,
    /// Its impacts as they were found last, and what all searches together spanned.
    seen: Times,
    span_s: (f64, f64),
}

impl Known {
    pub(super) fn new(seen: Times) -> Self {
        Self {
            told: None,
            span_s: seen.span_s(),
            seen,
        }
    }

    /// The number that it was told by.
    pub(super) fn number(&self) -> Option<usize> {
        self.told.as_ref().map(|(number, _)| *number)
    }

    pub(super) fn is_same(&self, times: &Times) -> bool {
        let told = self.told.as_ref();
        self.seen.is_same(times) || told.is_some_and(|(_, told)| told.is_same(times))
    }

    /// Whether there is more to a chain than was measured: it is another, or reaches further.
    pub(super) fn is_news(&self, times: &Times) -> bool {
        let (first_s, last_s) = times.span_s();
        let further = first_s < self.span_s.0 - SAME_S || last_s > self.span_s.1 + SAME_S;
        further || !self.is_same(times)
    }

    /// Whether these are more impacts than were told.
    pub(super) fn is_more(&self, times: &Times) -> bool {
        let told = self.told.as_ref();
        told.is_none_or(|(_, told)| times.0.len() > told.0.len())
    }

    pub(super) fn see(&mut self, times: &Times) {
        let (first_s, last_s) = times.span_s();
        self.span_s = (self.span_s.0.min(first_s), self.span_s.1.max(last_s));
        if times.0.len() > self.seen.0.len() {
            self.seen.clone_from(times);
        }
    }

    pub(super) fn tell(&mut self, number: usize, times: Times) {
        self.told = Some((number, times));
    }

    /// Whether it reaches into the sound from this time on.
    pub(super) fn ends_after(&self, time_s: f64) -> bool {
        self.span_s.1 > time_s
    }
}

/// Impacts of the drops that were told, ascending, but for those that are to be measured again.
pub(super) fn reported_s(known: &[Known], again: &[Times]) -> Vec<f64> {
    let kept = known.iter().filter(|k| !again.iter().any(|a| k.is_same(a)));
    let told = kept.filter_map(|k| k.told.as_ref());
    sorted(told.flat_map(|(_, times)| times.0.iter().copied()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Impacts from a time on, whose first flight and its ratio are these.
    fn times(first_s: f64, flight_s: f64, count: i32) -> Times {
        let at = |n: i32| first_s + flight_s * (1.0 - 0.8_f64.powi(n)) / 0.2;
        Times((0..count).map(at).collect())
    }

    #[test]
    fn a_drop_of_which_the_beginning_is_gone_or_more_was_heard_is_the_same() {
        let told = times(1.0, 0.5, 12);
        let late = Times(told.0[5..].iter().map(|t| t + 3e-3).collect());
        assert!(told.is_same(&late) && late.is_same(&told));
        assert!(told.is_same(&times(1.0, 0.5, 20)));
        for other in [times(6.0, 0.5, 12), times(1.13, 0.43, 12)] {
            assert!(!told.is_same(&other) && !other.is_same(&told), "{other:?}");
        }
    }

    #[test]
    fn only_what_reaches_further_is_news() {
        let mut known = Known::new(times(1.0, 0.5, 12));
        assert!(!known.is_news(&times(1.0, 0.5, 12)) && !known.is_news(&times(1.0, 0.5, 9)));
        assert!(known.is_news(&times(1.0, 0.5, 14)) && known.is_news(&times(9.0, 0.5, 9)));
        known.tell(1, times(1.0, 0.5, 12));
        known.see(&times(1.0, 0.5, 14));
        assert!(!known.is_news(&times(1.0, 0.5, 13)) && known.is_more(&times(1.0, 0.5, 14)));
    }
}
