//! Texts in a panel, and which of them have room.

use plotters::element::{EmptyElement, Rectangle, Text};
use plotters::prelude::DrawingBackend;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, TextStyle, WHITE};

use super::draw::{Chart, Pen, problem};
use super::{Note, Side, style};
use crate::Error;

/// A rectangle in pixels: left, top, right, bottom.
type Frame = [i32; 4];

/// Labels are at least this far from each other, in pixels of the finished picture.
const APART_PX: u32 = 5;

impl Pen {
    pub(super) fn note<'a, DB: DrawingBackend + 'a>(
        self,
        chart: &mut Chart<'a, DB>,
        note: &Note,
    ) -> Result<(), Error> {
        let (pos, offset) = self.anchor(note.side);
        let text = Text::new(note.text.clone(), offset, self.note_style(note).pos(pos));
        let placed = EmptyElement::at(note.at) + text;
        chart.draw_series([placed]).map_err(|e| problem(&e))?;
        Ok(())
    }

    fn note_style(self, note: &Note) -> TextStyle<'static> {
        self.text(style::TICK_PX, note.colour)
    }

    /// Which point of a text stands how far from its place.
    fn anchor(self, side: Side) -> (Pos, (i32, i32)) {
        let gap = self.px(14);
        let (horizontal, vertical, offset) = match side {
            Side::Left => (HPos::Right, VPos::Center, (-gap, 0)),
            Side::Right => (HPos::Left, VPos::Center, (gap, 0)),
            Side::Above => (HPos::Center, VPos::Bottom, (0, -self.px(20))),
            Side::Below => (HPos::Center, VPos::Top, (0, gap)),
        };
        (Pos::new(horizontal, vertical), offset)
    }

    /// Draws those texts that touch neither one drawn before nor the edge of the panel.
    pub(super) fn labels<'a, DB: DrawingBackend + 'a>(
        self,
        chart: &mut Chart<'a, DB>,
        notes: &[Note],
    ) -> Result<(), Error> {
        let (across, down) = chart.plotting_area().get_pixel_range();
        let panel = [across.start, down.start, across.end, down.end];
        let sheet = chart.plotting_area().strip_coord_spec();
        let mut taken: Vec<Frame> = Vec::new();
        for note in notes {
            let frame = self.frame(chart, note)?;
            let within = frame[0] >= panel[0]
                && frame[1] >= panel[1]
                && frame[2] <= panel[2]
                && frame[3] <= panel[3];
            if within && !taken.iter().any(|other| touch(*other, frame)) {
                // Lines of the grid do not go through the text.
                let ground = [(frame[0], frame[1]), (frame[2], frame[3])]
                    .map(|(x, y)| (x - across.start, y - down.start));
                let ground = Rectangle::new(ground, WHITE.mix(0.8).filled());
                sheet.draw(&ground).map_err(|e| problem(&e))?;
                self.note(chart, note)?;
                taken.push(frame);
            }
        }
        Ok(())
    }

    /// What a text takes up, with a margin.
    fn frame<'a, DB: DrawingBackend + 'a>(
        self,
        chart: &Chart<'a, DB>,
        note: &Note,
    ) -> Result<Frame, Error> {
        let area = chart.plotting_area();
        let size = area.estimate_text_size(&note.text, &self.note_style(note));
        let (width, height) = size.map_err(|e| problem(&e))?;
        let [width, height] = [width, height].map(|s| i32::try_from(s).unwrap_or(i32::MAX / 4));
        let (x, y) = chart.backend_coord(&note.at);
        let (pos, (dx, dy)) = self.anchor(note.side);
        let left = x + dx
            - match pos.h_pos {
                HPos::Left => 0,
                HPos::Center => width / 2,
                HPos::Right => width,
            };
        let top = y + dy
            - match pos.v_pos {
                VPos::Top => 0,
                VPos::Center => height / 2,
                VPos::Bottom => height,
            };
        let margin = self.px(APART_PX) / 2 + 1;
        Ok([left - margin, top, left + width + margin, top + height])
    }
}

const fn touch(a: Frame, b: Frame) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}
