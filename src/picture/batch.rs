//! Many recordings: e of each with its interval, their mean, and how often each e came out.

use std::collections::HashSet;

use super::names::Names;
use super::{around, at_least, printable};
use crate::order::sort_by_number;
use crate::plot::{
    Axis, Band, Colour, Curve, Dots, Figure, Layer, Note, Panel, Row, Shape, Side, Stroke,
};
use crate::report::{counted, short};
use crate::units::{real, whole};

/// One drop of a batch, or a recording without one.
#[derive(Debug, Clone, PartialEq)]
pub struct BatchRow {
    /// The recording.
    pub file: String,
    /// The number of the drop where there are several in it.
    pub drop: Option<usize>,
    /// e, or why there is none, in few words.
    pub restitution: Result<Ranged, String>,
    /// Whether it is far from the rest.
    pub outlier: bool,
}

/// e of a drop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ranged {
    /// e.
    pub value: f64,
    /// Its 95 % interval; none where the recording does not tell.
    pub interval95: Option<[f64; 2]>,
}

/// The mean of a batch and its standard error.
pub type Mean = (f64, f64);

/// The order of the rows from top to bottom.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Order {
    /// That of the files.
    File,
    /// From the greatest e to the least; what has none stands at the bottom.
    Restitution,
}

/// Height in pixels for each row, of what stands around them, and of both between these.
const ROW_PX: u32 = 30;
const AROUND_ROWS_PX: u32 = 140;
const HEIGHTS_PX: (u32, u32) = (300, 1700);
/// Height of the histogram, and of the lines above all.
const COUNTS_PX: u32 = 380;
const HEAD_PX: u32 = 130;
/// Half the width of the bar of an interval, against that of a row.
const REACH: f64 = 0.15;
/// Rows that can have their name each; of more, every second, third, … has it.
const MOST_NAMES: usize = 50;
/// Fewer drops than this make no histogram.
const LEAST_COUNTED: usize = 8;
/// The histogram has the root of the number of rows as its number of bins, between these.
const BINS: (f64, f64) = (5.0, 40.0);
/// An interval goes on beyond the values by this share of their range at most, and axes have this range at least.
const BEYOND: f64 = 0.5;
const LEAST_RANGE: f64 = 0.004;

/// One sheet for all rows. The mean is that of the summary, drawn with its 95 % interval.
#[must_use]
pub fn sheet(rows: &[BatchRow], mean: Option<Mean>, order: Order) -> Figure {
    let rows = ordered(rows, order);
    let files: Vec<&str> = rows.iter().map(|row| row.file.as_str()).collect();
    let names = Names::of(&files);
    let height = u32::try_from(rows.len()).unwrap_or(u32::MAX);
    let height = height.saturating_mul(ROW_PX).saturating_add(AROUND_ROWS_PX);
    let values: Vec<f64> = rows.iter().filter_map(|row| value(row)).collect();
    let height = height.clamp(HEIGHTS_PX.0, HEIGHTS_PX.1);
    let mut panels = vec![(height, each(&rows, &names.own, mean))];
    if values.len() >= LEAST_COUNTED {
        panels.push((COUNTS_PX, histogram(&values)));
    }
    let all = panels.iter().map(|(height, _)| height).sum::<u32>();
    Figure {
        headline: mean.map(|(mean, std)| format!("mean e = {}", short(mean, std))),
        title: title(values.len(), &files, &names.shared),
        subtitle: None,
        rows: panels
            .into_iter()
            .map(|(height, panel)| Row {
                height,
                panels: vec![panel],
            })
            .collect(),
        size: (1400, all + HEAD_PX),
        density: 1.0,
    }
}

/// How many drops and recordings, and what the names of these have in common, which the rows leave out: without their number it
/// would pass for the name of one.
fn title(drops: usize, files: &[&str], (head, tail): &(String, String)) -> String {
    let recordings = files.iter().collect::<HashSet<_>>().len();
    let (drops, recordings) = (counted(drops, "drop"), counted(recordings, "recording"));
    let named = match head.as_str() {
        "" => String::new(),
        head => format!(" named {}", printable(&format!("{head}…{tail}"))),
    };
    format!("{drops} in {recordings}{named}")
}

fn value(row: &BatchRow) -> Option<f64> {
    let value = row.restitution.as_ref().ok()?.value;
    value.is_finite().then_some(value)
}

fn ordered(rows: &[BatchRow], order: Order) -> Vec<&BatchRow> {
    let mut rows: Vec<&BatchRow> = rows.iter().collect();
    if order == Order::Restitution {
        sort_by_number(&mut rows, |row| -value(row).unwrap_or(f64::NEG_INFINITY));
    }
    rows
}

/// The name of a row, with the number of its drop.
fn label(row: &BatchRow, name: &str) -> String {
    let number = row.drop.map(|number| format!(", {number}"));
    printable(&(name.to_owned() + &number.unwrap_or_default()))
}

fn each(rows: &[&BatchRow], names: &[String], mean: Option<Mean>) -> Panel {
    let (low, high) = range(rows, mean);
    let every = rows.len().div_ceil(MOST_NAMES).max(1);
    let place = |i: usize| real(rows.len()) - real(i);
    let named = rows.iter().zip(names).enumerate().step_by(every);
    let named = named.map(|(i, (row, name))| (place(i), label(row, name)));
    let named = named.collect();
    let axis = Axis::named(named, 0.0, real(rows.len().max(1)) + 1.0);
    let mut panel = Panel::new(Axis::linear("e", low, high).with_ticks(9), axis)
        .headed("Each drop with its 95 % interval");
    if let Some((mean, std)) = mean {
        panel = with_mean(panel, mean, std);
    }
    for (i, row) in rows.iter().enumerate() {
        let interval = row.restitution.as_ref().ok().and_then(|e| e.interval95);
        if let Some([from, to]) = interval {
            let bar = Band::bar((from, to), place(i), REACH, colour(row));
            panel = panel.with(Layer::Band(bar));
        }
    }
    let dots = |outlier: bool| {
        let rows = rows.iter().enumerate();
        let rows = rows.filter(move |(_, row)| row.outlier == outlier);
        rows.filter_map(|(i, row)| Some((value(row)?, place(i))))
            .collect::<Vec<_>>()
    };
    panel = panel.with(Layer::Dots(Dots::new(
        dots(false),
        Shape::Point,
        Colour::BLUE,
    )));
    let far = dots(true);
    if !far.is_empty() {
        let far = Dots::new(far, Shape::Point, Colour::RED).named("outlier");
        panel = panel.with(Layer::Dots(far));
    }
    let missing = rows.iter().enumerate().filter_map(|(i, row)| {
        Some(Note {
            at: (low, place(i)),
            side: Side::Right,
            text: printable(row.restitution.as_ref().err()?),
            colour: Colour::GREY,
        })
    });
    panel.with(Layer::Labels(missing.collect()))
}

fn colour(row: &BatchRow) -> Colour {
    if row.outlier {
        Colour::RED
    } else {
        Colour::BLUE
    }
}

/// The mean as a line and its 95 % interval as a band over all rows.
fn with_mean(panel: Panel, mean: f64, std: f64) -> Panel {
    let (from, to) = (panel.y.from, panel.y.to);
    let reach = 1.96 * std;
    let band = [mean - reach, mean + reach].map(|e| (e, from, to));
    let line = Curve::new(vec![(mean, from), (mean, to)], Colour::BLACK).stroke(Stroke::Dashed);
    panel
        .with(Layer::Band(Band {
            points: band.to_vec(),
            colour: Colour::ORANGE,
            name: None,
        }))
        .with(Layer::Curve(line.named("mean with its 95 % interval")))
}

/// All values with room, and of their intervals as much as leaves the values room.
fn range(rows: &[&BatchRow], mean: Option<Mean>) -> (f64, f64) {
    let values = rows.iter().filter_map(|row| value(row));
    let (low, high) = at_least(around(values.chain(mean.map(|m| m.0)), 0.0), LEAST_RANGE);
    let beyond = BEYOND * (high - low);
    let intervals = rows.iter().filter_map(|row| row.restitution.as_ref().ok());
    let ends = intervals.filter_map(|e| e.interval95).flatten();
    let ends = ends.map(|end| end.clamp(low - beyond, high + beyond));
    around(ends.chain([low, high]), 0.05)
}

fn histogram(values: &[f64]) -> Panel {
    let (low, high) = at_least(around(values.iter().copied(), 0.0), LEAST_RANGE);
    let bins = real(values.len()).sqrt().ceil().clamp(BINS.0, BINS.1);
    let width = (high - low) / bins;
    let mut counts = vec![0_usize; whole(bins)];
    for value in values {
        // The whole bins below it; the greatest e belongs to the last bin.
        let below = ((value - low) / width).floor();
        let bin = whole(below).min(counts.len() - 1);
        counts[bin] += 1;
    }
    let most = real(counts.iter().copied().max().unwrap_or(0).max(1));
    let from = around([low, high], 0.05);
    let mut panel = Panel::new(
        Axis::linear("e", from.0, from.1),
        Axis::counting("drops", 0.0, 1.1 * most).with_ticks(5),
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
