//! Figures as SVG, whose texts are measured in the bundled font.
//!
//! `plotters` measures texts itself, in a browser by elements of the page, of which a worker has none. Measured here, a
//! picture is the same to the byte on every machine.

use plotters::backend::SVGBackend;
use plotters::drawing::IntoDrawingArea;
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
};

use super::widths::width_px;
use super::{Figure, draw};
use crate::Error;

/// The SVG is drawn this much larger and shown smaller: its coordinates are whole numbers, on which a curve of the final
/// size would show steps.
const FINENESS: u32 = 8;

/// The height of a text that `plotters` calls so large, as it has it.
const EM: f64 = 1.24;

/// The figure as an SVG document.
///
/// # Errors
/// [`Error::Plot`] where an axis has no extent or the drawing fails.
pub fn to_svg(figure: &Figure) -> Result<String, Error> {
    let size = figure.size;
    let (width, height) = (size.0 * FINENESS, size.1 * FINENESS);
    let mut document = String::new();
    {
        let svg = SVGBackend::with_string(&mut document, (width, height));
        let area = Vector(svg).into_drawing_area();
        draw::figure(figure, &area, FINENESS)?;
        area.present().map_err(|e| draw::problem(&e))?;
    }
    // The view box keeps the fine coordinates; only the size that it is shown at changes.
    let drawn = format!("width=\"{width}\" height=\"{height}\"");
    let shown = format!("width=\"{}\" height=\"{}\"", size.0, size.1);
    Ok(document.replacen(&drawn, &shown, 1))
}

/// An SVG document that knows how wide its texts are.
struct Vector<'a>(SVGBackend<'a>);

type Problem<'a> = DrawingErrorKind<<SVGBackend<'a> as DrawingBackend>::ErrorType>;
type Outcome<'a> = Result<(), Problem<'a>>;

impl<'a> DrawingBackend for Vector<'a> {
    type ErrorType = <SVGBackend<'a> as DrawingBackend>::ErrorType;

    fn get_size(&self) -> (u32, u32) {
        self.0.get_size()
    }

    fn ensure_prepared(&mut self) -> Outcome<'a> {
        self.0.ensure_prepared()
    }

    fn present(&mut self) -> Outcome<'a> {
        self.0.present()
    }

    fn draw_pixel(&mut self, point: BackendCoord, color: BackendColor) -> Outcome<'a> {
        self.0.draw_pixel(point, color)
    }

    fn draw_line<S: BackendStyle>(
        &mut self,
        from: BackendCoord,
        to: BackendCoord,
        style: &S,
    ) -> Outcome<'a> {
        self.0.draw_line(from, to, style)
    }

    fn draw_rect<S: BackendStyle>(
        &mut self,
        upper_left: BackendCoord,
        bottom_right: BackendCoord,
        style: &S,
        fill: bool,
    ) -> Outcome<'a> {
        self.0.draw_rect(upper_left, bottom_right, style, fill)
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Outcome<'a> {
        self.0.draw_path(path, style)
    }

    fn draw_circle<S: BackendStyle>(
        &mut self,
        centre: BackendCoord,
        radius: u32,
        style: &S,
        fill: bool,
    ) -> Outcome<'a> {
        self.0.draw_circle(centre, radius, style, fill)
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Outcome<'a> {
        self.0.fill_polygon(corners, style)
    }

    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        at: BackendCoord,
    ) -> Outcome<'a> {
        self.0.draw_text(text, style, at)
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), Problem<'a>> {
        Ok(measured(text, style.size()))
    }
}

/// Width and height of a text in pixels, without what stands behind the point, as `plotters` has them.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "`as` saturates, and texts are small"
)]
fn measured(text: &str, size: f64) -> (u32, u32) {
    (width_px(text, size) as u32, (size / EM) as u32)
}

#[cfg(test)]
mod tests {
    use plotters::style::{FontFamily, FontStyle, TextStyle};

    use super::*;
    use crate::plot::style;

    fn assert_as_plotters(text: &str, size: f64) {
        let style = TextStyle::from((FontFamily::Name(style::FONT), size, FontStyle::Normal));
        let theirs = style.font.box_size(text).unwrap();
        assert_eq!(measured(text, size), theirs, "{text} at {size}");
    }

    #[test]
    fn texts_measure_what_plotters_says() {
        style::register().unwrap();
        for text in [
            "",
            "e = 0.929",
            "AVAVA",
            "rebound height (mm)",
            "Δt ± 10⁻⁶ µs",
        ] {
            for size in [14.0, 141.0, 176.0, 240.0] {
                assert_as_plotters(text, size);
            }
        }
    }

    /// At this size a pixel is a unit of the font.
    #[test]
    fn every_character_is_as_wide_as_in_the_font() {
        style::register().unwrap();
        for character in '\0'..='\u{ffff}' {
            assert_as_plotters(&character.to_string(), 2384.0);
        }
    }
}
