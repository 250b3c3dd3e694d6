//! A few onsets closely, each with its time and the error of it.

use super::around;
use super::sound::Onset;
use crate::plot::{Axis, Band, Colour, Curve, Layer, Panel, Stroke};
use crate::report::{Drop, decimals};

/// More samples than this are shown by the least and the greatest of each few.
const MOST_POINTS: usize = 1000;

/// Errors of times below a thousandth of a microsecond are not written out.
const LEAST_STD_S: f64 = 1e-9;

/// A panel for each onset.
pub(super) fn panels(drop: &Drop, onsets: &[Onset]) -> Vec<Panel> {
    let panels = onsets.iter().filter(|onset| !onset.samples.is_empty());
    panels.map(|onset| panel(drop, onset)).collect()
}

fn panel(drop: &Drop, onset: &Onset) -> Panel {
    let impact = &drop.impacts[onset.impact];
    let samples = onset.samples.iter().enumerate();
    let points = samples.map(|(i, &x)| (1e3 * (onset.time_s(i) - impact.time_s), f64::from(x)));
    let points = thinned(points.collect());
    let greatest = points.iter().map(|p| p.1.abs()).fold(0.0, f64::max);
    let (low, high) = around([-greatest, greatest], 0.1);
    let (from, to) = around(points.iter().map(|p| p.0), 0.0);
    let std_ms = 1e3 * impact.time_std_s.unwrap_or(0.0);
    let amplitude = Axis::linear("amplitude", low, high).with_ticks(5);
    Panel::new(
        Axis::linear("after its onset (ms)", from, to).with_ticks(6),
        amplitude,
    )
    .headed(format!(
        "Impact {}: {}",
        onset.impact + 1,
        time(impact.time_s, impact.time_std_s)
    ))
    .with(Layer::Band(Band {
        points: [-std_ms, std_ms].map(|x| (x, low, high)).to_vec(),
        colour: Colour::RED,
        name: None,
    }))
    .with(Layer::Curve(
        Curve::new(vec![(0.0, low), (0.0, high)], Colour::RED).stroke(Stroke::Dashed),
    ))
    .with(Layer::Curve(
        Curve::new(points, Colour::BLUE).stroke(Stroke::Fine),
    ))
}

/// `0.700217 s ± 0.014 µs`.
fn time(time_s: f64, std_s: Option<f64>) -> String {
    let Some(std_s) = std_s else {
        return format!("{time_s:.4} s");
    };
    let places = decimals(std_s).clamp(3, 6);
    let (std, unit) = if std_s < 1e-3 {
        (1e6 * std_s, "µs")
    } else {
        (1e3 * std_s, "ms")
    };
    if std_s < LEAST_STD_S {
        return format!("{time_s:.places$} s ± < 0.001 µs");
    }
    let digits = decimals(std);
    format!("{time_s:.places$} s ± {std:.digits$} {unit}")
}

/// The same line with fewer points.
fn thinned(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    if points.len() <= MOST_POINTS {
        return points;
    }
    let few = (2 * points.len()).div_ceil(MOST_POINTS);
    let extremes = points.chunks(few).flat_map(|part| {
        let by_size = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
        let ends = [part.iter().min_by(by_size), part.iter().max_by(by_size)];
        let mut ends: Vec<(f64, f64)> = ends.into_iter().flatten().copied().collect();
        ends.sort_by(|a, b| a.0.total_cmp(&b.0));
        ends
    });
    extremes.collect()
}
