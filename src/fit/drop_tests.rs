//! The fit on drops whose e, contact, drag and noises are known.

use super::bounces::{ImpactLaw, Terms};
use super::model_kind::ModelKind;
use super::model_selection::{Choice, Inputs, fit, select};
use crate::impact::Impact;
use crate::physics::FlightLaw;
use crate::physics::priors::Known;
use crate::random::SplitMix64;
use crate::units::real;

/// A drop from 0.8 s of first flight.
#[derive(Debug, Clone, Copy)]
struct Made {
    e: f64,
    impacts: usize,
    contact_s: f64,
    terminal_speed: Option<f64>,
    time_std_s: f64,
    bounce_std: f64,
}

const STEEL: Made = Made {
    e: 0.9,
    impacts: 30,
    contact_s: 0.0,
    terminal_speed: None,
    time_std_s: 5e-6,
    bounce_std: 0.004,
};

impl Made {
    fn impacts(&self, rng: &mut SplitMix64) -> Vec<Impact> {
        let law = self.terminal_speed.map_or_else(
            || FlightLaw::without_air(9.81).unwrap(),
            |v| FlightLaw::with_terminal_speed(9.81, v).unwrap(),
        );
        let (mut at_s, mut speed) = (0.0, 0.4 * 9.81);
        let mut impacts = Vec::new();
        for _ in 0..self.impacts {
            impacts.push(Impact::heard(
                at_s + self.time_std_s * rng.normal(),
                self.time_std_s,
            ));
            let hop = law.hop(speed).unwrap();
            at_s += hop.time_s + self.contact_s;
            speed = hop.landing_speed_m_per_s * self.e * (self.bounce_std * rng.normal()).exp();
        }
        impacts
    }

    /// How often the interval of the model holds e, in this many drops.
    fn coverage(&self, terms: &Terms, drops: usize) -> f64 {
        let mut rng = SplitMix64::new(3);
        let held = (0..drops).filter(|_| {
            let fit = fit(&self.impacts(&mut rng), terms).unwrap();
            let [low, high] = fit.ln_restitution.interval95.unwrap();
            (low..high).contains(&self.e.ln())
        });
        real(held.count()) / real(drops)
    }
}

/// Four standard errors of a share of 0.95 in 400 drops are 0.044.
const DROPS: usize = 400;
const COVERAGE: std::ops::Range<f64> = 0.906..0.994;

#[test]
fn the_interval_holds_e_as_often_as_it_says_where_bounces_scatter() {
    for (time_std_s, bounce_std, impacts) in [(1e-6, 0.005, 5), (1e-6, 0.02, 12), (2e-4, 0.02, 12)]
    {
        let made = Made {
            time_std_s,
            bounce_std,
            impacts,
            ..STEEL
        };
        let share = made.coverage(&Terms::default(), DROPS);
        assert!(COVERAGE.contains(&share), "{made:?}: {share}");
    }
}

#[test]
fn the_interval_holds_e_at_least_as_often_where_the_times_rule() {
    // A scatter that the times hide cannot be ruled out, so the interval leaves room for it and holds e too often.
    for (bounce_std, impacts) in [(0.005, 12), (0.002, 30), (0.0, 20)] {
        let made = Made {
            time_std_s: 2e-4,
            bounce_std,
            impacts,
            ..STEEL
        };
        let share = made.coverage(&Terms::default(), DROPS);
        assert!(share >= COVERAGE.start, "{made:?}: {share}");
    }
}

#[test]
fn contact_and_drag_that_are_fitted_keep_the_interval_true() {
    let made = Made {
        e: 0.93,
        impacts: 50,
        contact_s: 2e-3,
        terminal_speed: Some(8.3),
        ..STEEL
    };
    let terms = Terms {
        contact: Some(Known {
            value: 2e-3,
            std: 4e-3,
        }),
        drag: Some(Known {
            value: 1.0,
            std: 2.0,
        }),
        speed: None,
        bend: None,
        law: ImpactLaw::Alike,
    };
    let share = made.coverage(&terms, DROPS);
    assert!(COVERAGE.contains(&share), "{share}");
}

#[test]
fn the_air_that_slows_a_heavy_ball_unseen_is_in_the_interval() {
    // A ball of 50 g and 3 cm: its drag gains nothing, and yet moves e by 0.001.
    let made = Made {
        e: 0.97,
        impacts: 90,
        terminal_speed: Some(50.0),
        time_std_s: 1e-6,
        bounce_std: 0.002,
        ..STEEL
    };
    let mut rng = SplitMix64::new(16);
    let (mut held, mut told) = (0, 0);
    for _ in 0..100 {
        let selection = select(
            &made.impacts(&mut rng),
            &[],
            &Inputs::default(),
            Choice::Auto,
        )
        .unwrap();
        let [low, high] = selection.fit.ln_restitution.interval95.unwrap();
        held += usize::from((low..high).contains(&made.e.ln()));
        told += usize::from(selection.fit.drag_per_s2.is_some());
    }
    assert!(held >= 90 && told <= 10, "{held} held, {told} with a drag");
}

#[test]
fn models_are_selected_as_far_as_the_drop_supports() {
    let mut rng = SplitMix64::new(5);
    let plain = select(
        &STEEL.impacts(&mut rng),
        &[],
        &Inputs::default(),
        Choice::Auto,
    )
    .unwrap();
    assert_eq!(plain.selected, ModelKind::Constant);
    let soft = Made {
        contact_s: 5e-3,
        bounce_std: 0.002,
        ..STEEL
    };
    let soft = select(
        &soft.impacts(&mut rng),
        &[],
        &Inputs::default(),
        Choice::Auto,
    )
    .unwrap();
    assert_eq!(soft.selected, ModelKind::Contact);
    assert!((soft.fit.contact_s.unwrap().value - 5e-3).abs() < 1e-3);
    let light = Made {
        e: 0.93,
        impacts: 45,
        terminal_speed: Some(8.3),
        bounce_std: 0.002,
        ..STEEL
    };
    let light = select(
        &light.impacts(&mut rng),
        &[],
        &Inputs::default(),
        Choice::Drag,
    )
    .unwrap();
    let drag = light.fit.drag_per_s2.unwrap();
    assert!((drag.value - (9.81_f64 / 8.3).powi(2)).abs() < 4.0 * drag.std.unwrap());
    assert!((light.fit.ln_restitution.value.exp() - 0.93).abs() < 2e-3);
}

#[test]
fn a_drag_that_is_known_is_in_every_model_and_no_candidate_of_its_own() {
    let mut rng = SplitMix64::new(6);
    let light = Made {
        terminal_speed: Some(8.3),
        ..STEEL
    };
    let inputs = Inputs {
        contact_s: None,
        drag_per_s2: Some(Known {
            value: (9.81_f64 / 8.3).powi(2),
            std: 0.1,
        }),
    };
    let selection = select(&light.impacts(&mut rng), &[], &inputs, Choice::Auto).unwrap();
    assert!(selection.fit.drag_per_s2.is_some());
    let mut named = selection.candidates.iter().map(|c| c.model);
    assert!(named.all(|m| m == ModelKind::Flexible || !m.has_drag()));
}

#[test]
fn a_bounce_that_is_left_out_may_have_lost_any_part_of_the_speed() {
    let mut rng = SplitMix64::new(11);
    let clean = STEEL.impacts(&mut rng);
    let with_loss = |share: f64| {
        let mut impacts = clean.clone();
        let at = clean[8].time_s;
        for impact in &mut impacts[9..] {
            impact.time_s = at + share * (impact.time_s - at);
        }
        let selection = select(&impacts, &[8], &Inputs::default(), Choice::Constant).unwrap();
        selection.fit.ln_restitution
    };
    let (less, more) = (with_loss(0.9), with_loss(0.7));
    let std = less.std.unwrap();
    assert!(
        (less.value - more.value).abs() < 0.1 * std,
        "{less:?} {more:?}"
    );
    assert!((std / more.std.unwrap() - 1.0).abs() < 0.1);
}

#[test]
fn outliers_do_not_own_the_answer() {
    let mut rng = SplitMix64::new(8);
    let clean = STEEL.impacts(&mut rng);
    let expected = fit(&clean, &Terms::default()).unwrap().ln_restitution;
    let mut late = clean.clone();
    late[28].time_s += 4e-3;
    let fitted = fit(&late, &Terms::default()).unwrap();
    assert_eq!(fitted.outliers.times, [28]);
    let off = (fitted.ln_restitution.value - expected.value).abs();
    assert!(off < expected.std.unwrap(), "{off}");
    let mut several = clean;
    for number in [20, 23, 26, 28] {
        several[number].time_s += 4e-3;
    }
    let fitted = fit(&several, &Terms::default()).unwrap();
    let off = (fitted.ln_restitution.value - expected.value).abs();
    assert!(off < 2.0 * expected.std.unwrap(), "{off}");
}

#[test]
fn three_impacts_give_one_ratio_and_two_give_nothing() {
    let mut rng = SplitMix64::new(9);
    let impacts = STEEL.impacts(&mut rng);
    let one = fit(&impacts[..3], &Terms::default())
        .unwrap()
        .ln_restitution;
    assert!(one.interval95.is_none() && one.std.is_none());
    assert!((one.value.exp() - 0.9).abs() < 0.02);
    assert!(fit(&impacts[..2], &Terms::default()).is_none());
}

#[test]
fn the_budget_names_the_noise_that_rules_and_adds_up() {
    let mut rng = SplitMix64::new(10);
    let scattering = fit(&STEEL.impacts(&mut rng), &Terms::default())
        .unwrap()
        .budget;
    assert!(scattering.bounce > 0.8, "{scattering:?}");
    let jittering = Made {
        time_std_s: 1e-3,
        bounce_std: 0.0,
        impacts: 20,
        ..STEEL
    };
    let jittering = fit(&jittering.impacts(&mut rng), &Terms::default())
        .unwrap()
        .budget;
    assert!(jittering.timing > scattering.timing, "{jittering:?}");
    for b in [scattering, jittering] {
        assert!((b.timing + b.bounce + b.inputs + b.noise_sizes + b.model - 1.0).abs() < 1e-9);
    }
}
