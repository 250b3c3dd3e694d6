//! The ball from numbers, as documents.

use bounce_audio::Error;
use bounce_audio::solve::{
    ContactInputs, GivenErrors, Surroundings, TotalTimeInputs, from_contact, from_total_time,
};
use pyo3::{PyResult, Python, pyfunction};

use crate::failure::detached;

/// Standard errors of the inputs, in the order of `GivenErrors`.
type Errors = [Option<f64>; 6];

fn surroundings(gravity_m_per_s2: f64, mass_kg: Option<f64>, errors: Errors) -> Surroundings {
    let [
        total_time_s,
        height_m,
        gravity_error,
        mass_error,
        contact_time_s,
        restitution,
    ] = errors;
    Surroundings {
        gravity_m_per_s2,
        mass_kg,
        std_error: GivenErrors {
            total_time_s,
            height_m,
            gravity_m_per_s2: gravity_error,
            mass_kg: mass_error,
            contact_time_s,
            restitution,
        },
    }
}

/// From bounces, total time and height.
#[pyfunction]
#[expect(
    clippy::too_many_arguments,
    reason = "they cross the border one by one"
)]
pub(crate) fn solve_total_time(
    py: Python<'_>,
    bounces: usize,
    total_time_s: f64,
    height_m: f64,
    contact_time_s: Option<f64>,
    gravity_m_per_s2: f64,
    mass_kg: Option<f64>,
    errors: Errors,
) -> PyResult<String> {
    let inputs = TotalTimeInputs {
        bounces,
        total_time_s,
        height_m,
        contact_time_s,
        ball: surroundings(gravity_m_per_s2, mass_kg, errors),
    };
    detached(py, || {
        Ok(serde_json::to_string(&from_total_time(&inputs)?)?)
    })
}

/// From restitution and contact time.
#[pyfunction]
pub(crate) fn solve_contact(
    py: Python<'_>,
    restitution: f64,
    contact_time_s: f64,
    height_m: Option<f64>,
    gravity_m_per_s2: f64,
    mass_kg: Option<f64>,
    errors: Errors,
) -> PyResult<String> {
    let inputs = ContactInputs {
        restitution,
        contact_time_s,
        height_m,
        ball: surroundings(gravity_m_per_s2, mass_kg, errors),
    };
    detached(py, || {
        let solved: Result<_, Error> = from_contact(&inputs);
        Ok(serde_json::to_string(&solved?)?)
    })
}
