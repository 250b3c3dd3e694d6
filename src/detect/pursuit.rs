//! Matching pursuit: match after match of a pattern, each taken out whole.

use super::matches::Matches;
use crate::signal::correlate::Correlator;
use crate::signal::interpolate::vertex;
use crate::units::{narrow, real};

/// The matches of a stretch of sound with the head of a pattern and with all of it, less the sounds found so far.
///
/// The head tells impacts apart whose rings overlap. The whole, up to where another impact may sound, says how much of it is there:
/// what has its head alone is none, and to take its ring out would add one, which would be found in turn without end.
pub(super) struct Residue {
    head: Matches,
    whole: Matches,
    /// 0 where a match may be taken, −∞ where one was.
    free: Vec<f32>,
    /// The best free match of each block.
    best: Vec<f32>,
    /// Samples of the head.
    reach: usize,
}

/// The size by the head may be so many times that by the whole. Taking a·s out changes the energy by a·(a − 2·b)·‖s‖², b being the
/// size by the whole, so up to 2 it falls; impacts that follow disturb b. Measured: 2 to 5 differ by single impacts.
const MOST_BY_HEAD: f64 = 3.0;
/// Length of the blocks whose best match is remembered.
const BLOCK: usize = 128;

impl Residue {
    /// Of a sound, which is silent after its end, and a pattern whose head is so many samples long, and that sounds alone for
    /// so many.
    pub(super) fn new(
        mut sound: Vec<f64>,
        pattern: &[f64],
        head: usize,
        alone: usize,
    ) -> Option<Self> {
        let count = sound.len().checked_sub(head)?;
        sound.resize(count + alone, 0.0);
        let mut correlator = Correlator::default();
        let mut matches = |part| Matches::of(&sound, pattern, part, count, &mut correlator);
        let mut residue = Self {
            head: matches(head)?,
            whole: matches(alone)?,
            free: vec![0.0; count],
            best: vec![0.0; count.div_ceil(BLOCK)],
            reach: head,
        };
        residue.look_again(0, count);
        Some(residue)
    }

    /// Finds the best match anew in the blocks that hold these samples.
    fn look_again(&mut self, from: usize, to: usize) {
        let blocks = from / BLOCK..to.div_ceil(BLOCK);
        let products = self.head.values.chunks(BLOCK).zip(self.free.chunks(BLOCK));
        let best = self.best.iter_mut().zip(products);
        for (best, (products, free)) in best.skip(blocks.start).take(blocks.len()) {
            *best = highest(products.iter().zip(free).map(|(p, f)| p + f));
        }
    }

    /// The first free match that is at least so great.
    fn first(&self, least: f32) -> Option<usize> {
        let start = BLOCK * self.best.iter().position(|&b| b >= least)?;
        (start..self.head.values.len()).find(|&i| self.match_at(i) >= least)
    }

    fn match_at(&self, index: usize) -> f32 {
        self.head.values[index] + self.free[index]
    }

    /// The free match, uphill from an index, that none within reach exceeds.
    fn summit(&self, mut index: usize, reach: usize) -> usize {
        loop {
            let mut near =
                index.saturating_sub(reach)..(index + reach + 1).min(self.head.values.len());
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
    /// side lobes overlap, which reach as far as the head, the highest of them is the sound. A weaker match may be noise, and its
    /// pattern would only be added.
    pub(super) fn matches(mut self, certain: f64, weakest: f64, apart: usize) -> Vec<(f64, f64)> {
        let mut found = Vec::new();
        while let Some(first) = self.first(narrow(certain)) {
            let best = self.summit(first, self.reach);
            let (position, z) = self.take(best, apart);
            found.push((position, f64::from(z)));
            self.take_out(best, position - real(best));
        }
        while let Some(best) = self.first(narrow(weakest)) {
            let best = self.summit(best, apart);
            let (position, z) = self.take(best, apart);
            found.push((position, f64::from(z)));
        }
        found
    }

    /// Takes a pattern out by the size of its head, or by that of the whole where the ring to the head is missing.
    fn take_out(&mut self, at: usize, later: f64) {
        let (by_head, by_whole) = (self.head.amplitude(at), self.whole.amplitude(at));
        let amplitude = if by_head < MOST_BY_HEAD * by_whole {
            by_head
        } else {
            by_whole
        };
        if amplitude > 0.0 {
            self.whole.take_out(at, later, amplitude);
            let (from, to) = self.head.take_out(at, later, amplitude);
            self.look_again(from, to);
        }
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
        let at = |k: usize| self.head.values.get(k).copied().map(f64::from);
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
