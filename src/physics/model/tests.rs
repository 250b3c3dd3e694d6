//! Balls against their parts.

use super::*;

const G: f64 = 9.81;

fn given(restitution: RestitutionLaw) -> BallModel {
    let bounce = Bounce::Given {
        restitution,
        contact_time_s: 2e-3,
    };
    BallModel::new(FlightLaw::without_air(G).unwrap(), bounce).unwrap()
}

#[test]
fn restitution_and_contact_are_those_of_the_law() {
    let e = Restitution::new(0.9).unwrap();
    let constant = given(RestitutionLaw::Constant(e));
    assert_eq!(constant.restitution(3.0), Some(e));
    assert_eq!(constant.contact_time_s(3.0), Some(2e-3));
    assert_eq!(constant.restitution(-1.0), None);
    let visco = given(RestitutionLaw::Viscoelastic {
        gamma1: 2.0,
        gamma2: 0.0,
    });
    assert!(visco.restitution(1.0).is_none() && visco.restitution(0.01).is_some());
}

#[test]
fn a_linear_ball_is_the_exact_contact_and_stays_when_it_is_slow() {
    let ball = Oscillator::from_contact(Restitution::new(0.9).unwrap(), 2e-3).unwrap();
    let release_rule = ReleaseRule::ZeroDisplacement;
    let contact = LinearContact::new(ball, G, release_rule).unwrap();
    let flight = FlightLaw::without_air(G).unwrap();
    let model = BallModel::new(flight, Bounce::Linear { ball, release_rule }).unwrap();
    assert_eq!(model.rebound(1.0).unwrap(), contact.rebound(1.0).unwrap());
    assert_eq!(model.restitution(1e-4), None);
    let few = model.intervals(1.0).count();
    assert!((10..1000).contains(&few), "{few}");
}

#[test]
fn the_ends_of_an_interval_are_those_of_the_flight_in_it() {
    let e = Restitution::new(0.8).unwrap();
    let contact = LinearContact::with_restitution_at(e, 1.0, 8e-3, G).unwrap();
    let flight = FlightLaw::with_drag(G, 0.5).unwrap();
    let bounce = Bounce::Linear {
        ball: contact.oscillator(),
        release_rule: ReleaseRule::ZeroDisplacement,
    };
    let model = BallModel::new(flight, bounce).unwrap();
    for speed in [0.3, 0.8, 3.0] {
        let leaving = model
            .restitution(speed)
            .unwrap()
            .rebound_speed_m_per_s(speed);
        let interval_s = model.intervals(speed).next().unwrap();
        let contact_s = model.contact_time_s(speed).unwrap();
        assert!((model.contact_in_s(interval_s) / contact_s - 1.0).abs() < 1e-9);
        let found = 0.5 * G * model.ends(interval_s).unwrap().ln_leaving.exp();
        assert!(
            (found / leaving - 1.0).abs() < 1e-9,
            "{speed}: {found} {leaving}"
        );
    }
    assert!(model.contact_time_s(0.3).unwrap() > 1.02 * model.contact_time_s(3.0).unwrap());
}

#[test]
fn intervals_hold_contact_and_the_flight_with_drag() {
    let e = Restitution::new(0.9).unwrap();
    let bounce = Bounce::Given {
        restitution: RestitutionLaw::Constant(e),
        contact_time_s: 2e-3,
    };
    let flight = FlightLaw::with_drag(G, 1.2).unwrap();
    let model = BallModel::new(flight, bounce).unwrap();
    let hop = flight.hop(0.9 * 2.0).unwrap();
    let next = flight.hop(0.9 * hop.landing_speed_m_per_s).unwrap();
    let found: Vec<f64> = model.intervals(2.0).take(2).collect();
    for (found, hop) in found.iter().zip([hop, next]) {
        assert!((found - hop.time_s - 2e-3).abs() < 1e-15);
    }
}
