//! The posterior of ln e, the sizes of the noises integrated out.

use statrs::distribution::{ContinuousCDF, Normal};

use super::bounces::Bounces;
use super::least_squares::{Prior, Solution, solve};
use super::noise::{Noise, Sizes};
use crate::physics::priors::BOUNCE_STD;
use crate::statistics::bisected;
use crate::units::real;

/// Steps over the range of `σ_e` in the search for its likelihood: a factor of four each, twice narrowed.
const COARSE: usize = 10;
const NARROWINGS: usize = 2;
/// Steps over the part that matters: greatest length in `ln σ_e`, and least number.
const FINE_STEP: f64 = 0.5;
const FEWEST_STEPS: usize = 9;
/// Values this many nats below the best are left out.
const NEGLIGIBLE: f64 = 12.0;
/// Prior standard deviation of ln φ: the stated errors of the times are right within a quarter.
const TIMING_SCALE_STD: f64 = 0.25;
/// Nodes and weights of Gauss and Hermite's rule for a standard normal variable: ±√3 and 0.
const HERMITE: [(f64, f64); 3] = [
    (-1.732_050_807_568_877_2, 1.0 / 6.0),
    (0.0, 2.0 / 3.0),
    (1.732_050_807_568_877_2, 1.0 / 6.0),
];
/// ln φ either side of 0 at which its likelihood is evaluated beforehand.
const LOOK: f64 = 0.15;

/// Mixture of the solutions at all sizes of the noises, each by its share of the evidence.
#[derive(Debug)]
pub(super) struct Posterior {
    parts: Vec<(f64, Sizes, Solution)>,
    /// The least value of each parameter.
    least: Vec<f64>,
    /// ln of the evidence for the model.
    pub ln_evidence: f64,
}

impl Posterior {
    /// Integrates over both sizes. None if no size of the noises has a solution.
    ///
    /// # Formula
    /// ```text
    /// p(θ) ∝ ∬ L(σ_e, φ)·N(θ; θ̂, V)·p(σ_e)·p(φ) dσ_e dφ,   p(ln σ_e) ∝ √(Σ (σ_e²/(σ_e² + λᵢ))²)
    /// ```
    /// Jeffreys' prior: where the bounces' own noise is seen, `σ_e` is a scale; where the times hide it, small values count
    /// less, as data that cannot show it are no evidence that it is 0 ([`Noise::information`]).
    /// Over `ln σ_e` by the trapezoidal rule, over ln φ by Gauss and Hermite's, laid where the posterior of φ is.
    pub(super) fn over_noise(bounces: &Bounces, noise: &Noise, priors: &[Prior]) -> Option<Self> {
        let at = |ln_bounce: f64, timing: f64| {
            let sizes = Sizes {
                bounce: ln_bounce.exp(),
                timing,
            };
            let solution = solve(bounces, noise, sizes, priors)?;
            let prior = 0.5 * noise.information(sizes)?.ln();
            Some((solution.ln_likelihood + prior, sizes, solution))
        };
        let (range, top) = range(|ln_bounce| Some((at(ln_bounce, 1.0)?.0, ())))?;
        let (centre, width) = timing_scale(|ln_timing| Some(at(top, ln_timing.exp())?.0))?;
        let mut parts: Vec<(f64, Sizes, Solution)> =
            Vec::with_capacity(range.count * HERMITE.len());
        for k in 0..range.count {
            let end = k == 0 || k + 1 == range.count;
            for (node, weight) in HERMITE {
                let ln_timing = centre + width * node;
                // The prior over the normal distribution that the rule is for.
                let prior = 0.5 * (node * node - (ln_timing / TIMING_SCALE_STD).powi(2));
                let share = weight * width / TIMING_SCALE_STD * if end { 0.5 } else { 1.0 };
                let part = at(range.at(k), ln_timing.exp());
                parts.extend(part.map(|(ln, sizes, s)| (ln + prior + share.ln(), sizes, s)));
            }
        }
        let best = parts.iter().map(|p| p.0).fold(f64::NEG_INFINITY, f64::max);
        let mut total = 0.0;
        for (weight, ..) in &mut parts {
            *weight = (*weight - best).exp();
            total += *weight;
        }
        for (weight, _, solution) in &mut parts {
            *weight /= total;
            solution.keep_above_least(priors);
        }
        (total > 0.0).then(|| Self {
            parts,
            least: priors.iter().map(|p| p.least).collect(),
            ln_evidence: best + (total * range.step).ln(),
        })
    }

    /// Mean and standard deviation of a parameter, θ being number 0.
    pub(super) fn moments(&self, parameter: usize) -> (f64, f64) {
        let mean = self.mean_of(|_, s| s.values[parameter]);
        let variance = self.mean_of(|_, s| {
            s.covariance[parameter][parameter] + (s.values[parameter] - mean).powi(2)
        });
        (mean, variance.sqrt())
    }

    /// Mean of something over the mixture.
    pub(super) fn mean_of(&self, of: impl Fn(Sizes, &Solution) -> f64) -> f64 {
        self.parts.iter().map(|(w, n, s)| w * of(*n, s)).sum()
    }

    /// Means of two things that are found together.
    pub(super) fn mean_of_two(&self, of: impl Fn(Sizes, &Solution) -> (f64, f64)) -> (f64, f64) {
        let parts = self.parts.iter().map(|(w, n, s)| (w, of(*n, s)));
        parts.fold((0.0, 0.0), |(a, b), (w, (x, y))| (a + w * x, b + w * y))
    }

    /// The value below which a parameter lies with this probability.
    pub(super) fn quantile(&self, parameter: usize, probability: f64) -> f64 {
        let normal = Normal::standard();
        let least = self.least[parameter];
        let below = |x: f64| {
            self.mean_of(|_, s| {
                let (mean, variance) = s.before_least[parameter];
                let cdf = |x: f64| normal.cdf((x - mean) / variance.sqrt());
                let cut = if least > f64::NEG_INFINITY {
                    cdf(least)
                } else {
                    0.0
                };
                ((cdf(x) - cut) / (1.0 - cut).max(f64::MIN_POSITIVE)).clamp(0.0, 1.0)
            })
        };
        let (mean, std) = self.moments(parameter);
        // Chebyshev: not even 1 in 400 lies beyond 20 standard deviations.
        let range = (mean - 20.0 * std, mean + 20.0 * std);
        bisected(range, BISECTIONS, |x| below(x) < probability)
    }
}

/// The sizes of the noises of maximum likelihood, with the stated errors of the times, and their solution.
pub(super) fn maximum_likelihood(
    bounces: &Bounces,
    noise: &Noise,
    priors: &[Prior],
) -> Option<(Sizes, Solution)> {
    let at = |ln_bounce: f64| {
        let sizes = Sizes {
            bounce: ln_bounce.exp(),
            timing: 1.0,
        };
        let solution = solve(bounces, noise, sizes, priors)?;
        Some((solution.ln_likelihood, (sizes, solution)))
    };
    let (range, top) = range(at)?;
    let hill = range.hill(top, 0.0, at)?;
    // Taken between the places of the grid, so that it is continuous as the trial moves.
    match at(hill.vertex) {
        Some((likelihood, found)) if likelihood >= hill.top.1 => Some(found),
        _ => Some(hill.top.2),
    }
}

/// Forty standard deviations halved this often leave a millionth of one.
const BISECTIONS: usize = 26;

/// The part of the range of `ln σ_e` that matters, in fine steps, and about the place in it of greatest density.
fn range<T>(ln_density: impl Fn(f64) -> Option<(f64, T)>) -> Option<(Grid, f64)> {
    let (first, last) = (BOUNCE_STD.0.ln(), BOUNCE_STD.1.ln());
    let (mut from, mut to) = (first, last);
    let mut top = first + COMMON * (last - first);
    for _ in 0..NARROWINGS {
        let grid = Grid::new(from, to, COARSE);
        let hill = grid.hill(top, NEGLIGIBLE, &ln_density)?;
        top = hill.top.0;
        from = (hill.lowest - grid.step).max(first);
        to = (hill.highest + grid.step).min(last);
    }
    let count = crate::units::whole(((to - from) / FINE_STEP).ceil()) + 1;
    Some((Grid::new(from, to, count.max(FEWEST_STEPS)), top))
}

/// Centre and width of the posterior of ln φ, by a parabola through three of its values.
fn timing_scale(ln_likelihood: impl Fn(f64) -> Option<f64>) -> Option<(f64, f64)> {
    let ln = |x: f64| Some(ln_likelihood(x)? - 0.5 * (x / TIMING_SCALE_STD).powi(2));
    let (less, same, more) = (ln(-LOOK)?, ln(0.0)?, ln(LOOK)?);
    let curvature = (2.0 * same - less - more) / (LOOK * LOOK);
    // The curvature is at least that of the prior: the likelihood can bend the other way.
    let width = curvature.max(TIMING_SCALE_STD.powi(-2)).sqrt().recip();
    let centre = width * width * (more - less) / (2.0 * LOOK);
    Some((
        centre.clamp(-2.0 * TIMING_SCALE_STD, 2.0 * TIMING_SCALE_STD),
        width,
    ))
}

/// Place of most balls in the range of `ln σ_e`, as a share of it: half a per cent.
const COMMON: f64 = 0.67;

/// Evenly spaced places.
#[derive(Debug, Clone, Copy)]
struct Grid {
    from: f64,
    step: f64,
    count: usize,
}

/// The peak of a unimodal function and where it falls below `negligible`.
#[derive(Debug)]
struct Hill<T> {
    /// Place, value, and what was found there.
    top: (f64, f64, T),
    /// Vertex of the parabola through the top and its neighbours; the top itself at an end of the grid.
    vertex: f64,
    lowest: f64,
    highest: f64,
}

impl Grid {
    fn new(from: f64, to: f64, count: usize) -> Self {
        Self {
            from,
            step: (to - from) / real(count - 1),
            count,
        }
    }

    fn at(&self, index: usize) -> f64 {
        self.from + real(index) * self.step
    }

    /// The peak of a unimodal function, and the range in which it is below it by no more than `negligible`.
    ///
    /// The function is evaluated from the place nearest to `start` both ways until it is below that range: the rest of the
    /// grid costs nothing.
    fn hill<T>(
        &self,
        start: f64,
        negligible: f64,
        of: impl Fn(f64) -> Option<(f64, T)>,
    ) -> Option<Hill<T>> {
        let start = crate::units::whole((start - self.from) / self.step);
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
