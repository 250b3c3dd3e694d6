//! Height, mass and diameter that differ from file to file: from a table, or from the names.

mod pattern;
mod table;

pub(super) use pattern::Pattern;
pub(super) use table::Table;

use crate::Error;
use crate::cli::listen::Listening;
use crate::cli::quantity::{diameter, height, mass};

/// What is known of one file beyond what the command line says of all.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Given {
    height_m: Option<f64>,
    mass_kg: Option<f64>,
    diameter_m: Option<f64>,
}

/// The names of what may differ.
const NAMES: [&str; 3] = ["height", "mass", "diameter"];

impl Given {
    /// Reads a quantity by its name, which is one of [`NAMES`].
    fn set(&mut self, name: &str, text: &str) -> Result<(), Error> {
        let (argument, value, place) = match name {
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
        listening.height = self.height_m.or(all.height);
        listening.mass = self.mass_kg.or(all.mass);
        listening.diameter = self.diameter_m.or(all.diameter);
        listening
    }
}
