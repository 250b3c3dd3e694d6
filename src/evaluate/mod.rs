//! How well the analyzer does on recordings whose truth is known.
//!
//! [`reference`](mod@reference) is the truth, [`matching`] pairs what was found with it, [`scores`] says what that means
//! for one recording, [`rows`] sums recordings up, [`text`] and [`rows::Evaluation`] show it, [`thresholds`] hold it to
//! what was once reached. Nothing here reads a file or a clock: analyses and seconds come from outside.

pub mod matching;
#[cfg(feature = "plots")]
pub mod picture;
pub mod reference;
pub mod rows;
pub mod scores;
mod statistics;
pub mod text;
pub mod thresholds;

#[cfg(test)]
mod tests;
