//! Pictures: what they show is data, [`to_svg`] and [`to_png`] draw it in memory. No file, no font of the system.
//!
//! ```
//! use bounce_audio::plot::{self, Axis, Colour, Curve, Figure, Layer, Panel};
//!
//! let heights = (0..20).map(|n| (f64::from(n), 30.5 * 0.87_f64.powi(n))).collect();
//! let panel = Panel::new(Axis::linear("bounce", 0.0, 20.0), Axis::linear("height (cm)", 0.0, 35.0))
//!     .with(Layer::Curve(Curve::new(heights, Colour::BLUE).named("e = 0.93")));
//! let svg = plot::to_svg(&Figure::new("Heights after each bounce", vec![panel]))?;
//! assert!(svg.contains("height (cm)") && svg.ends_with("</svg>\n"));
//! # Ok::<(), bounce_audio::Error>(())
//! ```

mod axis;
// Glyphs are drawn by `plotters`, which can do so everywhere but in a browser.
#[cfg(not(target_arch = "wasm32"))]
mod bitmap;
mod clip;
mod draw;
mod heading;
mod labels;
mod layers;
mod marks;
mod style;
mod vector;
mod widths;

pub use axis::Axis;
#[cfg(not(target_arch = "wasm32"))]
pub use bitmap::to_png;
pub use layers::{Band, Curve, Dots, Layer, Note, Shape, Side, Stroke};
pub use style::Colour;
pub use vector::to_svg;

/// A picture of panels in rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// What it tells, large above all.
    pub headline: Option<String>,
    /// What the picture shows. A title that is too long is shortened in its middle.
    pub title: String,
    /// A line below the title.
    pub subtitle: Option<String>,
    /// From top to bottom.
    pub rows: Vec<Row>,
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Size of texts, lines and dots: 1 where one panel fills the picture, less where there are many.
    pub density: f64,
}

/// Panels side by side.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Its share of the height, against those of the other rows.
    pub height: u32,
    /// From left to right, of one width.
    pub panels: Vec<Panel>,
}

/// Width and height in pixels of a picture with one row.
const SIZE: (u32, u32) = (1400, 900);

impl Figure {
    /// A figure of one row.
    #[must_use]
    pub fn new(title: impl Into<String>, panels: Vec<Panel>) -> Self {
        Self {
            headline: None,
            title: title.into(),
            subtitle: None,
            rows: vec![Row { height: 1, panels }],
            size: SIZE,
            density: 1.0,
        }
    }
}

/// Two axes and what is drawn between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// From the back to the front.
    pub layers: Vec<Layer>,
    /// What the panel shows, above it; the names of its layers stand beside that, where they cover nothing.
    pub heading: Option<String>,
}

impl Panel {
    /// An empty panel.
    #[must_use]
    pub const fn new(x: Axis, y: Axis) -> Self {
        Self {
            x,
            y,
            layers: Vec::new(),
            heading: None,
        }
    }

    /// The panel with one layer more, in front.
    #[must_use]
    pub fn with(mut self, layer: Layer) -> Self {
        self.layers.push(layer);
        self
    }

    /// The panel with a heading.
    #[must_use]
    pub fn headed(mut self, heading: impl Into<String>) -> Self {
        self.heading = Some(heading.into());
        self
    }
}
