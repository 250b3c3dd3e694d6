//! The figures as data, from the equations and the numbers of the paper.

mod motion;
mod relations;

use bounce_audio::Error;
use bounce_audio::physics::BounceSeries;
use bounce_audio::plot::{Colour, Curve, Dots, Figure, Layer, Note, Shape, Side, Stroke};

const HEIGHT_M: f64 = 0.305;
const GRAVITY_M_PER_S2: f64 = 9.81;
const BOUNCES: u32 = 70;
const TOTAL_TIME_S: f64 = 7.5;
/// e as the paper rounds it.
const RESTITUTION: f64 = 0.93;
/// ΔT from n and that e, and from the high-speed video, as the paper gives them.
const CONTACT_BY_EQ20_S: f64 = 3.4e-3;
const CONTACT_BY_VIDEO_S: f64 = 1.0e-3;

/// The figures with the names of their files.
///
/// # Errors
/// None, as long as the numbers above are those of a ball.
pub(crate) fn all() -> Result<[(&'static str, Figure); 6], Error> {
    Ok([
        ("figure-2-first-bounce", motion::first_bounce()?),
        ("figure-3-bounce-history", motion::bounce_history()?),
        ("figure-4-total-time", relations::total_time()?),
        ("figure-5-contact-time", relations::contact_time()?),
        ("figure-6-stiffness", relations::stiffness()?),
        ("figure-7-damping", relations::damping()?),
    ])
}

fn series() -> Result<BounceSeries, Error> {
    BounceSeries::new(HEIGHT_M, GRAVITY_M_PER_S2)
}

fn curve(points: Vec<(f64, f64)>, colour: Colour) -> Layer {
    Layer::Curve(Curve::new(points, colour))
}

fn named(points: Vec<(f64, f64)>, colour: Colour, stroke: Stroke, name: &str) -> Layer {
    Layer::Curve(Curve::new(points, colour).stroke(stroke).named(name))
}

/// A point with a name: filled for the experiment, a ring for the video.
fn dot(at: (f64, f64), hollow: bool, name: &str) -> Layer {
    let shape = if hollow { Shape::Ring } else { Shape::Disc };
    Layer::Dots(Dots::new(vec![at], shape, Colour::BLACK).named(name))
}

fn note(at: (f64, f64), side: Side, text: impl Into<String>, colour: Colour) -> Layer {
    Layer::Note(Note {
        at,
        side,
        text: text.into(),
        colour,
    })
}

/// Evenly spaced values, both ends included.
fn spread(from: f64, to: f64, steps: u32) -> impl Iterator<Item = f64> {
    (0..=steps).map(move |i| from + (to - from) * f64::from(i) / f64::from(steps))
}
