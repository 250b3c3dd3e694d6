//! Evenly spaced places, and the hill of a function over them.

use crate::units::{real, whole};

/// Evenly spaced places.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid {
    pub from: f64,
    pub step: f64,
    pub count: usize,
}

/// The peak of a unimodal function and where it falls below `negligible`.
#[derive(Debug)]
pub(super) struct Hill<T> {
    /// Place, value, and what was found there.
    pub top: (f64, f64, T),
    /// Vertex of the parabola through the top and its neighbours; the top itself at an end of the grid.
    pub vertex: f64,
    pub lowest: f64,
    pub highest: f64,
}

impl Grid {
    pub(super) fn new(from: f64, to: f64, count: usize) -> Self {
        Self {
            from,
            step: (to - from) / real(count - 1),
            count,
        }
    }

    pub(super) fn at(&self, index: usize) -> f64 {
        self.from + real(index) * self.step
    }

    /// The peak of a unimodal function, and the range in which it is below it by no more than `negligible`.
    ///
    /// The function is evaluated from the place nearest to `start` both ways until it is below that range: the rest of the
    /// grid costs nothing.
    pub(super) fn hill<T>(
        &self,
        start: f64,
        negligible: f64,
        of: impl Fn(f64) -> Option<(f64, T)>,
    ) -> Option<Hill<T>> {
        let start = whole((start - self.from) / self.step);
        let start = start.min(self.count - 1);
        let mut top: Option<(f64, f64, T)> = None;
        let mut values = Vec::with_capacity(self.count);
        let mut falls = |index: usize| {
            let place = self.at(index);
            let found = of(place);
            let value = found.as_ref().map_or(f64::NEG_INFINITY, |f| f.0);
            values.push((place, value));
            let highest = top.as_ref().map_or(f64::NEG_INFINITY, |t| t.1);
            if let Some((value, found)) = found.filter(|f| f.0 > highest) {
                top = Some((place, value, found));
            }
            value < highest - negligible
        };
        let _ = (0..=start).rev().any(&mut falls);
        let _ = (start + 1..self.count).any(&mut falls);
        let top = top?;
        let beside = |step: f64| {
            let is_there = |v: &&(f64, f64)| (v.0 - top.0 - step).abs() < 0.5 * self.step;
            values.iter().find(is_there).map(|v| v.1)
        };
        let vertex = match (beside(-self.step), beside(self.step)) {
            (Some(left), Some(right)) if left.min(right) > f64::NEG_INFINITY => {
                let curvature = (left - top.1) + (right - top.1);
                let off = 0.5 * (left - right) / curvature.min(-f64::MIN_POSITIVE);
                top.0 + self.step * off.clamp(-0.5, 0.5)
            }
            _ => top.0,
        };
        let inside = values.iter().filter(|v| v.1 >= top.1 - negligible);
        let inside = inside.map(|v| v.0);
        Some(Hill {
            vertex,
            lowest: inside.clone().fold(f64::INFINITY, f64::min),
            highest: inside.fold(f64::NEG_INFINITY, f64::max),
            top,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hill_is_the_same_from_wherever_it_is_climbed() {
        let grid = Grid::new(-3.0, 7.0, 101);
        for start in [-3.0, 0.0, 2.1, 2.2, 5.0, 7.0] {
            let hill = grid.hill(start, 1.0, |x| Some((-(x - 2.13).powi(2), ())));
            let hill = hill.unwrap();
            let ends = [hill.top.0, hill.lowest, hill.highest];
            for (end, expected) in ends.into_iter().zip([2.1, 1.2, 3.1]) {
                assert!((end - expected).abs() < 1e-9, "from {start}: {ends:?}");
            }
        }
    }

    #[test]
    fn where_there_is_no_value_is_no_hill() {
        let grid = Grid::new(0.0, 1.0, 11);
        let right = grid.hill(0.1, 1.0, |x| (x > 0.45).then_some((-x, ())));
        assert!((right.unwrap().top.0 - 0.5).abs() < 1e-9);
        assert!(grid.hill(0.1, 1.0, |_| None::<(f64, ())>).is_none());
    }
}
