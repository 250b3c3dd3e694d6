//! Pairs what was found with what is true: one to one, within 2 ms after one common offset.

use crate::statistics::median;

/// Farthest that a pair may be apart, in seconds.
pub const TOLERANCE_S: f64 = 2e-3;
/// Largest common offset that is looked for, in seconds: a sound is no later than that after the touch.
const LARGEST_OFFSET_S: f64 = 20e-3;

/// One pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Index in what was found.
    pub found: usize,
    /// Index in what is true.
    pub truth: usize,
    /// Found minus true minus the offset, in seconds.
    pub error_s: f64,
}

/// All pairs, in order of what is true.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Matching {
    /// What all found times have in common, in seconds: the median of found minus true.
    pub offset_s: f64,
    /// The pairs.
    pub pairs: Vec<Pair>,
}

/// Pairs found times with true ones, both ascending, under the offset that pairs most of them.
#[must_use]
pub fn pair(found_s: &[f64], truth_s: &[f64]) -> Matching {
    let mut best: Option<(usize, f64)> = None;
    for offset in offsets(found_s, truth_s) {
        let count = under(found_s, truth_s, offset).len();
        // The offset nearest to none, of those that pair as many.
        let better = best.is_none_or(|(most, other)| {
            count > most || (count == most && offset.abs() < other.abs())
        });
        if better {
            best = Some((count, offset));
        }
    }
    let Some((_, rough)) = best else {
        return Matching::default();
    };
    let offset_s = rough + middle(&under(found_s, truth_s, rough));
    let mut pairs = under(found_s, truth_s, offset_s);
    let rest = middle(&pairs);
    for p in &mut pairs {
        p.error_s -= rest;
    }
    Matching {
        offset_s: offset_s + rest,
        pairs,
    }
}

fn middle(pairs: &[Pair]) -> f64 {
    median(pairs.iter().map(|p| p.error_s)).unwrap_or(0.0)
}

/// Every small difference of a found and a true time.
fn offsets(found_s: &[f64], truth_s: &[f64]) -> Vec<f64> {
    let differences = found_s
        .iter()
        .flat_map(|f| truth_s.iter().map(move |t| f - t));
    differences
        .filter(|d| d.abs() <= LARGEST_OFFSET_S)
        .collect()
}

/// The nearest pairs first, each time once.
fn under(found_s: &[f64], truth_s: &[f64], offset_s: f64) -> Vec<Pair> {
    let mut near: Vec<Pair> = Vec::new();
    for (truth, &t) in truth_s.iter().enumerate() {
        let centre = t + offset_s;
        let start = found_s.partition_point(|f| *f < centre - TOLERANCE_S);
        for (k, &f) in found_s[start..].iter().enumerate() {
            if f > centre + TOLERANCE_S {
                break;
            }
            near.push(Pair {
                found: start + k,
                truth,
                error_s: f - centre,
            });
        }
    }
    near.sort_by(|a, b| a.error_s.abs().total_cmp(&b.error_s.abs()));
    let (mut found_taken, mut truth_taken) =
        (vec![false; found_s.len()], vec![false; truth_s.len()]);
    near.retain(|p| {
        let free = !found_taken[p.found] && !truth_taken[p.truth];
        if free {
            (found_taken[p.found], truth_taken[p.truth]) = (true, true);
        }
        free
    });
    near.sort_by_key(|p| p.truth);
    near
}
