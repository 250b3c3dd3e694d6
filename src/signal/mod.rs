//! Tools for sampled signals, which know nothing of impacts: octave bands, whitening, correlation, interpolation.

pub(crate) mod constant_fraction;
pub mod correlate;
pub mod filterbank;
mod fourier;
pub mod interpolate;
pub(crate) mod logarithm;
pub(crate) mod smooth;
pub mod sound;
pub mod template;
pub mod whiten;
