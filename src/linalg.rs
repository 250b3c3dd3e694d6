//! Products of vectors, and small symmetric positive definite systems.

/// `Σ aᵢ·bᵢ` over two sequences of one length, in sums that run side by side.
#[inline]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    const LANES: usize = 8;
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<LANES>(), b.as_chunks::<LANES>());
    let mut sums = [0.0; LANES];
    for (x, y) in a.iter().zip(b) {
        for (sum, (x, y)) in sums.iter_mut().zip(x.iter().zip(y)) {
            *sum += x * y;
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(x, y)| x * y).sum();
    sums.iter().sum::<f64>() + rest
}

/// A pivot of less than this share of its diagonal element is nothing but rounding: the matrix has no inverse.
const LEAST_PIVOT: f64 = 1e-14;

/// Cholesky's factors without square roots, `M = L·D·Lᵀ`, of the leading `size` rows and columns of a matrix.
///
/// L has a unit diagonal, D is diagonal and positive. Rows and columns may differ by orders of magnitude: scaling both alike
/// scales the factors and loses nothing (Golub and Van Loan, Matrix Computations, 4.1 and 4.2).
#[derive(Debug, Clone)]
pub(crate) struct Cholesky<const N: usize> {
    lower: [[f64; N]; N],
    pivots: [f64; N],
    size: usize,
}

impl<const N: usize> Cholesky<N> {
    /// The factors, from the lower triangle of a matrix; none where it is not positive definite.
    pub(crate) fn of(matrix: &[[f64; N]; N], size: usize) -> Option<Self> {
        let mut factors = Self {
            lower: [[0.0; N]; N],
            pivots: [0.0; N],
            size: size.min(N),
        };
        let mut reciprocals = [0.0; N];
        for (i, row) in matrix.iter().enumerate().take(factors.size) {
            let mut pivot = row[i];
            // The row of L·D, of which that of L follows.
            let mut scaled = [0.0; N];
            for (j, element) in row.iter().enumerate().take(i) {
                let known = scaled[..j].iter().zip(&factors.lower[j][..j]);
                let left = element - known.map(|(s, l)| s * l).sum::<f64>();
                scaled[j] = left;
                let factor = left * reciprocals[j];
                factors.lower[i][j] = factor;
                pivot -= factor * left;
            }
            if pivot.is_nan() || pivot <= LEAST_PIVOT * row[i] {
                return None;
            }
            factors.pivots[i] = pivot;
            reciprocals[i] = 1.0 / pivot;
        }
        Some(factors)
    }

    /// `L⁻¹·b`.
    fn forward(&self, right: &[f64; N]) -> [f64; N] {
        let mut y = *right;
        for i in 0..self.size {
            let known = self.lower[i][..i].iter().zip(&y[..i]);
            let known: f64 = known.map(|(l, y)| l * y).sum();
            y[i] -= known;
        }
        y
    }

    /// `M⁻¹·b`; what lies beyond the leading part stays as it is.
    pub(crate) fn solve(&self, right: &[f64; N]) -> [f64; N] {
        let mut x = self.forward(right);
        for i in (0..self.size).rev() {
            let known: f64 = (i + 1..self.size).map(|k| self.lower[k][i] * x[k]).sum();
            x[i] = x[i] / self.pivots[i] - known;
        }
        x
    }

    /// `bᵀ·M⁻¹·b`.
    pub(crate) fn quadratic(&self, right: &[f64; N]) -> f64 {
        let y = self.forward(right);
        let terms = y.iter().zip(&self.pivots).take(self.size);
        terms.map(|(y, d)| y * y / d).sum()
    }

    /// `M⁻¹`; zero beyond the leading part.
    pub(crate) fn inverse(&self) -> [[f64; N]; N] {
        let mut inverse = [[0.0; N]; N];
        for (i, row) in inverse.iter_mut().enumerate().take(self.size) {
            row[i] = 1.0;
            *row = self.solve(row);
        }
        inverse
    }

    /// `ln det M`.
    pub(crate) fn ln_determinant(&self) -> f64 {
        // The product of four variances neither overflows nor vanishes.
        let fours = self.pivots[..self.size].chunks(4);
        fours.map(|d| d.iter().product::<f64>().ln()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    const N: usize = 6;

    /// `A·Aᵀ` of a random A, rows and columns scaled by powers of ten.
    fn matrix() -> [[f64; N]; N] {
        let mut rng = SplitMix64::new(7);
        let a: [[f64; N]; N] = std::array::from_fn(|_| std::array::from_fn(|_| rng.normal()));
        let scale = |i: usize| 10_f64.powi(3 * i32::try_from(i).unwrap() - 6);
        std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let product: f64 = (0..N).map(|k| a[i][k] * a[j][k]).sum();
                product * scale(i) * scale(j)
            })
        })
    }

    #[test]
    fn a_solution_gives_the_right_side_back_in_the_leading_part() {
        let matrix = matrix();
        let right: [f64; N] = std::array::from_fn(|i| 1.0 + 2.0 * crate::units::real(i));
        for size in 1..=N {
            let factors = Cholesky::of(&matrix, size).unwrap();
            let x = factors.solve(&right);
            for i in 0..size {
                let back: f64 = (0..size).map(|j| matrix[i][j] * x[j]).sum();
                let size: f64 = (0..size).map(|j| (matrix[i][j] * x[j]).abs()).sum();
                assert!((back - right[i]).abs() < 1e-13 * size.max(1.0), "row {i}");
            }
            assert_eq!(x[size..], right[size..]);
            let quadratic: f64 = (0..size).map(|i| right[i] * x[i]).sum();
            assert!((factors.quadratic(&right) / quadratic - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn an_inverse_and_a_determinant_are_those_of_two_by_two() {
        let matrix = [[4.0, 1.0, 9.0], [1.0, 3.0, 9.0], [9.0, 9.0, 9.0]];
        let factors = Cholesky::of(&matrix, 2).unwrap();
        assert!((factors.ln_determinant() - 11_f64.ln()).abs() < 1e-15);
        let expected = [[3.0, -1.0], [-1.0, 4.0]];
        for (row, expected) in factors.inverse().iter().zip(expected) {
            for (x, e) in row.iter().zip(expected) {
                assert!((x - e / 11.0).abs() < 1e-15);
            }
            assert_eq!(row[2], 0.0);
        }
    }

    #[test]
    fn a_matrix_without_an_inverse_has_no_factors() {
        for matrix in [
            [[1.0, 2.0], [2.0, 4.0]],
            [[1.0, 2.0], [2.0, 3.0]],
            [[0.0, 0.0], [0.0, 1.0]],
            [[f64::NAN, 0.0], [0.0, 1.0]],
            [[f64::INFINITY, 0.0], [0.0, 1.0]],
        ] {
            assert!(Cholesky::of(&matrix, 2).is_none(), "{matrix:?}");
        }
    }
}
