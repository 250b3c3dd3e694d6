//! Tools for sampled signals, which know nothing of impacts: octave bands, whitening, correlation, interpolation.

pub mod correlate;
pub mod filterbank;
pub mod interpolate;
pub(crate) mod logarithm;
pub mod whiten;
