//! An evaluation as a table for people.

use super::rows::{Evaluation, Row};

const HEAD: &str = "timing       model     scene         files  recall  precis  false lost split   median    p95  limit× floor×  slips stated×     walk   e med   e p90  cover95   audio s/s  of limit";

/// The table: totals first, then the scenes of each way of timing.
#[must_use]
pub fn to_text(evaluation: &Evaluation) -> String {
    let mut text = format!("{} recordings", evaluation.files);
    if let Some(limit) = evaluation.limit_audio_s_per_s {
        text += &format!("; reading them and summing squares: {limit:.0} s of audio a second");
    }
    text += "\n\n";
    text += HEAD;
    text += "\n";
    for row in evaluation.rows.iter().chain(&evaluation.scenes) {
        text += &line(row);
    }
    text + "
recall: share of the audible impacts that were found; precis: share of what was found that is an impact
false: drops where none was; lost: drops not found; split: drops found in pieces
median, p95: error of the times in microseconds, after one common offset per recording; what was lost counts as infinite
limit×: rms error over the least that is possible; floor×: over what a match with the mean sound reaches at best
slips: off by half a period or more; stated×: rms error over stated
walk: slope of the error against level, in microseconds per dB
e med, e p90: error of e against the ball's own, infinite for a lost drop; cover95: how often the 95 % interval holds it
"
}

fn line(row: &Row) -> String {
    let micro = |x: Option<f64>| number(x.map(|s| 1e6 * s), 2);
    format!(
        "{:<12} {:<9} {:<12} {:>6} {:>7} {:>7} {:>6} {:>4} {:>5} {:>8} {:>6} {:>7} {:>6} {:>6} {:>7} {:>8} {:>7} {:>7} {:>8} {:>11} {:>9}\n",
        row.timing,
        row.model,
        row.scene.as_deref().unwrap_or("all"),
        row.files,
        number(row.recall, 3),
        number(row.precision, 3),
        row.false_drops,
        row.lost_drops,
        row.split_drops,
        micro(row.timing_error_median_s),
        number(row.timing_error_p95_s.map(|s| 1e6 * s), 0),
        number(row.efficiency, 1),
        number(row.efficiency_of_match, 1),
        number(row.cycle_slips, 3),
        number(row.error_over_stated, 1),
        number(row.walk_s_per_db.map(|s| 1e6 * s), 3),
        number(row.restitution_error_median, 4),
        number(row.restitution_error_p90, 4),
        number(row.coverage95, 2),
        number(row.audio_s_per_s, 0),
        number(row.of_limit, 4),
    )
}

fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "-".to_owned(), |x| format!("{x:.digits$}"))
}
