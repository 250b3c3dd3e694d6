//! Figure 4 of the paper: total time against the number of bounces, for several e.

use crate::Error;
use crate::physics::{BounceSeries, Restitution};
use crate::plot::{Axis, Colour, Curve, Dots, Figure, Layer, Note, Panel, Shape, Side};
use crate::units::{real, whole};

/// e of the curves of the paper.
const CURVES: [f64; 6] = [0.70, 0.80, 0.85, 0.90, 0.93, 0.95];
/// Points of a curve.
const POINTS: usize = 100;
/// Curves go on this much beyond the point, and the axis beyond them.
const BEYOND: f64 = 100.0 / 70.0;
const ROOM: f64 = 1.15;
/// A curve of the paper that is nearer to the e found gives way to it.
const NEAR: f64 = 0.012;

/// A drop of which n and `T_total` are known.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// n.
    pub bounces: usize,
    /// `T_total` in seconds.
    pub total_time_s: f64,
    /// Its standard error in seconds, if known.
    pub total_time_std_s: Option<f64>,
    /// e by (25), if its curve is to be drawn.
    pub restitution: Option<f64>,
    /// What the legend says of it.
    pub name: String,
}

/// `T_total` against n by (25), with a point.
///
/// # Errors
/// [`Error::Argument`] where height, gravity or e are out of range.
pub fn figure(
    height_m: f64,
    gravity_m_per_s2: f64,
    point: &Point,
    title: &str,
) -> Result<Figure, Error> {
    let series = BounceSeries::new(height_m, gravity_m_per_s2)?;
    let last = whole(BEYOND * real(point.bounces.max(2)));
    let own = point.restitution;
    let mut drawn: Vec<(f64, Colour)> = CURVES.into_iter().zip(Colour::FAMILY).collect();
    drawn.retain(|(e, _)| own.is_none_or(|own| (e - own).abs() > NEAR));
    drawn.extend(own.map(|e| (e, Colour::BLACK)));
    let (mut curves, mut names) = (Vec::new(), Vec::new());
    let mut longest = point.total_time_s;
    for (e, colour) in drawn {
        let points = curve(&series, Restitution::new(e)?, last)?;
        let at = points.last().copied().unwrap_or_default();
        longest = longest.max(at.1);
        let digits = if own == Some(e) { 4 } else { 2 };
        names.push(Note {
            at,
            side: Side::Right,
            text: format!("e = {e:.digits$}"),
            colour,
        });
        curves.push(Layer::Curve(Curve::new(points, colour)));
    }
    // The curve of the point is named first, and so always.
    names.reverse();
    let at = (real(point.bounces), point.total_time_s);
    let mut dot = Dots::new(vec![at], Shape::Disc, Colour::BLACK).named(&point.name);
    if let Some(std_s) = point.total_time_std_s {
        dot = dot.with_errors([std_s]);
    }
    let mut panel = Panel::new(
        Axis::counting("number of bounces n", 0.0, ROOM * real(last)),
        Axis::linear(
            "total time from release to rest (s)",
            0.0,
            ROOM * ROOM * longest,
        ),
    );
    panel.layers = curves;
    let panel = panel.with(Layer::Labels(names)).with(Layer::Dots(dot));
    Ok(Figure::new(title, vec![panel]))
}

fn curve(
    series: &BounceSeries,
    restitution: Restitution,
    last: usize,
) -> Result<Vec<(f64, f64)>, Error> {
    let mut numbers: Vec<usize> = (0..=POINTS).map(|k| 1 + (last - 1) * k / POINTS).collect();
    numbers.dedup();
    let point = |n: usize| Ok((real(n), series.total_time_s(restitution, n)?));
    numbers.into_iter().map(point).collect()
}
