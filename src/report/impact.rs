//! One impact as data.

use serde::{Deserialize, Serialize};

use super::Status;

/// One impact and the flight after it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Impact {
    /// Seconds from the first sample.
    pub time_s: f64,
    /// Standard error of the time in seconds; null where it is inferred.
    pub time_std_s: Option<f64>,
    /// Peak of its sound below full scale; null where it is inferred or silent.
    pub level_db: Option<f64>,
    /// To the next impact, in seconds; null for the last, and where either end is inferred.
    pub interval_s: Option<f64>,
    /// That interval over the one before.
    pub ratio: Option<f64>,
    /// Height of the rebound, g·T²/8 of the interval T, in metres.
    pub rebound_height_m: Option<f64>,
    /// Its standard error by those of the times, in metres.
    pub rebound_height_std_m: Option<f64>,
    /// Speeds and e of this impact.
    #[serde(flatten)]
    pub bounce: Bounce,
    /// Whether it was heard.
    pub status: Status,
}

#[cfg(test)]
impl Impact {
    /// An impact of which nothing is known but that it was heard then.
    pub(crate) fn heard(time_s: f64) -> Self {
        Self {
            time_s,
            time_std_s: None,
            level_db: None,
            interval_s: None,
            ratio: None,
            rebound_height_m: None,
            rebound_height_std_m: None,
            bounce: Bounce::default(),
            status: Status::Heard,
        }
    }
}

/// Speeds, e and the energy kept at one impact, with standard errors by those of the times.
///
/// Speeds are those at the ends of a flight of T less the contact time, under the drag of the selected model if it has
/// them: without, g·T/2. Null where the flight before or after, which a number rests on, was not heard whole.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Bounce {
    /// Speed of arrival.
    pub impact_speed_m_per_s: Option<f64>,
    /// Its standard error.
    pub impact_speed_std_m_per_s: Option<f64>,
    /// Speed of leaving.
    pub rebound_speed_m_per_s: Option<f64>,
    /// Its standard error.
    pub rebound_speed_std_m_per_s: Option<f64>,
    /// e of this impact: the second speed over the first.
    pub restitution: Option<f64>,
    /// Its standard error; neighbouring flights share a time.
    pub restitution_std: Option<f64>,
    /// Share of the energy of arrival that it leaves with, e².
    pub energy_kept: Option<f64>,
    /// Its standard error.
    pub energy_kept_std: Option<f64>,
}
