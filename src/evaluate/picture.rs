//! Error against speed: one mark for each way of timing and model, and the limit.

use super::rows::{Evaluation, Row};
use crate::plot::{Axis, Colour, Corner, Curve, Dots, Figure, Layer, Note, Panel, Side, Stroke};

/// Room left around the marks, as a factor on both axes.
const ROOM: f64 = 3.0;

/// Where the line stands if the limit was not measured, in seconds of audio per second.
const UNMEASURED_LIMIT: f64 = 1e4;

/// The median and the 95th percentile of the timing error of each way against its speed, on logarithmic axes, with the
/// speed of only reading the files as a line. Ways that found nothing have no mark.
#[must_use]
pub fn figure(evaluation: &Evaluation) -> Figure {
    let marks: Vec<(&Row, f64, f64, f64)> = evaluation
        .rows
        .iter()
        .filter_map(|row| {
            let (median, p95) = (row.timing_error_median_s?, row.timing_error_p95_s?);
            let speed = row.audio_s_per_s?;
            (median > 0.0 && p95 > 0.0 && speed > 0.0).then_some((
                row,
                speed,
                1e6 * median,
                1e6 * p95,
            ))
        })
        .collect();
    let lowest = marks
        .iter()
        .map(|m| m.2)
        .fold(f64::INFINITY, f64::min)
        .min(1e6);
    let highest = marks
        .iter()
        .map(|m| m.3)
        .fold(0.0, f64::max)
        .max(2.0 * lowest);
    let limit = evaluation.limit_audio_s_per_s.unwrap_or(UNMEASURED_LIMIT);
    let slowest = marks.iter().map(|m| m.1).fold(limit, f64::min);
    let fastest = marks.iter().map(|m| m.1).fold(limit, f64::max);
    // The legend stands below the lowest mark.
    let errors = (lowest / ROOM.powi(3), highest * ROOM);
    let mut panel = Panel::new(
        Axis::logarithmic(
            "speed (seconds of audio per second of one core)",
            slowest / ROOM,
            fastest * ROOM,
        ),
        Axis::logarithmic("timing error (µs)", errors.0, errors.1),
    )
    .legend_at(Corner::LowerLeft)
    .with(Layer::Curve(
        Curve::new(vec![(limit, errors.0), (limit, errors.1)], Colour::BLACK)
            .stroke(Stroke::Dashed)
            .named("limit: reading the files and summing squares"),
    ));
    let dots = |hollow: bool, name: &str, points: Vec<(f64, f64)>| {
        Layer::Dots(Dots {
            points,
            colour: Colour::BLUE,
            hollow,
            name: Some(name.to_owned()),
        })
    };
    panel = panel
        .with(dots(
            false,
            "median",
            marks.iter().map(|m| (m.1, m.2)).collect(),
        ))
        .with(dots(
            true,
            "95th percentile",
            marks.iter().map(|m| (m.1, m.3)).collect(),
        ));
    for (row, speed, median, _) in &marks {
        let text = format!("{}, {}", row.timing, row.model);
        panel = panel.with(Layer::Note(Note {
            at: (*speed, *median),
            side: Side::Right,
            text,
            colour: Colour::BLUE,
        }));
    }
    Figure::new(
        format!(
            "Timing error against speed, {} recordings",
            evaluation.files
        ),
        vec![panel],
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::to_svg;

    #[test]
    fn every_way_that_found_something_has_its_name_in_the_picture() {
        let evaluation = Evaluation::of(&[], Some(1e4));
        let svg = to_svg(&figure(&evaluation)).unwrap();
        assert!(svg.contains("limit: reading the files") && !svg.contains("correlation"));
    }
}
