//! What can be drawn in a panel.

use super::Colour;

/// Something drawn in a panel.
#[derive(Debug, Clone, PartialEq)]
pub enum Layer {
    /// A line.
    Curve(Curve),
    /// Separate points.
    Dots(Dots),
    /// An area between two lines.
    Band(Band),
    /// A text.
    Note(Note),
    /// Texts of which only those are drawn that have room: none touches one that stands before it in the list, or the
    /// edge of the panel.
    Labels(Vec<Note>),
    /// An arrow with a head at both ends: a length or a duration.
    Span {
        /// One end.
        from: (f64, f64),
        /// The other end.
        to: (f64, f64),
    },
}

impl Layer {
    /// Its name in the legend.
    pub(super) fn name(&self) -> Option<&str> {
        let name = match self {
            Self::Curve(curve) => &curve.name,
            Self::Dots(dots) => &dots.name,
            Self::Band(band) => &band.name,
            Self::Note(_) | Self::Labels(_) | Self::Span { .. } => return None,
        };
        name.as_deref()
    }
}

/// How a line is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// Solid.
    Solid,
    /// Solid and thin: for the swings of a sound.
    Fine,
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

/// The look of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// A large disc with a white rim.
    Disc,
    /// A large ring with a white rim.
    Ring,
    /// A small disc: one of many.
    Point,
    /// A small ring: one of many, less sure.
    Circlet,
    /// A small cross: one of many, not counted.
    Cross,
}

/// Points, with error bars or without; those outside the axes are left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Dots {
    /// In the units of the axes.
    pub points: Vec<(f64, f64)>,
    /// Lower and upper end of the error bar of each point; empty for none.
    pub bars: Vec<(f64, f64)>,
    /// Colour.
    pub colour: Colour,
    /// Look.
    pub shape: Shape,
    /// For the legend.
    pub name: Option<String>,
}

impl Dots {
    /// Points without error bars and name.
    #[must_use]
    pub const fn new(points: Vec<(f64, f64)>, shape: Shape, colour: Colour) -> Self {
        Self {
            points,
            bars: Vec::new(),
            colour,
            shape,
            name: None,
        }
    }

    /// The points with a name in the legend.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }

    /// The points with an error bar each: the standard error to both sides.
    #[must_use]
    pub fn with_errors(mut self, errors: impl IntoIterator<Item = f64>) -> Self {
        let ends = self.points.iter().zip(errors);
        self.bars = ends.map(|(p, e)| (p.1 - e, p.1 + e)).collect();
        self
    }
}

/// An area between two lines, pale; parts outside the axes are left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Band {
    /// Horizontal place, lower and upper end, in the units of the axes.
    pub points: Vec<(f64, f64, f64)>,
    /// Colour.
    pub colour: Colour,
    /// For the legend.
    pub name: Option<String>,
}

impl Band {
    /// A bar along the horizontal axis, with its half width on the vertical one.
    #[must_use]
    pub fn bar((from, to): (f64, f64), at: f64, reach: f64, colour: Colour) -> Self {
        Self {
            points: [from, to].map(|x| (x, at - reach, at + reach)).to_vec(),
            colour,
            name: None,
        }
    }
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
