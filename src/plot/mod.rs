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
mod bitmap;
mod clip;
mod draw;
mod style;

pub use axis::{Axis, Scale};
pub use bitmap::to_png;
pub use style::Colour;

use plotters::backend::SVGBackend;
use plotters::drawing::IntoDrawingArea;

use crate::Error;

/// A picture of one or more panels side by side.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// What the picture shows.
    pub title: String,
    /// From left to right.
    pub panels: Vec<Panel>,
}

impl Figure {
    /// A figure.
    #[must_use]
    pub fn new(title: impl Into<String>, panels: Vec<Panel>) -> Self {
        Self {
            title: title.into(),
            panels,
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
    /// Where the names of the layers stand.
    pub legend: Corner,
}

impl Panel {
    /// An empty panel, its legend at the upper right.
    #[must_use]
    pub const fn new(x: Axis, y: Axis) -> Self {
        Self {
            x,
            y,
            layers: Vec::new(),
            legend: Corner::UpperRight,
        }
    }

    /// The panel with one layer more, in front.
    #[must_use]
    pub fn with(mut self, layer: Layer) -> Self {
        self.layers.push(layer);
        self
    }

    /// The panel with its legend elsewhere.
    #[must_use]
    pub const fn legend_at(mut self, corner: Corner) -> Self {
        self.legend = corner;
        self
    }
}

/// A corner of a panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Corner {
    /// Upper left.
    UpperLeft,
    /// Upper right.
    UpperRight,
    /// Lower left.
    LowerLeft,
    /// Lower right.
    LowerRight,
}

/// Something drawn in a panel.
#[derive(Debug, Clone, PartialEq)]
pub enum Layer {
    /// A line.
    Curve(Curve),
    /// Separate points.
    Dots(Dots),
    /// A text.
    Note(Note),
    /// An arrow with a head at both ends: a length or a duration.
    Span {
        /// One end.
        from: (f64, f64),
        /// The other end.
        to: (f64, f64),
    },
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// Solid.
    Solid,
    /// Solid, pale and wide: to be seen beneath a dashed line.
    Broad,
    /// Dashed and thin.
    Dashed,
}

/// A line through points; parts outside the axes are left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// In the units of the axes.
    pub points: Vec<(f64, f64)>,
    /// Colour.
    pub colour: Colour,
    /// Stroke.
    pub stroke: Stroke,
    /// For the legend.
    pub name: Option<String>,
}

impl Curve {
    /// A solid line without a name.
    #[must_use]
    pub const fn new(points: Vec<(f64, f64)>, colour: Colour) -> Self {
        Self {
            points,
            colour,
            stroke: Stroke::Solid,
            name: None,
        }
    }

    /// The line with a name in the legend.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }

    /// The line with another stroke.
    #[must_use]
    pub const fn stroke(mut self, stroke: Stroke) -> Self {
        self.stroke = stroke;
        self
    }
}

/// Round points with a white rim.
#[derive(Debug, Clone, PartialEq)]
pub struct Dots {
    /// In the units of the axes.
    pub points: Vec<(f64, f64)>,
    /// Colour.
    pub colour: Colour,
    /// Whether they are rings.
    pub hollow: bool,
    /// For the legend.
    pub name: Option<String>,
}

/// On which side of its place a text stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// To the left.
    Left,
    /// To the right.
    Right,
    /// Above, centred.
    Above,
    /// Below, centred.
    Below,
}

/// A text in a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Note {
    /// Its place, in the units of the axes.
    pub at: (f64, f64),
    /// Where it stands from there.
    pub side: Side,
    /// What it says.
    pub text: String,
    /// Colour.
    pub colour: Colour,
}

/// Width and height in pixels.
const SIZE: (u32, u32) = (1400, 900);

/// The SVG is drawn this much larger and shown smaller: its coordinates are whole numbers, on which a curve of the final
/// size would show steps.
const FINENESS: u32 = 8;

/// The figure as an SVG document.
///
/// # Errors
/// [`Error::Plot`] where an axis has no extent or the drawing fails.
pub fn to_svg(figure: &Figure) -> Result<String, Error> {
    let (width, height) = (SIZE.0 * FINENESS, SIZE.1 * FINENESS);
    let mut document = String::new();
    {
        let area = SVGBackend::with_string(&mut document, (width, height)).into_drawing_area();
        draw::figure(figure, &area, FINENESS)?;
        area.present().map_err(|e| draw::problem(&e))?;
    }
    // The view box keeps the fine coordinates; only the size that it is shown at changes.
    let drawn = format!("width=\"{width}\" height=\"{height}\"");
    let shown = format!("width=\"{}\" height=\"{}\"", SIZE.0, SIZE.1);
    Ok(document.replacen(&drawn, &shown, 1))
}
