//! The level over time, with impacts and rejected sounds.

use super::sound::Sound;
use crate::order::sort_by_number;
use crate::plot::{Axis, Band, Colour, Dots, Layer, Note, Panel, Shape, Side};
use crate::report::{Drop, Report, Status};
use crate::statistics::sorted;
use crate::units::real;

/// Levels shown below the ordinary one, in dB.
const BELOW_DB: f64 = 6.0;
/// The least level shown: that of 16 bits.
const LEAST_DB: f64 = -96.0;
/// Range of levels shown at least, in dB.
const LEAST_RANGE_DB: f64 = 30.0;
/// Room for the numbers above full scale, as a share of the range.
const NUMBERS: f64 = 0.14;

/// The panel; without a drop, all that was heard and rejected.
pub(super) fn panel(report: &Report, drop: Option<&Drop>, sound: &Sound) -> Panel {
    let least_db = least_db(drop, sound);
    let most_db = -NUMBERS * least_db;
    let level = sound
        .levels()
        .map(|(t, level)| (t, least_db, level.max(least_db)));
    let time = Axis::linear("time (s)", sound.from_s, sound.to_s);
    let heading = format!("Level of channel {}", sound.channel);
    let mut panel = Panel::new(
        time,
        Axis::linear("level (dB)", least_db, most_db).with_ticks(6),
    )
    .headed(heading)
    .with(Layer::Band(Band {
        points: level.collect(),
        colour: Colour::GREY,
        name: None,
    }));
    // Where the sound is below the least level, marks stand at the foot.
    let at = |time_s: f64, db: Option<f64>| {
        let db = db.unwrap_or_else(|| sound.level_at(time_s));
        (time_s, db.clamp(least_db, most_db))
    };
    let shown = |time_s: f64| (sound.from_s..=sound.to_s).contains(&time_s);
    let rejected = drop.into_iter().flat_map(|d| &d.rejected);
    let rejected = rejected.chain(&report.rejected);
    let rejected = rejected.map(|r| r.time_s).filter(|&t| shown(t));
    let others = report.drops.iter();
    let others = others.filter(|other| drop.is_none_or(|d| !std::ptr::eq(d, *other)));
    let others = others.flat_map(|other| &other.impacts);
    let others = others.map(|i| (i.time_s, i.level_db));
    let own = |status: Status| {
        let impacts = drop.into_iter().flat_map(|d| &d.impacts);
        let impacts = impacts.filter(move |i| i.status == status);
        impacts.map(|i| (i.time_s, i.level_db)).collect::<Vec<_>>()
    };
    for (marks, shape, colour, name) in [
        (
            rejected.map(|t| (t, None)).collect(),
            Shape::Cross,
            Colour::GREY,
            "rejected",
        ),
        (
            others.filter(|o| shown(o.0)).collect(),
            Shape::Point,
            Colour::GREEN,
            "of another drop",
        ),
        (
            own(Status::Inferred),
            Shape::Circlet,
            Colour::GREY,
            "inferred",
        ),
        (
            own(Status::Doubtful),
            Shape::Circlet,
            Colour::BLUE,
            "doubtful",
        ),
        (own(Status::Heard), Shape::Point, Colour::BLUE, "impact"),
    ] {
        if !marks.is_empty() {
            let points = marks.into_iter().map(|(t, db)| at(t, db)).collect();
            panel = panel.with(Layer::Dots(Dots::new(points, shape, colour).named(name)));
        }
    }
    panel.with(Layer::Labels(numbers(drop, most_db)))
}

/// The foot of the panel: below the ordinary level of the sound and below the weakest impact.
fn least_db(drop: Option<&Drop>, sound: &Sound) -> f64 {
    let levels = sorted(sound.levels().map(|(_, level)| level));
    let ordinary = levels.get(levels.len() / 10).copied().unwrap_or(LEAST_DB);
    let impacts = drop.into_iter().flat_map(|d| &d.impacts);
    let weakest = impacts.filter_map(|i| i.level_db).fold(0.0, f64::min);
    let least = ordinary.min(weakest) - BELOW_DB;
    (10.0 * (least / 10.0).floor()).clamp(LEAST_DB, -LEAST_RANGE_DB)
}

/// Numbers of the impacts in the order in which they get room: the first, the last, round ones, the rest.
fn numbers(drop: Option<&Drop>, at_db: f64) -> Vec<Note> {
    let count = drop.map_or(0, |d| d.impacts.len());
    let mut order: Vec<usize> = (1..=count).collect();
    sort_by_number(&mut order, |&n| {
        let steps = [100, 50, 20, 10, 5, 2, 1];
        let is_end = n == 1 || n == count;
        let ends_first = if is_end { -real(steps.len()) } else { 0.0 };
        let roundest_first = steps.iter().position(|step| n % step == 0);
        ends_first + roundest_first.map_or(0.0, real)
    });
    let impacts = drop.map_or(&[][..], |d| &d.impacts);
    let note = |n: usize| Note {
        at: (impacts[n - 1].time_s, at_db),
        side: Side::Below,
        text: n.to_string(),
        colour: Colour::BLACK,
    };
    order.into_iter().map(note).collect()
}
