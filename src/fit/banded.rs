//! Pentadiagonal symmetric matrices and their factors `L·D·Lᵀ`: the covariance of neighbouring bounces.

/// A symmetric matrix: in row i the elements of columns i, i − 1 and i − 2, 0 before the first column.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Banded {
    pub rows: Vec<[f64; 3]>,
}

/// `L·D·Lᵀ` of a positive definite banded matrix, L with a unit diagonal and two diagonals below it.
#[derive(Debug, Clone)]
pub(super) struct Factors {
    rows: Vec<Row>,
}

/// One row of the factors.
#[derive(Debug, Clone, Copy)]
struct Row {
    /// `1/D_i`.
    precision: f64,
    /// L in columns i − 1 and i − 2.
    one: f64,
    two: f64,
}

/// Pivots whose product is taken before its logarithm: the product of eight variances of ln e, from 10⁻¹⁵ to 1, does not
/// underflow.
const PIVOTS_AT_ONCE: usize = 8;

impl Factors {
    /// Gaussian elimination in O(n) of the matrix with these rows; none if it is not positive definite.
    pub(super) fn of(rows: impl ExactSizeIterator<Item = [f64; 3]>) -> Option<Self> {
        let mut factors = Vec::with_capacity(rows.len());
        let before_first = Row {
            precision: 0.0,
            one: 0.0,
            two: 0.0,
        };
        let (mut before, mut before_it) = (before_first, before_first);
        for [main, first, second] in rows {
            let below = first - second * before.one;
            let two = second * before_it.precision;
            let one = below * before.precision;
            let pivot = main - two * second - one * below;
            if !(pivot > 0.0 && pivot.is_finite()) {
                return None;
            }
            let row = Row {
                precision: 1.0 / pivot,
                one,
                two,
            };
            (before, before_it) = (row, before);
            factors.push(row);
        }
        Some(Self { rows: factors })
    }

    /// ln of the determinant.
    pub(super) fn ln_determinant(&self) -> f64 {
        let product = |rows: &[Row]| rows.iter().map(|r| r.precision).product::<f64>();
        let chunks = self.rows.chunks(PIVOTS_AT_ONCE);
        -chunks.map(|rows| product(rows).ln()).sum::<f64>()
    }

    /// `D⁻¹`: weights under which the rows of `L⁻¹·x` have unit variance, if x has the covariance that was factored.
    pub(super) fn precisions(&self) -> impl Iterator<Item = f64> + '_ {
        self.rows.iter().map(|r| r.precision)
    }

    /// `L⁻¹·X` of a matrix of N columns, row by row.
    pub(super) fn forward<const N: usize>(
        &self,
        rows: impl Iterator<Item = [f64; N]>,
    ) -> Vec<[f64; N]> {
        let (mut before, mut before_it) = ([0.0; N], [0.0; N]);
        let mut out = Vec::with_capacity(self.rows.len());
        for (row, x) in self.rows.iter().zip(rows) {
            let y = std::array::from_fn(|c| x[c] - row.one * before[c] - row.two * before_it[c]);
            (before, before_it) = (y, before);
            out.push(y);
        }
        out
    }

    /// The inverse times x.
    pub(super) fn solve(&self, x: &[f64]) -> Vec<f64> {
        let forward = self.forward(x.iter().map(|&x| [x]));
        let scaled = forward.iter().zip(self.precisions());
        let mut y: Vec<f64> = scaled.map(|([y], p)| y * p).collect();
        for i in (0..y.len()).rev() {
            if let Some(next) = self.rows.get(i + 1) {
                y[i] -= next.one * y[i + 1];
            }
            if let Some(next) = self.rows.get(i + 2) {
                y[i] -= next.two * y[i + 2];
            }
        }
        y
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_solution_solves_and_whitening_is_a_root_of_the_inverse() {
        let matrix = Banded {
            rows: vec![
                [4.0, 0.0, 0.0],
                [5.0, 1.0, 0.0],
                [6.0, -0.5, 0.3],
                [5.5, 0.7, -0.2],
                [4.5, -1.1, 0.4],
            ],
        };
        let x = [1.0, -2.0, 0.5, 3.0, -1.0];
        let factors = Factors::of(matrix.rows.iter().copied()).unwrap();
        let y = factors.solve(&x);
        for i in 0..5 {
            let mut back = matrix.rows[i][0] * y[i];
            for step in [1, 2] {
                if i >= step {
                    back += matrix.rows[i][step] * y[i - step];
                }
                if i + step < 5 {
                    back += matrix.rows[i + step][step] * y[i + step];
                }
            }
            assert!((back - x[i]).abs() < 1e-12, "row {i}: {back}");
        }
        let white = factors.forward(x.iter().map(|&x| [x]));
        let white = white.iter().zip(factors.precisions());
        let white: f64 = white.map(|([w], p)| p * w * w).sum();
        let direct: f64 = x.iter().zip(&y).map(|(x, y)| x * y).sum();
        assert!((white - direct).abs() < 1e-12);
    }

    #[test]
    fn a_matrix_that_is_not_positive_has_no_factors() {
        let matrix = Banded {
            rows: vec![[1.0, 0.0, 0.0], [1.0, 2.0, 0.0]],
        };
        assert!(Factors::of(matrix.rows.iter().copied()).is_none());
    }
}
