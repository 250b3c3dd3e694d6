//! Figures onto a drawing area of `plotters`, whatever is behind it.

use std::fmt::Display;

use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::Shift;
use plotters::coord::cartesian::Cartesian2d;
use plotters::drawing::DrawingArea;
use plotters::element::{DashedPathElement, EmptyElement, PathElement, Polygon};
use plotters::prelude::DrawingBackend;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontFamily, FontStyle, ShapeStyle, TextStyle, WHITE};

use super::heading::{fitting, width};
use super::style::{self, FONT};
use super::{Axis, Colour, Curve, Figure, Layer, Panel, Stroke, clip};
use crate::Error;

pub(super) type Area<DB> = DrawingArea<DB, Shift>;
pub(super) type Chart<'a, DB> = ChartContext<'a, DB, Cartesian2d<Axis, Axis>>;

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
    // A bitmap draws and measures by `plotters`.
    #[cfg(not(target_arch = "wasm32"))]
    style::register()?;
    area.fill(&WHITE).map_err(|e| problem(&e))?;
    let pen = Pen {
        scale: f64::from(scale) * figure.density,
    };
    let mut rest = area.margin(pen.px(14), 0, 0, 0);
    let titles = [
        (figure.headline.as_ref(), style::HEADLINE_PX),
        (Some(&figure.title), style::TITLE_PX),
        (figure.subtitle.as_ref(), style::TICK_PX),
    ];
    for (text, size) in titles {
        let Some(text) = text else { continue };
        let (line, below) = rest.split_vertically(pen.px(size + 10));
        pen.centred(text, size, &line)?;
        rest = below;
    }
    let all: u32 = figure.rows.iter().map(|row| row.height).sum();
    let (_, height) = rest.dim_in_pixel();
    for row in &figure.rows {
        let share = u64::from(height) * u64::from(row.height) / u64::from(all.max(1));
        let (own, below) = rest.split_vertically(i32::try_from(share).unwrap_or(0));
        let parts = own.split_evenly((1, row.panels.len().max(1)));
        for (panel, part) in row.panels.iter().zip(&parts) {
            pen.panel(panel, part)?;
        }
        rest = below;
    }
    Ok(())
}

/// Draws at one scale.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pen {
    scale: f64,
}

impl Pen {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "`as` saturates, and sizes are small"
    )]
    pub(super) fn px(self, size: u32) -> i32 {
        (f64::from(size) * self.scale).round() as i32
    }

    pub(super) fn text(self, size: u32, colour: Colour) -> TextStyle<'static> {
        let family = FontFamily::Name(FONT);
        let size = f64::from(self.px(size));
        TextStyle {
            color: colour.0.to_backend_color(),
            ..TextStyle::from((family, size, FontStyle::Normal))
        }
    }

    pub(super) fn line(self, colour: Colour, width: u32) -> ShapeStyle {
        colour.0.stroke_width(self.width(width))
    }

    fn width(self, width: u32) -> u32 {
        u32::try_from(self.px(width)).unwrap_or(0).max(1)
    }

    /// A line of text in the middle of an area, shortened where it has no room.
    fn centred<DB: DrawingBackend>(
        self,
        text: &str,
        size: u32,
        area: &Area<DB>,
    ) -> Result<(), Error> {
        let (width, height) = area.dim_in_pixel();
        let [width, height] = [width, height].map(|s| i32::try_from(s).unwrap_or(0));
        let style = self.text(size, Colour::BLACK);
        let style = style.pos(Pos::new(HPos::Center, VPos::Center));
        let text = fitting(area, text, &style, width - self.px(40))?;
        area.draw_text(&text, &style, (width / 2, height / 2))
            .map_err(|e| problem(&e))
    }

    fn panel<'a, DB: DrawingBackend + 'a>(
        self,
        panel: &Panel,
        area: &'a Area<DB>,
    ) -> Result<(), Error> {
        panel.x.check()?;
        panel.y.check()?;
        let beside = self.beside(panel, area)?;
        let named = panel.layers.iter().any(|layer| layer.name().is_some());
        let above = panel.heading.is_some() || named;
        let height = if above { self.px(HEADING_PX) } else { 0 };
        let (head, area) = area.split_vertically(height);
        if above {
            let (width, _) = head.dim_in_pixel();
            let right = i32::try_from(width).unwrap_or(0) - self.px(MARGIN_RIGHT_PX);
            let left = self.px(MARGIN_PX) + beside;
            self.heading(panel, &head, (left, right))?;
        }
        let mut chart = ChartBuilder::on(&area)
            .margin(self.px(MARGIN_PX))
            .margin_top(self.px(if above { 2 } else { MARGIN_PX }))
            .margin_right(self.px(MARGIN_RIGHT_PX))
            .x_label_area_size(self.px(78))
            .y_label_area_size(beside)
            .build_cartesian_2d(panel.x.clone(), panel.y.clone())
            .map_err(|e| problem(&e))?;
        self.mesh(&mut chart, panel)?;
        for layer in &panel.layers {
            match layer {
                Layer::Curve(curve) => self.curve(&mut chart, curve, panel)?,
                Layer::Dots(dots) => self.dots(&mut chart, dots, panel)?,
                Layer::Band(band) => self.band(&mut chart, band, panel)?,
                Layer::Note(note) => self.note(&mut chart, note)?,
                Layer::Labels(notes) => self.labels(&mut chart, notes)?,
                Layer::Span { from, to } => self.span(&mut chart, *from, *to)?,
            }
        }
        Ok(())
    }

    /// Width of the texts of the vertical axis: alike for all that have numbers, so that panels below each other line up.
    fn beside<DB: DrawingBackend>(self, panel: &Panel, area: &Area<DB>) -> Result<i32, Error> {
        let axis = &panel.y;
        let style = self.text(style::TICK_PX, Colour::BLACK);
        let widths = axis.labels().into_iter().map(|l| width(area, &l, &style));
        let widest = widths.collect::<Result<Vec<i32>, Error>>()?;
        let widest = widest.into_iter().max();
        Ok(match widest {
            Some(widest) if !axis.names.is_empty() => widest + self.px(NAMES_PX),
            Some(_) => self.px(Y_LABELS_PX),
            None => self.px(UNLABELLED_PX),
        })
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
            .bold_line_style(Colour::GREY.0.mix(0.35).stroke_width(self.width(1)))
            .light_line_style(Colour::GREY.0.mix(0.14).stroke_width(self.width(1)))
            .set_all_tick_mark_size(self.px(7))
            .draw()
            .map_err(|e| problem(&e))
    }

    pub(super) fn stroke(self, curve: &Curve) -> ShapeStyle {
        match curve.stroke {
            Stroke::Solid => self.line(curve.colour, style::CURVE_PX),
            Stroke::Fine | Stroke::Dashed => self.line(curve.colour, 2),
            Stroke::Broad => {
                let pale = curve.colour.0.mix(0.4);
                pale.stroke_width(self.width(style::BROAD_PX))
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
        let (dash, gap) = (self.px(12), self.px(8));
        let parts = clip::inside(&curve.points, &panel.x, &panel.y).into_iter();
        let drawn = if curve.stroke == Stroke::Dashed {
            let dashed = |part| DashedPathElement::new(part, dash, gap, style);
            chart.draw_series(parts.map(dashed))
        } else {
            chart.draw_series(parts.map(|part| PathElement::new(part, style)))
        };
        drawn.map_err(|e| problem(&e))?;
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
}

/// Height of the line above a panel.
const HEADING_PX: u32 = 36;
/// Around a panel with its texts.
const MARGIN_PX: u32 = 16;
const MARGIN_RIGHT_PX: u32 = 32;
/// Width of the texts of a vertical axis.
const Y_LABELS_PX: u32 = 110;
/// The same of one without ticks, and what names need beside their own width.
const UNLABELLED_PX: u32 = 44;
const NAMES_PX: u32 = 16;
/// Length of the sample of a line in the legend.
pub(super) const SAMPLE_PX: u32 = 36;

#[expect(
    clippy::cast_possible_truncation,
    reason = "`as` saturates, and arrow heads are small"
)]
fn pixel(length: f64) -> i32 {
    length.round() as i32
}
