//! The ball from numbers typed in: bounces, total time and height, or restitution and contact time.
//!
//! What comes out is data with the field names of the JSON document; [`text`] writes it for a person. Every number that
//! does not exist is `None`, null in JSON.
//!
//! ```
//! use bounce_audio::solve::{self, Surroundings, TotalTimeInputs};
//!
//! // The paper's drop: 30.5 cm, 70 bounces, 7.5 s, 2.5 g.
//! let solved = solve::from_total_time(&TotalTimeInputs {
//!     bounces: 70,
//!     total_time_s: 7.5,
//!     height_m: 0.305,
//!     contact_time_s: None,
//!     ball: Surroundings { mass_kg: Some(0.0025), ..Surroundings::default() },
//! })?;
//! assert_eq!(format!("{:.5}", solved.eq25.values.restitution), "0.93347");
//! # Ok::<(), bounce_audio::Error>(())
//! ```

mod ball;
mod contact;
mod numbers;
pub mod text;
mod total_time;
mod warnings;

pub use ball::{Parameters, Rest, SolvedBall};
pub use contact::{ContactInputs, ContactSolution, from_contact};
pub use total_time::{TotalTimeInputs, TotalTimeSolution, from_total_time};

use serde::Serialize;

/// What both ways to the ball share.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Surroundings {
    /// Acceleration of free fall. Default 9.81.
    pub gravity_m_per_s2: f64,
    /// Mass of the ball; without it there are k/m and c/m, but no k and c.
    pub mass_kg: Option<f64>,
    /// Standard errors of what was measured.
    pub std_error: GivenErrors,
}

impl Default for Surroundings {
    fn default() -> Self {
        Self {
            gravity_m_per_s2: 9.81,
            mass_kg: None,
            std_error: GivenErrors::default(),
        }
    }
}

/// Standard errors of the inputs. Where none is given the results have no errors either; where some are, the others
/// count as exact.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct GivenErrors {
    /// Of the total time.
    pub total_time_s: Option<f64>,
    /// Of the height of release.
    pub height_m: Option<f64>,
    /// Of gravity.
    pub gravity_m_per_s2: Option<f64>,
    /// Of the mass.
    pub mass_kg: Option<f64>,
    /// Of the contact time.
    pub contact_time_s: Option<f64>,
    /// Of the restitution.
    pub restitution: Option<f64>,
}

impl GivenErrors {
    /// Whether any was given.
    #[must_use]
    pub fn any(&self) -> bool {
        *self != Self::default()
    }
}

/// A solution as a JSON document, ending with a line feed.
///
/// # Errors
/// If a value cannot be written as JSON, which no solution of this module holds.
pub fn to_json<S: Serialize>(solution: &S) -> Result<String, serde_json::Error> {
    serde_json::to_string_pretty(solution).map(|document| document + "\n")
}
