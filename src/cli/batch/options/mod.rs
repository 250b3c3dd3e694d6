//! Height, mass, diameter, ball and group that differ from file to file: from a table, or from the names.

mod pattern;
mod table;

pub(super) use pattern::Pattern;
pub(super) use table::Table;

use crate::Error;
use crate::cli::listen::Listening;
use crate::cli::quantity::{diameter, height, mass};

/// What is known of one file beyond what the command line says of all.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Given {
    height_m: Option<f64>,
    mass_kg: Option<f64>,
    diameter_m: Option<f64>,
    /// The ball that was dropped.
    pub ball: Option<String>,
    /// The group that the drop is of.
    pub group: Option<String>,
}

/// The names of what may differ: quantities, then words.
const NAMES: [&str; 5] = ["height", "mass", "diameter", "ball", "group"];

impl Given {
    /// Reads what has one of [`NAMES`].
    fn set(&mut self, name: &str, text: &str) -> Result<(), Error> {
        let (argument, value, place) = match name {
            "ball" => {
                self.ball = Some(text.to_owned());
                return Ok(());
            }
            "group" => {
                self.group = Some(text.to_owned());
                return Ok(());
            }
            "height" => ("height", height(text)?, &mut self.height_m),
            "mass" => ("mass", mass(text)?, &mut self.mass_kg),
            _ => ("diameter", diameter(text)?, &mut self.diameter_m),
        };
        if value <= 0.0 {
            return Err(Error::argument(argument, value, "above 0"));
        }
        *place = Some(value);
        Ok(())
    }

    /// How to listen to the file: what it is given counts before what all are.
    pub(super) fn over(self, all: &Listening) -> Listening {
        let mut listening = all.clone();
        listening.known.height = self.height_m.or(all.known.height);
        listening.known.mass = self.mass_kg.or(all.known.mass);
        listening.known.diameter = self.diameter_m.or(all.known.diameter);
        listening
    }
}
