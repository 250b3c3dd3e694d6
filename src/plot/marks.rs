//! Points with error bars, and areas, onto a panel.

use plotters::element::{Circle, Cross, PathElement, Polygon};
use plotters::prelude::DrawingBackend;
use plotters::style::{Color, ShapeStyle, WHITE};

use super::draw::{Chart, Pen, problem};
use super::{Axis, Band, Dots, Panel, Shape, style};
use crate::Error;

impl Shape {
    pub(super) const fn radius_px(self) -> u32 {
        match self {
            Self::Disc | Self::Ring => style::DOT_PX,
            Self::Point | Self::Circlet => style::POINT_PX,
            Self::Cross => style::CROSS_PX,
        }
    }
}

impl Pen {
    pub(super) fn point_style(self, dots: &Dots) -> ShapeStyle {
        match dots.shape {
            Shape::Disc | Shape::Point => dots.colour.0.filled(),
            Shape::Ring => self.line(dots.colour, 4),
            Shape::Circlet | Shape::Cross => self.line(dots.colour, 2),
        }
    }

    pub(super) fn dots<'a, DB: DrawingBackend + 'a>(
        self,
        chart: &mut Chart<'a, DB>,
        dots: &Dots,
        panel: &Panel,
    ) -> Result<(), Error> {
        self.bars(chart, dots, panel)?;
        let size = self.px(dots.shape.radius_px());
        let fill = self.point_style(dots);
        let inside = |at: &(f64, f64)| within(&panel.x, at.0) && within(&panel.y, at.1);
        let points: Vec<(f64, f64)> = dots.points.iter().copied().filter(inside).collect();
        if matches!(dots.shape, Shape::Disc | Shape::Ring | Shape::Circlet) {
            // The rim lifts the point off the curves behind it; a small ring is white inside.
            let rim = match dots.shape {
                Shape::Circlet => size,
                _ => size + self.px(2),
            };
            let rims = points.iter();
            let rims = rims.map(|&at| Circle::new(at, rim, WHITE.filled()));
            chart.draw_series(rims).map_err(|e| problem(&e))?;
        }
        let drawn = if dots.shape == Shape::Cross {
            chart.draw_series(points.iter().map(|&at| Cross::new(at, size, fill)))
        } else {
            chart.draw_series(points.iter().map(|&at| Circle::new(at, size, fill)))
        };
        drawn.map_err(|e| problem(&e))?;
        Ok(())
    }

    fn bars<'a, DB: DrawingBackend + 'a>(
        self,
        chart: &mut Chart<'a, DB>,
        dots: &Dots,
        panel: &Panel,
    ) -> Result<(), Error> {
        let style = self.line(dots.colour, 2);
        let bars = dots.points.iter().zip(&dots.bars);
        let bars = bars.filter_map(|(&(x, _), &(low, high))| {
            let (low, high) = (clamped(&panel.y, low)?, clamped(&panel.y, high)?);
            (within(&panel.x, x) && low < high)
                .then(|| PathElement::new([(x, low), (x, high)], style))
        });
        chart.draw_series(bars).map_err(|e| problem(&e))?;
        Ok(())
    }

    pub(super) fn band<'a, DB: DrawingBackend + 'a>(
        self,
        chart: &mut Chart<'a, DB>,
        band: &Band,
        panel: &Panel,
    ) -> Result<(), Error> {
        let (mut lower, mut upper) = (Vec::new(), Vec::new());
        for &(x, low, high) in &band.points {
            let ends = clamped(&panel.y, low).zip(clamped(&panel.y, high));
            let Some(((low, high), x)) = ends.zip(clamped(&panel.x, x)) else {
                continue;
            };
            lower.push((x, low));
            upper.push((x, high));
        }
        if lower.is_empty() {
            return Ok(());
        }
        lower.extend(upper.into_iter().rev());
        let area = Polygon::new(lower, band.colour.0.mix(style::PALE).filled());
        chart.draw_series([area]).map_err(|e| problem(&e))?;
        Ok(())
    }
}

fn within(axis: &Axis, value: f64) -> bool {
    (-1e-9..=1.0 + 1e-9).contains(&axis.place(value))
}

/// The nearest value on the axis; none where there is none.
fn clamped(axis: &Axis, value: f64) -> Option<f64> {
    // What is not positive lies below the start of a logarithmic axis.
    let place = axis.place(value);
    if value.is_nan() || (place.is_nan() && value > 0.0) {
        return None;
    }
    Some(if place > 0.0 {
        axis.value(place.min(1.0))
    } else {
        axis.from
    })
}
