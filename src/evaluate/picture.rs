//! Error and speed of every way of analysis: a row for each, a dot with the range of its error.

use super::rows::{Evaluation, Row};
use crate::plot::{
    Axis, Band, Colour, Curve, Dots, Figure, Layer, Panel, Row as PanelRow, Shape, Stroke,
};

/// Room left around the marks, as a factor.
const ROOM: f64 = 1.5;
/// Height in pixels of each row, and of what stands around them.
const ROW_PX: u32 = 44;
const AROUND_ROWS_PX: u32 = 260;
const LEAST_ROWS: u32 = 3;
/// Half the width of a range, against that of a row.
const REACH: f64 = 0.12;

/// What a panel shows of a row: a value, and the far end of its range; none where so much was lost that it has none.
type Mark = (f64, Option<f64>);

/// For each way of timing and model a row: the median error of the times up to the 95th percentile, that of e up to the
/// 90th, and the speed, with that of only reading the files as a line. What found nothing has its name and no dots.
#[must_use]
pub fn figure(evaluation: &Evaluation) -> Figure {
    let rows = &evaluation.rows;
    let times = |row: &Row| {
        let upper = row.timing_error_p95_s.map(|s| 1e6 * s);
        Some((1e6 * row.timing_error_median_s?, upper))
    };
    let restitutions = |row: &Row| Some((row.restitution_error_median?, row.restitution_error_p90));
    let speeds = |row: &Row| row.audio_s_per_s.map(|speed| (speed, Some(speed)));
    let limit = evaluation.limit_audio_s_per_s;
    let panels = vec![
        panel(rows, &times, None, true).headed("Times"),
        panel(rows, &restitutions, None, false).headed("e"),
        panel(rows, &speeds, limit, false).headed("Speed"),
    ];
    let labels = ["error (µs)", "error of e", "seconds of audio per second"];
    let panels = panels.into_iter().zip(labels).map(|(mut panel, label)| {
        panel.x.label = label.to_owned();
        panel
    });
    let count = u32::try_from(rows.len())
        .unwrap_or(u32::MAX)
        .max(LEAST_ROWS);
    Figure {
        rows: vec![PanelRow {
            height: 1,
            panels: panels.collect(),
        }],
        size: (
            1400,
            count.saturating_mul(ROW_PX).saturating_add(AROUND_ROWS_PX),
        ),
        subtitle: Some(
            "dot: median; bar: up to the 95th percentile of times, the 90th of e".to_owned(),
        ),
        ..Figure::new(
            format!(
                "Ways of timing and models on {} recordings",
                evaluation.files
            ),
            Vec::new(),
        )
    }
}

/// A panel with a row for each way; the first has their names.
fn panel(
    rows: &[Row],
    mark: &dyn Fn(&Row) -> Option<Mark>,
    limit: Option<f64>,
    names: bool,
) -> Panel {
    let marks: Vec<(f64, Mark)> = (1_u32..)
        .zip(rows.iter().rev())
        .filter_map(|(place, row)| Some((f64::from(place), mark(row)?)))
        // Nothing else has a place on a logarithmic axis.
        .filter(|(_, (value, upper))| *value > 0.0 && upper.is_none_or(|u| u > 0.0))
        .collect();
    let values = marks
        .iter()
        .flat_map(|(_, (value, upper))| [Some(*value), *upper]);
    let values: Vec<f64> = values.flatten().chain(limit).collect();
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(0.0, f64::max);
    let (low, high) = if values.is_empty() {
        (1.0, 10.0)
    } else {
        (low / ROOM, high * ROOM)
    };
    let named = (1_u32..).zip(rows.iter().rev());
    let named = named.filter(|_| names);
    let named =
        named.map(|(place, row)| (f64::from(place), format!("{}, {}", row.timing, row.model)));
    let top = f64::from(u32::try_from(rows.len()).unwrap_or(u32::MAX).max(1)) + 0.8;
    let mut panel = Panel::new(
        Axis::logarithmic("", low, high).with_ticks(5),
        Axis::named(named.collect(), 0.2, top),
    );
    if let Some(limit) = limit {
        let line = Curve::new(vec![(limit, 0.2), (limit, top)], Colour::BLACK);
        let line = line.stroke(Stroke::Dashed).named("only reading");
        panel = panel.with(Layer::Curve(line));
    }
    for (place, (value, upper)) in &marks {
        let range = (*value, upper.unwrap_or(high));
        let bar = Band::bar(range, *place, REACH, Colour::BLUE);
        panel = panel.with(Layer::Band(bar));
    }
    let dots = marks.iter().map(|(place, (value, _))| (*value, *place));
    panel.with(Layer::Dots(Dots::new(
        dots.collect(),
        Shape::Disc,
        Colour::BLUE,
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::to_svg;

    fn row(model: &str, found: bool) -> Row {
        Row {
            timing: "correlation".to_owned(),
            model: model.to_owned(),
            timing_error_median_s: found.then_some(1e-6),
            timing_error_p95_s: found.then_some(1e-4),
            restitution_error_median: found.then_some(1e-3),
            restitution_error_p90: found.then_some(1e-2),
            audio_s_per_s: Some(200.0),
            ..Row::default()
        }
    }

    fn discs(svg: &str) -> usize {
        svg.split("<circle")
            .skip(1)
            .filter(|c| c.contains("fill=\"#0072B2\""))
            .count()
    }

    #[test]
    fn every_way_has_its_name_once_and_a_dot_for_what_it_found() {
        let empty = Evaluation::of(&[], Some(1e4));
        let svg = to_svg(&figure(&empty)).unwrap();
        assert!(svg.contains("only reading") && !svg.contains("correlation"));
        let full = Evaluation {
            rows: vec![row("auto", true), row("drag", true), row("speed", false)],
            ..empty
        };
        let svg = to_svg(&figure(&full)).unwrap();
        for name in [
            "correlation, auto",
            "correlation, drag",
            "correlation, speed",
        ] {
            assert_eq!(svg.matches(name).count(), 1, "{name}");
        }
        // Two ways with three dots each, and the speed of the third.
        assert_eq!(discs(&svg), 7);
        // What lost too much for its 90th percentile still has its median.
        let mut rows = full.rows.clone();
        rows[1].restitution_error_p90 = None;
        let svg = to_svg(&figure(&Evaluation { rows, ..full })).unwrap();
        assert_eq!(discs(&svg), 7);
    }
}
