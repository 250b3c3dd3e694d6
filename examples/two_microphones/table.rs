//! A row for each recording, and all impacts together.

use bounce_audio::report::Status;
use bounce_audio::statistics::quantile;
use bounce_audio::{Settings, analyze};

use super::delays::{Both, Delay, Timed, both, without_true};
use super::parallel::each;
use super::source::Source;

/// Off by more than this many seconds while less than the other is stated: an error that no one would expect.
const OFF_S: f64 = 1e-3;
const STATED_S: f64 = 0.3e-3;

/// What both channels of a recording say.
struct Row {
    name: String,
    heard: [usize; 2],
    delay: Option<Delay>,
    /// What a delay leaves of the difference of each impact in both, and its stated standard error, in seconds.
    rests_s: Vec<Timed>,
}

pub(crate) fn print(sources: &[Source]) {
    println!(
        "recording                     | heard, both | delay [µs] | drift [µs/s] | abs(dt) 50/75/90 % [µs] | abs(z) 50/75/90/95 % (right .67/1.15/1.64/1.96) | sure and off"
    );
    let rows = each(sources, row);
    for row in &rows {
        println!("{}", line(row));
    }
    let all: Vec<Timed> = rows.iter().flat_map(|r| r.rests_s.clone()).collect();
    println!("\nall {} impacts: {}", all.len(), figures(&all));
}

fn row(source: &Source) -> Row {
    let stereo = source.stereo();
    let times = stereo.channels.each_ref().map(|c| heard(c, stereo.rate));
    let paired = both(&times[0], &times[1]);
    let paired = without_true(&paired, &stereo.onsets_s);
    let delay = Delay::of(&paired);
    let rests_s = delay.map_or_else(Vec::new, |delay| {
        let rest = |b: &Both| (delay.rest_s(b), b.std_s);
        paired.iter().map(rest).collect()
    });
    Row {
        name: source.name(),
        heard: times.map(|t| t.len()),
        delay,
        rests_s,
    }
}

/// The impacts of all drops of a channel.
fn heard(samples: &[f32], rate: f64) -> Vec<Timed> {
    let analysis = analyze(samples, rate, &Settings::default()).unwrap();
    let impacts = analysis.drops.iter().flat_map(|d| &d.impacts);
    let heard = impacts.filter(|i| i.status != Status::Inferred);
    heard
        .filter_map(|i| Some((i.time_s, i.time_std_s?)))
        .collect()
}

fn line(row: &Row) -> String {
    let [first, second] = row.heard;
    let (at_mean_us, drift_us) = row
        .delay
        .map_or((f64::NAN, f64::NAN), |d| (1e6 * d.at_mean_s, 1e6 * d.per_s));
    format!(
        "{:<29} | {first:>3} {second:>3} {:>3} | {at_mean_us:>10.1} | {drift_us:>12.1} | {}",
        row.name,
        row.rests_s.len(),
        figures(&row.rests_s)
    )
}

fn figures(rests_s: &[Timed]) -> String {
    let off = |share| {
        let off_us = rests_s.iter().map(|(rest_s, _)| 1e6 * rest_s.abs());
        quantile(off_us, share).unwrap_or(f64::NAN)
    };
    let z = |share| {
        let z = rests_s.iter().map(|(rest_s, std_s)| rest_s.abs() / std_s);
        quantile(z, share).unwrap_or(f64::NAN)
    };
    let sure = rests_s
        .iter()
        .filter(|(rest_s, std_s)| rest_s.abs() > OFF_S && *std_s < STATED_S);
    format!(
        "{:>7.2} {:>7.2} {:>7.2} | {:>6.2} {:>6.2} {:>6.2} {:>6.2} | {}",
        off(0.5),
        off(0.75),
        off(0.9),
        z(0.5),
        z(0.75),
        z(0.9),
        z(0.95),
        sure.count()
    )
}
