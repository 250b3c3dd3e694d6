//! What comes in: every invalid number is refused by name and range, every valid one gets a finite answer.

use bounce_audio::Error;
use bounce_audio::physics::{
    Air, Ball, Bounce, BounceSeries, DropSetup, FlightLaw, InputErrors, Inversion, LinearContact,
    Oscillator, Rebound, ReleaseRule, Restitution, RestitutionLaw, Scatter, Sphere, damping_ratio,
    damping_ratio_approx, displaced_mass_fraction, terminal_speed_m_per_s,
};
use bounce_audio::random::SplitMix64;

/// A function of some positive numbers, with their names; its answers, or its refusal.
struct Tried {
    arguments: &'static [&'static str],
    call: fn(&[f64]) -> Result<Vec<f64>, Error>,
}

fn series(x: &[f64]) -> Result<BounceSeries, Error> {
    BounceSeries::new(x[0], x[1])
}

fn restitution_parts(e: Restitution) -> Vec<f64> {
    vec![e.value(), e.one_minus(), e.ln()]
}

fn inversion_parts(found: &Inversion) -> Vec<f64> {
    let mut parts = restitution_parts(found.restitution);
    parts.extend([
        found.per_total_time_per_s,
        found.per_height_per_m,
        found.per_gravity_s2_per_m,
        found.per_contact_time_per_s,
    ]);
    parts
}

fn contact_parts(x: &[f64], rule: ReleaseRule) -> Result<Vec<f64>, Error> {
    let contact = LinearContact::new(Oscillator::new(x[0], x[1])?, x[2], rule)?;
    let mut parts = vec![
        contact.deepest_position_m(x[3])?,
        contact.position_m(x[3], x[4])?,
        contact.velocity_m_per_s(x[3], x[4])?,
    ];
    parts.extend(contact.least_leaving_speed_m_per_s());
    if let Rebound::Leaves(leaving) = contact.rebound(x[3])? {
        assert!(leaving.contact_time_s > 0.0 && leaving.speed_m_per_s <= x[3]);
        parts.extend(restitution_parts(leaving.restitution));
        parts.extend([
            leaving.contact_time_s,
            leaving.speed_m_per_s,
            leaving.position_m,
        ]);
    }
    Ok(parts)
}

fn flight_parts(law: &FlightLaw, x: f64) -> Result<Vec<f64>, Error> {
    let (hop, fall, rise) = (law.hop(x)?, law.fall(x)?, law.rise(x)?);
    Ok(vec![
        hop.time_s,
        hop.apex_m,
        hop.landing_speed_m_per_s,
        fall.time_s,
        fall.landing_speed_m_per_s,
        rise.time_s,
        rise.height_m,
    ])
}

fn drop_parts(setup: DropSetup) -> Result<Vec<f64>, Error> {
    let limited = DropSetup {
        most_impacts: Some(50),
        ..setup
    };
    let parts = limited.impacts()?.flat_map(|impact| {
        [
            impact.time_s,
            impact.impact_speed_m_per_s,
            impact.rebound_speed_m_per_s,
            impact.contact_time_s.unwrap_or(0.0),
            impact.apex_m,
            impact.flight_time_s,
            impact.restitution(),
        ]
    });
    Ok(parts.collect())
}

const EVERYTHING: &[Tried] = &[
    Tried {
        arguments: &[
            "height_m",
            "gravity_m_per_s2",
            "restitution",
            "contact_time_s",
        ],
        call: |x| {
            let (series, e) = (series(x)?, Restitution::new(x[2])?);
            let mut parts = vec![
                series.first_fall_s(),
                series.first_impact_speed_m_per_s(),
                series.bounces_to_rest(e, x[3])?,
                series.total_time_approx_s(e)?,
                damping_ratio(e),
                damping_ratio_approx(e),
            ];
            for n in [1, 2, 70, 1_000_000, usize::MAX] {
                let (lowest, highest) = series.attainable_total_time_s(n)?;
                parts.extend([
                    series.height_after_m(e, n),
                    series.flight_after_s(e, n),
                    series.rest_contact_time_s(e, n)?,
                    series.rest_contact_time_approx_s(e, n)?,
                    BounceSeries::contact_time_amplification(e, n)?,
                    series.flight_time_s(e, n)?,
                    series.total_time_with_contact_s(e, n, x[3])?,
                    series.total_time_s(e, n)?,
                    lowest,
                    highest,
                ]);
            }
            Ok(parts)
        },
    },
    Tried {
        arguments: &["height_m", "gravity_m_per_s2", "total_time_s"],
        call: |x| {
            Ok(inversion_parts(
                &series(x)?.restitution_from_total_time(70, x[2])?,
            ))
        },
    },
    Tried {
        arguments: &[
            "height_m",
            "gravity_m_per_s2",
            "total_time_s",
            "contact_time_s",
        ],
        call: |x| {
            let found = series(x)?.restitution_with_contact_time(70, x[2], x[3])?;
            Ok(inversion_parts(&found))
        },
    },
    Tried {
        arguments: &["height_m", "gravity_m_per_s2", "total_time_s"],
        call: |x| {
            Ok(inversion_parts(
                &series(x)?.restitution_from_total_time_approx(x[2])?,
            ))
        },
    },
    Tried {
        arguments: &["mass_kg", "stiffness_n_per_m", "damping_n_s_per_m"],
        call: |x| {
            let unit_mass = Ball::new(x[0], x[1], x[2])?.oscillator();
            Ok(vec![
                unit_mass.natural_frequency_rad_per_s(),
                unit_mass.damping_ratio(),
                unit_mass.stiffness_per_mass_per_s2(),
                unit_mass.damping_per_mass_per_s(),
                unit_mass.contact_time_approx_s(),
                unit_mass.rest_position_m(9.81)?,
            ])
        },
    },
    Tried {
        arguments: &["mass_kg", "restitution", "contact_time_s"],
        call: |x| {
            let ball = Ball::from_contact(x[0], Restitution::new(x[1])?, x[2])?;
            Ok(vec![
                ball.stiffness_n_per_m(),
                ball.damping_n_s_per_m(),
                ball.oscillator().natural_frequency_rad_per_s(),
                ball.oscillator().damping_ratio(),
                Ball::stiffness_approx_n_per_m(x[0], x[2])?,
            ])
        },
    },
    Tried {
        arguments: &["natural_frequency_rad_per_s", "damping_ratio"],
        call: |x| {
            let ball = Oscillator::new(x[0], x[1])?;
            let mut parts = restitution_parts(ball.restitution()?);
            parts.extend([ball.damped_frequency_rad_per_s()?, ball.contact_time_s()?]);
            Ok(parts)
        },
    },
    Tried {
        arguments: &[
            "natural_frequency_rad_per_s",
            "damping_ratio",
            "gravity_m_per_s2",
            "speed_m_per_s",
            "time_s",
        ],
        call: |x| contact_parts(x, ReleaseRule::ZeroDisplacement),
    },
    Tried {
        arguments: &[
            "natural_frequency_rad_per_s",
            "damping_ratio",
            "gravity_m_per_s2",
            "speed_m_per_s",
            "time_s",
        ],
        call: |x| contact_parts(x, ReleaseRule::ZeroForce),
    },
    Tried {
        arguments: &[
            "natural_frequency_rad_per_s",
            "damping_ratio",
            "speed_m_per_s",
            "time_s",
        ],
        call: |x| {
            let ball = Oscillator::new(x[0], x[1])?;
            Ok(vec![
                ball.weightless_position_m(x[2], x[3])?,
                ball.weightless_velocity_m_per_s(x[2], x[3])?,
            ])
        },
    },
    Tried {
        arguments: &["gravity_m_per_s2", "terminal_speed_m_per_s"],
        call: |x| flight_parts(&FlightLaw::with_terminal_speed(x[0], x[1])?, 0.3),
    },
    Tried {
        arguments: &["gravity_m_per_s2", "height_m"],
        call: |x| {
            let mut parts = vec![FlightLaw::without_air(x[0])?.fall(x[1])?.time_s];
            parts.extend(flight_parts(&FlightLaw::without_air(x[0])?, x[1])?);
            parts.extend(flight_parts(
                &FlightLaw::with_terminal_speed(x[0], 8.0)?,
                x[1],
            )?);
            Ok(parts)
        },
    },
    Tried {
        arguments: &[
            "mass_kg",
            "diameter_m",
            "density_kg_per_m3",
            "drag_coefficient",
            "gravity_m_per_s2",
        ],
        call: |x| {
            let sphere = Sphere {
                mass_kg: x[0],
                diameter_m: x[1],
            };
            let air = Air {
                density_kg_per_m3: x[2],
                drag_coefficient: x[3],
            };
            let mut parts = vec![terminal_speed_m_per_s(x[4], sphere, air)?];
            parts.push(displaced_mass_fraction(sphere, air)?);
            parts.extend(flight_parts(&FlightLaw::in_air(x[4], sphere, air)?, 0.3)?);
            Ok(parts)
        },
    },
    Tried {
        arguments: &[
            "height_m",
            "gravity_m_per_s2",
            "restitution",
            "contact_time_s",
        ],
        call: |x| {
            drop_parts(DropSetup::new(
                x[0],
                FlightLaw::without_air(x[1])?,
                Bounce::Given {
                    restitution: RestitutionLaw::Constant(Restitution::new(x[2])?),
                    contact_time_s: x[3],
                },
            ))
        },
    },
    Tried {
        arguments: &["height_m", "natural_frequency_rad_per_s", "damping_ratio"],
        call: |x| {
            drop_parts(DropSetup::new(
                x[0],
                FlightLaw::with_terminal_speed(9.81, 8.0)?,
                Bounce::Linear {
                    ball: Oscillator::new(x[1], x[2])?,
                    release_rule: ReleaseRule::ZeroForce,
                },
            ))
        },
    },
];

/// A valid value of each argument.
fn ordinary(argument: &str) -> f64 {
    match argument {
        "height_m" | "time_s" => 0.3,
        "total_time_s" => 7.0,
        "restitution" => 0.9,
        "contact_time_s" => 1e-3,
        "damping_ratio" => 0.03,
        "natural_frequency_rad_per_s" => 3e3,
        "mass_kg" => 0.0027,
        "diameter_m" => 0.04,
        _ => 1.5,
    }
}

#[test]
fn every_invalid_number_is_refused_by_its_name_and_range() {
    for tried in EVERYTHING {
        let valid: Vec<f64> = tried.arguments.iter().map(|a| ordinary(a)).collect();
        (tried.call)(&valid).unwrap_or_else(|error| panic!("{:?}: {error}", tried.arguments));
        for (i, argument) in tried.arguments.iter().enumerate() {
            let may_be_zero = [
                "contact_time_s",
                "damping_ratio",
                "damping_n_s_per_m",
                "time_s",
            ];
            let zero = (!may_be_zero.contains(argument)).then_some(0.0);
            let one = (*argument == "restitution").then_some(1.0);
            let wrong = [
                -1.0,
                f64::NAN,
                f64::INFINITY,
                f64::NEG_INFINITY,
                1e300,
                -1e-300,
            ];
            for value in wrong.into_iter().chain(zero).chain(one) {
                let mut inputs = valid.clone();
                inputs[i] = value;
                match (tried.call)(&inputs) {
                    Err(Error::Argument {
                        argument: named,
                        expected,
                        ..
                    }) => {
                        // A speed may be named for what it is where the height it comes from is out of range.
                        assert!(
                            named == *argument || *argument == "height_m",
                            "{argument} = {value} is reported as {named}"
                        );
                        assert!(!expected.is_empty());
                    }
                    other => panic!("{argument} = {value}: {other:?}"),
                }
            }
        }
    }
}

#[test]
fn no_finite_input_gives_nan_or_infinity() {
    let mut random = SplitMix64::new(17);
    let mut answered = 0;
    for tried in EVERYTHING {
        for round in 0..4000 {
            // From the neighbourhood of balls to the far ends of what is accepted.
            let reach = [1.0, 6.0, 59.0][round % 3];
            let inputs: Vec<f64> = (tried.arguments.iter())
                .map(|argument| match *argument {
                    "restitution" if round % 2 == 0 => random.uniform().min(1.0 - 1e-12),
                    "restitution" => 1.0 - 10_f64.powf(-15.0 * random.uniform()),
                    _ => ordinary(argument) * 10_f64.powf(reach * (2.0 * random.uniform() - 1.0)),
                })
                .collect();
            if let Ok(parts) = (tried.call)(&inputs) {
                answered += 1;
                let finite = parts.iter().all(|part| part.is_finite());
                assert!(finite, "{:?} = {inputs:?}: {parts:?}", tried.arguments);
            }
        }
    }
    assert!(answered > 30_000, "only {answered} were answered");
}

#[test]
fn no_bounces_at_all_is_refused() {
    let series = BounceSeries::new(0.3, 9.81).unwrap();
    let e = Restitution::new(0.9).unwrap();
    for error in [
        series.flight_time_s(e, 0).unwrap_err(),
        series.total_time_s(e, 0).unwrap_err(),
        series.total_time_with_contact_s(e, 0, 1e-3).unwrap_err(),
        series.rest_contact_time_s(e, 0).unwrap_err(),
        series.rest_contact_time_approx_s(e, 0).unwrap_err(),
        series.attainable_total_time_s(0).unwrap_err(),
        series.restitution_from_total_time(0, 7.0).unwrap_err(),
        series
            .restitution_with_contact_time(1, 7.0, 1e-3)
            .unwrap_err(),
        BounceSeries::contact_time_amplification(e, 0).unwrap_err(),
    ] {
        let message = error.to_string();
        assert!(
            message.contains("bounces is") && message.contains("whole number ≥"),
            "{message}"
        );
    }
}

#[test]
fn a_total_time_without_root_is_refused_with_what_can_be_had() {
    let series = BounceSeries::new(0.305, 9.81).unwrap();
    let (lowest, highest) = series.attainable_total_time_s(70).unwrap();
    for total in [0.1, lowest, highest, 100.0] {
        match series.restitution_from_total_time(70, total) {
            Err(Error::NoRoot { low, high, .. }) => {
                assert_eq!((low, high), (format!("{lowest} s"), format!("{highest} s")));
            }
            other => panic!("{total} s: {other:?}"),
        }
    }
    for inside in [lowest * (1.0 + 1e-15), highest * (1.0 - 1e-15)] {
        assert!(
            series.restitution_from_total_time(70, inside).is_ok(),
            "{inside}"
        );
    }
    let short = series.restitution_from_total_time_approx(0.2).unwrap_err();
    assert!(short.to_string().contains("without limit"), "{short}");
    assert!(series.restitution_with_contact_time(70, 0.3, 1e-3).is_err());
}

#[test]
fn a_ball_that_cannot_swing_back_is_refused_by_its_damping() {
    let critical = Oscillator::new(1000.0, 1.0).unwrap();
    for error in [
        critical.restitution().unwrap_err(),
        critical.contact_time_s().unwrap_err(),
        LinearContact::new(critical, 9.81, ReleaseRule::ZeroDisplacement).unwrap_err(),
    ] {
        assert!(
            error
                .to_string()
                .contains("damping_ratio is 1, expected 0 ≤ ζ < 1"),
            "{error}"
        );
    }
    assert!(LinearContact::new(critical, 9.81, ReleaseRule::ZeroForce).is_ok());
}

#[test]
fn an_elastic_ball_never_rests() {
    let series = BounceSeries::new(0.3, 9.81).unwrap();
    assert!(series.total_time_approx_s(Restitution::ELASTIC).is_err());
    assert!(series.bounces_to_rest(Restitution::ELASTIC, 1e-3).is_err());
    let law = RestitutionLaw::Constant(Restitution::ELASTIC);
    assert!(law.at(1.0).is_err());
}

#[test]
fn negative_errors_and_scatter_are_refused() {
    let series = BounceSeries::new(0.305, 9.81).unwrap();
    let found = series.restitution_from_total_time(70, 7.5).unwrap();
    for bad in [-0.1, f64::NAN, f64::INFINITY] {
        let errors = InputErrors {
            height_m: bad,
            ..InputErrors::default()
        };
        let message = found.std_error(&errors).unwrap_err().to_string();
        assert!(message.contains("std_error.height_m"), "{message}");
        let setup = DropSetup {
            scatter: Some(Scatter {
                ln_restitution_std: bad,
                seed: 1,
            }),
            ..DropSetup::new(
                1.0,
                FlightLaw::without_air(9.81).unwrap(),
                Bounce::Given {
                    restitution: RestitutionLaw::Constant(Restitution::new(0.9).unwrap()),
                    contact_time_s: 1e-3,
                },
            )
        };
        assert!(setup.impacts().is_err());
    }
}

#[test]
fn a_ball_lighter_than_air_is_refused() {
    let balloon = Sphere {
        mass_kg: 0.002,
        diameter_m: 0.2,
    };
    let error = FlightLaw::in_air(9.81, balloon, Air::default()).unwrap_err();
    assert!(error.to_string().contains("mass_kg"), "{error}");
}
