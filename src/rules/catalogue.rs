//! The rules that are known, with their sources.

use crate::Error;
use crate::report::rule::Spread;

/// How a rule book tests a ball, or a surface with a ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rule {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it is for, in a few words.
    pub about: &'static str,
    /// Where it stands.
    pub source: &'static str,
    /// From the ball's lowest point to the surface at release, in metres.
    pub drop_height_m: f64,
    /// Rebound that is allowed, to the ball's lowest point, in metres.
    pub allowed_m: [f64; 2],
    /// Mass of the ball in kg: the middle of what is allowed.
    pub mass_kg: f64,
    /// Diameter of the ball in metres, likewise.
    pub diameter_m: f64,
    /// How far apart rebounds may be, if the rule says.
    pub allowed_spread: Option<Spread>,
    /// How often it has each ball dropped, if it says.
    pub drops: Option<usize>,
    /// How many balls it takes, if it says.
    pub balls: Option<usize>,
    /// Which mean of the rebounds of a ball counts.
    pub mean: Mean,
}

/// A mean of rebounds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mean {
    /// Their sum over their number.
    Arithmetic,
    /// The root of their product.
    Geometric,
}

/// 2.7 g and 40 mm, from 305 mm on a steel block, 24 balls, of each the geometric mean of three determinations.
const ITTF_BALL: Rule = Rule {
    name: "ittf-ball",
    about: "table tennis ball, not celluloid, on steel",
    source: "ITTF Technical Leaflet T3, The Ball (40 mm), 2016",
    drop_height_m: 0.305,
    allowed_m: [0.240, 0.265],
    mass_kg: 2.7e-3,
    diameter_m: 0.040,
    allowed_spread: None,
    drops: Some(3),
    balls: Some(24),
    mean: Mean::Geometric,
};

/// 56.0–59.4 g, 6.54–6.86 cm, from 254 cm.
const ITF_TENNIS: Rule = Rule {
    name: "itf-tennis",
    about: "tennis ball, types 1 and 2, on granite or concrete",
    source: "ITF Rules of Tennis, Appendix I",
    drop_height_m: 2.54,
    allowed_m: [1.35, 1.47],
    mass_kg: 57.7e-3,
    diameter_m: 0.067,
    allowed_spread: None,
    drops: None,
    balls: None,
    mean: Mean::Arithmetic,
};

/// 420–445 g, 68.5–69.5 cm around, from 2 m on steel, ten drops.
const FIFA_PRO: Rule = Rule {
    name: "fifa-pro",
    about: "football of size 5, on steel",
    source: "FIFA Quality Pro, as makers of balls quote it; older versions differ",
    drop_height_m: 2.0,
    allowed_m: [1.35, 1.55],
    mass_kg: 0.4325,
    diameter_m: 0.2196,
    allowed_spread: Some(Spread {
        greatest_m: 0.10,
        drops: 10,
    }),
    drops: Some(10),
    balls: None,
    mean: Mean::Arithmetic,
};

/// All of them.
pub const RULES: [Rule; 10] = [
    ITTF_BALL,
    Rule {
        name: "ittf-ball-celluloid",
        about: "table tennis ball of celluloid, on steel",
        allowed_m: [0.240, 0.260],
        ..ITTF_BALL
    },
    Rule {
        name: "ittf-table",
        about: "table, with a table tennis ball: about 23 cm, here 22.5 to 23.5",
        source: "ITTF Laws of Table Tennis, 2.1.3",
        drop_height_m: 0.300,
        allowed_m: [0.225, 0.235],
        drops: None,
        balls: None,
        mean: Mean::Arithmetic,
        ..ITTF_BALL
    },
    ITF_TENNIS,
    // 7.00–7.30 cm.
    Rule {
        name: "itf-tennis-type3",
        about: "tennis ball, type 3 (slow, larger), on granite or concrete",
        diameter_m: 0.0715,
        ..ITF_TENNIS
    },
    Rule {
        name: "itf-tennis-altitude",
        about: "tennis ball for high altitude, on granite or concrete",
        allowed_m: [1.22, 1.35],
        ..ITF_TENNIS
    },
    FIFA_PRO,
    Rule {
        name: "fifa-turf",
        about: "football turf, with a football",
        source: "FIFA Quality Programme for Football Turf, FIFA Quality, requirements of 2015",
        allowed_m: [0.60, 1.00],
        allowed_spread: None,
        drops: None,
        ..FIFA_PRO
    },
    Rule {
        name: "fifa-turf-pro",
        about: "football turf of the higher class, with a football",
        source: "FIFA Quality Programme for Football Turf, FIFA Quality Pro, requirements of 2015",
        allowed_m: [0.60, 0.85],
        allowed_spread: None,
        drops: None,
        ..FIFA_PRO
    },
    // 600–650 g, 75–78 cm around; 1.2–1.4 m to the top of the ball, less its diameter.
    Rule {
        name: "basketball",
        about: "basketball of size 7, on the court; rebound to its top 1.2 to 1.4 m",
        source: "older FIBA rules, as secondary sources quote them",
        drop_height_m: 1.8,
        allowed_m: [0.9565, 1.1565],
        mass_kg: 0.625,
        diameter_m: 0.2435,
        allowed_spread: None,
        drops: None,
        balls: None,
        mean: Mean::Arithmetic,
    },
];

/// The rule of this name.
///
/// # Errors
/// [`Error::Argument`] for a name that no rule has.
pub fn rule(name: &str) -> Result<Rule, Error> {
    let found = RULES.iter().find(|rule| rule.name == name);
    found.copied().ok_or_else(|| Error::Argument {
        argument: "--rule",
        got: format!("'{name}'"),
        expected: "a rule that analyze --help names",
    })
}

impl Rule {
    /// What it is for, drop, rebound, ball and source.
    #[must_use]
    pub fn in_words(&self) -> String {
        let [low, high] = self.allowed_m.map(|m| 1e3 * m);
        format!(
            "{}: {low:.0} to {high:.0} mm from {:.0} mm; ball {:.1} g, {:.1} mm ({})",
            self.about,
            1e3 * self.drop_height_m,
            1e3 * self.mass_kg,
            1e3 * self.diameter_m,
            self.source
        )
    }
}
