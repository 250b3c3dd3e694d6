//! Groups of drops compared: means at one speed, the scatter within drops, between drops and between groups told apart, and
//! which differences chance does not explain.

mod weighted;

use statrs::distribution::{ContinuousCDF, StudentsT};

use super::{Estimate, student};
use crate::order::sort_by_number;
use crate::physics::priors::SPEED_EXPONENT_BEYOND;
use crate::units::real;
use weighted::{Fit, Sums};

/// Speeds that differ by less than this factor, as its logarithm, are one speed: by the exponents of real balls e then
/// differs by less than 0.0025 of itself.
const ONE_SPEED: f64 = 0.05;
/// Differences that chance makes as often as this or more rarely are real. Convention.
const REAL: f64 = 0.05;

/// One drop: what was measured and its standard error, at a speed if that counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Member {
    /// Index of its group.
    pub group: usize,
    /// The value: e.
    pub value: f64,
    /// The standard error that it claims, 0 or more.
    pub std: f64,
    /// ln of the speed that the value belongs to, if it changes with that.
    pub ln_speed: Option<f64>,
}

/// A group.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mean {
    /// Number of drops.
    pub count: usize,
    /// Mean at the common speed.
    pub mean: Estimate,
    /// Standard deviation of its drops about that; none of one.
    pub spread: Option<f64>,
}

/// The second group less the first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// Indices of both.
    pub groups: [usize; 2],
    /// Difference of their means; the interval of several is widened so that all hold together with 95 %.
    pub difference: Estimate,
    /// Probability of one as great by chance where there is none.
    pub chance: f64,
    /// The same, corrected for the number of differences (Holm).
    pub corrected: f64,
}

impl Difference {
    /// Whether chance is no explanation.
    #[must_use]
    pub fn is_real(&self) -> bool {
        self.corrected < REAL
    }
}

/// Groups compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Groups {
    /// Each group.
    pub means: Vec<Mean>,
    /// The speed at which they are compared; none where no speed is known or all have one.
    pub at_speed_m_per_s: Option<f64>,
    /// Change of the value for a speed greater by a factor of 2.7, where the drops tell.
    pub slope: Option<Estimate>,
    /// Scatter within a drop: the errors that drops claim, root mean square.
    pub within: f64,
    /// Standard deviation between drops of a group beside that.
    pub between_drops: f64,
    /// Standard deviation between groups beside both.
    pub between_groups: f64,
    /// Degrees of freedom of the scatter between drops.
    pub freedom: usize,
    /// Each pair of groups.
    pub differences: Vec<Difference>,
}

impl Groups {
    /// Of two groups or more, each with a drop, and more drops than groups.
    ///
    /// # Formula
    /// ```text
    /// y = a_g + b·(ln v − ln v₀) + u + ε,   u ~ τ between drops,   ε ~ σ claimed
    /// τ² = max(0, (Q − f)/(Σw − Σ_g Σw²/Σw)),   w = 1/σ²,   f = N − groups (− 1)      DerSimonian and Laird
    /// then w = 1/(σ² + τ²),   q = Σw·(y − fit)²/f,   var a_g = q/Σw + q·(x̄_g − x₀)²/S,   S = Σw(x − x̄_g)²
    /// t of f degrees of freedom                                                        Knapp and Hartung
    /// ```
    /// With equal errors it is Student's test with a covariate. The slope b is fitted where the drops tell it better than the
    /// exponents of real balls do, 0.05·y; else it is 0 with that error. The scatter is taken to be alike in all groups.
    #[must_use]
    pub fn of(members: &[Member], count: usize) -> Option<Self> {
        let held = |g: usize| members.iter().filter(|m| m.group == g).count();
        if count < 2 || (0..count).any(|g| held(g) == 0) || members.len() <= count {
            return None;
        }
        let middle = middle(members);
        let plain = members.len() - count;
        // As many as tell a slope and its own scatter.
        let sloped = middle.is_some() && plain > 2;
        let with_slope = sloped.then(|| Fitted::of(members, count, middle, plain - 1));
        let level = members.iter().map(|m| m.value).sum::<f64>() / real(members.len());
        let prior = SPEED_EXPONENT_BEYOND * level.abs();
        let told = with_slope.filter(|f| f.slope_std() < prior);
        let of_slope = middle.map_or(0.0, |_| prior);
        let fitted =
            told.unwrap_or_else(|| Fitted::without_slope(members, count, middle, plain, of_slope));
        Some(fitted.compared(members))
    }
}

/// Drops of one ball from different heights, brought to one speed.
#[derive(Debug, Clone, PartialEq)]
pub struct Levelled {
    /// That speed.
    pub at_speed_m_per_s: f64,
    /// Change of the value for a speed greater by a factor of 2.7.
    pub slope: Estimate,
    /// The value of each at that speed.
    pub values: Vec<f64>,
}

impl Levelled {
    /// Of one group; none where the speeds are alike, no change is seen beyond its interval, or a single drop makes the
    /// change: without it the others would have another, and it may be another ball.
    #[must_use]
    pub fn of(members: &[Member]) -> Option<Self> {
        let middle = middle(members)?;
        let freedom = members.len().checked_sub(2).filter(|free| *free >= 2)?;
        let slope = slope(members, middle, freedom);
        let [low, high] = slope.interval95?;
        let is_of_all = (0..members.len()).all(|left_out| {
            let others = [&members[..left_out], &members[left_out + 1..]].concat();
            let middle = self::middle(&others);
            let others = middle.map(|x0| self::slope(&others, x0, freedom - 1).value);
            others.is_some_and(|value| low <= value && value <= high)
        });
        let level = |m: &Member| m.value - slope.value * (m.ln_speed.unwrap_or(middle) - middle);
        ((low > 0.0 || high < 0.0) && is_of_all).then(|| Self {
            at_speed_m_per_s: middle.exp(),
            slope,
            values: members.iter().map(level).collect(),
        })
    }
}

/// Change of the value for a speed greater by a factor of 2.7, of one group.
fn slope(members: &[Member], middle: f64, freedom: usize) -> Estimate {
    let fitted = Fitted::of(members, 1, Some(middle), freedom);
    fitted.estimate(fitted.fit.slope, fitted.slope_std().powi(2), 0.025)
}

/// ln of the common speed: the mean, where the drops have different ones.
fn middle(members: &[Member]) -> Option<f64> {
    let speeds: Option<Vec<f64>> = members.iter().map(|m| m.ln_speed).collect();
    let speeds = speeds?;
    let least = speeds.iter().copied().fold(f64::INFINITY, f64::min);
    let most = speeds.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mean = speeds.iter().sum::<f64>() / real(speeds.len());
    (most - least > ONE_SPEED).then_some(mean)
}

/// A fit with its scatter.
#[derive(Debug, Clone)]
struct Fitted {
    fit: Fit,
    count: usize,
    middle: Option<f64>,
    freedom: usize,
    between: f64,
    /// q, what the variance of a unit weight is.
    unit: f64,
    /// Standard deviation of a slope that is not fitted.
    slope_prior: f64,
}

impl Fitted {
    fn of(members: &[Member], count: usize, middle: Option<f64>, freedom: usize) -> Self {
        Self::with(members, count, middle, freedom, 0.0, true)
    }

    fn without_slope(
        members: &[Member],
        count: usize,
        middle: Option<f64>,
        freedom: usize,
        slope_prior: f64,
    ) -> Self {
        Self::with(members, count, middle, freedom, slope_prior, false)
    }

    fn with(
        members: &[Member],
        count: usize,
        middle: Option<f64>,
        freedom: usize,
        slope_prior: f64,
        sloped: bool,
    ) -> Self {
        let x0 = middle.unwrap_or(0.0);
        let least = floor(members);
        let weights = |variance: f64| -> Vec<f64> {
            members
                .iter()
                .map(|m| 1.0 / (m.std.powi(2).max(least) + variance))
                .collect()
        };
        let first = weights(0.0);
        let fit = Fit::of(members, count, &first, x0, sloped);
        let between = fit.between(members, &first, freedom);
        let fit = Fit::of(members, count, &weights(between), x0, sloped);
        Self {
            unit: fit.square / real(freedom),
            fit,
            count,
            middle,
            freedom,
            between: between.sqrt(),
            slope_prior,
        }
    }

    fn slope_std(&self) -> f64 {
        if self.fit.lever > 0.0 {
            (self.unit / self.fit.lever).sqrt()
        } else {
            f64::INFINITY
        }
    }

    /// Variance of a difference of two places on the line of a group that are this far apart.
    fn by_slope(&self, apart: f64) -> f64 {
        let std = if self.fit.lever > 0.0 {
            self.slope_std()
        } else {
            self.slope_prior
        };
        (apart * std).powi(2)
    }

    fn at_middle(&self, group: usize) -> f64 {
        let Sums { x, y, .. } = self.fit.sums[group];
        y - self.fit.slope * x
    }

    fn estimate(&self, value: f64, variance: f64, tail: f64) -> Estimate {
        let std = variance.sqrt();
        let reach = student(1.0 - tail, real(self.freedom)) * std;
        Estimate {
            value,
            std_error: Some(std),
            interval95: Some([value - reach, value + reach]),
        }
    }

    fn mean(&self, members: &[Member], group: usize) -> Mean {
        let sums = self.fit.sums[group];
        let variance = self.unit / sums.weight + self.by_slope(sums.x);
        let x0 = self.middle.unwrap_or(0.0);
        let own = members.iter().filter(|m| m.group == group);
        let levelled = own.map(|m| m.value - self.fit.slope * (m.ln_speed.unwrap_or(x0) - x0));
        let levelled: Vec<f64> = levelled.collect();
        Mean {
            count: levelled.len(),
            mean: self.estimate(self.at_middle(group), variance, 0.025),
            spread: spread(&levelled),
        }
    }

    fn difference(&self, [first, second]: [usize; 2], tail: f64) -> Difference {
        let (a, b) = (self.fit.sums[first], self.fit.sums[second]);
        let value = self.at_middle(second) - self.at_middle(first);
        let variance = self.unit * (a.weight.recip() + b.weight.recip()) + self.by_slope(b.x - a.x);
        let t = value / variance.sqrt();
        let chance =
            StudentsT::new(0.0, 1.0, real(self.freedom)).map_or(f64::NAN, |d| 2.0 * d.sf(t.abs()));
        Difference {
            groups: [first, second],
            difference: self.estimate(value, variance, tail),
            chance,
            corrected: chance,
        }
    }

    fn compared(&self, members: &[Member]) -> Groups {
        let means: Vec<Mean> = (0..self.count).map(|g| self.mean(members, g)).collect();
        let pairs: Vec<[usize; 2]> = (0..self.count)
            .flat_map(|first| (first + 1..self.count).map(move |second| [first, second]))
            .collect();
        // Bonferroni: Holm's steps have no intervals of their own.
        let tail = 0.025 / real(pairs.len());
        let differences = pairs
            .iter()
            .map(|pair| self.difference(*pair, tail))
            .collect();
        let within = members.iter().map(|m| m.std * m.std).sum::<f64>() / real(members.len());
        let slope = (self.fit.lever > 0.0).then(|| {
            let variance = self.slope_std().powi(2);
            self.estimate(self.fit.slope, variance, 0.025)
        });
        Groups {
            between_groups: between_groups(&means),
            means,
            at_speed_m_per_s: self.middle.map(f64::exp),
            slope,
            within: within.sqrt(),
            between_drops: self.between,
            freedom: self.freedom,
            differences: corrected(differences),
        }
    }
}

/// Least variance that a claimed error counts with: a value without an error weighs no more than the scatter allows.
fn floor(members: &[Member]) -> f64 {
    let values: Vec<f64> = members.iter().map(|m| m.value).collect();
    let scale = spread(&values).unwrap_or(0.0).max(f64::EPSILON);
    (1e-3 * scale).powi(2)
}

fn spread(values: &[f64]) -> Option<f64> {
    let free = values.len().checked_sub(1).filter(|n| *n > 0)?;
    let mean = values.iter().sum::<f64>() / real(values.len());
    let square: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
    Some((square / real(free)).sqrt())
}

/// What the means differ by beside their errors.
fn between_groups(means: &[Mean]) -> f64 {
    let values: Vec<f64> = means.iter().map(|m| m.mean.value).collect();
    let errors = means.iter().filter_map(|m| m.mean.std_error).map(|s| s * s);
    let claimed = errors.sum::<f64>() / real(means.len());
    let found = spread(&values).map_or(0.0, |s| s * s);
    (found - claimed).max(0.0).sqrt()
}

/// Holm 1979: the k-th rarest of m counts m − k + 1 fold, and none less than a rarer one. It holds whatever the groups' sizes
/// and errors, which Tukey's does not.
fn corrected(mut differences: Vec<Difference>) -> Vec<Difference> {
    let mut order: Vec<usize> = (0..differences.len()).collect();
    sort_by_number(&mut order, |&i| differences[i].chance);
    let mut most = 0.0_f64;
    for (k, index) in order.iter().enumerate() {
        let fold = real(differences.len() - k);
        most = most.max((fold * differences[*index].chance).min(1.0));
        differences[*index].corrected = most;
    }
    differences
}

#[cfg(test)]
mod tests;
