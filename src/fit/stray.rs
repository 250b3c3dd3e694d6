//! Bounces and times that stray: they are kept, and count for little.

use super::model::{State, pulls, time_pull};
use super::posterior::likeliest;

/// One bounce or time in two hundred strays.
const SHARE: f64 = 0.005;
/// A wild bounce scatters ten times as much as others.
const WILDNESS: f64 = 100.0;
/// A stray time is off by this share of the flights around it: another sound in its place.
const STRAY_TIME: f64 = 0.1;
/// What is off by less than this many standard deviations strays too little to be looked at.
const SUSPICIOUS: f64 = 2.0;
/// Of fewer impacts none can be told to be the one that strays.
const FEWEST: usize = 7;
/// At most one in this many strays, or the others are no clear majority.
const MOST: usize = 4;

/// Numbers of the impacts that stray, counted from 0.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Strays {
    /// The ball rebounded otherwise than usual.
    pub bounces: Vec<usize>,
    /// The time is not that of the impact.
    pub times: Vec<usize>,
}

/// Finds strays one by one, the clearest first, then those that hide one another, and lets them count less.
///
/// A stray is believed where the data are likelier with it than without by more than strays are rarer than others:
/// `ln L' − ln L > ln((1 − q)/q)`, q = 0.005, each at its likeliest scatter.
pub(super) fn find(state: &mut State<'_>) -> Option<Strays> {
    let impacts = state.time_variances.len();
    let mut strays = Strays::default();
    while impacts >= FEWEST && strays.bounces.len() + strays.times.len() < impacts / MOST {
        let Some((now, bounce, time)) = suspects(state) else {
            break;
        };
        let mut with_bounce = state.clone();
        with_bounce.wildness[bounce] = WILDNESS;
        let mut with_time = state.clone();
        with_time.time_variances[time] += (STRAY_TIME * state.shorter_flight(time)).powi(2);
        let (by_bounce, by_time) = (likelihood(&with_bounce)?, likelihood(&with_time)?);
        if by_bounce.max(by_time) - now < ((1.0 - SHARE) / SHARE).ln() {
            break;
        }
        if by_bounce >= by_time {
            strays.bounces.push(bounce + 1);
            *state = with_bounce;
        } else {
            strays.times.push(time);
            *state = with_time;
        }
        state.settle()?;
    }
    let crowd = crowd(state, &strays)?;
    strays.times.extend(crowd);
    strays.bounces.sort_unstable();
    strays.times.sort_unstable();
    Some(strays)
}

/// Times that stray together, as at the end of a drop where nothing is clear any more: many strays hide one another, for
/// the scatter of all bounces grows by them. So what lies far from the median is tried as a whole, at the price of each.
///
/// Bounces next to a stray that is known already are off because of it.
fn crowd(state: &mut State<'_>, known: &Strays) -> Option<Vec<usize>> {
    let impacts = state.time_variances.len();
    let bounces = state.bounces()?;
    let middle = median(bounces.ln_e.clone());
    let off: Vec<f64> = bounces.ln_e.iter().map(|z| (z - middle).abs()).collect();
    let usual = MAD_TO_STD * median(off.clone());
    let mut suspects: Vec<usize> = (0..off.len()).filter(|&j| off[j] > FAR * usual).collect();
    suspects.sort_by(|&a, &b| off[b].total_cmp(&off[a]));
    // A stray time moves the bounce there most, and the bounces next to it the other way.
    let mut far: Vec<usize> = Vec::new();
    for impact in suspects.into_iter().map(|j| j + 1) {
        let mut named = far.iter().chain(&known.times).chain(&known.bounces);
        if named.all(|n| n.abs_diff(impact) > 1) {
            far.push(impact);
        }
    }
    let count = far.len() + known.bounces.len() + known.times.len();
    if impacts < FEWEST || far.len() < 2 || count > impacts / MOST {
        return Some(Vec::new());
    }
    let mut without = state.clone();
    for &time in &far {
        without.time_variances[time] += (STRAY_TIME * state.shorter_flight(time)).powi(2);
    }
    let price = crate::units::real(far.len()) * ((1.0 - SHARE) / SHARE).ln();
    if likelihood(&without)? - likelihood(state)? < price {
        return Some(Vec::new());
    }
    *state = without;
    state.settle()?;
    Some(far)
}

/// What lies farther from the median than this many robust standard deviations is looked at together.
const FAR: f64 = 5.0;
/// The standard deviation of a normal distribution over its median absolute deviation.
const MAD_TO_STD: f64 = 1.4826;

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// The likelihood as it stands, the bounce and the time that are farthest off by their own errors; none if none is.
fn suspects(state: &State<'_>) -> Option<(f64, usize, usize)> {
    let bounces = state.bounces()?;
    let noise = state.noise(&bounces);
    let (sizes, solution) = likeliest(&bounces, &noise, &state.priors())?;
    let pulls = pulls(&bounces, &noise, sizes, &solution)?;
    let farthest = |off: &[f64]| (0..off.len()).max_by(|&a, &b| off[a].total_cmp(&off[b]));
    let by_bounce: Vec<f64> = pulls
        .iter()
        .zip(&state.wildness)
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
