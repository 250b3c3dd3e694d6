//! A rule of one's own: `e=0.75..0.80@254cm,57.7g,67mm`.

use super::{Mean, Rule};
use crate::Error;
use crate::physics::{Air, FlightLaw, Sphere};
use crate::units::Quantity;

/// The gravity for which limits of e become heights: of a fall and a rise their ratio does not depend on it.
const GRAVITY_M_PER_S2: f64 = 9.81;

/// What limits can be of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Limited {
    /// e of the impact.
    Restitution,
    /// The height of the rebound over that of release.
    Resilience,
    /// The height of the rebound.
    Rebound,
}

impl Rule {
    /// A rule by its limits: `e`, `resilience` or `rebound`, from the least to the greatest, `@` the height of release, then mass
    /// and diameter of the ball, as the air counts. Each drop is judged, and of a lot each ball by the mean of its drops.
    ///
    /// # Errors
    /// [`Error::Argument`] for another form, limits that no ball can keep to, and a ball or height that is none.
    pub fn of_limits(text: &str) -> Result<Self, Error> {
        let parts = Parts::of(text).ok_or_else(|| wrong(text, FORM))?;
        let drop_height_m = above_zero(Quantity::Length, text, parts.height)?;
        let ball = Sphere {
            mass_kg: above_zero(Quantity::Mass, text, parts.mass)?,
            diameter_m: above_zero(Quantity::Length, text, parts.diameter)?,
        };
        let quantity = match parts.limited {
            Limited::Rebound => Quantity::Length,
            Limited::Restitution | Limited::Resilience => Quantity::Share,
        };
        let limits = [
            quantity.parse("--rule", &parts.least)?,
            quantity.parse("--rule", parts.most)?,
        ];
        if !(limits[0] >= 0.0 && limits[0] < limits[1]) {
            return Err(wrong(text, "limits from less to more"));
        }
        let allowed_m = match parts.limited {
            Limited::Rebound => limits,
            Limited::Resilience => limits.map(|share| share * drop_height_m),
            Limited::Restitution => rebounds_m(limits, drop_height_m, ball)?,
        };
        let gains = parts.limited == Limited::Restitution && limits[1] > 1.0;
        if gains || allowed_m[1] > drop_height_m {
            return Err(wrong(text, "limits of a ball that gains no height"));
        }
        Ok(Self {
            name: "own",
            about: "limits of one's own",
            source: "limits as given",
            drop_height_m,
            allowed_m,
            mass_kg: ball.mass_kg,
            diameter_m: ball.diameter_m,
            allowed_spread: None,
            drops: None,
            balls: None,
            mean: Mean::Arithmetic,
        })
    }
}

const FORM: &str = "a rule that analyze --help names, or limits such as e=0.75..0.80@254cm,57.7g,67mm (e, resilience or \
                    rebound, height of release, mass and diameter of the ball)";

fn wrong(text: &str, expected: &'static str) -> Error {
    Error::Argument {
        argument: "--rule",
        got: format!("'{text}'"),
        expected,
    }
}

fn above_zero(quantity: Quantity, text: &str, part: &str) -> Result<f64, Error> {
    let value = quantity.parse("--rule", part)?;
    if value > 0.0 {
        return Ok(value);
    }
    Err(wrong(text, "height, mass and diameter above 0"))
}

/// The rebounds in air that these e make of a height.
fn rebounds_m(limits: [f64; 2], height_m: f64, ball: Sphere) -> Result<[f64; 2], Error> {
    let flight = FlightLaw::in_air(GRAVITY_M_PER_S2, ball, Air::default())?;
    let speed = flight.fall(height_m)?.landing_speed_m_per_s;
    let rebound = |e: f64| -> Result<f64, Error> {
        if e == 0.0 {
            return Ok(0.0);
        }
        Ok(flight.rise(e * speed)?.height_m)
    };
    Ok([rebound(limits[0])?, rebound(limits[1])?])
}

/// The words of a rule.
struct Parts<'a> {
    limited: Limited,
    least: String,
    most: &'a str,
    height: &'a str,
    mass: &'a str,
    diameter: &'a str,
}

impl<'a> Parts<'a> {
    fn of(text: &'a str) -> Option<Self> {
        let (what, rest) = text.split_once('=')?;
        let limited = match what.trim() {
            "e" => Limited::Restitution,
            "resilience" => Limited::Resilience,
            "rebound" => Limited::Rebound,
            _ => return None,
        };
        let (limits, rest) = rest.split_once('@')?;
        let (least, most) = limits.split_once("..")?;
        let (least, most) = (least.trim(), most.trim());
        let mut parts = rest.split(',');
        let (height, mass, diameter) = (parts.next()?, parts.next()?, parts.next()?);
        // The unit of the second limit counts for the first: 135..147cm.
        let unit = most.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.');
        let bare = least.parse::<f64>().is_ok();
        parts.next().is_none().then_some(Self {
            limited,
            least: if bare {
                format!("{least}{unit}")
            } else {
                least.to_owned()
            },
            most,
            height,
            mass,
            diameter,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_become_rebounds_from_the_height() {
        let rule = Rule::of_limits("rebound=135..147cm@254cm,57.7g,67mm").unwrap();
        assert_eq!((rule.allowed_m, rule.drop_height_m), ([1.35, 1.47], 2.54));
        assert_eq!((rule.mass_kg, rule.diameter_m), (0.0577, 0.067));
        let rule = Rule::of_limits("resilience=40..50%@50cm, 16g, 16mm").unwrap();
        assert_eq!(rule.allowed_m, [0.2, 0.25]);
        // In air a ball of this e comes back less high than e² of its height.
        let rule = Rule::of_limits("e=0.75..0.80@254cm,57.7g,67mm").unwrap();
        let [low, high] = rule.allowed_m;
        assert!(low < 0.5625 * 2.54 && low > 0.9 * 0.5625 * 2.54, "{low}");
        assert!(high < 0.64 * 2.54 && high > 0.9 * 0.64 * 2.54, "{high}");
        let dead = Rule::of_limits("e=0..0.8@254cm,57.7g,67mm").unwrap();
        assert_eq!(dead.allowed_m, [0.0, high]);
        let heavy = Rule::of_limits("e=0.5..0.8@1m,100kg,20mm").unwrap();
        assert!((heavy.allowed_m[1] - 0.64).abs() < 1e-4, "{heavy:?}");
    }

    #[test]
    fn what_is_no_rule_is_one_sentence() {
        for (text, part) in [
            ("e=0.75..0.80@254cm", "such as"),
            ("e=0.75-0.80@254cm,57.7g,67mm", "such as"),
            ("bounce=0.7..0.8@1m,50g,60mm", "such as"),
            ("e=0.75..0.80@254cm,57.7g,67mm,1", "such as"),
            ("e=0.8..0.7@254cm,57.7g,67mm", "less to more"),
            ("e=0.8..1.2@254cm,57.7g,67mm", "gains no height"),
            ("rebound=2..3m@1m,57.7g,67mm", "gains no height"),
            ("e=-0.1..0.7@254cm,57.7g,67mm", "less to more"),
            ("e=0.7..0.8@0,57.7g,67mm", "above 0"),
            ("e=0.7..0.8@1m,57.7mm,67mm", "57.7mm"),
            ("e=x..0.8@1m,57.7g,67mm", "'x'"),
            ("e=0.7..0.8@1m,0.1g,67mm", "mass"),
        ] {
            let said = Rule::of_limits(text).unwrap_err().to_string();
            assert!(
                said.contains(part) && !said.contains('\n'),
                "{text}: {said}"
            );
        }
    }
}
