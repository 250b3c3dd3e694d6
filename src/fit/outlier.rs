//! Outliers among bounces and times: their variance is inflated, so that they are kept and count for little.

use super::least_squares::solve;
use super::noise::Sizes;
use super::posterior::likeliest;
use super::state::{State, pulls, time_pull};
use crate::statistics::{MAD_TO_STD, upper_median};

/// Log-likelihood in nats that an outlier has to gain: `ln((1 − q)/q)` for q = 0.005, one bounce or time in two hundred.
const PRICE: f64 = 5.293_304_824_724_492;
/// Variance inflation of an outlying bounce: it scatters ten times as much as others.
const VARIANCE_INFLATION: f64 = 100.0;
/// Standard deviation of an outlying time, as a share of the shorter flight beside it: another sound in its place.
const OUTLIER_TIME_SHARE: f64 = 0.1;
/// Standard deviations by which a bounce or time is off at least to be tried as an outlier.
const SUSPICIOUS: f64 = 2.0;
/// Fewest impacts among which an outlier can be identified.
const FEWEST: usize = 7;
/// Impacts for each outlier, at least: the others have to be a clear majority.
const MOST: usize = 4;

/// Numbers of the outlying impacts, counted from 0.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Outliers {
    /// The ball rebounded otherwise than usual.
    pub bounces: Vec<usize>,
    /// The time is not that of the impact.
    pub times: Vec<usize>,
}

/// Finds outliers that mask one another, then others one by one, the clearest first, and inflates their variances.
///
/// An outlier is accepted where it raises the maximum likelihood, at the best scatter with it and without it, by more than
/// outliers are rarer than other impacts.
pub(super) fn find(state: &mut State<'_>) -> Option<Outliers> {
    let impacts = state.time_variances.len();
    let mut outliers = Outliers {
        times: masked_outliers(state)?,
        ..Outliers::default()
    };
    while impacts >= FEWEST && outliers.bounces.len() + outliers.times.len() < impacts / MOST {
        let Some((now, bounce, time)) = suspects(state) else {
            break;
        };
        let mut with_bounce = state.clone();
        with_bounce.variance_inflation[bounce] = VARIANCE_INFLATION;
        let mut with_time = state.clone();
        with_time.time_variances[time] += (OUTLIER_TIME_SHARE * state.shorter_flight(time)).powi(2);
        let (by_bounce, by_time) = (likelihood(&with_bounce)?, likelihood(&with_time)?);
        if by_bounce.max(by_time) - now < PRICE {
            break;
        }
        if by_bounce >= by_time {
            outliers.bounces.push(bounce + 1);
            *state = with_bounce;
        } else {
            outliers.times.push(time);
            *state = with_time;
        }
        state.converge().ok()?;
    }
    outliers.bounces.sort_unstable();
    outliers.times.sort_unstable();
    Some(outliers)
}

/// Outlying times that mask one another, as at the faint end of a drop: the scatter of all bounces grows by them. So they
/// are sought at the scatter of the median bounce, the farthest first, and tried as a whole, at the price of each.
fn masked_outliers(state: &mut State<'_>) -> Option<Vec<usize>> {
    let impacts = state.time_variances.len();
    let bounces = state.bounces()?;
    let median = |values: &[f64]| upper_median(values.iter().copied()).unwrap_or(0.0);
    let middle = median(&bounces.ln_e);
    let off: Vec<f64> = bounces.ln_e.iter().map(|z| (z - middle).abs()).collect();
    let sizes = Sizes {
        bounce: MAD_TO_STD * median(&off),
        timing: 1.0,
    };
    let suspects = off.iter().filter(|&&z| z > FAR * sizes.bounce).count();
    if impacts < FEWEST || suspects < 2 || sizes.bounce <= 0.0 {
        return Some(Vec::new());
    }
    let far = far_times(state, sizes)?;
    let without = |far: &[usize]| {
        let mut without = state.clone();
        for &time in far {
            without.time_variances[time] +=
                (OUTLIER_TIME_SHARE * state.shorter_flight(time)).powi(2);
        }
        Some((likelihood(&without)?, without))
    };
    // Between two outliers a time looks like a third: only those stay that the others do not explain.
    let mut kept = far.clone();
    for time in far {
        let others: Vec<usize> = kept.iter().copied().filter(|&t| t != time).collect();
        if without(&kept)?.0 - without(&others)?.0 < PRICE {
            kept = others;
        }
    }
    let (by_all, without) = without(&kept)?;
    if kept.len() < 2 || by_all - likelihood(state)? < PRICE * crate::units::real(kept.len()) {
        return Some(Vec::new());
    }
    *state = without;
    state.converge().ok()?;
    Some(kept)
}

/// Times that are far off at these sizes of the noises, the farthest first.
fn far_times(state: &State<'_>, sizes: Sizes) -> Option<Vec<usize>> {
    let mut without = state.clone();
    let mut far = Vec::new();
    while far.len() < state.time_variances.len() / MOST {
        let Some(time) = farthest_time(&without, sizes)? else {
            break;
        };
        // Its weight goes until all are found, so that it does not make its neighbours look far off.
        without.time_variances[time] += state.shorter_flight(time).powi(2);
        far.push(time);
    }
    Some(far)
}

/// The time that is off by most of its own scatter, `|aᵀΣ⁻¹r|/√(aᵀΣ⁻¹a)`, if that is far; a are the slopes of ln e by it.
fn farthest_time(state: &State<'_>, sizes: Sizes) -> Option<Option<usize>> {
    let bounces = state.bounces()?;
    let noise = state.noise(&bounces);
    let solution = solve(&bounces, &noise, sizes, &state.priors())?;
    let pulls = pulls(&bounces, &noise, sizes, &solution)?;
    let factors = noise.factors(sizes)?;
    let off = (0..state.time_variances.len()).map(|k| {
        let mut slopes = vec![0.0; pulls.len()];
        for side in 0..3 {
            if let Some(j) = k.checked_sub(side).filter(|&j| j < slopes.len()) {
                slopes[j] = bounces.slopes[j][side];
            }
        }
        let scatter = time_pull(&bounces, &factors.solve(&slopes), k);
        (time_pull(&bounces, &pulls, k).abs() / scatter.sqrt(), k)
    });
    let farthest = off.max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some((farthest.0 > FAR).then_some(farthest.1))
}

/// Robust standard deviations by which times are off that are tried together.
const FAR: f64 = 5.0;

/// The present likelihood, and the bounce and the time that are farthest off in their own standard errors; none if neither
/// is far enough.
fn suspects(state: &State<'_>) -> Option<(f64, usize, usize)> {
    let bounces = state.bounces()?;
    let noise = state.noise(&bounces);
    let (sizes, solution) = likeliest(&bounces, &noise, &state.priors())?;
    let pulls = pulls(&bounces, &noise, sizes, &solution)?;
    let farthest = |off: &[f64]| (0..off.len()).max_by(|&a, &b| off[a].total_cmp(&off[b]));
    let by_bounce: Vec<f64> = pulls
        .iter()
        .zip(&state.variance_inflation)
        .map(|(p, w)| {
            if *w > 1.0 {
                0.0
            } else {
                p.abs() * sizes.bounce
            }
        })
        .collect();
    let by_time: Vec<f64> = (0..state.time_variances.len())
        .map(|k| time_pull(&bounces, &pulls, k).abs() * state.time_variances[k].sqrt())
        .collect();
    let (bounce, time) = (farthest(&by_bounce)?, farthest(&by_time)?);
    (by_bounce[bounce].max(by_time[time]) > SUSPICIOUS).then_some((
        solution.ln_likelihood,
        bounce,
        time,
    ))
}

fn likelihood(state: &State<'_>) -> Option<f64> {
    let bounces = state.bounces()?;
    let noise = state.noise(&bounces);
    Some(
        likeliest(&bounces, &noise, &state.priors())?
            .1
            .ln_likelihood,
    )
}
