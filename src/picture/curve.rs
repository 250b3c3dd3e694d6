//! e against speed over all drops: the bounces, the curve and its band.

use super::around;
use crate::plot::{Axis, Band, Colour, Curve, Dots, Figure, Layer, Panel, Shape};
use crate::report::curve::SpeedCurve;
use crate::statistics::sorted;
use crate::units::{real, whole};

/// The axis of e leaves out as many bounces at either end: those that stray farthest would make a line of the band. Convention.
const SHARE_SHOWN: f64 = 0.98;

/// One picture.
#[must_use]
pub fn sheet(curve: &SpeedCurve) -> Figure {
    let rows = curve.rows();
    let ends = |i: usize| {
        rows.iter()
            .map(move |r| r.restitution.interval95.unwrap_or([r.restitution.value; 2])[i])
    };
    let dots: Vec<(f64, f64)> = curve.bounces().iter().map(|(v, e, _)| (*v, *e)).collect();
    let (low, high) = around(ends(0).chain(ends(1)).chain(most(&dots)), 0.05);
    let (slow, fast) = (
        rows.first().map_or(0.1, |r| r.speed_m_per_s),
        rows.last().map_or(10.0, |r| r.speed_m_per_s),
    );
    let speed = Axis::logarithmic("impact speed (m/s)", 0.95 * slow, 1.05 * fast);
    let line = rows.iter().map(|r| (r.speed_m_per_s, r.restitution.value));
    let band = rows.iter().zip(ends(0).zip(ends(1)));
    let panel = Panel::new(speed, Axis::linear("e", low, high).with_ticks(7))
        .with(Layer::Dots(
            Dots::new(dots, Shape::Point, Colour::GREY).named("bounces"),
        ))
        .with(Layer::Band(Band {
            points: band
                .map(|(r, (from, to))| (r.speed_m_per_s, from, to))
                .collect(),
            colour: Colour::BLUE,
            name: Some("95 % band".to_owned()),
        }))
        .with(Layer::Curve(
            Curve::new(line.collect(), Colour::BLUE).named("all drops"),
        ));
    Figure::new("e against speed, over all drops", vec![panel])
}

/// The range of e that most bounces keep to: the last ones of a drop stray far.
fn most(dots: &[(f64, f64)]) -> Vec<f64> {
    let values = sorted(dots.iter().map(|(_, e)| *e));
    let at = |share: f64| {
        values
            .get(whole(share * real(values.len().saturating_sub(1))))
            .copied()
    };
    [1.0 - SHARE_SHOWN, SHARE_SHOWN]
        .into_iter()
        .filter_map(at)
        .collect()
}
