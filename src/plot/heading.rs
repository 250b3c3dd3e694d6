//! What stands above a panel: its heading at the left, its legend at the right.

use plotters::element::{Circle, Cross, DashedPathElement, PathElement, Rectangle};
use plotters::prelude::DrawingBackend;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, TextStyle};

use super::draw::{Area, Pen, SAMPLE_PX, problem};
use super::{Colour, Layer, Panel, Shape, Stroke, style};
use crate::Error;

/// Room between an entry of the legend and the next.
const BETWEEN_PX: u32 = 18;

impl Pen {
    /// Draws heading and legend into an area one line high, between these places.
    pub(super) fn heading<DB: DrawingBackend>(
        self,
        panel: &Panel,
        area: &Area<DB>,
        (left, right): (i32, i32),
    ) -> Result<(), Error> {
        let (_, height) = area.dim_in_pixel();
        let middle = i32::try_from(height / 2).unwrap_or(0);
        let style = |colour| {
            let style = self.text(style::TICK_PX, colour);
            style.pos(Pos::new(HPos::Left, VPos::Center))
        };
        let mut end = right;
        let entries = panel.layers.iter().rev();
        let entries = entries.filter_map(|layer| Some((layer, layer.name()?)));
        for (layer, name) in entries {
            let start = end - width(area, name, &style(Colour::BLACK))?;
            let text = (start, middle);
            area.draw_text(name, &style(Colour::BLACK), text)
                .map_err(|e| problem(&e))?;
            let sample = start - self.px(SAMPLE_PX + 8);
            self.sample(layer, area, (sample, middle))?;
            end = sample - self.px(BETWEEN_PX);
        }
        let Some(heading) = &panel.heading else {
            return Ok(());
        };
        let heading = fitting(area, heading, &style(Colour::BLACK), end - left)?;
        area.draw_text(&heading, &style(Colour::BLACK), (left, middle))
            .map_err(|e| problem(&e))
    }

    /// What a layer looks like, from a place to [`SAMPLE_PX`] right of it.
    fn sample<DB: DrawingBackend>(
        self,
        layer: &Layer,
        area: &Area<DB>,
        (x, y): (i32, i32),
    ) -> Result<(), Error> {
        let end = x + self.px(SAMPLE_PX);
        let middle = x + self.px(SAMPLE_PX) / 2;
        let drawn = match layer {
            Layer::Curve(curve) if curve.stroke == Stroke::Dashed => {
                let (dash, gap) = (self.px(12), self.px(8));
                let line = [(x, y), (end, y)];
                area.draw(&DashedPathElement::new(line, dash, gap, self.stroke(curve)))
            }
            Layer::Curve(curve) => {
                area.draw(&PathElement::new([(x, y), (end, y)], self.stroke(curve)))
            }
            Layer::Dots(dots) => {
                let size = self.px(dots.shape.radius_px());
                if !dots.bars.is_empty() {
                    let reach = self.px(style::TICK_PX) / 2;
                    let bar = [(middle, y - reach), (middle, y + reach)];
                    area.draw(&PathElement::new(bar, self.line(dots.colour, 2)))
                        .map_err(|e| problem(&e))?;
                }
                let style = self.point_style(dots);
                if dots.shape == Shape::Cross {
                    area.draw(&Cross::new((middle, y), size, style))
                } else {
                    area.draw(&Circle::new((middle, y), size, style))
                }
            }
            Layer::Band(band) => {
                let reach = self.px(style::TICK_PX) / 3;
                let corners = [(x, y - reach), (end, y + reach)];
                let pale = band.colour.0.mix(style::PALE).filled();
                area.draw(&Rectangle::new(corners, pale))
            }
            Layer::Note(_) | Layer::Labels(_) | Layer::Span { .. } => Ok(()),
        };
        drawn.map_err(|e| problem(&e))
    }
}

/// Width of a text in pixels.
pub(super) fn width<DB: DrawingBackend>(
    area: &Area<DB>,
    text: &str,
    style: &TextStyle<'_>,
) -> Result<i32, Error> {
    let size = area.estimate_text_size(text, style);
    let (width, _) = size.map_err(|e| problem(&e))?;
    Ok(i32::try_from(width).unwrap_or(i32::MAX))
}

/// A text, without as much of its middle as keeps it from fitting into this many pixels.
pub(super) fn fitting<DB: DrawingBackend>(
    area: &Area<DB>,
    text: &str,
    style: &TextStyle<'_>,
    room: i32,
) -> Result<String, Error> {
    let characters: Vec<char> = text.chars().collect();
    let mut kept = characters.len();
    let mut shown = text.to_owned();
    while kept > 1 && width(area, &shown, style)? > room {
        kept = (kept * 9 / 10).min(kept - 1);
        let (head, tail) = (kept.div_ceil(2), characters.len() - kept / 2);
        let parts = [&characters[..head], &['…'], &characters[tail..]];
        shown = parts.concat().into_iter().collect();
    }
    Ok(shown)
}
