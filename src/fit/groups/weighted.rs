//! Means of groups and one slope, by weighted least squares.

use super::Member;
use crate::units::real;

/// Sums of one group under some weights.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sums {
    pub weight: f64,
    pub x: f64,
    pub y: f64,
}

/// A fit of a mean for each group and a slope for all.
#[derive(Debug, Clone)]
pub(super) struct Fit {
    pub sums: Vec<Sums>,
    pub slope: f64,
    /// Σw(x − x̄)² within groups; 0 where there is no slope.
    pub lever: f64,
    /// Σw·(value − fit)².
    pub square: f64,
}

impl Fit {
    pub(super) fn of(
        members: &[Member],
        count: usize,
        weights: &[f64],
        x0: f64,
        sloped: bool,
    ) -> Self {
        let x = |m: &Member| m.ln_speed.unwrap_or(x0) - x0;
        let of_group = |g: usize| {
            let own = || {
                members
                    .iter()
                    .zip(weights)
                    .filter(move |(m, _)| m.group == g)
            };
            let weight: f64 = own().map(|(_, w)| w).sum();
            let mean =
                |of: &dyn Fn(&Member) -> f64| own().map(|(m, w)| w * of(m)).sum::<f64>() / weight;
            Sums {
                weight,
                x: mean(&x),
                y: mean(&|m| m.value),
            }
        };
        let sums: Vec<Sums> = (0..count).map(of_group).collect();
        let off = |m: &Member| (x(m) - sums[m.group].x, m.value - sums[m.group].y);
        let (mut lever, mut product) = (0.0, 0.0);
        for (m, w) in members.iter().zip(weights).filter(|_| sloped) {
            let (x, y) = off(m);
            lever += w * x * x;
            product += w * x * y;
        }
        let slope = if lever > 0.0 { product / lever } else { 0.0 };
        let residual = |(m, w): (&Member, &f64)| {
            let (x, y) = off(m);
            w * (y - slope * x).powi(2)
        };
        let square = members.iter().zip(weights).map(residual).sum();
        Self {
            sums,
            slope,
            lever,
            square,
        }
    }

    /// τ², by what the residuals exceed their claimed errors.
    pub(super) fn between(&self, members: &[Member], weights: &[f64], freedom: usize) -> f64 {
        let total: f64 = weights.iter().sum();
        let squares = |g: usize| -> f64 {
            let own = members.iter().zip(weights).filter(|(m, _)| m.group == g);
            own.map(|(_, w)| w * w).sum()
        };
        let lost: f64 = self
            .sums
            .iter()
            .zip(0..)
            .map(|(s, g)| squares(g) / s.weight)
            .sum();
        ((self.square - real(freedom)) / (total - lost)).max(0.0)
    }
}
