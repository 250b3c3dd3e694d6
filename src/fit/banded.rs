//! Symmetric matrices with two diagonals beside the main one: what the noise of neighbouring bounces makes.

/// A symmetric matrix, given by its main diagonal and the two below it.
///
/// `first[j]` stands in row `j + 1` and column `j`, `second[j]` in row `j + 2` and column `j`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Banded {
    pub main: Vec<f64>,
    pub first: Vec<f64>,
    pub second: Vec<f64>,
}

/// `L·D·Lᵀ` of a positive definite banded matrix, L with a unit diagonal and two diagonals below it.
#[derive(Debug, Clone)]
pub(super) struct Factors {
    pivots: Vec<f64>,
    first: Vec<f64>,
    second: Vec<f64>,
}

impl Banded {
    /// Gaussian elimination in O(n); none if the matrix is not positive definite.
    pub(super) fn factors(&self) -> Option<Factors> {
        let n = self.main.len();
        let mut factors = Factors {
            pivots: Vec::with_capacity(n),
            first: Vec::with_capacity(n),
            second: Vec::with_capacity(n),
        };
        for i in 0..n {
            let (mut pivot, mut below) = (self.main[i], 0.0);
            let two = i.checked_sub(2).map_or(0.0, |j| {
                let l = self.second[j] / factors.pivots[j];
                pivot -= l * l * factors.pivots[j];
                below = l * factors.first[j] * factors.pivots[j];
                l
            });
            let one = i.checked_sub(1).map_or(0.0, |j| {
                let l = (self.first[j] - below) / factors.pivots[j];
                pivot -= l * l * factors.pivots[j];
                l
            });
            if !(pivot > 0.0 && pivot.is_finite()) {
                return None;
            }
            if i >= 2 {
                factors.second.push(two);
            }
            if i >= 1 {
                factors.first.push(one);
            }
            factors.pivots.push(pivot);
        }
        Some(factors)
    }
}

impl Factors {
    /// ln of the determinant.
    pub(super) fn ln_determinant(&self) -> f64 {
        self.pivots.iter().map(|d| d.ln()).sum()
    }

    /// `D^(−½)·L⁻¹·x`: values of unit variance, if x has the covariance that was factored.
    pub(super) fn whitened(&self, x: &[f64]) -> Vec<f64> {
        let mut y = self.forward(x);
        for (y, d) in y.iter_mut().zip(&self.pivots) {
            *y /= d.sqrt();
        }
        y
    }

    /// The inverse times x.
    pub(super) fn solve(&self, x: &[f64]) -> Vec<f64> {
        let mut y = self.forward(x);
        for (y, d) in y.iter_mut().zip(&self.pivots) {
            *y /= d;
        }
        for i in (0..y.len()).rev() {
            if i + 1 < y.len() {
                y[i] -= self.first[i] * y[i + 1];
            }
            if i + 2 < y.len() {
                y[i] -= self.second[i] * y[i + 2];
            }
        }
        y
    }

    fn forward(&self, x: &[f64]) -> Vec<f64> {
        let mut y = x.to_vec();
        for i in 1..y.len() {
            y[i] -= self.first[i - 1] * y[i - 1];
            if i >= 2 {
                y[i] -= self.second[i - 2] * y[i - 2];
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
            main: vec![4.0, 5.0, 6.0, 5.5, 4.5],
            first: vec![1.0, -0.5, 0.7, -1.1],
            second: vec![0.3, -0.2, 0.4],
        };
        let x = [1.0, -2.0, 0.5, 3.0, -1.0];
        let factors = matrix.factors().unwrap();
        let y = factors.solve(&x);
        for i in 0..5 {
            let mut back = matrix.main[i] * y[i];
            for (step, diagonal) in [(1, &matrix.first), (2, &matrix.second)] {
                if i >= step {
                    back += diagonal[i - step] * y[i - step];
                }
                if i + step < 5 {
                    back += diagonal[i] * y[i + step];
                }
            }
            assert!((back - x[i]).abs() < 1e-12, "row {i}: {back}");
        }
        let white: f64 = factors.whitened(&x).iter().map(|w| w * w).sum();
        let direct: f64 = x.iter().zip(&y).map(|(x, y)| x * y).sum();
        assert!((white - direct).abs() < 1e-12);
    }

    #[test]
    fn a_matrix_that_is_not_positive_has_no_factors() {
        let matrix = Banded {
            main: vec![1.0, 1.0],
            first: vec![2.0],
            second: vec![],
        };
        assert!(matrix.factors().is_none());
    }
}
