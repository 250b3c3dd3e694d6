//! The first rebound of a drop from a known height, as standards measure it.

use serde::{Deserialize, Serialize};

use super::numbers::decimals;
use crate::fit::Estimate;

/// The rebound after the first impact, by the flight that follows it. Errors are those of the times, of the height of release,
/// of a contact and a drag that are not known exactly, and of the air that a ball of unknown mass and diameter displaces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Rebound {
    /// Height of release in metres, from the ball's lowest point to the surface.
    pub drop_height_m: f64,
    /// Speed at the impact.
    pub impact_speed_m_per_s: f64,
    /// Height of the rebound in metres, to the ball's lowest point.
    pub height_m: Estimate,
    /// e of the impact.
    pub restitution: Estimate,
    /// Height of the rebound over that of release, 0 to 1; without drag e².
    pub resilience: Estimate,
}

/// Unit of a height, as rule books have it: millimetres for low drops, centimetres for high ones.
#[derive(Debug, Clone, Copy)]
pub(super) struct Unit {
    pub name: &'static str,
    pub per_m: f64,
}

impl Unit {
    pub(super) fn of(drop_height_m: f64) -> Self {
        let (name, per_m) = if drop_height_m < 1.0 {
            ("mm", 1e3)
        } else {
            ("cm", 1e2)
        };
        Self { name, per_m }
    }

    /// A height that was given, in metres: `30.5 cm`.
    pub(super) fn bare(self, value_m: f64) -> String {
        let value = format!("{:.1}", self.per_m * value_m);
        format!("{} {}", value.trim_end_matches(".0"), self.name)
    }

    /// A value and its standard error, in metres.
    pub(super) fn plus_minus(self, value_m: f64, std_m: f64) -> String {
        let Self { name, per_m } = self;
        let digits = decimals(per_m * std_m);
        format!(
            "{:.digits$} ± {:.digits$} {name}",
            per_m * value_m,
            per_m * std_m
        )
    }
}

/// `81.9 ± 0.3 cm from 100 cm, resilience 81.9 ± 0.3 %`.
pub(super) fn in_words(rebound: &Rebound) -> String {
    let unit = Unit::of(rebound.drop_height_m);
    let height = |e: &Estimate| unit.plus_minus(e.value, e.std_error.unwrap_or(0.0));
    let percent = 100.0 * rebound.resilience.std_error.unwrap_or(0.0);
    let digits = decimals(percent);
    format!(
        "{} from {}, resilience {:.digits$} ± {percent:.digits$} %",
        height(&rebound.height_m),
        unit.bare(rebound.drop_height_m),
        100.0 * rebound.resilience.value,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rebound_is_told_in_the_unit_of_its_rule_book() {
        let with = |value: f64, std: f64| Estimate {
            value,
            std_error: Some(std),
            interval95: None,
        };
        let mut rebound = Rebound {
            drop_height_m: 1.0,
            impact_speed_m_per_s: 4.43,
            height_m: with(0.8187, 0.0031),
            restitution: with(0.905, 0.0017),
            resilience: with(0.8187, 0.0031),
        };
        assert_eq!(
            in_words(&rebound),
            "81.87 ± 0.31 cm from 100 cm, resilience 81.87 ± 0.31 %"
        );
        rebound.drop_height_m = 0.3055;
        rebound.height_m = with(0.2502, 0.0012);
        assert!(in_words(&rebound).starts_with("250.2 ± 1.2 mm from 305.5 mm, "));
    }
}
