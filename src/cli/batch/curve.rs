//! `batch --at-speed` and `--curve`: e against speed over all drops.

use std::path::PathBuf;

use clap::Args;

use super::say;
use crate::Error;
use crate::cli::output;
use crate::cli::picture::Target;
use crate::picture::curve::sheet;
use crate::plot::Figure;
use crate::report::curve::{Bounces, SpeedCurve};

/// What is asked of the curve.
#[derive(Debug, Args)]
#[command(next_help_heading = "e against speed")]
pub(super) struct CurveArguments {
    /// Say e at these impact speeds in m/s, by one curve through the bounces of all drops
    #[arg(
        long,
        value_name = "SPEED,…",
        value_delimiter = ',',
        value_parser = speed,
        conflicts_with = "resume",
        allow_hyphen_values = true
    )]
    at_speed: Vec<f64>,
    /// Draw that curve with its 95 % band, or write it as a table
    #[arg(long, value_name = "OUT.svg|png|csv", conflicts_with = "resume")]
    curve: Option<PathBuf>,
}

/// Speeds that a curve is asked for: from an atom's breadth a second to that of light.
const SPEEDS: std::ops::RangeInclusive<f64> = 1e-9..=3e8;

fn speed(text: &str) -> Result<f64, String> {
    let number = text.trim();
    let number = number.strip_suffix("m/s").unwrap_or(number).trim_end();
    let speed: Option<f64> = number.parse().ok();
    let within = speed.filter(|speed| SPEEDS.contains(speed));
    within.ok_or_else(|| "expected a speed above 0 in m/s, such as 2.5".to_owned())
}

impl CurveArguments {
    /// Whether the curve can be written, before anything is listened to.
    pub(super) fn check(&self) -> Result<(), Error> {
        match &self.curve {
            Some(path) if !is_table(path) => {
                Target::new(path).map(|_| ()).map_err(|_| Error::Argument {
                    argument: "--curve",
                    got: format!("'{}'", path.display()),
                    expected: "a name that ends in .svg, .png or .csv",
                })
            }
            _ => Ok(()),
        }
    }

    pub(super) const fn path(&self) -> Option<&PathBuf> {
        self.curve.as_ref()
    }

    /// Says and draws what was asked for; gives both.
    pub(super) fn told(&self, bounces: Bounces) -> Result<Told, Error> {
        if self.at_speed.is_empty() && self.curve.is_none() {
            return Ok(Told::default());
        }
        let Some(curve) = bounces.curve() else {
            let problem =
                "a curve of e against speed takes three drops with an e of single bounces";
            return Err(Error::refused(problem));
        };
        let said = "\n".to_owned() + &curve.in_words(&self.at_speed);
        say(&said);
        if let Some(path) = &self.curve {
            write(path, &curve)?;
        }
        Ok(Told {
            said,
            figure: Some(sheet(&curve)),
        })
    }
}

/// The curve in words and as a picture, if it was asked for.
#[derive(Debug, Default)]
pub(super) struct Told {
    pub said: String,
    pub figure: Option<Figure>,
}

fn is_table(path: &std::path::Path) -> bool {
    path.extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("csv"))
}

fn write(path: &std::path::Path, curve: &SpeedCurve) -> Result<(), Error> {
    if is_table(path) {
        return output::write(path, b"speed_m_per_s,", curve.to_csv().as_bytes());
    }
    Target::new(path)?.draw(&sheet(curve))
}
