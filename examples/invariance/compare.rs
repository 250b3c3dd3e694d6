//! Two reports on the same sound: what differs.

use bounce_audio::report::Status;
use bounce_audio::{Analysis, Drop};

/// Two times are of one impact if they are no further apart, in seconds: impacts nearer than 4 ms are one sound.
const SAME_S: f64 = 2e-3;

/// What differs between the report on an original and that on a variant of it.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Difference {
    /// |Δe| over the standard error of the original's e, of each drop that is in both; infinite where e was lost.
    pub(crate) restitutions: Vec<f64>,
    /// Greatest |Δt| over the standard error of the original's time.
    pub(crate) time: f64,
    pub(crate) impacts_lost: usize,
    pub(crate) impacts_gained: usize,
    pub(crate) drops_lost: usize,
    pub(crate) drops_gained: usize,
}

impl Difference {
    /// The greatest difference of e.
    pub(crate) fn restitution(&self) -> f64 {
        self.restitutions.iter().copied().fold(0.0, f64::max)
    }

    /// Of two drops that are one: adds how they differ.
    fn add(&mut self, original: &Drop, other: &Drop, shift_s: f64) {
        let paired = pairs(&heard(original, 0.0), &heard(other, -shift_s));
        self.impacts_lost += paired.lost;
        self.impacts_gained += paired.gained;
        let off = paired.pairs.iter();
        let off = off.map(|((a, std_s), (b, _))| (a - b).abs() / std_s);
        self.time = off.fold(self.time, f64::max);
        let Some((e, std)) = restitution(original) else {
            return;
        };
        let off = restitution(other).map_or(f64::INFINITY, |(other, _)| (other - e).abs() / std);
        self.restitutions.push(off);
    }
}

/// How the report on a variant differs whose sounds are later by so many seconds.
pub(crate) fn difference<'a>(
    original: &Analysis,
    others: impl Iterator<Item = &'a Drop>,
    shift_s: f64,
) -> Difference {
    let mut left: Vec<&Drop> = others.collect();
    let mut difference = Difference::default();
    for drop in &original.drops {
        let times = heard(drop, 0.0);
        let shared = |other: &Drop| pairs(&times, &heard(other, -shift_s)).pairs.len();
        let best = (0..left.len()).max_by_key(|&i| shared(left[i]));
        match best.filter(|&i| 2 * shared(left[i]) >= times.len()) {
            Some(same) => difference.add(drop, left.remove(same), shift_s),
            None => difference.drops_lost += 1,
        }
    }
    difference.drops_gained = left.len();
    difference
}

/// A time and its standard error, in seconds.
type Timed = (f64, f64);

/// The impacts that were heard, later by so many seconds.
fn heard(drop: &Drop, later_s: f64) -> Vec<Timed> {
    let heard = drop.impacts.iter().filter(|i| i.status != Status::Inferred);
    heard
        .filter_map(|i| Some((i.time_s + later_s, i.time_std_s?)))
        .collect()
}

/// e and its standard error, where it has one.
fn restitution(drop: &Drop) -> Option<(f64, f64)> {
    let estimate = drop.restitution.as_ref()?.estimate;
    Some((estimate.value, estimate.std_error?))
}

/// Times of two reports, one to one.
#[derive(Debug, Default, PartialEq)]
struct Paired {
    pairs: Vec<(Timed, Timed)>,
    lost: usize,
    gained: usize,
}

/// Pairs times in order.
fn pairs(ours: &[Timed], others: &[Timed]) -> Paired {
    let mut paired = Paired::default();
    let (mut i, mut k) = (0, 0);
    while let (Some(&a), Some(&b)) = (ours.get(i), others.get(k)) {
        if (a.0 - b.0).abs() <= SAME_S {
            paired.pairs.push((a, b));
            (i, k) = (i + 1, k + 1);
        } else if a.0 < b.0 {
            i += 1;
        } else {
            k += 1;
        }
    }
    paired.lost = ours.len() - paired.pairs.len();
    paired.gained = others.len() - paired.pairs.len();
    paired
}
