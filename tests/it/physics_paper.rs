//! The worked example of the paper: a 2.50 g ball from 30.5 cm makes 70 bounces in 7.5 s.

use bounce_audio::physics::{
    Air, Ball, Bounce, BounceSeries, DropSetup, FlightLaw, Oscillator, Restitution, RestitutionLaw,
    Sphere, damping_ratio, terminal_speed_m_per_s,
};

const BOUNCES: usize = 70;
const TOTAL_TIME_S: f64 = 7.5;
const MASS_KG: f64 = 0.0025;

fn series() -> BounceSeries {
    BounceSeries::new(0.305, 9.81).unwrap()
}

/// Fails unless `value` rounds to `printed`, whose last digit is worth `unit`.
fn rounds_to(name: &str, value: f64, printed: f64, unit: f64) {
    assert!(
        (value - printed).abs() <= 0.5 * unit,
        "{name}: {value} is not {printed} to within half of {unit}"
    );
}

#[test]
fn restitution_from_bounces_and_total_time_is_the_papers() {
    let exact = series()
        .restitution_from_total_time(BOUNCES, TOTAL_TIME_S)
        .unwrap()
        .restitution;
    let approximate = series()
        .restitution_from_total_time_approx(TOTAL_TIME_S)
        .unwrap()
        .restitution;
    rounds_to("e by (25), paper", exact.value(), 0.93, 1e-2);
    rounds_to("e by (25)", exact.value(), 0.93347, 1e-5);
    rounds_to("e by (30), paper", approximate.value(), 0.94, 1e-2);
    rounds_to("e by (30)", approximate.value(), 0.93564, 1e-5);

    let unrounded = series().rest_contact_time_s(exact, BOUNCES).unwrap();
    rounds_to("ΔT by (20), unrounded e", unrounded, 4.474e-3, 1e-6);
    let rounded = series()
        .rest_contact_time_s(Restitution::new(0.93).unwrap(), BOUNCES)
        .unwrap();
    rounds_to("ΔT by (20), paper", rounded, 3.4e-3, 1e-4);
    rounds_to("ΔT by (20), rounded e", rounded, 3.447e-3, 1e-6);
}

#[test]
fn the_ball_of_a_contact_time_of_3_4_ms_is_the_papers() {
    let e = Restitution::new(0.93).unwrap();
    let ball = Ball::from_contact(MASS_KG, e, 3.4e-3).unwrap();
    let unit_mass = Oscillator::from_contact(e, 3.4e-3).unwrap();
    let stiffness = unit_mass.stiffness_per_mass_per_s2();
    let frequency = unit_mass.natural_frequency_rad_per_s();
    for (name, value, paper, paper_unit, computed, unit) in [
        ("k/m", stiffness, 8.5e5, 1e4, 8.542e5, 1e2),
        ("k", ball.stiffness_n_per_m(), 2.1e3, 1e2, 2.136e3, 1.0),
        (
            "c/m",
            unit_mass.damping_per_mass_per_s(),
            43.0,
            1.0,
            42.69,
            1e-2,
        ),
        ("c", ball.damping_n_s_per_m(), 0.11, 1e-2, 0.1067, 1e-4),
        ("ω_n", frequency, 920.0, 10.0, 924.2, 0.1),
        (
            "f_n",
            frequency / std::f64::consts::TAU,
            150.0,
            10.0,
            147.1,
            0.1,
        ),
        ("ζ", damping_ratio(e), 0.023, 1e-3, 0.02309, 1e-5),
    ] {
        rounds_to(name, value, paper, paper_unit);
        rounds_to(name, value, computed, unit);
    }
}

#[test]
fn the_ball_of_a_contact_time_of_1_ms_is_the_papers() {
    let e = Restitution::new(0.93).unwrap();
    let ball = Ball::from_contact(MASS_KG, e, 1e-3).unwrap();
    let unit_mass = ball.oscillator();
    let stiffness = unit_mass.stiffness_per_mass_per_s2();
    let frequency = unit_mass.natural_frequency_rad_per_s();
    for (name, value, paper, paper_unit, computed, unit) in [
        ("k/m", stiffness, 1.0e7, 1e6, 9.875e6, 1e3),
        ("k", ball.stiffness_n_per_m(), 25e3, 1e3, 24.69e3, 10.0),
        (
            "c/m",
            unit_mass.damping_per_mass_per_s(),
            145.0,
            1.0,
            145.1,
            0.1,
        ),
        ("c", ball.damping_n_s_per_m(), 0.36, 1e-2, 0.3629, 1e-4),
        ("ω_n", frequency, 3100.0, 100.0, 3142.0, 1.0),
        (
            "f_n",
            frequency / std::f64::consts::TAU,
            500.0,
            100.0,
            500.1,
            0.1,
        ),
    ] {
        rounds_to(name, value, paper, paper_unit);
        rounds_to(name, value, computed, unit);
    }
}

#[test]
fn drag_left_aside_lowers_the_restitution_that_is_read() {
    let sphere = Sphere {
        mass_kg: MASS_KG,
        diameter_m: 0.038,
    };
    let air = Air {
        drag_coefficient: 0.5,
        ..Air::default()
    };
    let terminal = terminal_speed_m_per_s(9.81, sphere, air).unwrap();
    let setup = DropSetup {
        shortest_flight_s: Some(1e-9),
        ..DropSetup::new(
            0.305,
            FlightLaw::with_terminal_speed(9.81, terminal).unwrap(),
            Bounce::Given {
                restitution: RestitutionLaw::Constant(Restitution::new(0.94).unwrap()),
                contact_time_s: 0.0,
            },
        )
    };
    let total = setup.impacts().unwrap().last().unwrap().time_s;
    let read = series().restitution_from_total_time_approx(total).unwrap();
    rounds_to(
        "e by (30) of a ball with e = 0.94",
        read.restitution.value(),
        0.929,
        1e-3,
    );
}
