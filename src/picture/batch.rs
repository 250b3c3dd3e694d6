//! Many recordings: e of each with its interval, and how often each e came out.

use super::{around, printable};
use crate::plot::{Axis, Band, Colour, Dots, Figure, Layer, Note, Panel, Row, Shape, Side};
use crate::units::{real, whole};

/// One drop of a batch.
#[derive(Debug, Clone, PartialEq)]
pub struct BatchRow {
    /// What it is called: its file, with the number of the drop where there are several.
    pub name: String,
    /// e.
    pub restitution: f64,
    /// Its 95 % interval; none where the recording does not tell.
    pub interval95: Option<[f64; 2]>,
}

/// Names have this share of the width of their panel, and this many characters at most.
const NAMES: f64 = 0.4;
const LONGEST_NAME: usize = 26;
/// Height in pixels for each row, between these.
const ROW_PX: u32 = 26;
const HEIGHTS_PX: (u32, u32) = (700, 1800);
/// The histogram has the root of the number of rows as its number of bins, between these.
const BINS: (f64, f64) = (5.0, 40.0);
const DENSITY: f64 = 0.8;

/// One sheet for all rows that have an e, in their order from top to bottom.
#[must_use]
pub fn sheet(rows: &[BatchRow]) -> Figure {
    let height = u32::try_from(rows.len()).unwrap_or(u32::MAX);
    let height = height.saturating_mul(ROW_PX).saturating_add(200);
    let rows: Vec<&BatchRow> = rows.iter().filter(|r| r.restitution.is_finite()).collect();
    Figure {
        title: format!("e of {} drops", rows.len()),
        subtitle: mean(&rows),
        rows: vec![Row {
            height: 1,
            panels: vec![each(&rows), histogram(&rows)],
        }],
        size: (1400, height.clamp(HEIGHTS_PX.0, HEIGHTS_PX.1)),
        density: DENSITY,
    }
}

/// The plain mean and the spread between the drops.
fn mean(rows: &[&BatchRow]) -> Option<String> {
    if rows.len() < 2 {
        return None;
    }
    let count = real(rows.len());
    let mean = rows.iter().map(|r| r.restitution).sum::<f64>() / count;
    let squares = rows.iter().map(|r| (r.restitution - mean).powi(2));
    let spread = (squares.sum::<f64>() / (count - 1.0)).sqrt();
    let digits = crate::report::decimals(spread).max(1);
    Some(format!(
        "mean {mean:.digits$}, standard deviation between drops {spread:.digits$}"
    ))
}

fn each(rows: &[&BatchRow]) -> Panel {
    let ends = rows.iter().flat_map(|r| {
        let [low, high] = r.interval95.unwrap_or([r.restitution; 2]);
        [low, high, r.restitution]
    });
    let (low, high) = around(ends, 0.05);
    // Names stand left of all intervals.
    let left = low - NAMES / (1.0 - NAMES) * (high - low);
    let count = real(rows.len().max(1));
    let place = |i: usize| count - real(i);
    let order = Axis::linear("", 0.0, count + 1.0).with_ticks(0);
    let mut panel = Panel::new(Axis::linear("e", left, high).with_ticks(7), order)
        .headed("Each drop with its 95 % interval");
    for (i, row) in rows.iter().enumerate() {
        let reach = 0.12;
        if let Some([from, to]) = row.interval95 {
            panel = panel.with(Layer::Band(Band {
                points: [from, to]
                    .map(|e| (e, place(i) - reach, place(i) + reach))
                    .to_vec(),
                colour: Colour::BLUE,
                name: None,
            }));
        }
    }
    let points = rows.iter().enumerate();
    let points = points.map(|(i, row)| (row.restitution, place(i))).collect();
    let names = rows.iter().enumerate().map(|(i, row)| Note {
        at: (left, place(i)),
        side: Side::Right,
        text: short(&row.name),
        colour: Colour::BLACK,
    });
    panel
        .with(Layer::Dots(Dots::new(points, Shape::Point, Colour::BLUE)))
        .with(Layer::Labels(names.collect()))
}

/// A name without its middle where it is long: numbers stand at the end.
fn short(name: &str) -> String {
    let characters: Vec<char> = printable(name).chars().collect();
    if characters.len() <= LONGEST_NAME {
        return characters.into_iter().collect();
    }
    let kept = LONGEST_NAME / 2;
    let parts = [
        &characters[..kept],
        &['…'],
        &characters[characters.len() - kept..],
    ];
    parts.concat().into_iter().collect()
}

fn histogram(rows: &[&BatchRow]) -> Panel {
    let (low, high) = around(rows.iter().map(|r| r.restitution), 1e-9);
    let bins = real(rows.len()).sqrt().ceil().clamp(BINS.0, BINS.1);
    let width = (high - low) / bins;
    let mut counts = vec![0_usize; whole(bins)];
    for row in rows {
        // The whole bins below it; the greatest e belongs to the last bin.
        let below = ((row.restitution - low) / width).floor();
        let bin = whole(below).min(counts.len() - 1);
        counts[bin] += 1;
    }
    let most = real(counts.iter().copied().max().unwrap_or(0).max(1));
    let from = around([low, high], 0.05);
    let mut panel = Panel::new(
        Axis::linear("e", from.0, from.1).with_ticks(6),
        Axis::counting("number of drops", 0.0, 1.1 * most),
    )
    .headed("How often");
    for (bin, count) in counts.iter().enumerate().filter(|(_, c)| **c > 0) {
        let start = low + real(bin) * width;
        let sides = [start + 0.03 * width, start + 0.97 * width];
        panel = panel.with(Layer::Band(Band {
            points: sides.map(|x| (x, 0.0, real(*count))).to_vec(),
            colour: Colour::BLUE,
            name: None,
        }));
    }
    panel
}
