//! The look of every picture: font, colours, sizes.

#[cfg(not(target_arch = "wasm32"))]
use std::sync::OnceLock;

use plotters::style::RGBColor;
#[cfg(not(target_arch = "wasm32"))]
use plotters::style::{FontStyle, register_font};

#[cfg(not(target_arch = "wasm32"))]
use crate::Error;

/// A colour that is told from the others by everyone, on white: after Okabe and Ito, the light ones darkened so that
/// text in them can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Colour(pub(super) RGBColor);

impl Colour {
    /// For axes, texts and what is measured.
    pub const BLACK: Self = Self(RGBColor(0x1a, 0x1a, 0x1a));
    /// For helping lines.
    pub const GREY: Self = Self(RGBColor(0x70, 0x70, 0x70));
    /// Blue.
    pub const BLUE: Self = Self(RGBColor(0x00, 0x72, 0xb2));
    /// Vermillion.
    pub const RED: Self = Self(RGBColor(0xd5, 0x5e, 0x00));
    /// Bluish green.
    pub const GREEN: Self = Self(RGBColor(0x00, 0x8a, 0x64));
    /// Reddish purple.
    pub const PURPLE: Self = Self(RGBColor(0xb0, 0x55, 0x8c));
    /// Orange.
    pub const ORANGE: Self = Self(RGBColor(0xb8, 0x7d, 0x00));
    /// Sky blue.
    pub const SKY: Self = Self(RGBColor(0x3a, 0x9b, 0xd6));

    /// Colours for curves of one family, in this order.
    pub const FAMILY: [Self; 6] = [
        Self::BLUE,
        Self::RED,
        Self::GREEN,
        Self::PURPLE,
        Self::ORANGE,
        Self::SKY,
    ];
}

/// Name of the font in SVG: the bundled one where it is installed, else what the viewer has. Bitmaps always use the
/// bundled one, which is registered under this whole list.
pub(super) const FONT: &str = "DejaVu Sans, Verdana, sans-serif";

/// Sizes in pixels of the finished picture.
pub(super) const HEADLINE_PX: u32 = 56;
pub(super) const TITLE_PX: u32 = 30;
pub(super) const LABEL_PX: u32 = 26;
pub(super) const TICK_PX: u32 = 22;
pub(super) const CURVE_PX: u32 = 3;
pub(super) const BROAD_PX: u32 = 8;
pub(super) const DOT_PX: u32 = 9;
pub(super) const POINT_PX: u32 = 4;
pub(super) const CROSS_PX: u32 = 3;
/// Opacity of areas.
pub(super) const PALE: f64 = 0.35;

/// The bundled font.
#[cfg(not(target_arch = "wasm32"))]
pub(super) const FONT_FILE: &[u8] = include_bytes!("../../assets/fonts/DejaVuSans-subset.ttf");

#[cfg(not(target_arch = "wasm32"))]
static REGISTERED: OnceLock<bool> = OnceLock::new();

/// Makes the bundled font known to `plotters`, once.
#[cfg(not(target_arch = "wasm32"))]
pub(super) fn register() -> Result<(), Error> {
    let known =
        REGISTERED.get_or_init(|| register_font(FONT, FontStyle::Normal, FONT_FILE).is_ok());
    if *known {
        Ok(())
    } else {
        Err(Error::Plot {
            problem: "the bundled font cannot be read".to_owned(),
        })
    }
}
