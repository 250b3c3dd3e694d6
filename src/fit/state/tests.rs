//! Rounds of linear fits on times of a known ball.

use super::*;
use crate::fit::least_squares::NormalEquations;
use crate::fit::model_kind::ModelKind;
use crate::fit::model_selection::{Choice, Inputs, select};
use crate::fit::posterior::{Model, Posterior};
use crate::physics::priors::CONTACT_S;
use crate::physics::{LinearContact, Oscillator, Rebound, ReleaseRule, Restitution};
use crate::random::SplitMix64;

/// Touches of a linear ball with its weight, each off by a random error of this size, which is what they state.
fn touches(e: f64, contact_s: f64, count: usize, std_s: f64) -> Vec<Impact> {
    let ball = Oscillator::from_contact(Restitution::new(e).unwrap(), contact_s).unwrap();
    let contact = LinearContact::new(ball, 9.81, ReleaseRule::ZeroDisplacement).unwrap();
    let mut rng = SplitMix64::new(3);
    let (mut time_s, mut speed) = (0.5, 2.0);
    let mut touches = Vec::new();
    for _ in 0..count {
        touches.push(Impact::heard(time_s + std_s * rng.normal(), std_s));
        let Rebound::Leaves(leaving) = contact.rebound(speed).unwrap() else {
            panic!("it leaves");
        };
        speed *= leaving.restitution.value();
        time_s += leaving.contact_time_s + 2.0 * speed / 9.81;
    }
    touches
}

#[test]
fn a_linear_ball_is_told_from_a_contact_by_exact_times() {
    for std_s in [1e-6, 1e-7] {
        let touches = touches(0.93, 80e-6, 65, std_s);
        let selection = select(&touches, &[], &Inputs::default(), Choice::Auto).unwrap();
        let gain = |model: ModelKind| {
            let mut candidates = selection.candidates.iter();
            candidates.find(|c| c.model == model).unwrap().gain_nats
        };
        let (linear, contact) = (gain(ModelKind::Linear), gain(ModelKind::Contact));
        assert!(linear >= contact, "{:?}", selection.candidates);
        // Constant e with a shorter contact is as likely and 1e-4 off: the interval holds both.
        let ball = Oscillator::from_contact(Restitution::new(0.93).unwrap(), 80e-6).unwrap();
        let contact = LinearContact::new(ball, 9.81, ReleaseRule::ZeroDisplacement).unwrap();
        let at_speed = 0.5 * 9.81 * selection.fit.mean_speed_s;
        let Rebound::Leaves(leaving) = contact.rebound(at_speed).unwrap() else {
            panic!("it leaves");
        };
        let truth = leaving.restitution.ln();
        let [low, high] = selection.fit.ln_restitution.interval95.unwrap();
        let width = high - low;
        assert!(
            (low..high).contains(&truth) && width < 5e-4,
            "{low} {truth} {high}"
        );
    }
}

#[test]
fn twice_the_rounds_and_a_tenth_of_the_move_change_no_evidence() {
    let known = |value, std| Some(Known { value, std });
    let (contact, drag) = (known(2e-3, 6e-3), known(1.0, 2.0));
    let terms = |contact, drag, law| Terms {
        contact,
        drag,
        speed: None,
        bend: None,
        law,
    };
    let mut compared = 0;
    for (e, contact_s, count, std_s) in [
        (0.93, 80e-6, 65, 1e-6),
        (0.9, 1e-3, 40, 1e-6),
        (0.9, 1e-3, 40, 1e-4),
        (0.8, 3e-3, 18, 1e-5),
    ] {
        let touches = touches(e, contact_s, count, std_s);
        for terms in [
            terms(contact, drag, ImpactLaw::Alike),
            terms(contact, None, ImpactLaw::Linear),
            terms(None, drag, ImpactLaw::Viscoelastic),
        ] {
            let evidence = |rest: f64, rounds: usize| {
                let mut state = State::new(&touches, &[], &terms);
                state.converge_to(rest, rounds).ok()?;
                let bounces = state.bounces()?;
                let noise = state.noise(&bounces);
                let model = Model {
                    ln_odds: 0.0,
                    priors: state.priors(),
                };
                let posterior = Posterior::over_noise(&bounces, &noise, &[model])?;
                Some(posterior.ln_evidence)
            };
            let usual = evidence(CONVERGED, MOST_ROUNDS);
            let longer = evidence(0.1 * CONVERGED, 2 * MOST_ROUNDS);
            let moved = usual.zip(longer).map(|(a, b)| (a - b).abs());
            assert!(moved.is_some_and(|m| m < 0.1), "{usual:?} {longer:?}");
            compared += 1;
        }
    }
    assert_eq!(compared, 12);
}

#[test]
fn a_contact_longer_than_the_flights_is_of_no_ball() {
    let touches = touches(0.9, 1e-3, 20, 1e-6);
    let terms = Terms {
        contact: Some(CONTACT_S),
        law: ImpactLaw::Linear,
        ..Terms::default()
    };
    let state = State::new(&touches, &[], &terms);
    let shortest_s = touches[19].time_s - touches[18].time_s;
    let greatest_s = state.priors()[CONTACT].greatest + state.values.contact_s;
    assert!((greatest_s - LONGEST_LINEAR_CONTACT * shortest_s).abs() < 1e-12);
    let bounces = state.bounces().unwrap();
    let noise = state.noise(&bounces);
    let sizes = Sizes {
        bounce: 0.01,
        timing: 1.0,
    };
    let equations = NormalEquations::of(&bounces, &noise, sizes, false).unwrap();
    let mut priors = state.priors();
    assert!(equations.ln_likelihood(&priors).is_some());
    priors[CONTACT] = Prior::new(0.1, 1e-6, 0.0).up_to(0.09);
    assert!(equations.ln_likelihood(&priors).is_none());
}
