//! Drops whose truth is known, each with one thing wrong.

use super::*;
use crate::analysis::drop::{by_height, estimates};
use crate::analysis::model::fitted;
use crate::fit::irregular::Regularity;
use crate::physics::FlightLaw;
use crate::random::SplitMix64;

const G: f64 = 9.81;

/// A drop from a height, and how it is heard.
#[derive(Clone, Copy)]
struct Made {
    height_m: f64,
    e: f64,
    bounces: usize,
    terminal_speed: Option<f64>,
    contact_s: f64,
}

/// A ball that air and contact hardly matter to, heard until its flights are a few milliseconds.
const STEEL: Made = Made {
    height_m: 0.3,
    e: 0.9,
    bounces: 50,
    terminal_speed: None,
    contact_s: 1e-4,
};

/// A light ball: K is 1.24 s⁻².
const LIGHT: Made = Made {
    e: 0.93,
    bounces: 70,
    terminal_speed: Some(8.8),
    contact_s: 7e-4,
    ..STEEL
};

impl Made {
    /// The impacts by flight law, with 0.2 % scatter of the bounces and 1 µs of the times.
    fn impacts(&self) -> Vec<Impact> {
        let law = self.terminal_speed.map_or_else(
            || FlightLaw::without_air(G).unwrap(),
            |v| FlightLaw::with_terminal_speed(G, v).unwrap(),
        );
        let mut rng = SplitMix64::new(8);
        let mut speed = law.fall(self.height_m).unwrap().landing_speed_m_per_s;
        let mut time_s = 1.0;
        let impact = |_| {
            let impact = Impact::heard(time_s + 1e-6 * rng.normal(), 1e-6);
            let hop = law
                .hop(speed * self.e * (0.002 * rng.normal()).exp())
                .unwrap();
            time_s += hop.time_s + self.contact_s;
            speed = hop.landing_speed_m_per_s;
            impact
        };
        (0..self.bounces).map(impact).collect()
    }
}

fn with_height(height_m: f64) -> Settings {
    Settings {
        height_m: Some(height_m),
        ..Settings::default()
    }
}

/// The codes that these impacts call for.
fn codes(timed: &[Impact], settings: &Settings) -> Vec<&'static str> {
    let flights = Flights::between(timed);
    let ratio = flights.ratio().unwrap();
    let height_m = settings.height_m.unwrap();
    let height = by_height(timed, &flights, ratio.value, height_m, settings).unwrap();
    let estimates = estimates(Some(ratio), height.total, height.first_rebound);
    let regularity = Regularity::of(timed);
    let modelled = fitted(timed, &regularity.part, &regularity, settings).unwrap();
    let agreement = Agreement::of(timed, &flights, &estimates, &modelled, settings).unwrap();
    let disagreement = agreement.unwrap().warning();
    let warnings = height.warning.into_iter().chain(disagreement);
    warnings.map(|w| w.code.word()).collect()
}

#[test]
fn ways_that_agree_call_for_nothing() {
    // (19) makes n: the last flight is about as long as the contact that (20) gives.
    let whole = Made {
        contact_s: 0.0,
        bounces: 80,
        ..STEEL
    };
    assert_eq!(codes(&whole.impacts(), &with_height(0.3)), [""; 0]);
}

#[test]
fn the_drag_of_the_air_is_named() {
    assert_eq!(codes(&LIGHT.impacts(), &with_height(0.3)), ["air_drag"]);
    let model = crate::fit::model_selection::Choice::Constant;
    let constant = Settings {
        model,
        ..with_height(0.3)
    };
    assert_eq!(codes(&LIGHT.impacts(), &constant), ["air_drag"]);
}

/// The light ball with its mass and diameter. Its flights here have g and no buoyancy, so g is larger by what the air
/// takes off.
fn given(height_m: f64) -> Settings {
    Settings {
        mass_kg: Some(2.7e-3),
        diameter_m: Some(0.04),
        gravity_m_per_s2: G / 0.978,
        ..with_height(height_m)
    }
}

#[test]
fn drag_that_is_given_needs_no_warning_and_shows_a_wrong_height() {
    assert_eq!(codes(&LIGHT.impacts(), &given(0.3)), [""; 0]);
    for height_m in [0.285, 0.315] {
        assert_eq!(codes(&LIGHT.impacts(), &given(height_m)), ["wrong_height"]);
    }
}

#[test]
fn bounces_too_faint_to_hear_are_named() {
    let cut = Made {
        bounces: 36,
        ..STEEL
    };
    assert_eq!(
        codes(&cut.impacts(), &with_height(0.3)),
        ["bounces_unheard"]
    );
}

#[test]
fn a_wrong_height_is_named_whichever_way() {
    for (made, height_m) in [(STEEL, 0.33), (STEEL, 0.28), (LIGHT, 0.27)] {
        // As for the light ball below: the flights have what the air takes off.
        let gravity_m_per_s2 = made.terminal_speed.map_or(G, |_| G / 0.978);
        let settings = Settings {
            gravity_m_per_s2,
            ..with_height(height_m)
        };
        let codes = codes(&made.impacts(), &settings);
        assert_eq!(codes, ["wrong_height"], "{height_m} m, e {}", made.e);
    }
}

#[test]
fn a_height_that_is_not_sure_is_not_called_wrong() {
    let unsure = Settings {
        height_std_m: 0.03,
        ..with_height(0.33)
    };
    assert!(!codes(&STEEL.impacts(), &unsure).contains(&"wrong_height"));
}

#[test]
fn a_first_impact_that_is_missing_is_not_called_a_wrong_height() {
    for made in [STEEL, LIGHT] {
        let impacts = made.impacts();
        assert_eq!(
            codes(&impacts[1..], &with_height(0.3)),
            ["first_impact_missing"]
        );
    }
}

#[test]
fn a_total_time_that_is_too_long_has_no_known_cause() {
    let agreement = Agreement {
        bounces: 50,
        ratio: Value {
            value: 0.9,
            std: 1e-3,
        },
        eq25: None,
        eq30: Some(Value {
            value: 0.91,
            std: 1e-3,
        }),
        first: None,
        drag: Drag::Unknown,
    };
    assert_eq!(
        agreement.warning().unwrap().code,
        WarningCode::EstimatesDisagree
    );
    let cut = Agreement {
        eq30: None,
        ..agreement
    };
    assert!(cut.warning().is_none());
}
