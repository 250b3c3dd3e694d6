//! Restitution from height, number of bounces and total time: equations (25) and (30).

use super::flights::Flights;
use super::{Estimate, student_975};
use crate::Error;
use crate::impact::Impact;
use crate::physics::BounceSeries;
use crate::units::real;

/// A drop from a known height, its impacts timed: the input of (25).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimedDrop<'a> {
    /// All impacts in order of time.
    pub impacts: &'a [Impact],
    /// The flights between them.
    pub flights: &'a Flights,
    /// e from the flights: how the ball would have gone on.
    pub restitution: f64,
    /// From the ball's lowest point to the surface, in metres.
    pub height_m: f64,
    /// Standard error of the height in metres.
    pub height_std_m: f64,
    /// In m/s².
    pub gravity_m_per_s2: f64,
}

/// Why there is no total time.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Missing {
    /// The first flight is too short for this height: impacts before it were not recorded.
    FirstImpact {
        /// The first flight in seconds.
        first_flight_s: f64,
        /// The first flight by the height and the ratio of the first flights, in seconds.
        expected_s: f64,
    },
    /// The first flight is longer than a perfect ball's from this height.
    Height {
        /// The first flight in seconds.
        first_flight_s: f64,
        /// That of a ball that loses nothing, in seconds.
        longest_s: f64,
    },
    /// The recording, or the bouncing, ends long before the ball would rest.
    End {
        /// Time that the ball would have gone on, in seconds.
        left_s: f64,
    },
}

/// The total time and e by it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TotalTime {
    /// From release to rest, in seconds: `√(2·h0/g) + (t_n − t_1) + ΔT`, ΔT the last contact by (20).
    pub total_time_s: f64,
    /// e by (25); none where no e gives this total time.
    pub eq25: Option<Estimate>,
    /// e by (30).
    pub eq30: Option<Estimate>,
}

/// Greatest time that the ball goes on after the last flight, as a share of the whole: with more it was not the last.
const LARGEST_REST: f64 = 0.1;
/// A first flight shorter than expected by more than half a bounce has lost a bounce: halfway in ln T.
const HALF_A_BOUNCE: f64 = 1.5;

/// The total time and what follows from it.
///
/// The standard error holds the scatter of the bounces (each moves all flights after it), and the time that the ball
/// goes on unheard, which makes n and the total time lower bounds, and the error of the height. Gravity is exact.
///
/// # Errors
/// [`Error::Argument`] if height or gravity is not positive.
pub fn solve(drop: &TimedDrop<'_>) -> Result<Result<TotalTime, Missing>, Error> {
    let series = BounceSeries::new(drop.height_m, drop.gravity_m_per_s2)?;
    if let Some(missing) = missing_in(drop, &series) {
        return Ok(Err(missing));
    }
    let (Some(first), Some(last)) = (drop.impacts.first(), drop.impacts.last()) else {
        return Ok(Err(Missing::End { left_s: 0.0 }));
    };
    let observed = last.time_s - first.time_s;
    let bounces = drop.impacts.len();
    let mut total_time_s = series.first_fall_s() + observed;
    let mut root = None;
    // The last contact is that of (20), which depends on e: each round changes it by dΔT/de·de, far below itself.
    for _ in 0..LIMIT {
        root = series
            .restitution_from_total_time(bounces, total_time_s)
            .ok();
        let Some(found) = root else { break };
        let rest_contact_s = series.rest_contact_time_s(found.restitution, bounces)?;
        let before_s = total_time_s;
        total_time_s = series.first_fall_s() + observed + rest_contact_s;
        if (total_time_s - before_s).abs() <= REST * total_time_s {
            break;
        }
    }
    let std_s = error_s(drop);
    let freedom = real(drop.flights.ln_ratios().len().saturating_sub(1));
    let estimate = |e: f64, per_time: f64, per_height: f64| {
        let std = (per_time * std_s).hypot(per_height * drop.height_std_m);
        let reach = student_975(freedom) * std;
        Estimate {
            value: e,
            std_error: Some(std),
            interval95: Some([(e - reach).max(0.0), (e + reach).min(1.0)]),
        }
    };
    let endless = series.restitution_from_total_time_approx(total_time_s).ok();
    Ok(Ok(TotalTime {
        total_time_s,
        eq25: root.map(|r| {
            estimate(
                r.restitution.value(),
                r.per_total_time_per_s,
                r.per_height_per_m,
            )
        }),
        eq30: endless.map(|r| {
            estimate(
                r.restitution.value(),
                r.per_total_time_per_s,
                r.per_height_per_m,
            )
        }),
    }))
}

/// The last contact has converged once the total time changes by no more than this share of itself: rounding.
const REST: f64 = 1e-14;
/// Rounds at most, where rounding never lets it rest.
const LIMIT: usize = 30;

/// √(h1/h0): e of the first impact, drag of the first fall included; none if the first flight was not heard whole.
///
/// # Formula
/// ```text
/// h1 = g·T_1²/8,   e = √(h1/h0) = T_1·√(g/(8·h0)),   (σ/e)² = (σ_T/T_1)² + (σ_h/2h0)²
/// ```
#[must_use]
pub fn first_rebound(drop: &TimedDrop<'_>) -> Option<Estimate> {
    let flight = drop.flights.after(0)?;
    let value = flight * (drop.gravity_m_per_s2 / (8.0 * drop.height_m)).sqrt();
    let timing = drop.impacts[0].std_s.hypot(drop.impacts[1].std_s) / flight;
    let std = value * timing.hypot(0.5 * drop.height_std_m / drop.height_m);
    let reach = student_975(f64::INFINITY) * std;
    Some(Estimate {
        value,
        std_error: Some(std),
        interval95: Some([value - reach, value + reach]),
    })
}

/// What of the drop is missing, if anything is.
///
/// # Errors
/// [`Error::Argument`] if height or gravity is not positive.
pub fn missing(drop: &TimedDrop<'_>) -> Result<Option<Missing>, Error> {
    let series = BounceSeries::new(drop.height_m, drop.gravity_m_per_s2)?;
    Ok(missing_in(drop, &series))
}

fn missing_in(drop: &TimedDrop<'_>, series: &BounceSeries) -> Option<Missing> {
    if let Some(first_flight_s) = drop.flights.after(0) {
        let longest_s = 2.0 * series.first_fall_s();
        if first_flight_s > longest_s {
            return Some(Missing::Height {
                first_flight_s,
                longest_s,
            });
        }
        let early: Vec<f64> = drop
            .flights
            .ln_ratios()
            .iter()
            .take(2)
            .map(|(_, r)| *r)
            .collect();
        let ln_ratio = early.iter().sum::<f64>() / real(early.len().max(1));
        // Of one flight nothing tells how much the ball loses.
        if !early.is_empty() && (first_flight_s / longest_s).ln() < HALF_A_BOUNCE * ln_ratio {
            return Some(Missing::FirstImpact {
                first_flight_s,
                expected_s: longest_s * ln_ratio.exp(),
            });
        }
    }
    let left_s = left_s(drop.impacts, drop.flights, drop.restitution);
    let whole =
        series.first_fall_s() + drop.impacts.last()?.time_s - drop.impacts.first()?.time_s + left_s;
    (left_s > LARGEST_REST * whole).then_some(Missing::End { left_s })
}

/// Time that the ball goes on after the last impact, at the same ratio for ever: `T·e/(1 − e)` after a last flight T.
#[must_use]
pub fn left_s(impacts: &[Impact], flights: &Flights, restitution: f64) -> f64 {
    let last = impacts.len().checked_sub(2).and_then(|i| flights.after(i));
    last.unwrap_or(0.0) * restitution / (1.0 - restitution).max(f64::EPSILON)
}

/// Standard error of the total time: scatter, and the unheard end, of which anything may be missing.
fn error_s(drop: &TimedDrop<'_>) -> f64 {
    let scatter = drop.flights.scatter().unwrap_or(0.0);
    let last = drop.impacts.last().map_or(0.0, |i| i.time_s);
    // A rebound stronger by a share makes all flights after it longer by that share.
    let moved: f64 = drop.impacts.iter().map(|i| (last - i.time_s).powi(2)).sum();
    (scatter * moved.sqrt())
        .hypot(left_s(drop.impacts, drop.flights, drop.restitution) / 3.0_f64.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    const G: f64 = 9.81;

    /// The impacts of a ball of constant e, from its first one at 1 s.
    fn impacts(height: f64, e: f64, count: usize) -> Vec<Impact> {
        let mut flight = 2.0 * e * (2.0 * height / G).sqrt();
        let mut time_s = 1.0;
        (0..count)
            .map(|_| {
                let impact = Impact::heard(time_s, 1e-5);
                time_s += flight;
                flight *= e;
                impact
            })
            .collect()
    }

    fn solved(impacts: &[Impact], height_m: f64) -> Result<TotalTime, Missing> {
        let flights = Flights::between(impacts);
        let restitution = flights.ratio().unwrap().value;
        solve(&TimedDrop {
            impacts,
            flights: &flights,
            restitution,
            height_m,
            height_std_m: 1e-3,
            gravity_m_per_s2: G,
        })
        .unwrap()
    }

    #[test]
    fn the_papers_own_ball_comes_back() {
        // 70 bounces at the e that (25) gives for 7.5 s: the flights alone last 7.5 s less 70 contacts.
        let found = solved(&impacts(0.305, 0.9335, 70), 0.305).unwrap();
        let eq25 = found.eq25.unwrap();
        assert!(
            (eq25.value - 0.9335).abs() < 0.003 && eq25.std_error.unwrap() > 0.0,
            "{found:?}"
        );
        assert!(found.eq30.unwrap().value > 0.93);
    }

    #[test]
    fn a_lost_first_impact_is_noticed() {
        let whole = impacts(0.5, 0.8, 20);
        assert!(solved(&whole, 0.5).is_ok());
        assert!(matches!(
            solved(&whole[1..], 0.5),
            Err(Missing::FirstImpact { .. })
        ));
        assert!(matches!(solved(&whole, 0.2), Err(Missing::Height { .. })));
    }

    #[test]
    fn an_early_end_is_noticed() {
        assert!(matches!(
            solved(&impacts(0.5, 0.9, 8), 0.5),
            Err(Missing::End { .. })
        ));
    }

    #[test]
    fn the_first_rebound_is_the_first_restitution() {
        let impacts = impacts(0.5, 0.8, 5);
        let flights = Flights::between(&impacts);
        let drop = TimedDrop {
            impacts: &impacts,
            flights: &flights,
            restitution: 0.8,
            height_m: 0.5,
            height_std_m: 1e-3,
            gravity_m_per_s2: G,
        };
        assert!((first_rebound(&drop).unwrap().value - 0.8).abs() < 1e-12);
    }
}
