//! The bounce at an impact by the two flights beside it: speeds, e and the energy kept, with the errors of the times.

use crate::fit::flights::Flights;
use crate::impact::Impact;
use crate::physics::BallModel;
use crate::physics::ends::Ends;
use crate::report::Bounce;

/// Both ends of the flight in an interval between impacts, by the model of the ball: without one, of a ball whose contact
/// takes no time in no air.
pub(super) fn ends(ball: Option<&BallModel>, interval_s: f64) -> Option<Ends> {
    ball.map_or_else(|| Ends::of(interval_s, 0.0), |ball| ball.ends(interval_s))
}

/// The bounce at impact `number`, counted from 0.
///
/// # Formula
/// ```text
/// T = D − C,   w = g·T_before/2,   u = g·T_after/2   (with drag those of a flight of length T),   e = u/w
/// σ_w/w = w′·√(s₀² + s₁²),   σ_u/u = u′·√(s₁² + s₂²)
/// (σ_e/e)² = (w′·s₀)² + ((w′ + u′)·s₁)² + (u′·s₂)²,   energy kept e²,   σ = 2e·σ_e
/// ```
/// D are the intervals between impacts, C is the contact time of the model in them, s₀, s₁ and s₂ the standard errors of the times before, at and after this impact,
/// u′ and w′ the derivatives of ln u and ln w by the interval, 1/T without drag. A late time makes the flight before it
/// longer and the one after it shorter, so its two parts add. C, K and g count as exact.
pub(super) fn bounce(
    timed: &[Impact],
    flights: &Flights,
    number: usize,
    ball: Option<&BallModel>,
    gravity_m_per_s2: f64,
) -> Bounce {
    let ends = |flight: Option<usize>| ends(ball, flights.after(flight?)?);
    let (before, after) = (ends(number.checked_sub(1)), ends(Some(number)));
    let std = |impact: usize| timed[impact].std_s;
    let speed = |ln: f64| 0.5 * gravity_m_per_s2 * ln.exp();
    let arrival = before.map(|b| {
        let value = speed(b.ln_landing);
        (
            value,
            value * b.landing_slope * std(number - 1).hypot(std(number)),
        )
    });
    let leaving = after.map(|a| {
        let value = speed(a.ln_leaving);
        (
            value,
            value * a.leaving_slope * std(number).hypot(std(number + 1)),
        )
    });
    let restitution = before.zip(after).map(|(b, a)| {
        let value = (a.ln_leaving - b.ln_landing).exp();
        let own = (b.landing_slope + a.leaving_slope) * std(number);
        let others = (b.landing_slope * std(number - 1)).hypot(a.leaving_slope * std(number + 1));
        (value, value * own.hypot(others))
    });
    Bounce {
        impact_speed_m_per_s: arrival.map(|v| v.0),
        impact_speed_std_m_per_s: arrival.map(|v| v.1),
        rebound_speed_m_per_s: leaving.map(|v| v.0),
        rebound_speed_std_m_per_s: leaving.map(|v| v.1),
        restitution: restitution.map(|e| e.0),
        restitution_std: restitution.map(|e| e.1),
        energy_kept: restitution.map(|(e, _)| e * e),
        energy_kept_std: restitution.map(|(e, std)| 2.0 * e * std),
    }
}

/// Standard error of the rebound height `h = g·T²/8` after impact `number`: `σ_h = g·T/4·√(s₁² + s₂²)`.
pub(super) fn rebound_height_std_m(
    timed: &[Impact],
    flights: &Flights,
    number: usize,
    gravity_m_per_s2: f64,
) -> Option<f64> {
    let flight_s = flights.after(number)?;
    let std_s = timed[number].std_s.hypot(timed[number + 1].std_s);
    Some(0.25 * gravity_m_per_s2 * flight_s * std_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::{Bounce as Bouncing, FlightLaw, Restitution, RestitutionLaw};
    use crate::random::SplitMix64;

    const G: f64 = 9.81;

    fn timed(times_s: &[f64], std_s: f64) -> Vec<Impact> {
        let impact = |&time_s: &f64| Impact::heard(time_s, std_s);
        times_s.iter().map(impact).collect()
    }

    /// A ball that has this contact and drag.
    fn ball(contact_time_s: f64, drag_per_s2: f64) -> BallModel {
        let restitution = RestitutionLaw::Constant(Restitution::new(0.9).unwrap());
        let bounce = Bouncing::Given {
            restitution,
            contact_time_s,
        };
        BallModel::new(FlightLaw::with_drag(G, drag_per_s2).unwrap(), bounce).unwrap()
    }

    /// The second impact of these.
    fn second(timed: &[Impact], ball: Option<&BallModel>) -> Bounce {
        bounce(timed, &Flights::between(timed), 1, ball, G)
    }

    #[test]
    fn without_air_and_contact_speeds_are_half_of_g_times_the_flights() {
        let found = second(&timed(&[0.0, 0.5, 0.9], 1e-4), None);
        for (value, expected) in [
            (found.impact_speed_m_per_s, 0.25 * G),
            (found.rebound_speed_m_per_s, 0.2 * G),
            (found.restitution, 0.8),
            (found.energy_kept, 0.64),
        ] {
            assert!((value.unwrap() - expected).abs() < 1e-12, "{found:?}");
        }
    }

    #[test]
    fn contact_and_drag_are_taken_out() {
        let law = FlightLaw::with_terminal_speed(G, 8.0).unwrap();
        let (first, contact_s) = (law.hop(2.4).unwrap(), 2e-3);
        let rebound = 0.9 * first.landing_speed_m_per_s;
        let arrival_s = first.time_s + contact_s;
        let next_s = arrival_s + law.hop(rebound).unwrap().time_s + contact_s;
        let ball = ball(contact_s, (G / 8.0).powi(2));
        let found = second(&timed(&[0.0, arrival_s, next_s], 1e-6), Some(&ball));
        assert!((found.restitution.unwrap() - 0.9).abs() < 1e-9);
        assert!((found.rebound_speed_m_per_s.unwrap() - rebound).abs() < 1e-9);
        let arrival = found.impact_speed_m_per_s.unwrap();
        assert!((arrival - first.landing_speed_m_per_s).abs() < 1e-9);
    }

    /// Standard deviation of what is read from times that err, over many tries.
    fn scattered(read: impl Fn(&[Impact]) -> f64, std_s: f64) -> f64 {
        const TRIES: usize = 4_000;
        let mut rng = SplitMix64::new(5);
        let mut values = Vec::with_capacity(TRIES);
        for _ in 0..TRIES {
            let times_s = [0.0, 0.5, 0.9].map(|t| t + std_s * rng.normal());
            values.push(read(&timed(&times_s, std_s)));
        }
        let mean = values.iter().sum::<f64>() / TRIES as f64;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        (squares / (TRIES - 1) as f64).sqrt()
    }

    #[test]
    fn errors_are_those_of_times_that_err() {
        const STD_S: f64 = 1e-4;
        let ball = ball(1e-3, 1.4);
        type Read = fn(&Bounce) -> Option<f64>;
        let pairs: [(Read, Read); 4] = [
            (|b| b.impact_speed_m_per_s, |b| b.impact_speed_std_m_per_s),
            (|b| b.rebound_speed_m_per_s, |b| b.rebound_speed_std_m_per_s),
            (|b| b.restitution, |b| b.restitution_std),
            (|b| b.energy_kept, |b| b.energy_kept_std),
        ];
        let stated = second(&timed(&[0.0, 0.5, 0.9], STD_S), Some(&ball));
        for (i, (value, std)) in pairs.into_iter().enumerate() {
            let seen = scattered(|t| value(&second(t, Some(&ball))).unwrap(), STD_S);
            let stated = std(&stated).unwrap();
            // The standard deviation of 4000 tries errs by 1.1 %.
            assert!((stated / seen - 1.0).abs() < 0.05, "{i}: {stated} {seen}");
        }
        let height = |t: &[Impact]| G * Flights::between(t).after(1).unwrap().powi(2) / 8.0;
        let times = timed(&[0.0, 0.5, 0.9], STD_S);
        let stated = rebound_height_std_m(&times, &Flights::between(&times), 1, G).unwrap();
        assert!((stated / scattered(height, STD_S) - 1.0).abs() < 0.05);
    }

    #[test]
    fn what_has_no_flight_beside_it_is_null() {
        let times = timed(&[0.0, 0.5, 0.9], 1e-6);
        let at = |number| bounce(&times, &Flights::between(&times), number, None, G);
        let (first, last) = (at(0), at(2));
        assert!(first.impact_speed_m_per_s.is_none() && first.restitution.is_none());
        assert!(first.rebound_speed_m_per_s.is_some() && first.energy_kept_std.is_none());
        assert!(last.impact_speed_m_per_s.is_some() && last.rebound_speed_m_per_s.is_none());
        let long = ball(0.45, 0.0);
        assert!(second(&times, Some(&long)).rebound_speed_m_per_s.is_none());
    }
}
