//! e against speed, pooled over the bounces of many drops: a smooth curve with a band.

use super::{Estimate, student};
use crate::linalg::Cholesky;
use crate::physics::priors::SPEED_EXPONENT_BEYOND;
use crate::statistics::bisected;
use crate::units::real;

/// Most coefficients: a cubic in ln v follows 1 − e ∝ v^(1/5) within 0.0003 from 0.1 to 5 m/s at e = 0.9.
const MOST: usize = 4;
/// Drops for each coefficient beyond the first: the band rests on how much the curve moves when one drop is left out.
const DROPS_EACH: usize = 2;
/// Fewest drops of a curve.
const FEWEST: usize = 3;
/// The scatter and the curve learn from each other until no scatter changes by more than this share of itself (convention).
const REST: f64 = 1e-3;
/// Rounds at most: a scatter near 0 halves for ever.
const LIMIT: usize = 50;
/// Greatest scatter of e from bounce to bounce that is looked for, and between drops.
const MOST_SCATTER: f64 = 0.5;

/// One bounce.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// Index of its drop.
    pub drop: usize,
    /// ln of the speed of arrival in m/s.
    pub ln_speed: f64,
    /// e.
    pub restitution: f64,
    /// Its standard error by the times.
    pub std: f64,
}

/// The curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Number of drops.
    pub drops: usize,
    /// Number of bounces.
    pub bounces: usize,
    /// The speeds between which three drops or more have bounces, in m/s.
    pub speeds_m_per_s: [f64; 2],
    /// Scatter of e from bounce to bounce of a drop, beside the errors of the times.
    pub bounce_std: f64,
    /// Scatter of whole drops about the curve, beside what their bounces claim.
    pub drop_std: f64,
    scale: Scale,
    size: usize,
    whole: [f64; MOST],
    /// The curve without each drop.
    without: Vec<[f64; MOST]>,
}

/// From ln v to −1 … 1.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Scale {
    middle: f64,
    reach: f64,
}

impl Scale {
    /// Powers of the scaled logarithm, by Chebyshev's polynomials.
    fn row(self, ln_speed: f64) -> [f64; MOST] {
        let x = (ln_speed - self.middle) / self.reach;
        [1.0, x, 2.0 * x * x - 1.0, (4.0 * x * x - 3.0) * x]
    }
}

/// The normal equations of a drop.
#[derive(Debug, Clone, Copy)]
struct Equations {
    matrix: [[f64; MOST]; MOST],
    right: [f64; MOST],
}

impl Curve {
    /// Of three drops or more.
    ///
    /// # Formula
    /// ```text
    /// e_ij = Σ_k β_k·T_k(x) + u_i + ε_ij,   x = ln v scaled to −1 … 1,   T_k of Chebyshev,   k = 0 … 3 at most
    /// var ε = σ² of the times + s²,   u_i ~ τ:   generalised least squares, s and τ by moments
    /// var f(v) = (N − 1)/N·Σ_i (f₋ᵢ(v) − mean)²,   t of N − 1 degrees of freedom      jackknife over the N drops
    /// ```
    /// What bounces of one drop have in common (its times, its height, its contact, its spot of the floor) needs no model so.
    #[must_use]
    pub fn of(points: &[Point]) -> Option<Self> {
        let usable = |p: &&Point| p.std.is_finite() && p.std > 0.0 && p.ln_speed.is_finite();
        let points: Vec<Point> = points.iter().filter(usable).copied().collect();
        let by_drop = by_drop(&points);
        if by_drop.len() < FEWEST {
            return None;
        }
        let (low, high) = shared(&by_drop);
        // Of three or four drops from unlike heights no speed may be common to three.
        if low > high {
            return None;
        }
        let scale = Scale {
            middle: 0.5 * (low + high),
            reach: (0.5 * (high - low)).max(1e-3),
        };
        let size = (1 + (by_drop.len() - 1) / DROPS_EACH).min(MOST);
        let mut scatter = Scatter::default();
        let mut whole = [0.0; MOST];
        for _ in 0..LIMIT {
            let equations: Vec<Equations> = by_drop
                .iter()
                .map(|d| scatter.equations(d, scale))
                .collect();
            whole = solved(&equations, None, size)?;
            let residual = |p: &Point| p.restitution - value(&whole, size, scale, p.ln_speed);
            let before = std::mem::replace(&mut scatter, Scatter::of(&by_drop, &residual, size));
            if scatter.is_as(before) {
                break;
            }
        }
        let equations: Vec<Equations> = by_drop
            .iter()
            .map(|d| scatter.equations(d, scale))
            .collect();
        let without = (0..by_drop.len()).map(|i| solved(&equations, Some(i), size));
        Some(Self {
            drops: by_drop.len(),
            bounces: points.len(),
            speeds_m_per_s: [low.exp(), high.exp()],
            bounce_std: scatter.bounce.sqrt(),
            drop_std: scatter.drop.sqrt(),
            scale,
            size,
            whole,
            without: without.collect::<Option<_>>()?,
        })
    }

    /// e at a speed, and whether that lies beyond those heard: then e is that of the nearest speed heard, with the error by the
    /// exponents of real balls.
    #[must_use]
    pub fn at(&self, speed_m_per_s: f64) -> (Estimate, bool) {
        let [low, high] = self.speeds_m_per_s;
        let within = speed_m_per_s.clamp(low, high);
        let beyond = (speed_m_per_s / within).ln().abs();
        let at =
            |coefficients: &[f64; MOST]| value(coefficients, self.size, self.scale, within.ln());
        let middle = at(&self.whole);
        let places: Vec<f64> = self.without.iter().map(at).collect();
        let count = real(places.len());
        let mean = places.iter().sum::<f64>() / count;
        let square: f64 = places.iter().map(|x| (x - mean).powi(2)).sum();
        let std = ((count - 1.0) / count * square).sqrt();
        let std = std.hypot(SPEED_EXPONENT_BEYOND * beyond * middle);
        let reach = student(0.975, count - 1.0) * std;
        let estimate = Estimate {
            value: middle,
            std_error: Some(std),
            interval95: Some([(middle - reach).max(0.0), (middle + reach).min(1.0)]),
        };
        (estimate, beyond > 1e-9)
    }
}

fn value(coefficients: &[f64; MOST], size: usize, scale: Scale, ln_speed: f64) -> f64 {
    let row = scale.row(ln_speed);
    (0..size).map(|k| coefficients[k] * row[k]).sum()
}

fn by_drop(points: &[Point]) -> Vec<Vec<Point>> {
    let most = points.iter().map(|p| p.drop + 1).max().unwrap_or(0);
    let mut drops = vec![Vec::new(); most];
    for point in points {
        drops[point.drop].push(*point);
    }
    drops.retain(|d| !d.is_empty());
    drops
}

/// ln of the speeds between which [`FEWEST`] drops have bounces.
fn shared(drops: &[Vec<Point>]) -> (f64, f64) {
    let end = |fold: fn(f64, f64) -> f64, from: f64| -> Vec<f64> {
        let of = |d: &Vec<Point>| d.iter().map(|p| p.ln_speed).fold(from, fold);
        let mut ends: Vec<f64> = drops.iter().map(of).collect();
        ends.sort_by(f64::total_cmp);
        ends
    };
    let (slowest, fastest) = (
        end(f64::min, f64::INFINITY),
        end(f64::max, f64::NEG_INFINITY),
    );
    (slowest[FEWEST - 1], fastest[drops.len() - FEWEST])
}

/// Variances beside those of the times.
#[derive(Debug, Clone, Copy, Default)]
struct Scatter {
    bounce: f64,
    drop: f64,
}

impl Scatter {
    /// By moments: within the drops, then of their means.
    fn of(drops: &[Vec<Point>], residual: &dyn Fn(&Point) -> f64, size: usize) -> Self {
        let points: usize = drops.iter().map(Vec::len).sum();
        let free = real(points.saturating_sub(drops.len() + size).max(1));
        let too_small = |variance: f64| {
            let square: f64 = drops.iter().map(|d| mean(d, variance, residual).2).sum();
            square > free
        };
        let bounce = if too_small(0.0) {
            bisected((0.0, MOST_SCATTER.powi(2)), 60, too_small)
        } else {
            0.0
        };
        let means: Vec<(f64, f64)> = drops
            .iter()
            .map(|d| {
                let (mean, weight, _) = mean(d, bounce, residual);
                (mean, 1.0 / weight)
            })
            .collect();
        let free = real(means.len().saturating_sub(size).max(1));
        let too_small = |variance: f64| {
            means
                .iter()
                .map(|(m, v)| m * m / (v + variance))
                .sum::<f64>()
                > free
        };
        let drop = if too_small(0.0) {
            bisected((0.0, MOST_SCATTER.powi(2)), 60, too_small)
        } else {
            0.0
        };
        Self { bounce, drop }
    }

    /// Whether neither part differs much from that of another.
    fn is_as(self, other: Self) -> bool {
        let near = |now: f64, then: f64| (now - then).abs() <= REST * now;
        near(self.bounce, other.bounce) && near(self.drop, other.drop)
    }

    /// The normal equations of a drop: of `Σ + τ²·11ᵀ` the inverse by Sherman and Morrison.
    fn equations(self, points: &[Point], scale: Scale) -> Equations {
        let (mut matrix, mut right) = ([[0.0; MOST]; MOST], [0.0; MOST]);
        let (mut rows, mut value, mut total) = ([0.0; MOST], 0.0, 0.0);
        for p in points {
            let row = scale.row(p.ln_speed);
            let weight = 1.0 / (p.std * p.std + self.bounce);
            total += weight;
            value += weight * p.restitution;
            for k in 0..MOST {
                rows[k] += weight * row[k];
                right[k] += weight * row[k] * p.restitution;
                for (m, r) in matrix[k].iter_mut().zip(&row) {
                    *m += weight * row[k] * r;
                }
            }
        }
        let shared = self.drop / (1.0 + self.drop * total);
        for k in 0..MOST {
            right[k] -= shared * rows[k] * value;
            for (m, r) in matrix[k].iter_mut().zip(&rows) {
                *m -= shared * rows[k] * r;
            }
        }
        Equations { matrix, right }
    }
}

/// Weighted mean of the residuals of a drop, its weight, and the weighted square about it.
fn mean(points: &[Point], variance: f64, residual: &dyn Fn(&Point) -> f64) -> (f64, f64, f64) {
    let weight = |p: &Point| 1.0 / (p.std * p.std + variance);
    let total: f64 = points.iter().map(weight).sum();
    let mean = points.iter().map(|p| weight(p) * residual(p)).sum::<f64>() / total;
    let square = points
        .iter()
        .map(|p| weight(p) * (residual(p) - mean).powi(2))
        .sum();
    (mean, total, square)
}

/// The coefficients by all drops, or all but one.
fn solved(equations: &[Equations], left_out: Option<usize>, size: usize) -> Option<[f64; MOST]> {
    let (mut matrix, mut right) = ([[0.0; MOST]; MOST], [0.0; MOST]);
    let used = equations
        .iter()
        .enumerate()
        .filter(|(i, _)| Some(*i) != left_out);
    for (_, one) in used {
        for k in 0..MOST {
            right[k] += one.right[k];
            for (m, o) in matrix[k].iter_mut().zip(&one.matrix[k]) {
                *m += o;
            }
        }
    }
    Some(Cholesky::of(&matrix, size)?.solve(&right))
}

#[cfg(test)]
mod tests;
