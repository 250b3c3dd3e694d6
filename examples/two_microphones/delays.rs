//! The times of one impact in two channels, and what is left of their difference without a common delay.

use bounce_audio::statistics::median;

/// The same impact is no further apart in two channels, in seconds: 3.4 m of way, and thuds that are timed late.
const FARTHEST_S: f64 = 10e-3;
/// A true onset belongs to a time of the first channel that is no further from it, in seconds.
const TRUE_S: f64 = 5e-3;

/// A time and its standard error, in seconds.
pub(crate) type Timed = (f64, f64);

/// One impact in both channels, in seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Both {
    /// When it was, in the first channel.
    pub(crate) time_s: f64,
    /// How much later it was in the second.
    pub(crate) later_s: f64,
    /// Standard error of that, by those stated of both.
    pub(crate) std_s: f64,
}

/// A delay that may drift: `later = at_mean + per_s·(t − mean)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Delay {
    pub(crate) at_mean_s: f64,
    pub(crate) per_s: f64,
    mean_s: f64,
}

/// The impacts that are in both channels: each time is the nearest one of the other.
pub(crate) fn both(first: &[Timed], second: &[Timed]) -> Vec<Both> {
    let pairs = first.iter().enumerate().filter_map(|(i, &(time_s, std))| {
        let (other_s, other_std) = second[nearest(second, time_s)?];
        let is_mutual = nearest(first, other_s) == Some(i);
        (is_mutual && (other_s - time_s).abs() <= FARTHEST_S).then(|| Both {
            time_s,
            later_s: other_s - time_s,
            std_s: std.hypot(other_std),
        })
    });
    pairs.collect()
}

/// The same without the true delays, of the impacts of which they are known; all of them where none is known.
pub(crate) fn without_true(both: &[Both], onsets_s: &[[f64; 2]]) -> Vec<Both> {
    if onsets_s.is_empty() {
        return both.to_vec();
    }
    let known = both.iter().filter_map(|pair| {
        let [first, second] = *onsets_s.iter().min_by(|a, b| {
            (a[0] - pair.time_s)
                .abs()
                .total_cmp(&(b[0] - pair.time_s).abs())
        })?;
        ((first - pair.time_s).abs() <= TRUE_S).then_some(Both {
            later_s: pair.later_s - (second - first),
            ..*pair
        })
    });
    known.collect()
}

fn nearest(times: &[Timed], to_s: f64) -> Option<usize> {
    let off = |i: &usize| (times[*i].0 - to_s).abs();
    (0..times.len()).min_by(|a, b| off(a).total_cmp(&off(b)))
}

impl Delay {
    /// The delay of some impacts: the median slope between any two of them (Theil and Sen), and the median of what that
    /// leaves. Stated errors have no say, which may be wrong; none of fewer than two impacts.
    pub(crate) fn of(both: &[Both]) -> Option<Self> {
        let slopes = both.iter().enumerate().flat_map(|(i, a)| {
            let later = both[i + 1..].iter();
            later.map(move |b| (b.later_s - a.later_s) / (b.time_s - a.time_s))
        });
        let per_s = median(slopes)?;
        let mean_s = median(both.iter().map(|b| b.time_s))?;
        let at_mean_s = median(both.iter().map(|b| b.later_s - per_s * (b.time_s - mean_s)))?;
        Some(Self {
            at_mean_s,
            per_s,
            mean_s,
        })
    }

    /// What it leaves of a difference, in seconds.
    pub(crate) fn rest_s(&self, both: &Both) -> f64 {
        both.later_s - self.at_mean_s - self.per_s * (both.time_s - self.mean_s)
    }
}
