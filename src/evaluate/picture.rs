//! Error against speed: a mark for each way of timing and each model, and the limit.

use super::rows::{Evaluation, Row};
use crate::plot::{
    Axis, Colour, Corner, Curve, Dots, Figure, Layer, Note, Panel, Shape, Side, Stroke,
};

/// Room left around the marks, as a factor on both axes.
const ROOM: f64 = 3.0;

/// Where the line stands if the limit was not measured, in seconds of audio per second.
const UNMEASURED_LIMIT: f64 = 1e4;

/// Names of marks stand at least this factor apart, or one would cover the other.
const NAMES_APART: f64 = 1.2;

/// One way of analysis: its name, its speed, and two quantiles of an error.
struct Mark {
    name: String,
    speed: f64,
    median: f64,
    /// None where so much was lost that it is infinite.
    upper: Option<f64>,
}

/// On the left the error of the times of each way of timing, on the right the error of e of every way and model, against
/// speed on logarithmic axes, with the speed of only reading the files as a line. Ways that found nothing have no mark.
#[must_use]
pub fn figure(evaluation: &Evaluation) -> Figure {
    // The model does not move the times: the first of each way of timing stands for all.
    let mut timings: Vec<&str> = Vec::new();
    let times = evaluation.rows.iter().filter(|row| {
        let new = !timings.contains(&row.timing.as_str());
        timings.push(&row.timing);
        new
    });
    let times = times.filter_map(|row| {
        let upper = row.timing_error_p95_s.map(|s| 1e6 * s);
        let median = 1e6 * row.timing_error_median_s?;
        mark(row, row.timing.clone(), median, upper)
    });
    let restitutions = evaluation.rows.iter().filter_map(|row| {
        let (median, upper) = (row.restitution_error_median?, row.restitution_error_p90);
        mark(row, format!("{}, {}", row.timing, row.model), median, upper)
    });
    let limit = evaluation.limit_audio_s_per_s.unwrap_or(UNMEASURED_LIMIT);
    let title = format!("Error against speed, {} recordings", evaluation.files);
    let panels = vec![
        panel(
            "timing error (µs)",
            "95th percentile",
            times.collect(),
            limit,
        ),
        panel(
            "error of e",
            "90th percentile",
            restitutions.collect(),
            limit,
        ),
    ];
    Figure::new(title, panels)
}

/// None of what has no place on logarithmic axes.
fn mark(row: &Row, name: String, median: f64, upper: Option<f64>) -> Option<Mark> {
    let speed = row.audio_s_per_s?;
    (median > 0.0 && upper.is_none_or(|u| u > 0.0) && speed > 0.0).then_some(Mark {
        name,
        speed,
        median,
        upper,
    })
}

fn panel(error: &str, upper: &str, mut marks: Vec<Mark>, limit: f64) -> Panel {
    marks.sort_by(|a, b| a.median.total_cmp(&b.median));
    let lowest = marks.first().map_or(1.0, |m| m.median);
    let highest = marks
        .iter()
        .map(|m| m.upper.unwrap_or(m.median))
        .fold(2.0 * lowest, f64::max);
    let slowest = marks.iter().map(|m| m.speed).fold(limit, f64::min);
    let fastest = marks.iter().map(|m| m.speed).fold(limit, f64::max);
    // The legend stands below the lowest mark.
    let errors = (lowest / ROOM.powi(3), highest * ROOM);
    let dots = |shape: Shape, name: &str, points: Vec<(f64, f64)>| {
        Layer::Dots(Dots::new(points, shape, Colour::BLUE).named(name))
    };
    let speed = "speed (seconds of audio per second of one core)";
    let mut panel = Panel::new(
        Axis::logarithmic(speed, slowest / ROOM, fastest * ROOM),
        Axis::logarithmic(error, errors.0, errors.1),
    )
    .legend_at(Corner::LowerLeft)
    .with(Layer::Curve(
        Curve::new(vec![(limit, errors.0), (limit, errors.1)], Colour::BLACK)
            .stroke(Stroke::Dashed)
            .named("limit: reading the files and summing squares"),
    ))
    .with(dots(
        Shape::Disc,
        "median",
        marks.iter().map(|m| (m.speed, m.median)).collect(),
    ))
    .with(dots(
        Shape::Ring,
        upper,
        marks
            .iter()
            .filter_map(|m| Some((m.speed, m.upper?)))
            .collect(),
    ));
    // All names stand in one column, in the order of the marks.
    let beside = marks.iter().map(|m| m.speed).fold(0.0, f64::max);
    let mut last = 0.0;
    for mark in marks {
        last = mark.median.max(NAMES_APART * last);
        panel = panel.with(Layer::Note(Note {
            at: (beside, last),
            side: Side::Right,
            text: mark.name,
            colour: Colour::BLUE,
        }));
    }
    panel
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::to_svg;

    #[test]
    fn every_way_that_found_something_has_its_name_in_the_picture() {
        let empty = Evaluation::of(&[], Some(1e4));
        let svg = to_svg(&figure(&empty)).unwrap();
        assert!(svg.contains("limit: reading the files") && !svg.contains("correlation"));
        let row = |model: &str, found: bool| Row {
            timing: "correlation".to_owned(),
            model: model.to_owned(),
            timing_error_median_s: found.then_some(1e-6),
            timing_error_p95_s: found.then_some(1e-4),
            restitution_error_median: found.then_some(1e-3),
            restitution_error_p90: found.then_some(1e-2),
            audio_s_per_s: Some(200.0),
            ..Row::default()
        };
        let full = Evaluation {
            rows: vec![row("auto", true), row("drag", true), row("speed", false)],
            ..empty
        };
        let svg = to_svg(&figure(&full)).unwrap();
        assert!(svg.contains("correlation, auto") && svg.contains("correlation, drag"));
        assert!(!svg.contains("correlation, speed"));
        // What lost too much for its 90th percentile still has its median.
        let mut rows = full.rows.clone();
        rows[1].restitution_error_p90 = None;
        let svg = to_svg(&figure(&Evaluation { rows, ..full })).unwrap();
        assert!(svg.contains("correlation, drag"));
    }
}
