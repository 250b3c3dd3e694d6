//! The release of a drop by its first flights: from how high, or under which gravity.

use serde::{Deserialize, Serialize};

use super::rebound::Unit;
use crate::fit::Estimate;

/// What the fall before the first impact heard must have been, if that was the first: its speed is that of leaving over e, by the
/// later bounces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Release {
    /// Height of release in metres, under the gravity of the settings.
    pub height_m: Estimate,
    /// Gravity in m/s² by the height of the settings; null without one.
    pub gravity_m_per_s2: Option<Estimate>,
}

/// `from 253 ± 12 cm, if the first bounce heard was the first`.
pub(super) fn in_words(release: &Release) -> String {
    let std = |e: &Estimate| e.std_error.unwrap_or(0.0);
    if let Some(gravity) = &release.gravity_m_per_s2 {
        let digits = super::decimals(std(gravity));
        return format!(
            "by the height gravity is {:.digits$} ± {:.digits$} m/s²",
            gravity.value,
            std(gravity)
        );
    }
    let height = &release.height_m;
    format!(
        "from {}, if the first bounce heard was the first",
        Unit::of(height.value).plus_minus(height.value, std(height))
    )
}
