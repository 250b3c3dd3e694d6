//! The pictures of results: pure functions of a report and of the little that was kept of its sound.
//!
//! [`sheet`] shows one drop of a recording on one sheet, [`batch`] many recordings, [`curve`] e against speed over all of them, [`total_time`] numbers typed in.
//! [`to_svg`] and [`to_png`] draw them, whatever they show.

pub mod batch;
mod bounces;
pub mod curve;
mod fitted;
mod level;
mod names;
mod onsets;
pub mod sheet;
pub mod sound;
pub mod total_time;

#[cfg(not(target_arch = "wasm32"))]
pub use crate::plot::to_png;
pub use crate::plot::{Figure, to_svg};

/// The ends of an axis that holds values with room on both sides; about a single value, or none, it still has extent.
fn around(values: impl IntoIterator<Item = f64>, room: f64) -> (f64, f64) {
    let finite = values.into_iter().filter(|v| v.is_finite());
    let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
        (low.min(v), high.max(v))
    });
    if low > high {
        return (0.0, 1.0);
    }
    let extent = (high - low).max(1e-6 * low.abs().max(high.abs()));
    let extent = if extent > 0.0 { extent } else { 1.0 };
    (low - room * extent, high + room * extent)
}

/// The same for positive values on a logarithmic axis, which then spans a factor of 1.2 at least.
fn around_by_ratio(values: impl IntoIterator<Item = f64>, room: f64) -> (f64, f64) {
    let logarithms = values.into_iter().filter(|v| *v > 0.0).map(f64::ln);
    let (low, high) = at_least(around(logarithms, room), 0.2);
    (low.exp(), high.exp())
}

/// Ends of an axis moved apart to an extent.
fn at_least((low, high): (f64, f64), extent: f64) -> (f64, f64) {
    let missing = (extent - (high - low)).max(0.0);
    (low - 0.5 * missing, high + 0.5 * missing)
}

/// A name from outside that can stand in a document: without control characters.
fn printable(name: &str) -> String {
    name.replace(char::is_control, "?")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_have_extent_whatever_they_hold() {
        for values in [vec![], vec![3.0], vec![0.0], vec![f64::NAN, 1.0, 1.0]] {
            let (low, high) = around(values.clone(), 0.1);
            assert!(low < high, "{values:?}");
            let (low, high) = around_by_ratio(values.clone(), 0.1);
            assert!(low > 0.0 && low < high, "{values:?}");
        }
        assert_eq!(around([1.0, 3.0], 0.5), (0.0, 4.0));
    }
}
