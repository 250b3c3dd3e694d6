//! `bounce-audio compare`: groups of drops against each other, by what `batch` does.

use clap::Args;

use super::{Outcome, batch};
use crate::Error;

/// Compare groups of drops: balls, floors, temperatures, students.
///
/// Each folder named is a group; with --pattern or --options the groups are those of {group} or of the column group. It is `batch
/// --group` with the answer on standard output and no rows, unless -o asks for them; all options of batch hold.
///
/// Exit status: 0 compared, 1 some file failed or had no drop, or there is nothing to compare, 2 what was asked could not be
/// done; with --rule 3 and 4 as for batch.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  bounce-audio compare cold warm --height 1m
  bounce-audio compare recordings --pattern '{group}-{number}.wav' --height 1m
  bounce-audio compare recordings --options balls.csv --report balls.html")]
#[group(skip)]
pub(super) struct Arguments {
    #[command(flatten)]
    batch: batch::Arguments,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    batch::run_for(&arguments.batch, batch::Purpose::Comparison)
}
