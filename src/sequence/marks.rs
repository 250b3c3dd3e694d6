//! What an impact sounds like beside the one before it: its loudness and its sound, against those of events at large.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_2_SQRT_PI};

use super::Event;
use crate::event::Profile;

/// Scale of the loudness of an impact about that of those before it, as a natural logarithm; measured: neighbours differ by a
/// factor of 1.4 on quiet recordings, and by two among noise.
const LOUDNESS_SPREAD: f64 = 0.6;
/// Density of the loudness of anything: from what can just be heard to the loudest are five units of ln.
pub(super) const LOUDNESS_AT_LARGE: f64 = 0.2;
/// Width of the kernel by which the loudness of clutter is estimated.
const KERNEL_WIDTH: f64 = 0.3;
/// Beyond this difference in loudness the kernel is nothing.
pub(super) const KERNEL_REACH: f64 = 3.0 * KERNEL_WIDTH;
/// Density of the difference in loudness of two impacts of one ball at 0. Derived: normal, √2·0.6 wide.
pub(super) const LOUDNESS_OF_ANOTHER: f64 = 0.47;

/// Profiles of neighbouring impacts of great strength are as unlike as this …
const LEAST_UNLIKENESS: f64 = 5e-3;
/// … and this divided by the strength more: the profile of a faint sound is known badly. Measured on neighbouring impacts.
const FAINT_UNLIKENESS: f64 = 2.2;
/// Mean unlikeness of two sounds at large; measured.
const UNLIKENESS_AT_LARGE: f64 = 0.25;
/// Share of impacts whose sound is like none before.
const OTHER: f64 = 0.1;

/// Density of the loudness of an event where another was found: normal.
pub(super) fn loudness_kernel(a: &Event, b: &Event) -> f64 {
    let off = (a.loudness - b.loudness).abs();
    if off > KERNEL_REACH {
        return 0.0;
    }
    let off = off / KERNEL_WIDTH;
    0.5 * FRAC_1_SQRT_2 * FRAC_2_SQRT_PI / KERNEL_WIDTH * (-0.5 * off * off).exp()
}

/// ln of the density of the loudness of an impact so far from what is expected: Student's with four degrees of freedom.
pub(super) fn ln_loudness_density(off: f64) -> f64 {
    let squared = (off / LOUDNESS_SPREAD).powi(2);
    (0.375 / LOUDNESS_SPREAD).ln() - 2.5 * (0.25 * squared).ln_1p()
}

/// ln of how much likelier the sound of an event is after one of the same ball than it is at large; 0 where nothing is
/// known of one of them.
///
/// # Formula
/// `(1 − ε)·exp(−u/τ)/Z + ε` for profiles as unlike as u, `τ = τ₀ + c/s` for an event of s nats, and `Z = τ/(τ + ū)`, the mean
/// of `exp(−u/τ)` where u is exponential with mean ū, as it is of two sounds at large.
pub(super) fn ln_likeness(event: &Event, before: &Profile) -> f64 {
    if !event.profile.is_known() || !before.is_known() {
        return 0.0;
    }
    let width = LEAST_UNLIKENESS + FAINT_UNLIKENESS / event.strength;
    let at_large = width / (width + UNLIKENESS_AT_LARGE);
    let like = (-event.profile.unlikeness(before) / width).exp() / at_large;
    ((1.0 - OTHER) * like + OTHER).ln()
}

/// ln of the density of what an event sounds like as the next impact of a ball, whose speed changes by this ratio.
pub(super) fn ln_sounds(before: &Event, event: &Event, ratio: f64) -> f64 {
    let louder = event.loudness - before.loudness - ratio.ln();
    ln_loudness_density(louder) + ln_likeness(event, &before.profile)
}
