//! e of the first impact by the height.

use super::super::model::Modelled;
use super::*;
use crate::event::Profile;
use crate::physics::priors::{DISPLACED, UNKNOWN_CONTACT_STD_S};
use crate::physics::{Air, FlightLaw, Sphere};
use crate::report::{Restitution, WarningCode};

const BALL: Sphere = Sphere {
    mass_kg: 0.0577,
    diameter_m: 0.067,
};

/// The first two impacts of a tennis ball from 2 m with e = 0.75, by a flight in air or none.
fn impacts(law: &FlightLaw, contact_s: f64) -> [Impact; 2] {
    let leaving = 0.75 * law.fall(2.0).unwrap().landing_speed_m_per_s;
    let flight_s = law.hop(leaving).unwrap().time_s;
    [1.0, 1.0 + flight_s + contact_s].map(|t| Impact::heard(t, 1e-6))
}

fn restitution(timed: &[Impact], settings: &Settings) -> Option<Restitution> {
    let answer = answer(timed, Modelled::default(), settings).unwrap();
    answer.modelled.restitution
}

#[test]
fn drag_and_contact_are_taken_out_where_the_ball_is_known() {
    let law = FlightLaw::in_air(9.81, BALL, Air::default()).unwrap();
    let settings = Settings::default()
        .height_m(2.0)
        .mass_kg(BALL.mass_kg)
        .diameter_m(BALL.diameter_m)
        .contact_time_s(5e-3);
    let e = restitution(&impacts(&law, 5e-3), &settings).unwrap();
    assert!((e.estimate.value - 0.75).abs() < 1e-9, "{e:?}");
    let bare = restitution(&impacts(&law, 5e-3), &Settings::default().height_m(2.0));
    assert!((bare.unwrap().estimate.value - 0.75).abs() > 0.005);
}

#[test]
fn a_contact_of_which_nothing_is_known_is_in_the_error() {
    let law = FlightLaw::without_air(9.81).unwrap();
    let timed = impacts(&law, 0.0);
    let e = restitution(&timed, &Settings::default().height_m(2.0)).unwrap();
    let by_contact = UNKNOWN_CONTACT_STD_S / (timed[1].time_s - timed[0].time_s);
    // Half of 3/2 of what balls at large displace.
    let expected = by_contact.hypot(0.75 * DISPLACED.std);
    let std = e.estimate.std_error.unwrap() / e.estimate.value;
    assert!((std / expected - 1.0).abs() < 0.02, "{std} {expected}");
}

#[test]
fn a_flight_longer_than_the_height_allows_gives_a_warning_and_no_e() {
    let law = FlightLaw::without_air(9.81).unwrap();
    let settings = Settings::default().height_m(1.0);
    let answer = answer(&impacts(&law, 0.0), Modelled::default(), &settings).unwrap();
    let codes: Vec<WarningCode> = answer.warnings.iter().map(|w| w.code).collect();
    assert_eq!(
        codes,
        [WarningCode::HeightTooSmall, WarningCode::FewBounces]
    );
    assert!(answer.modelled.restitution.is_none());
}

/// Sounds at these times, as events and as those that stand out.
fn sounds(times_s: &[f64]) -> (Vec<Event>, Vec<sequence::few::ClearSound>) {
    let event = |&time_s: &f64| Event {
        time_s,
        jitter_s: 5e-4,
        strength: 30.0,
        loudness: 3.0,
        profile: Profile::default(),
    };
    let clear = |&time_s: &f64| sequence::few::ClearSound {
        time_s,
        jitter_s: 5e-4,
        level: -1.0,
        is_short: true,
        is_new: true,
        profile: Profile::default(),
    };
    let events = times_s.iter().map(event).collect();
    (events, times_s.iter().map(clear).collect())
}

/// Flights of 0.4 s and four fifths of each before, among a sound that is none.
const SHRINKING_S: [f64; 7] = [1.0, 1.4, 1.72, 1.976, 2.1, 2.1808, 2.34464];

#[test]
fn impacts_that_follow_three_are_heard_with_them() {
    let (events, clear) = sounds(&SHRINKING_S);
    let three = |nats: f64| FewImpacts {
        impacts: clear[..3].to_vec(),
        nats,
        rival_nats: f64::NEG_INFINITY,
    };
    let chain = longer(&three(8.0), &events).unwrap();
    let found: Vec<f64> = chain.impacts.iter().map(|i| i.time_s).collect();
    assert_eq!(found, [1.0, 1.4, 1.72, 1.976, 2.1808, 2.34464]);
    assert!(longer(&three(5.0), &events).is_none(), "they are no drop");
    assert!(longer(&three(8.0), &events[..3]).is_none(), "none follows");
    let two = FewImpacts {
        impacts: clear[..2].to_vec(),
        ..three(8.0)
    };
    assert!(longer(&two, &events).is_none(), "two have no ratio");
}
