//! Errors of k, c and ζ and of the natural frequency, against many balls drawn from the errors that went in.

use bounce_audio::physics::{
    BounceSeries, ContactErrors, InputErrors, Oscillator, ParameterErrors, Restitution,
};
use bounce_audio::random::SplitMix64;

const DRAWS: usize = 20_000;

/// Relative standard deviation of each column.
fn relative_spread(rows: &[[f64; 4]]) -> [f64; 4] {
    let count = bounce_audio::units::real(rows.len());
    std::array::from_fn(|i| {
        let mean = rows.iter().map(|row| row[i]).sum::<f64>() / count;
        let square = rows.iter().map(|row| (row[i] - mean).powi(2)).sum::<f64>() / count;
        square.sqrt() / mean
    })
}

fn parameters(e: Restitution, contact_time_s: f64) -> [f64; 4] {
    let ball = Oscillator::from_contact(e, contact_time_s).unwrap();
    [
        ball.stiffness_per_mass_per_s2(),
        ball.damping_per_mass_per_s(),
        ball.natural_frequency_rad_per_s(),
        ball.damping_ratio(),
    ]
}

fn as_array(errors: &ParameterErrors) -> [f64; 4] {
    [
        errors.stiffness,
        errors.damping,
        errors.natural_frequency,
        errors.damping_ratio,
    ]
}

/// Four standard errors of a standard deviation from so many draws are 2 %.
fn assert_close(predicted: [f64; 4], drawn: [f64; 4]) {
    for (name, (p, d)) in ["k", "c", "ω_n", "ζ"]
        .iter()
        .zip(predicted.iter().zip(drawn))
    {
        assert!(
            (p / d - 1.0).abs() < 0.02,
            "{name}: predicted {p}, drawn {d}"
        );
    }
}

#[test]
fn a_measured_contact_time_spreads_as_predicted() {
    let mut random = SplitMix64::new(1);
    let errors = ContactErrors {
        restitution: 0.0005,
        contact_time_s: 1e-5,
        correlation: 0.0,
    };
    let e = Restitution::new(0.5).unwrap();
    let drawn: Vec<_> = (0..DRAWS)
        .map(|_| {
            let e = Restitution::new(0.5 + errors.restitution * random.normal()).unwrap();
            parameters(e, 1e-3 + errors.contact_time_s * random.normal())
        })
        .collect();
    let predicted = ParameterErrors::new(e, 1e-3, &errors).unwrap();
    assert_close(as_array(&predicted), relative_spread(&drawn));
}

#[test]
fn a_contact_time_from_the_rest_condition_spreads_as_predicted() {
    let mut random = SplitMix64::new(2);
    let errors = InputErrors {
        total_time_s: 2e-3,
        height_m: 2e-4,
        gravity_m_per_s2: 1e-3,
        contact_time_s: 0.0,
    };
    let (total, height, gravity) = (7.5, 0.305, 9.81);
    let find = |total: f64, height: f64, gravity: f64| {
        let series = BounceSeries::new(height, gravity).unwrap();
        let found = series.restitution_from_total_time(70, total).unwrap();
        let contact_time = series.rest_contact_time_s(found.restitution, 70).unwrap();
        (series, found, contact_time)
    };
    let (series, found, contact_time) = find(total, height, gravity);
    let contact = series.rest_contact_errors(70, &found, &errors).unwrap();
    let predicted = ParameterErrors::new(found.restitution, contact_time, &contact).unwrap();
    let drawn: Vec<_> = (0..DRAWS)
        .map(|_| {
            let (_, found, contact_time) = find(
                total + errors.total_time_s * random.normal(),
                height + errors.height_m * random.normal(),
                gravity + errors.gravity_m_per_s2 * random.normal(),
            );
            parameters(found.restitution, contact_time)
        })
        .collect();
    assert_close(as_array(&predicted), relative_spread(&drawn));
    assert!(contact.correlation > 0.9, "{contact:?}");
    // From the time alone, the contact time is known n times worse than e.
    let timing = InputErrors {
        total_time_s: 2e-3,
        ..InputErrors::default()
    };
    let contact = series.rest_contact_errors(70, &found, &timing).unwrap();
    let of_e = contact.restitution / found.restitution.value();
    let ratio = contact.contact_time_s / contact_time / of_e;
    assert!((ratio - 70.0).abs() < 0.1, "{ratio}");
}

#[test]
fn errors_out_of_range_are_refused_by_name() {
    let e = Restitution::new(0.9).unwrap();
    let good = ContactErrors {
        restitution: 0.01,
        contact_time_s: 1e-4,
        correlation: 0.0,
    };
    for (name, bad) in [
        (
            "std_error.restitution",
            ContactErrors {
                restitution: -1.0,
                ..good
            },
        ),
        (
            "std_error.contact_time_s",
            ContactErrors {
                contact_time_s: f64::NAN,
                ..good
            },
        ),
        (
            "correlation",
            ContactErrors {
                correlation: 1.5,
                ..good
            },
        ),
    ] {
        let error = ParameterErrors::new(e, 1e-3, &bad).unwrap_err().to_string();
        assert!(error.contains(name), "{error}");
    }
    assert!(ParameterErrors::new(Restitution::ELASTIC, 1e-3, &good).is_err());
}
