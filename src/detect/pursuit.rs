//! Matching pursuit: the best match of a pattern, taken out whole, and the next best in what is left.

use crate::linalg::dot;
use crate::signal::correlate::correlate;
use crate::signal::interpolate::{shifted, vertex};
use crate::units::{narrow, real, whole};

/// A sound that is sought, of which only the first samples are matched.
#[derive(Debug, Clone)]
pub(super) struct Pattern {
    /// All of it, which is taken out.
    pub shape: Vec<f64>,
    /// Samples that are matched.
    pub matched: usize,
}

impl Pattern {
    /// The match of the whole pattern with its matched part, from the lag `1 − matched` on.
    fn own_match(&self) -> Option<Vec<f64>> {
        let mut padded = vec![0.0; self.matched - 1];
        padded.extend(&self.shape);
        padded.resize(padded.len() + self.matched, 0.0);
        let mut own = correlate(&padded, &self.shape[..self.matched])?;
        own.truncate(self.shape.len() + self.matched - 1);
        Some(own)
    }
}

/// The match of a stretch of sound with the pattern at every sample, less the sounds found so far.
///
/// Sounds are taken out of the match and not of the sound: taking `a·s` out at p changes the match at k by
/// `a·R(k − p)`, where R is the match of the pattern with itself. All in standard deviations of the noise: an `f32` holds
/// the loudest impact to a hundredth of one.
pub(super) struct Residue {
    products: Vec<f32>,
    /// 0 where a match may be taken out, −∞ where one was.
    free: Vec<f32>,
    /// The best free match of each block.
    best: Vec<f32>,
    own: OwnMatch,
}

/// Length of the blocks whose best match is remembered.
const BLOCK: usize = 128;

impl Residue {
    pub(super) fn new(sound: &[f64], pattern: &Pattern) -> Option<Self> {
        let count = sound.len().checked_sub(pattern.matched)?;
        let shape = &pattern.shape[..pattern.matched];
        let scale = 1.0 / dot(shape, shape).sqrt();
        let products = correlate(sound, shape)?;
        let mut residue = Self {
            products: products[..count]
                .iter()
                .map(|p| narrow(scale * p))
                .collect(),
            free: vec![0.0; count],
            best: vec![0.0; count.div_ceil(BLOCK)],
            own: OwnMatch::of(pattern)?,
        };
        residue.look_again(0, count);
        Some(residue)
    }

    /// Finds the best match anew in the blocks that hold these samples.
    fn look_again(&mut self, from: usize, to: usize) {
        let blocks = from / BLOCK..to.div_ceil(BLOCK);
        let products = self.products.chunks(BLOCK).zip(self.free.chunks(BLOCK));
        let best = self.best.iter_mut().zip(products);
        for (best, (products, free)) in best.skip(blocks.start).take(blocks.len()) {
            *best = highest(products.iter().zip(free).map(|(p, f)| p + f));
        }
    }

    /// The first free match that is at least so great.
    fn first(&self, least: f32) -> Option<usize> {
        let start = BLOCK * self.best.iter().position(|&b| b >= least)?;
        (start..self.products.len()).find(|&i| self.match_at(i) >= least)
    }

    fn match_at(&self, index: usize) -> f32 {
        self.products[index] + self.free[index]
    }

    /// The free match, uphill from an index, that none within reach exceeds.
    fn summit(&self, mut index: usize, reach: usize) -> usize {
        loop {
            let mut near =
                index.saturating_sub(reach)..(index + reach + 1).min(self.products.len());
            let height = highest(near.clone().map(|i| self.match_at(i)));
            if self.match_at(index) >= height {
                return index;
            }
            index = near.find(|&i| self.match_at(i) >= height).unwrap_or(index);
        }
    }

    /// Takes match after match, and each of the size `certain` out of the rest; gives their positions and sizes in standard
    /// deviations.
    ///
    /// What is certain goes first and in order of time, so that the ring of one sound is out of the way of the next; where
    /// side lobes overlap the highest of them is the sound. A weaker match may be noise, and its pattern would only be added.
    pub(super) fn take_out(mut self, certain: f64, weakest: f64, apart: usize) -> Vec<(f64, f64)> {
        let mut found = Vec::new();
        // Side lobes reach as far as the matched part.
        let reach = self.own.centre;
        while let Some(first) = self.first(narrow(certain)) {
            let best = self.summit(first, reach);
            let (position, z) = self.take(best, apart);
            found.push((position, f64::from(z)));
            let (from, to) = self
                .own
                .subtract(&mut self.products, best, position - real(best), z);
            self.look_again(from, to);
        }
        while let Some(best) = self.first(narrow(weakest)) {
            let best = self.summit(best, apart);
            let (position, z) = self.take(best, apart);
            found.push((position, f64::from(z)));
        }
        found
    }

    /// The position of a match and its size; none is free beside it any more.
    fn take(&mut self, best: usize, apart: usize) -> (f64, f32) {
        let (beside, z) = (self.vertex(best), self.match_at(best));
        let (from, to) = (best.saturating_sub(apart), best + apart + 1);
        let to = to.min(self.free.len());
        self.free[from..to].fill(f32::NEG_INFINITY);
        self.look_again(from, to);
        (real(best) + beside, z)
    }

    /// Vertex of the parabola through three products, from the middle one.
    fn vertex(&self, k: usize) -> f64 {
        let at = |k: usize| self.products.get(k).copied().map(f64::from);
        let (Some(left), Some(middle), Some(right)) =
            (k.checked_sub(1).and_then(at), at(k), at(k + 1))
        else {
            return 0.0;
        };
        vertex([left, middle, right]).map_or(0.0, |x| x.clamp(-0.5, 0.5))
    }
}

/// The highest of some values, in lanes for the machine's vectors; −∞ of none.
fn highest(values: impl ExactSizeIterator<Item = f32>) -> f32 {
    values.fold(f32::NEG_INFINITY, |a, b| if b > a { b } else { a })
}

/// The match of the pattern with itself, R over R(0), between samples too.
struct OwnMatch {
    /// R from a little more than ½ a sample earlier to as much later, in [`STEPS`] to a sample; all from one lag on.
    phases: Vec<Vec<f32>>,
    /// The index of lag 0.
    centre: usize,
}

/// Steps between two samples at which R is known. Between them a parabola is laid through three, which is wrong by at
/// most (π/16)³/16 = 0.05 % where R changes as fast as it can: the vertex of the match is farther off.
const STEPS: usize = 16;

impl OwnMatch {
    fn of(pattern: &Pattern) -> Option<Self> {
        let own = pattern.own_match()?;
        let scale = 1.0 / own.get(pattern.matched - 1)?;
        let phase = |step: usize| {
            let later = (real(step) - 1.0) / real(STEPS) - 0.5;
            let moved = shifted(&own, -1.0 - later, own.len() + 2);
            moved.into_iter().map(|r| narrow(scale * r)).collect()
        };
        Some(Self {
            phases: (0..STEPS + 3).map(phase).collect(),
            // The first value of `own` belongs to a lag of 1 − matched, and one stands before it.
            centre: pattern.matched,
        })
    }

    /// Takes `z·R` out at an index and `later` in (−½, ½) of a sample; gives the range that changed.
    fn subtract(&self, products: &mut [f32], at: usize, later: f64, z: f32) -> (usize, usize) {
        let place = (later + 0.5) * real(STEPS);
        let nearest = whole(place).min(STEPS);
        let off = narrow(place - real(nearest));
        let weights = [
            0.5 * z * off * (off - 1.0),
            z * (1.0 - off * off),
            0.5 * z * off * (off + 1.0),
        ];
        let skip = self.centre.saturating_sub(at);
        let from = at.saturating_sub(self.centre);
        let [a, b, c] = [0, 1, 2].map(|beside| &self.phases[nearest + beside][skip..]);
        let end = (from + a.len()).min(products.len());
        for (((product, a), b), c) in products[from..end].iter_mut().zip(a).zip(b).zip(c) {
            *product -= weights[0] * a + weights[1] * b + weights[2] * c;
        }
        (from, end)
    }
}
