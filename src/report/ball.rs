//! The ball behind a drop, as data.

use serde::{Deserialize, Serialize};

use crate::physics::ReleaseRule;
use crate::words::words;

/// The mass-spring-damper ball.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Ball {
    /// Contact time ΔT.
    pub contact_time_s: f64,
    /// Its standard error.
    pub contact_time_std_s: f64,
    /// k; null without a mass.
    pub stiffness_n_per_m: Option<f64>,
    /// Its standard error, the mass being exact.
    pub stiffness_std_n_per_m: Option<f64>,
    /// c; null without a mass.
    pub damping_n_s_per_m: Option<f64>,
    /// Its standard error, the mass being exact.
    pub damping_std_n_s_per_m: Option<f64>,
    /// `ω_n`.
    pub natural_frequency_rad_per_s: f64,
    /// Its standard error.
    pub natural_frequency_std_rad_per_s: f64,
    /// ζ.
    pub damping_ratio: f64,
    /// Its standard error.
    pub damping_ratio_std: f64,
    /// When contact ends.
    pub release_rule: ReleaseRule,
    /// Where the contact time comes from.
    pub source: ContactSource,
}

words! {
    /// Where a contact time comes from.
    #[non_exhaustive]
    pub enum ContactSource {
        /// It was given.
        Given = "given",
        /// It was fitted to the intervals between impacts.
        Intervals = "intervals",
    }
}
