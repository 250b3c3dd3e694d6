//! Contact of the linear ball with its weight, against numbers computed from its differential equation.

use bounce_audio::physics::{
    Bounce, DropSetup, FlightLaw, Leaving, LinearContact, Oscillator, Rebound, ReleaseRule,
    Restitution,
};

const GRAVITY: f64 = 9.81;

fn leaving(contact: &LinearContact, speed_m_per_s: f64) -> Leaving {
    match contact.rebound(speed_m_per_s).unwrap() {
        Rebound::Leaves(leaving) => leaving,
        Rebound::Stays => panic!("{contact:?} stays at {speed_m_per_s} m/s"),
    }
}

fn ball_of(restitution: f64, contact_time_s: f64) -> Oscillator {
    Oscillator::from_contact(Restitution::new(restitution).unwrap(), contact_time_s).unwrap()
}

fn at_zero_displacement(ball: Oscillator) -> LinearContact {
    LinearContact::new(ball, GRAVITY, ReleaseRule::ZeroDisplacement).unwrap()
}

/// Release speed, time and position by Runge and Kutta's method, in units of `g/ω` and `1/ω`.
fn by_time_steps(zeta: f64, impact: f64, rule: ReleaseRule) -> Option<(f64, f64)> {
    let acceleration = |x: f64, v: f64| -1.0 - 2.0 * zeta * v - x;
    let held = |x: f64, v: f64| match rule {
        ReleaseRule::ZeroDisplacement => -x,
        ReleaseRule::ZeroForce => -x - 2.0 * zeta * v,
        other => panic!("no force for {other:?}"),
    };
    let step = 1e-4;
    let (mut x, mut v, mut time) = (0.0, -impact, 0.0);
    while time < 40.0 {
        let (x1, v1) = (v, acceleration(x, v));
        let (x2, v2) = (
            v + 0.5 * step * v1,
            acceleration(x + 0.5 * step * x1, v + 0.5 * step * v1),
        );
        let (x3, v3) = (
            v + 0.5 * step * v2,
            acceleration(x + 0.5 * step * x2, v + 0.5 * step * v2),
        );
        let (x4, v4) = (v + step * v3, acceleration(x + step * x3, v + step * v3));
        let (next_x, next_v) = (
            x + step / 6.0 * (x1 + 2.0 * x2 + 2.0 * x3 + x4),
            v + step / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4),
        );
        let (before, after) = (held(x, v), held(next_x, next_v));
        if time > 0.0 && after <= 0.0 {
            let part = before / (before - after);
            return Some((v + part * (next_v - v), time + part * step));
        }
        (x, v, time) = (next_x, next_v, time + step);
    }
    None
}

#[test]
fn the_closed_form_is_the_motion() {
    let mut left = 0;
    for rule in [ReleaseRule::ZeroDisplacement, ReleaseRule::ZeroForce] {
        for zeta in [0.0, 0.01, 0.2, 0.6, 0.9, 1.0, 1.7] {
            for impact in [0.05, 0.5, 2.0, 4.0, 30.0, 1000.0] {
                if zeta >= 1.0 && rule == ReleaseRule::ZeroDisplacement {
                    continue;
                }
                let ball = Oscillator::new(1.0, zeta).unwrap();
                let contact = LinearContact::new(ball, 1.0, rule).unwrap();
                let got = contact.rebound(impact).unwrap();
                let case = format!("{rule:?}, ζ {zeta}, u {impact}: {got:?}");
                match (got, by_time_steps(zeta, impact, rule)) {
                    (Rebound::Leaves(got), Some((speed, time))) => {
                        left += 1;
                        assert!(
                            (got.speed_m_per_s - speed).abs() < 1e-7 * (1.0 + impact),
                            "{case}: {speed}"
                        );
                        assert!(
                            (got.contact_time_s - time).abs() < 1e-6 * time,
                            "{case}: {time}"
                        );
                        let at_release = got.position_m + 2.0 * zeta * got.speed_m_per_s;
                        let held = match rule {
                            ReleaseRule::ZeroDisplacement => got.position_m,
                            ReleaseRule::ZeroForce => at_release,
                            other => panic!("no force for {other:?}"),
                        };
                        assert!(held.abs() < 1e-12 * impact, "{case}");
                    }
                    (Rebound::Stays, None) => {}
                    (_, stepped) => panic!("{case}: by time steps {stepped:?}"),
                }
            }
        }
    }
    assert_eq!(left, 37, "cases that left the surface");
}

#[test]
fn restitution_falls_at_low_speed_as_computed_from_the_motion() {
    for (contact_time_s, speed, expected) in [
        (1e-3, 1.0, 0.8996),
        (1e-3, 0.1, 0.8959),
        (1e-3, 0.03, 0.8855),
        (5e-3, 1.0, 0.8980),
        (5e-3, 0.1, 0.8773),
        (5e-3, 0.03, 0.7964),
    ] {
        let contact = at_zero_displacement(ball_of(0.9, contact_time_s));
        let e = leaving(&contact, speed).restitution.value();
        assert!(
            (e - expected).abs() <= 0.5e-4,
            "{contact_time_s} s at {speed} m/s: {e}"
        );
    }
}

#[test]
fn a_surface_that_cannot_pull_gives_the_known_restitution() {
    for (zeta, pulled, pushed) in [(0.05, 0.8545, 0.8588), (0.10, 0.7292, 0.7441)] {
        let ball = Oscillator::new(1e6, zeta).unwrap();
        let pulling = leaving(&at_zero_displacement(ball), 100.0);
        let contact = LinearContact::new(ball, GRAVITY, ReleaseRule::ZeroForce).unwrap();
        let pushing = leaving(&contact, 100.0);
        assert!(
            (pulling.restitution.value() - pulled).abs() <= 0.5e-4,
            "{pulling:?}"
        );
        assert!(
            (pushing.restitution.value() - pushed).abs() <= 0.5e-4,
            "{pushing:?}"
        );
        assert_eq!(pushing.release_rule, ReleaseRule::ZeroForce);
    }
    let critical = Oscillator::new(1e6, 1.0).unwrap();
    let contact = LinearContact::new(critical, GRAVITY, ReleaseRule::ZeroForce).unwrap();
    let e = leaving(&contact, 100.0).restitution.value();
    assert!((e - (-2.0_f64).exp()).abs() < 1e-6, "{e}");
}

#[test]
fn the_ball_stops_leaving_where_the_motion_says() {
    for (restitution, expected) in [(0.9, 0.71), (0.5, 2.95)] {
        let ball = ball_of(restitution, 1e-3);
        let contact = at_zero_displacement(ball);
        let grazing = contact.least_leaving_speed_m_per_s().unwrap();
        let unit = GRAVITY / ball.natural_frequency_rad_per_s();
        assert!(
            (grazing / unit - expected).abs() <= 0.5e-2,
            "{}",
            grazing / unit
        );
        assert_eq!(
            contact.rebound(grazing * (1.0 - 1e-9)).unwrap(),
            Rebound::Stays
        );
        let speed = leaving(&contact, grazing * (1.0 + 1e-9)).speed_m_per_s;
        assert!(speed > 0.0 && speed < 1e-3 * grazing, "{speed}");
    }
}

#[test]
fn an_undamped_ball_always_leaves_as_fast_as_it_came() {
    let contact = at_zero_displacement(Oscillator::new(3000.0, 0.0).unwrap());
    assert_eq!(contact.least_leaving_speed_m_per_s(), Some(0.0));
    for speed in [1e-50, 1e-9, 0.003, 1.0, 100.0, 1e50] {
        assert_eq!(leaving(&contact, speed).restitution, Restitution::ELASTIC);
    }
}

#[test]
fn the_papers_ball_makes_86_bounces_where_its_rest_condition_asks_for_92() {
    let series = bounce_audio::physics::BounceSeries::new(0.305, GRAVITY).unwrap();
    let e = series
        .restitution_from_total_time(70, 7.5)
        .unwrap()
        .restitution;
    let asked = series.bounces_to_rest(e, 1e-3).unwrap();
    assert!((asked - 92.0).abs() < 0.5, "{asked}");
    let setup = DropSetup::new(
        0.305,
        FlightLaw::without_air(GRAVITY).unwrap(),
        Bounce::Linear {
            ball: Oscillator::from_contact(e, 1e-3).unwrap(),
            release_rule: ReleaseRule::ZeroDisplacement,
        },
    );
    // 86 impacts; after the last of them the ball stays.
    let impacts: Vec<_> = setup.impacts().unwrap().collect();
    assert_eq!(impacts.len(), 86);
    assert!(impacts[85].contact_time_s.is_none() && impacts[84].flight_time_s > 0.0);
}

#[test]
fn with_weight_the_intervals_are_geometric_plus_a_fifth_of_the_contact_time() {
    let ball = ball_of(0.9, 1e-3);
    let (zeta, frequency) = (ball.damping_ratio(), ball.natural_frequency_rad_per_s());
    let first_order = 1e-3 - 4.0 * zeta * 1.9 / (frequency * 0.1);
    assert!((first_order / 1e-3 - 0.19).abs() < 0.005, "{first_order}");
    let bounce = Bounce::Linear {
        ball,
        release_rule: ReleaseRule::ZeroDisplacement,
    };
    let flight = FlightLaw::without_air(GRAVITY).unwrap();
    let drop: Vec<_> = (DropSetup::new(0.3, flight, bounce).impacts().unwrap()).collect();
    let intervals: Vec<f64> = drop
        .windows(2)
        .map(|pair| pair[1].time_s - pair[0].time_s)
        .collect();
    for step in [10, 15, 19] {
        // Three terms of a·rⁱ + C give C.
        let [a, b, c] = [intervals[0], intervals[step], intervals[2 * step]];
        let constant = (a * c - b * b) / (a + c - 2.0 * b) / 1e-3;
        assert!(
            (0.19..0.225).contains(&constant),
            "over {} impacts: {constant}",
            2 * step
        );
    }
}
