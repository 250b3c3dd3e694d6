//! The fit on drops of balls whose e depends on the speed.

use super::model_selection::{Choice, Inputs, select};
use crate::impact::Impact;
use crate::physics::priors::Known;
use crate::physics::{
    Air, FlightLaw, LinearContact, Oscillator, Rebound, ReleaseRule, Restitution, RestitutionLaw,
    Sphere,
};
use crate::random::SplitMix64;
use crate::units::real;

/// A drop of the linear ball with its weight, by the exact contact.
fn linear_drop(e: f64, contact_s: f64, impacts: usize, rng: &mut SplitMix64) -> Vec<Impact> {
    let ball = Oscillator::from_contact(Restitution::new(e).unwrap(), contact_s).unwrap();
    let contact = LinearContact::new(ball, 9.81, ReleaseRule::ZeroDisplacement).unwrap();
    let (mut at_s, mut speed) = (0.0, 0.3 * 9.81);
    let mut made = Vec::new();
    for _ in 0..impacts {
        made.push(Impact::heard(at_s + 5e-6 * rng.normal(), 5e-6));
        let Rebound::Leaves(leaving) = contact.rebound(speed).unwrap() else {
            panic!("it leaves");
        };
        speed = leaving.speed_m_per_s * (0.003 * rng.normal()).exp();
        at_s += leaving.contact_time_s + 2.0 * speed / 9.81;
    }
    made
}

#[test]
fn a_linear_balls_contact_and_e_come_back_with_its_own_model() {
    const DROPS: usize = 60;
    for (e, contact_s, impacts) in [(0.9_f64, 1e-3, 36), (0.8, 5e-3, 12)] {
        let mut rng = SplitMix64::new(12);
        let (mut contacts, mut fasts) = (0, 0);
        for _ in 0..DROPS {
            let made = linear_drop(e, contact_s, impacts, &mut rng);
            let selection = select(&made, &[], &Inputs::default(), Choice::Linear).unwrap();
            let [low, high] = selection.fit.contact_s.unwrap().interval95.unwrap();
            contacts += usize::from(low <= contact_s && contact_s <= high);
            let ball = selection.ball(9.81).unwrap().oscillator().unwrap();
            let fast = ball.restitution().unwrap().ln();
            let std = selection.fit.ln_restitution.std.unwrap();
            fasts += usize::from((fast - e.ln()).abs() < 3.0 * std);
        }
        assert!(
            contacts * 100 >= 80 * DROPS,
            "{contacts} of {DROPS} at {contact_s} s"
        );
        assert!(
            fasts * 100 >= 95 * DROPS,
            "{fasts} of {DROPS} at {contact_s} s"
        );
    }
}

#[test]
fn viscoelastic_spheres_are_told_from_a_constant_e_and_e_is_that_at_the_mean_speed() {
    let law = RestitutionLaw::Viscoelastic {
        gamma1: 0.07,
        gamma2: 0.6 * 0.07 * 0.07,
    };
    let mut rng = SplitMix64::new(15);
    let (mut held, mut told) = (0, 0);
    for _ in 0..60 {
        let (mut at_s, mut speed) = (0.0, 2.0);
        let mut impacts = Vec::new();
        for _ in 0..90 {
            impacts.push(Impact::heard(at_s + 1e-6 * rng.normal(), 1e-6));
            speed *= law.at(speed).unwrap().value() * (0.006 * rng.normal()).exp();
            at_s += 2.0 * speed / 9.81;
        }
        let selection = select(&impacts, &[], &Inputs::default(), Choice::Auto).unwrap();
        let truth = law
            .at(0.5 * 9.81 * selection.fit.mean_speed_s)
            .unwrap()
            .ln();
        let [low, high] = selection.fit.ln_restitution.interval95.unwrap();
        held += usize::from((low..high).contains(&truth));
        told += usize::from(selection.selected.is_by_speed());
    }
    assert!(held >= 52 && told >= 57, "{held} held, {told} told of 60");
}

#[test]
fn e_of_a_linear_ball_is_that_at_the_mean_speed_and_not_the_mean_over_its_impacts() {
    let (e, contact_s, impacts) = (0.88_f64, 2.2e-3, 34);
    let ball = Oscillator::from_contact(Restitution::new(e).unwrap(), contact_s).unwrap();
    let contact = LinearContact::new(ball, 9.81, ReleaseRule::ZeroDisplacement).unwrap();
    let ln_at = |speed: f64| match contact.rebound(speed).unwrap() {
        Rebound::Leaves(leaving) => leaving.restitution.ln(),
        Rebound::Stays => panic!("it leaves"),
    };
    let speeds = std::iter::successors(Some(0.3 * 9.81), |v| Some(v * ln_at(*v).exp()));
    let mean_ln = speeds.take(impacts - 2).map(ln_at).sum::<f64>() / real(impacts - 2);
    let mut rng = SplitMix64::new(14);
    let (mut off, mut apart, mut stds) = (0.0, 0.0, 0.0);
    for _ in 0..40 {
        let made = linear_drop(e, contact_s, impacts, &mut rng);
        let selection = select(&made, &[], &Inputs::default(), Choice::Linear).unwrap();
        let at_mean = ln_at(0.5 * 9.81 * selection.fit.mean_speed_s);
        off += selection.fit.ln_restitution.value - at_mean;
        apart += mean_ln - at_mean;
        stds += selection.fit.ln_restitution.std.unwrap();
    }
    // A mean of 40 is off by a sixth of one standard error, and by what is known of contacts at large, which are shorter; what
    // all impacts lose on average lies far beyond.
    assert!(off.abs() < 0.8 * stds, "{off} against {stds}");
    assert!(apart < -2.0 * stds, "{apart} against {stds}");
}

#[test]
fn a_light_ball_is_not_taken_for_a_duller_one_where_mass_and_diameter_are_given() {
    let ball = Sphere {
        mass_kg: 2.5e-3,
        diameter_m: 38e-3,
    };
    let law = FlightLaw::in_air(9.81, ball, Air::default()).unwrap();
    let rate = law.gravity_m_per_s2() / law.terminal_speed_m_per_s().unwrap();
    let inputs = Inputs {
        contact_s: None,
        drag_per_s2: Some(Known {
            value: rate * rate,
            std: 0.07 * rate * rate,
        }),
    };
    // Errors by drag of the first ratio and of the mean of 30.
    for (height_m, first_off, mean_off) in [(0.305, 0.026, 0.005), (1.0, 0.07, 0.011)] {
        let (mut at_s, mut speed) = (0.0, law.fall(height_m).unwrap().landing_speed_m_per_s);
        let mut impacts = Vec::new();
        for _ in 0..32 {
            impacts.push(Impact::heard(at_s, 1e-6));
            let hop = law.hop(0.93 * speed).unwrap();
            at_s += hop.time_s;
            speed = hop.landing_speed_m_per_s;
        }
        let flight = |i: usize| impacts[i + 1].time_s - impacts[i].time_s;
        let first = 0.93 - flight(1) / flight(0);
        let mean = 0.93 - (flight(30) / flight(0)).powf(1.0 / 30.0);
        assert!((first - first_off).abs() < 0.15 * first_off, "{first}");
        assert!((mean - mean_off).abs() < 0.15 * mean_off, "{mean}");
        let selection = select(&impacts, &[], &inputs, Choice::Drag).unwrap();
        let e = selection.fit.ln_restitution.value.exp();
        assert!((e - 0.93).abs() < 1e-4, "from {height_m} m: {e}");
    }
}
