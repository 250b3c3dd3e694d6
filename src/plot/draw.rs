//! Figures onto a drawing area of `plotters`, whatever is behind it.

use std::fmt::Display;

use plotters::chart::{ChartBuilder, ChartContext, SeriesLabelPosition};
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::drawing::DrawingArea;
use plotters::element::{Circle, DashedPathElement, EmptyElement, PathElement, Polygon, Text};
use plotters::prelude::DrawingBackend;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontFamily, FontStyle, ShapeStyle, TextStyle, WHITE};

use super::style::{self, FONT};
use super::{Axis, Colour, Corner, Curve, Dots, Figure, Layer, Note, Panel, Side, Stroke, clip};
use crate::Error;

type Area<DB> = DrawingArea<DB, Shift>;
type Chart<'a, DB> = ChartContext<'a, DB, Cartesian2d<Axis, Axis>>;

pub(super) fn problem(error: &impl Display) -> Error {
    Error::Plot {
        problem: error.to_string(),
    }
}

/// Draws a figure with all sizes times `scale`.
pub(super) fn figure<DB: DrawingBackend>(
    figure: &Figure,
    area: &Area<DB>,
    scale: u32,
) -> Result<(), Error> {
    style::register()?;
    area.fill(&WHITE).map_err(|e| problem(&e))?;
    let pen = Pen { scale };
    let title = pen.text(style::TITLE_PX, Colour::BLACK);
    let area = area
        .margin(pen.px(14), 0, 0, 0)
        .titled(&figure.title, title)
        .map_err(|e| problem(&e))?;
    let parts = area.split_evenly((1, figure.panels.len().max(1)));
    for (panel, part) in figure.panels.iter().zip(&parts) {
        pen.panel(panel, part)?;
    }
    Ok(())
}

/// Draws at one scale.
#[derive(Debug, Clone, Copy)]
struct Pen {
    scale: u32,
}

impl Pen {
    fn px(self, size: u32) -> i32 {
        i32::try_from(size * self.scale).unwrap_or(i32::MAX)
    }

    fn text(self, size: u32, colour: Colour) -> TextStyle<'static> {
        let family = FontFamily::Name(FONT);
        let size = f64::from(size * self.scale);
        TextStyle {
            color: colour.0.to_backend_color(),
            ..TextStyle::from((family, size, FontStyle::Normal))
        }
    }

    fn line(self, colour: Colour, width: u32) -> ShapeStyle {
        colour.0.stroke_width(width * self.scale)
    }

    fn panel<'a, DB: DrawingBackend + 'a>(
        self,
        panel: &Panel,
        area: &'a Area<DB>,
    ) -> Result<(), Error> {
        panel.x.check()?;
        panel.y.check()?;
        let mut chart = ChartBuilder::on(area)
            .margin(self.px(16))
            .margin_right(self.px(32))
            .x_label_area_size(self.px(78))
            .y_label_area_size(self.px(110))
            .build_cartesian_2d(panel.x.clone(), panel.y.clone())
            .map_err(|e| problem(&e))?;
        self.mesh(&mut chart, panel)?;
        for layer in &panel.layers {
            match layer {
                Layer::Curve(curve) => self.curve(&mut chart, curve, panel)?,
                Layer::Dots(dots) => self.dots(&mut chart, dots)?,
                Layer::Note(note) => self.note(&mut chart, note)?,
                Layer::Span { from, to } => self.span(&mut chart, *from, *to)?,
            }
        }
        self.legend(&mut chart, panel)
    }

    fn mesh<'a, DB: DrawingBackend + 'a>(
        self,
        chart: &mut Chart<'a, DB>,
        panel: &Panel,
    ) -> Result<(), Error> {
        chart
            .configure_mesh()
            .x_desc(panel.x.label.as_str())
            .y_desc(panel.y.label.as_str())
            .axis_desc_style(self.text(style::LABEL_PX, Colour::BLACK))
            .label_style(self.text(style::TICK_PX, Colour::BLACK))
            .axis_style(self.line(Colour::BLACK, 2))
            .bold_line_style(Colour::GREY.0.mix(0.35).stroke_width(self.scale))
            .light_line_style(Colour::GREY.0.mix(0.14).stroke_width(self.scale))
            .set_all_tick_mark_size(self.px(7))
            .draw()
            .map_err(|e| problem(&e))
    }

    fn stroke(self, curve: &Curve) -> ShapeStyle {
        match curve.stroke {
            Stroke::Solid => self.line(curve.colour, style::CURVE_PX),
            Stroke::Dashed => self.line(curve.colour, 2),
            Stroke::Broad => {
                let pale = curve.colour.0.mix(0.4);
                pale.stroke_width(style::BROAD_PX * self.scale)
            }
        }
    }

    fn curve<'a, DB: DrawingBackend + 'a>(
        self,
        chart: &mut Chart<'a, DB>,
        curve: &Curve,
        panel: &Panel,
    ) -> Result<(), Error> {
        let style = self.stroke(curve);
        let (dash, gap, sample) = (self.px(12), self.px(8), self.px(SAMPLE_PX));
        let parts = clip::inside(&curve.points, &panel.x, &panel.y).into_iter();
        let drawn = if curve.stroke == Stroke::Dashed {
            let dashed = |part| DashedPathElement::new(part, dash, gap, style);
            chart.draw_series(parts.map(dashed))
        } else {
            chart.draw_series(parts.map(|part| PathElement::new(part, style)))
        };
        let drawn = drawn.map_err(|e| problem(&e))?;
        let Some(name) = &curve.name else {
            return Ok(());
        };
        let labelled = drawn.label(name.as_str());
        if curve.stroke == Stroke::Dashed {
            labelled.legend(move |(x, y)| {
                DashedPathElement::new([(x, y), (x + sample, y)], dash, gap, style)
            });
        } else {
            labelled.legend(move |(x, y)| PathElement::new([(x, y), (x + sample, y)], style));
        }
        Ok(())
    }

    fn dots<'a, DB: DrawingBackend + 'a>(
        self,
        chart: &mut Chart<'a, DB>,
        dots: &Dots,
    ) -> Result<(), Error> {
        let size = self.px(style::DOT_PX);
        // The rim lifts the point off the curves behind it.
        let rim = size + self.px(2);
        let fill = if dots.hollow {
            self.line(dots.colour, 4)
        } else {
            dots.colour.0.filled()
        };
        let rims = dots.points.iter();
        let rims = rims.map(|&at| Circle::new(at, rim, WHITE.filled()));
        chart.draw_series(rims).map_err(|e| problem(&e))?;
        let points = dots.points.iter();
        let points = points.map(|&at| Circle::new(at, size, fill));
        let drawn = chart.draw_series(points).map_err(|e| problem(&e))?;
        if let Some(name) = &dots.name {
            let middle = self.px(SAMPLE_PX) / 2;
            let sample = move |(x, y)| Circle::new((x + middle, y), size, fill);
            drawn.label(name.as_str()).legend(sample);
        }
        Ok(())
    }

    fn note<'a, DB: DrawingBackend + 'a>(
        self,
        chart: &mut Chart<'a, DB>,
        note: &Note,
    ) -> Result<(), Error> {
        let gap = self.px(14);
        let (horizontal, vertical, offset) = match note.side {
            Side::Left => (HPos::Right, VPos::Center, (-gap, 0)),
            Side::Right => (HPos::Left, VPos::Center, (gap, 0)),
            Side::Above => (HPos::Center, VPos::Bottom, (0, -self.px(20))),
            Side::Below => (HPos::Center, VPos::Top, (0, gap)),
        };
        let style = self.text(style::TICK_PX, note.colour);
        let style = style.pos(Pos::new(horizontal, vertical));
        let text = Text::new(note.text.clone(), offset, style);
        let placed = EmptyElement::at(note.at) + text;
        chart.draw_series([placed]).map_err(|e| problem(&e))?;
        Ok(())
    }

    fn span<'a, DB: DrawingBackend + 'a>(
        self,
        chart: &mut Chart<'a, DB>,
        from: (f64, f64),
        to: (f64, f64),
    ) -> Result<(), Error> {
        let style = self.line(Colour::BLACK, 2);
        let shaft = PathElement::new([from, to], style);
        chart.draw_series([shaft]).map_err(|e| problem(&e))?;
        let (start, end) = (chart.backend_coord(&from), chart.backend_coord(&to));
        let along = (f64::from(end.0 - start.0), f64::from(end.1 - start.1));
        let length = along.0.hypot(along.1).max(1.0);
        let head = f64::from(self.px(12)) / length;
        for (at, direction) in [(from, head), (to, -head)] {
            let (dx, dy) = (direction * along.0, direction * along.1);
            // Half as wide as long.
            let corners = [
                (dx - 0.35 * dy, dy + 0.35 * dx),
                (dx + 0.35 * dy, dy - 0.35 * dx),
            ];
            let [left, right] = corners.map(|(x, y)| (pixel(x), pixel(y)));
            let triangle = Polygon::new([(0, 0), left, right], Colour::BLACK.0.filled());
            chart
                .draw_series([EmptyElement::at(at) + triangle])
                .map_err(|e| problem(&e))?;
        }
        Ok(())
    }

    fn legend<'a, DB: DrawingBackend + 'a>(
        self,
        chart: &mut Chart<'a, DB>,
        panel: &Panel,
    ) -> Result<(), Error> {
        let named = |layer: &Layer| match layer {
            Layer::Curve(curve) => curve.name.is_some(),
            Layer::Dots(dots) => dots.name.is_some(),
            Layer::Note(_) | Layer::Span { .. } => false,
        };
        if !panel.layers.iter().any(named) {
            return Ok(());
        }
        let position = match panel.legend {
            Corner::UpperLeft => SeriesLabelPosition::UpperLeft,
            Corner::UpperRight => SeriesLabelPosition::UpperRight,
            Corner::LowerLeft => SeriesLabelPosition::LowerLeft,
            Corner::LowerRight => SeriesLabelPosition::LowerRight,
        };
        chart
            .configure_series_labels()
            .position(position)
            .margin(self.px(16))
            .legend_area_size(self.px(SAMPLE_PX + 12))
            .label_font(self.text(style::TICK_PX, Colour::BLACK))
            .background_style(WHITE.mix(0.9))
            .draw()
            .map_err(|e| problem(&e))
    }
}

/// Length of the sample of a line in the legend.
const SAMPLE_PX: u32 = 44;

#[expect(
    clippy::cast_possible_truncation,
    reason = "`as` saturates, and arrow heads are small"
)]
fn pixel(length: f64) -> i32 {
    length.round() as i32
}
