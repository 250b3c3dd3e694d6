//! A few onsets closely, each with its time and the error of it.

use super::around;
use super::sound::Onset;
use crate::order::sort_by_number;
use crate::plot::{Axis, Band, Colour, Curve, Layer, Panel, Stroke};
use crate::report::{Drop, short_decimals};

/// More samples than this are shown by the least and the greatest of each few.
const MOST_POINTS: usize = 1000;

/// Errors of times below this are not written out, in µs.
const LEAST_STD_US: f64 = 0.01;

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
    let amplitude = Axis::linear("amplitude", low, high).with_ticks(0);
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

/// `0.70022 s ± 0.03 µs`, the time to 10 µs, which is finer than a picture shows.
fn time(time_s: f64, std_s: Option<f64>) -> String {
    let Some(std_s) = std_s else {
        return format!("{time_s:.4} s");
    };
    let (std, unit, least) = if std_s < 1e-3 {
        (1e6 * std_s, "µs", LEAST_STD_US)
    } else {
        (1e3 * std_s, "ms", 0.0)
    };
    if std < least {
        return format!("{time_s:.5} s within {least} µs");
    }
    let digits = short_decimals(std);
    format!("{time_s:.5} s ± {std:.digits$} {unit}")
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
        sort_by_number(&mut ends, |(x, _)| *x);
        ends
    });
    extremes.collect()
}
