//! Figures as PNG: drawn large, averaged down, encoded in memory.

use plotters::backend::BitMapBackend;
use plotters::drawing::IntoDrawingArea;
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind,
};

use super::{Figure, draw};
use crate::Error;

/// The PNG is drawn this much larger and averaged down, for smooth edges.
const OVERSAMPLING: u32 = 2;

/// The figure as the bytes of a PNG file.
///
/// # Errors
/// [`Error::Plot`] where an axis has no extent or the drawing fails.
pub fn to_png(figure: &Figure) -> Result<Vec<u8>, Error> {
    let (width, height) = (figure.size.0 * OVERSAMPLING, figure.size.1 * OVERSAMPLING);
    let mut large = vec![0; width as usize * height as usize * CHANNELS];
    {
        let bitmap = BitMapBackend::with_buffer(&mut large, (width, height));
        let area = Bitmap(bitmap).into_drawing_area();
        draw::figure(figure, &area, OVERSAMPLING)?;
        area.present().map_err(|e| draw::problem(&e))?;
    }
    encode(&averaged(&large, width as usize), figure.size).map_err(|e| draw::problem(&e))
}

/// Red, green, blue.
const CHANNELS: usize = 3;

/// The mean of every square of pixels.
fn averaged(large: &[u8], width: usize) -> Vec<u8> {
    let step = OVERSAMPLING as usize;
    let row = width * CHANNELS;
    let mut small = Vec::with_capacity(large.len() / step / step);
    for band in large.chunks_exact(step * row) {
        for x in (0..width).step_by(step) {
            for channel in 0..CHANNELS {
                let square = (0..step).flat_map(|dy| {
                    (0..step).map(move |dx| dy * row + (x + dx) * CHANNELS + channel)
                });
                let sum: u32 = square.map(|i| u32::from(band[i])).sum();
                let mean = sum / (OVERSAMPLING * OVERSAMPLING);
                small.push(u8::try_from(mean).unwrap_or(u8::MAX));
            }
        }
    }
    small
}

fn encode(pixels: &[u8], (width, height): (u32, u32)) -> Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(bytes)
}

/// A bitmap on which text stands where it is anchored: with `ab_glyph`, `plotters` puts it too high by a fifth of its
/// size.
struct Bitmap<'a>(BitMapBackend<'a>);

type Outcome<'a> = Result<(), DrawingErrorKind<<BitMapBackend<'a> as DrawingBackend>::ErrorType>>;

impl<'a> DrawingBackend for Bitmap<'a> {
    type ErrorType = <BitMapBackend<'a> as DrawingBackend>::ErrorType;

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

    /// Piece by piece with round joints: all at once, `plotters` draws long spikes where a line turns back.
    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        path: I,
        style: &S,
    ) -> Outcome<'a> {
        let radius = style.stroke_width() / 2;
        let mut before = None;
        for point in path {
            if let Some(before) = before {
                if radius > 0 {
                    self.0.draw_path([before, point], style)?;
                    self.0.draw_circle(point, radius, style, true)?;
                } else {
                    self.0.draw_line(before, point, style)?;
                }
            }
            before = Some(point);
        }
        Ok(())
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

    #[expect(
        clippy::cast_possible_truncation,
        reason = "`as` saturates, and text is small"
    )]
    fn draw_text<S: BackendTextStyle>(
        &mut self,
        text: &str,
        style: &S,
        (x, y): BackendCoord,
    ) -> Outcome<'a> {
        let down = (0.2 * style.size()).round() as i32;
        let (dx, dy) = style.transform().transform(0, down);
        self.0.draw_text(text, style, (x + dx, y + dy))
    }
}
