//! What must hold for every ball: energy, limits, monotony, and answers instead of NaN.

use bounce_audio::physics::{
    Air, Bounce, BounceSeries, DropSetup, FlightLaw, Impact, InputErrors, LinearContact,
    Oscillator, Rebound, ReleaseRule, Restitution, RestitutionLaw, Scatter, Sphere,
};
use bounce_audio::random::SplitMix64;

const GRAVITY: f64 = 9.81;

/// A number from `low` to `high`, evenly in its logarithm.
fn spread(random: &mut SplitMix64, low: f64, high: f64) -> f64 {
    low * (high / low).powf(random.uniform())
}

fn constant(e: f64, contact_time_s: f64) -> Bounce {
    Bounce::Given {
        restitution: RestitutionLaw::Constant(Restitution::new(e).unwrap()),
        contact_time_s,
    }
}

fn free_fall() -> FlightLaw {
    FlightLaw::without_air(GRAVITY).unwrap()
}

fn impacts(setup: &DropSetup) -> Vec<Impact> {
    setup.impacts().unwrap().collect()
}

/// Drops of every kind, with and without drag and scatter.
fn all_kinds_of_drops() -> Vec<DropSetup> {
    let mut random = SplitMix64::new(3);
    let mut setups = Vec::new();
    for round in 0..40 {
        let ball = Oscillator::new(
            spread(&mut random, 300.0, 3e4),
            spread(&mut random, 1e-3, 0.6),
        )
        .unwrap();
        let linear = |release_rule| Bounce::Linear { ball, release_rule };
        let viscoelastic = Bounce::Given {
            restitution: RestitutionLaw::Viscoelastic {
                gamma1: 0.1,
                gamma2: 0.006,
            },
            contact_time_s: 1e-3,
        };
        let terminal = spread(&mut random, 3.0, 300.0);
        for bounce in [
            linear(ReleaseRule::ZeroDisplacement),
            linear(ReleaseRule::ZeroForce),
            constant(0.9, 1e-3),
            viscoelastic,
        ] {
            let height = spread(&mut random, 1e-3, 10.0);
            let flights = [
                free_fall(),
                FlightLaw::with_terminal_speed(GRAVITY, terminal).unwrap(),
            ];
            for flight in flights {
                let mut setup = DropSetup::new(height, flight, bounce);
                setups.push(setup);
                setup.scatter = Some(Scatter {
                    ln_restitution_std: 0.05,
                    seed: round,
                });
                setups.push(setup);
            }
        }
    }
    setups
}

#[test]
fn energy_never_grows() {
    for setup in all_kinds_of_drops() {
        let drop = impacts(&setup);
        let first = (2.0 * GRAVITY * setup.height_m).sqrt();
        assert!(drop[0].impact_speed_m_per_s <= first * (1.0 + 1e-15));
        for impact in &drop {
            assert!(
                impact.rebound_speed_m_per_s <= impact.impact_speed_m_per_s,
                "{impact:?} of {setup:?}"
            );
            let highest = impact.rebound_speed_m_per_s.powi(2) / (2.0 * GRAVITY);
            assert!(impact.apex_m <= highest * (1.0 + 1e-14), "{impact:?}");
        }
        for pair in drop.windows(2) {
            assert!(
                pair[1].impact_speed_m_per_s <= pair[0].rebound_speed_m_per_s,
                "{pair:?} of {setup:?}"
            );
        }
    }
}

#[test]
fn a_drop_ends_with_the_ball_at_rest_and_every_touch_after_the_last() {
    for setup in all_kinds_of_drops() {
        let drop = impacts(&setup);
        let last = drop.last().unwrap();
        assert!(last.flight_time_s == 0.0 && last.apex_m == 0.0, "{last:?}");
        for pair in drop.windows(2) {
            let interval = pair[0].contact_time_s.unwrap() + pair[0].flight_time_s;
            let measured = pair[1].time_s - pair[0].time_s;
            assert!(
                (measured - interval).abs() < 1e-14 * pair[1].time_s,
                "{pair:?}"
            );
        }
    }
}

#[test]
fn fast_impacts_tend_to_the_restitution_and_contact_time_without_weight() {
    let mut random = SplitMix64::new(5);
    for _ in 0..200 {
        let zeta = spread(&mut random, 1e-6, 0.5);
        let frequency = spread(&mut random, 100.0, 1e5);
        let ball = Oscillator::new(frequency, zeta).unwrap();
        let contact = LinearContact::new(ball, GRAVITY, ReleaseRule::ZeroDisplacement).unwrap();
        let limit = ball.restitution().unwrap();
        let e0 = limit.value();
        for small in [1e-4, 1e-6, 1e-8] {
            let speed = GRAVITY / (frequency * small);
            let Rebound::Leaves(leaving) = contact.rebound(speed).unwrap() else {
                panic!("ζ {zeta} stays at g/(ωv) = {small}");
            };
            // First order in g/(ωv); what is left is of second order.
            let slower = 2.0 * zeta * (1.0 + e0) * small;
            let shortfall = leaving.restitution.one_minus() - limit.one_minus();
            let second_order = 1e3 * zeta * (small / e0).powi(2) + 1e-14 * limit.one_minus();
            assert!(
                (shortfall - slower).abs() <= second_order,
                "ζ {zeta}, g/(ωv) {small}: {shortfall} and {slower}"
            );
            let longer = small * (1.0 + e0) / e0 / frequency;
            let excess = leaving.contact_time_s - ball.contact_time_s().unwrap();
            let second_order = (1e3 * (small / e0).powi(2) + 1e-14) / frequency;
            assert!(
                (excess - longer).abs() <= second_order,
                "ζ {zeta}: {excess} and {longer}"
            );
        }
    }
}

#[test]
fn without_air_is_the_limit_of_thin_air_to_the_last_bits() {
    let thin = FlightLaw::with_terminal_speed(GRAVITY, 1e30).unwrap();
    for x in [1e-9, 1e-3, 0.3, 7.0, 1e4] {
        let (hop, limit) = (thin.hop(x).unwrap(), free_fall().hop(x).unwrap());
        let (fall, fall_limit) = (thin.fall(x).unwrap(), free_fall().fall(x).unwrap());
        for (got, wanted) in [
            (hop.time_s, limit.time_s),
            (hop.apex_m, limit.apex_m),
            (hop.landing_speed_m_per_s, limit.landing_speed_m_per_s),
            (fall.time_s, fall_limit.time_s),
            (fall.landing_speed_m_per_s, fall_limit.landing_speed_m_per_s),
        ] {
            assert!(
                (got / wanted - 1.0).abs() <= 4.0 * f64::EPSILON,
                "{x}: {got} {wanted}"
            );
        }
    }
}

#[test]
fn far_beyond_terminal_speed_the_ball_falls_at_it() {
    let thick = FlightLaw::with_terminal_speed(GRAVITY, 0.1).unwrap();
    let fall = thick.fall(100.0).unwrap();
    let (time, speed) = (fall.time_s, fall.landing_speed_m_per_s);
    assert!((speed - 0.1).abs() < 1e-15, "{speed}");
    let late = 0.1 / GRAVITY * std::f64::consts::LN_2;
    assert!((time - 1000.0 - late).abs() < 1e-9, "{time}");
}

#[test]
fn drag_lowers_the_apparent_restitution_by_the_known_amounts() {
    let air = Air {
        drag_coefficient: 0.5,
        ..Air::default()
    };
    let steel = 7800.0 * std::f64::consts::FRAC_PI_6 * 0.025_f64.powi(3);
    for (name, mass_kg, diameter_m, offsets, unit) in [
        ("ping-pong", 0.0027, 0.040, [-0.0056, -0.031, -0.087], 1e-3),
        ("tennis", 0.0577, 0.067, [-0.0007, -0.0044, -0.0143], 1e-4),
        ("golf", 0.0459, 0.0427, [-0.0004, -0.0023, -0.0075], 1e-4),
        ("steel", steel, 0.025, [-0.0001, -0.0006, -0.0019], 1e-4),
    ] {
        let sphere = Sphere {
            mass_kg,
            diameter_m,
        };
        let terminal = bounce_audio::physics::terminal_speed_m_per_s(GRAVITY, sphere, air).unwrap();
        let law = FlightLaw::with_terminal_speed(GRAVITY, terminal).unwrap();
        for (height, expected) in [0.05, 0.3, 1.0_f64].into_iter().zip(offsets) {
            let first = law.hop((2.0 * GRAVITY * height).sqrt()).unwrap();
            let second = law.hop(0.9 * first.landing_speed_m_per_s).unwrap();
            let offset = second.time_s / first.time_s - 0.9;
            assert!(
                (offset - expected).abs() <= unit,
                "{name} at {height} m: {offset}"
            );
        }
    }
}

#[test]
fn air_carries_and_slows_a_ping_pong_ball_by_2_2_percent() {
    let sphere = Sphere {
        mass_kg: 0.0027,
        diameter_m: 0.040,
    };
    let law = FlightLaw::in_air(GRAVITY, sphere, Air::default()).unwrap();
    let ratio = law.gravity_m_per_s2() / GRAVITY;
    assert!((ratio - 0.978).abs() <= 0.5e-3, "{ratio}");
}

#[test]
fn total_time_grows_with_restitution_for_every_number_of_bounces() {
    let series = BounceSeries::new(0.305, GRAVITY).unwrap();
    for n in [1, 2, 3, 10, 70, 1000, 1_000_000] {
        let losses = (1..400).rev().map(|i| 10_f64.powf(-0.03 * f64::from(i)));
        let mut times: Vec<f64> = losses
            .map(|loss| Restitution::from_one_minus(loss).unwrap())
            .map(|e| series.total_time_s(e, n).unwrap())
            .collect();
        times.reverse();
        // Equal only where the total time no longer changes in its last digit.
        let grown = times.windows(2).filter(|pair| pair[1] > pair[0]).count();
        assert!(
            times
                .windows(2)
                .all(|pair| pair[1] >= pair[0] * (1.0 - 1e-15)),
            "n = {n}"
        );
        assert!(grown > 100, "n = {n}: {grown}");
        let (lowest, highest) = series.attainable_total_time_s(n).unwrap();
        assert!(lowest < times[0] && times[398] <= highest, "n = {n}");
    }
}

#[test]
fn the_papers_own_ball_is_found_again_from_its_bounces() {
    let mut random = SplitMix64::new(9);
    for _ in 0..200 {
        let height = spread(&mut random, 1e-2, 10.0);
        let loss = spread(&mut random, 0.02, 0.5);
        let n = 2 + usize::try_from(random.next_u64() % 80).unwrap();
        let e = Restitution::from_one_minus(loss).unwrap();
        let series = BounceSeries::new(height, GRAVITY).unwrap();
        let contact_time_s = series.rest_contact_time_s(e, n).unwrap();
        let total = series.total_time_s(e, n).unwrap();

        // Played out: with this contact time it is the n-th impact after which the ball rests.
        let setup = DropSetup::new(
            height,
            free_fall(),
            constant(e.value(), contact_time_s * (1.0 + 1e-9)),
        );
        let drop = impacts(&setup);
        assert_eq!(drop.len(), n, "e {}, n {n}", e.value());
        let played = drop[n - 1].time_s + contact_time_s;
        assert!((played / total - 1.0).abs() < 1e-8, "{played} {total}");

        // And back: both inverses find e.
        for found in [
            series.restitution_from_total_time(n, total).unwrap(),
            series
                .restitution_with_contact_time(n, total, contact_time_s)
                .unwrap(),
        ] {
            let error = found.restitution.one_minus() / loss - 1.0;
            assert!(error.abs() < 1e-12, "e {}, n {n}: {error}", e.value());
        }
        let endless = series.total_time_approx_s(e).unwrap();
        let found = series.restitution_from_total_time_approx(endless).unwrap();
        assert!((found.restitution.one_minus() / loss - 1.0).abs() < 1e-13);
    }
}

#[test]
fn the_derivatives_of_an_inverse_are_its_differences() {
    type Inverse = fn(&[f64; 4]) -> bounce_audio::physics::Inversion;
    let at_rest: Inverse = |&[total, height, gravity, _]| {
        let series = BounceSeries::new(height, gravity).unwrap();
        series.restitution_from_total_time(70, total).unwrap()
    };
    let with_contact: Inverse = |&[total, height, gravity, contact]| {
        let series = BounceSeries::new(height, gravity).unwrap();
        (series.restitution_with_contact_time(70, total, contact)).unwrap()
    };
    let endless: Inverse = |&[total, height, gravity, _]| {
        let series = BounceSeries::new(height, gravity).unwrap();
        series.restitution_from_total_time_approx(total).unwrap()
    };
    let point = [7.5, 0.305, GRAVITY, 1e-3];
    for inverse in [at_rest, with_contact, endless] {
        let found = inverse(&point);
        let derivatives = [
            found.per_total_time_per_s,
            found.per_height_per_m,
            found.per_gravity_s2_per_m,
            found.per_contact_time_per_s,
        ];
        for (i, analytic) in derivatives.into_iter().enumerate() {
            let step = 1e-5 * point[i];
            let moved = |by: f64| {
                let mut inputs = point;
                inputs[i] += by;
                inverse(&inputs).restitution.value()
            };
            let numeric = (moved(step) - moved(-step)) / (2.0 * step);
            assert!(
                (numeric - analytic).abs() <= 1e-7 * analytic.abs() + 1e-12,
                "input {i} of {:?}: {numeric} {analytic}",
                found.equation
            );
        }
        let errors = InputErrors {
            total_time_s: 0.1,
            height_m: 0.002,
            ..InputErrors::default()
        };
        let expected = (derivatives[0] * 0.1).hypot(derivatives[1] * 0.002);
        assert!((found.std_error(&errors).unwrap() - expected).abs() < 1e-16);
    }
}

#[test]
fn a_seed_gives_the_same_drop_and_the_asked_scatter() {
    let mut setup = DropSetup::new(1.0, free_fall(), constant(0.999, 0.0));
    setup.most_impacts = Some(4000);
    setup.scatter = Some(Scatter {
        ln_restitution_std: 1e-4,
        seed: 42,
    });
    let drop = impacts(&setup);
    assert_eq!(drop, impacts(&setup));
    let logs: Vec<f64> = drop
        .iter()
        .map(|i| i.restitution().ln() - 0.999_f64.ln())
        .collect();
    let square = logs.iter().map(|x| x * x).sum::<f64>() / 4000.0;
    assert!((square.sqrt() / 1e-4 - 1.0).abs() < 0.05, "{square}");
}

#[test]
fn a_drop_without_contact_time_needs_a_limit_and_keeps_it() {
    let mut setup = DropSetup::new(1.0, free_fall(), constant(0.9, 0.0));
    let error = setup.impacts().unwrap_err().to_string();
    assert!(
        error.contains("most_impacts") && error.contains("shortest_flight_s"),
        "{error}"
    );
    setup.most_impacts = Some(17);
    assert_eq!(impacts(&setup).len(), 17);
    setup.most_impacts = None;
    setup.shortest_flight_s = Some(0.01);
    let drop = impacts(&setup);
    let (last, before) = (drop[drop.len() - 1], drop[drop.len() - 2]);
    assert!(
        last.flight_time_s < 0.01 && before.flight_time_s >= 0.01,
        "{last:?}"
    );
}

#[test]
fn a_drop_is_the_same_to_the_last_bit_on_every_machine() {
    let setup = DropSetup {
        scatter: Some(Scatter {
            ln_restitution_std: 0.005,
            seed: 2020,
        }),
        ..DropSetup::new(
            0.305,
            FlightLaw::with_terminal_speed(GRAVITY, 8.0).unwrap(),
            Bounce::Linear {
                ball: Oscillator::new(3142.0, 0.0231).unwrap(),
                release_rule: ReleaseRule::ZeroDisplacement,
            },
        )
    };
    let drop = impacts(&setup);
    let last = drop.last().unwrap();
    assert_eq!(
        (
            drop.len(),
            last.time_s.to_bits(),
            last.impact_speed_m_per_s.to_bits()
        ),
        (78, 4_618_193_600_728_766_890, 4_560_409_409_221_699_851),
    );
}

#[test]
fn a_bounce_with_a_factor_loses_as_much_more_and_none_makes_energy() {
    for setup in all_kinds_of_drops() {
        let plain = impacts(&setup);
        let mut changed = setup.impacts().unwrap();
        let (first, second) = (changed.next_with(0.8), changed.next_with(50.0));
        let first = first.unwrap();
        let expected = 0.8 * plain[0].rebound_speed_m_per_s;
        // A ball that then lies deeper than it would rise rests.
        let rests = first.rebound_speed_m_per_s <= 0.0;
        assert!(rests || (first.rebound_speed_m_per_s - expected).abs() < 1e-12 * expected);
        if let Some(second) = second {
            assert!(second.rebound_speed_m_per_s <= second.impact_speed_m_per_s);
        }
    }
}
