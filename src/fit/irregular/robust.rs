//! A trend and a scatter that single odd values do not move, and the odds that a value is odd.

use crate::statistics::{MAD_TO_STD, median};
use crate::units::real;

/// Least scatter of ln of a ratio: that of a fine ball on a fine plate.
pub(super) const LEAST_SCATTER: f64 = 0.003;
/// Efficiency of the median deviation: it is as exact as the standard deviation of this share of as many values.
const EFFICIENCY: f64 = 0.3675;
/// An accident: its prior probability, and the scale of ln of its ratio over that expected.
pub(super) type Accident = (f64, f64);
/// Theil and Sen's line: its value at a place, and the deviations of its points.
pub(super) fn line(points: &[(f64, f64)], at: f64) -> Option<(f64, Vec<f64>)> {
    let pairs = points.iter().enumerate();
    let slopes = pairs.flat_map(|(i, a)| {
        points[i + 1..]
            .iter()
            .map(move |b| (b.1 - a.1) / (b.0 - a.0))
    });
    let slope = median(slopes)?;
    let level = median(points.iter().map(|p| p.1 - slope * (p.0 - at)))?;
    let off = points.iter().map(|p| p.1 - level - slope * (p.0 - at));
    Some((level, off.collect()))
}

/// Robust standard deviation of deviations, and its degrees of freedom.
pub(super) fn spread(off: &[f64]) -> (f64, f64) {
    let middle = median(off.iter().map(|d| d.abs())).unwrap_or(0.0);
    (
        (MAD_TO_STD * middle).max(LEAST_SCATTER),
        EFFICIENCY * real(off.len()),
    )
}

/// ln of the odds that a deviation is by an accident, and not by a scatter of this variance and degrees of freedom.
pub(super) fn ln_odds(
    deviation: f64,
    (variance, freedom): (f64, f64),
    (prior, scale): Accident,
) -> f64 {
    let ln_density = |scale: f64| {
        -scale.ln() - 0.5 * (freedom + 1.0) * ((deviation / scale).powi(2) / freedom).ln_1p()
    };
    let std = variance.sqrt();
    (prior / (1.0 - prior)).ln() + ln_density(std.hypot(scale)) - ln_density(std)
}
