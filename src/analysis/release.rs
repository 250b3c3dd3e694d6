//! The height of release without a ruler, and gravity with one: by the first flights.

use super::Settings;
use super::course::Course;
use super::model::{self, Modelled};
use crate::Error;
use crate::fit::Estimate;
use crate::impact::Impact;
use crate::physics::priors::{ONE_BOUNCE, SPEED_EXPONENT_BEYOND};
use crate::physics::{BallModel, FlightLaw};
use crate::report::Release;
use crate::statistics::bisected;

/// The speed whose rebound is that heard is known once a step changes it by less than this share (convention): e changes so
/// little with the speed that each wins a digit.
const REST: f64 = 1e-12;
/// Steps at most; a law that has not come to rest by then has no such speed.
const LIMIT: usize = 100;
/// Halvings of the range of a height: to 10⁻¹² of it.
const HALVINGS: usize = 40;
/// With drag a fall is higher than without: by no more than this factor where the ball is half as fast as it can be.
const HIGHER: f64 = 4.0;

/// None where e is not known, or the contact fills the flight.
///
/// # Formula
/// ```text
/// u = g·(T₁ − C)/2,   v·e(v) = u,   h = v²/2g = g·T₁²/8e²        (with drag those of its flight and fall)
/// (σ_h/2h)² = (σ_e/e)² + s² + (0.05·ln(v/v₂))² + (σ_T/T₁)² + (σ_g/2g)²,   g = g₀·H/h by a known height H
/// ```
/// v₂ is the fastest speed that e was measured at, that of the second impact, and s by how much one bounce of balls at large is off
/// what the others say of it: 0.022. Without mass and diameter s is 0.053, as the flights tell drag badly and e of the fastest
/// impact rests on it: a ball of 40 mm from 0.9 m was off by 0.10 so, and by 0.05 with them.
pub(super) fn release(
    timed: &[Impact],
    flight_s: f64,
    modelled: &Modelled,
    settings: &Settings,
) -> Result<Option<Release>, Error> {
    let (Some(ball), Some(e)) = (&modelled.ball_model, &modelled.restitution) else {
        return Ok(None);
    };
    let course = Course::of(modelled, settings)?;
    let at = |off: f64| -> Result<Option<f64>, Error> {
        let Some(ends) = course.ends(flight_s, off) else {
            return Ok(None);
        };
        let speed = arrival(ball, course.leaving_m_per_s(&ends, off));
        speed.map(|v| height_m(&course.law(off)?, v)).transpose()
    };
    let (Some(middle), Some(less), Some(more), Some(ends)) =
        (at(0.0)?, at(-1.0)?, at(1.0)?, course.ends(flight_s, 0.0))
    else {
        return Ok(None);
    };
    let std_s = timed[0]
        .std_s
        .hypot(timed[1].std_s)
        .hypot(course.contact_s.1);
    let beyond = arrival(ball, course.leaving_m_per_s(&ends, 0.0))
        .map_or(0.0, |v| (v / course.landing_m_per_s(&ends)).ln());
    let of_e = e
        .estimate
        .std_error
        .map_or(ONE_BOUNCE.0, |std| std / e.estimate.value);
    let of_first = if model::law(settings)?.is_some() {
        ONE_BOUNCE.0
    } else {
        ONE_BOUNCE.1
    };
    let speed_std = of_e
        .hypot(of_first)
        .hypot(SPEED_EXPONENT_BEYOND * beyond)
        .hypot((ends.leaving_slope * std_s).hypot(settings.clock_std));
    let by_air = course.gravity_std().hypot(0.5 * (more / less).ln());
    let relative = (2.0 * speed_std).hypot(by_air);
    let gravity = settings.height_m.map(|given_m| {
        let by_height = settings.height_std_m / given_m;
        Estimate::with_relative_std(
            settings.gravity_m_per_s2 * given_m / middle,
            relative.hypot(by_height),
        )
    });
    Ok(Some(Release {
        height_m: Estimate::with_relative_std(middle, relative),
        gravity_m_per_s2: gravity,
    }))
}

/// The speed that a ball of this law leaves with `leaving` from.
fn arrival(ball: &BallModel, leaving: f64) -> Option<f64> {
    let mut speed = leaving;
    for _ in 0..LIMIT {
        let next = leaving / ball.restitution(speed)?.value();
        if (next / speed - 1.0).abs() < REST {
            return Some(next);
        }
        speed = next;
    }
    None
}

/// The height of the fall that ends with this speed.
fn height_m(law: &FlightLaw, speed: f64) -> Result<f64, Error> {
    let free = speed * speed / (2.0 * law.gravity_m_per_s2());
    let slower = |height: f64| {
        law.fall(height)
            .is_ok_and(|fall| fall.landing_speed_m_per_s < speed)
    };
    let height = bisected((0.5 * free, HIGHER * free), HALVINGS, slower);
    law.fall(height).map(|_| height)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::fit_times;
    use crate::physics::{Air, Sphere};

    const BALL: Sphere = Sphere {
        mass_kg: 0.0577,
        diameter_m: 0.067,
    };

    /// The impacts of a ball of e = 0.8 from 2 m, in air if it has a law.
    fn times(law: &FlightLaw, impacts: usize) -> Vec<f64> {
        let mut speed = law.fall(2.0).unwrap().landing_speed_m_per_s;
        let mut times = vec![1.0];
        for _ in 1..impacts {
            let hop = law.hop(0.8 * speed).unwrap();
            times.push(times[times.len() - 1] + hop.time_s);
            speed = hop.landing_speed_m_per_s;
        }
        times
    }

    fn found(times: Vec<f64>, settings: &Settings) -> Release {
        let times = times.into_iter().map(|t| (t, 1e-5)).collect();
        let analysis = fit_times(&[times], settings).unwrap();
        analysis.drops[0].release.clone().unwrap()
    }

    #[test]
    fn the_height_of_release_is_found_without_a_ruler_in_air_and_without() {
        let plain = found(
            times(&FlightLaw::without_air(9.81).unwrap(), 8),
            &Settings::default(),
        );
        assert!((plain.height_m.value / 2.0 - 1.0).abs() < 0.03, "{plain:?}");
        assert!(plain.gravity_m_per_s2.is_none());
        let law = FlightLaw::in_air(9.81, BALL, Air::default()).unwrap();
        let known = Settings::default()
            .mass_kg(BALL.mass_kg)
            .diameter_m(BALL.diameter_m)
            .contact_time_s(1e-6);
        let aired = found(times(&law, 8), &known);
        assert!((aired.height_m.value / 2.0 - 1.0).abs() < 0.01, "{aired:?}");
        let std = |release: &Release| release.height_m.std_error.unwrap();
        assert!(
            std(&aired) < std(&plain) && std(&aired) > 0.04 * 2.0,
            "{aired:?}"
        );
    }

    #[test]
    fn gravity_is_found_by_the_height() {
        let moon = times(&FlightLaw::without_air(1.62).unwrap(), 6);
        let settings = Settings::default()
            .height_m(2.0)
            .gravity_m_per_s2(1.7)
            .contact_time_s(1e-6);
        let gravity = found(moon, &settings).gravity_m_per_s2.unwrap();
        assert!((gravity.value / 1.62 - 1.0).abs() < 0.03, "{gravity:?}");
        // Three impacts: 8·h·(T₂/T₁)²/T₁².
        let three = found(
            vec![0.248, 0.955, 1.617],
            &Settings::default().height_m(0.7),
        );
        let expected = 5.6 * (0.662_f64 / 0.707).powi(2) / 0.707_f64.powi(2);
        let gravity = three.gravity_m_per_s2.unwrap();
        assert!(
            (gravity.value / expected - 1.0).abs() < 0.02,
            "{gravity:?} {expected}"
        );
        assert!((gravity.value - 9.81).abs() < gravity.std_error.unwrap());
    }

    #[test]
    fn one_flight_tells_no_release() {
        let settings = Settings::default().height_m(1.0);
        let analysis = fit_times(&[vec![(0.0, 1e-4), (0.8, 1e-4)]], &settings).unwrap();
        assert!(analysis.drops[0].release.is_none());
    }
}
