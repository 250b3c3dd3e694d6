//! The scorer scored: what is put in is what shows, and nothing else.

use super::reference::{Reference, ReferenceDrop};
use super::rows::{Evaluation, Row, Tier};
use super::scores::{FileScore, score};
use super::thresholds::Thresholds;
use crate::fit::Estimate;
use crate::report::{Analysis, Bounce, Drop, Impact, Restitution, Status};

const E: f64 = 0.9;
const LIMIT_S: f64 = 1e-6;

/// Twenty impacts from 1 s on.
fn truth() -> Reference {
    let (mut onset, mut flight, mut speed) = (1.0, 0.4, 2.0);
    let mut drop = ReferenceDrop {
        period_s: Some(200e-6),
        ..ReferenceDrop::default()
    };
    for _ in 0..20 {
        drop.onsets_s.push(onset);
        drop.speeds_m_per_s.push(speed);
        onset += flight;
        flight *= E;
        speed *= E;
    }
    drop.audible = vec![true; 20];
    drop.timing_limit_s = vec![Some(LIMIT_S); 20];
    drop.restitution_each = vec![E; 20];
    drop.restitution_nominal_each = vec![E; 20];
    Reference {
        scene: "test".to_owned(),
        drops: vec![drop],
    }
}

fn impact(time_s: f64) -> Impact {
    Impact {
        time_s,
        time_std_s: Some(2.0 * LIMIT_S),
        level_db: Some(-20.0),
        interval_s: None,
        ratio: None,
        rebound_height_m: None,
        rebound_height_std_m: None,
        bounce: Bounce::default(),
        status: Status::Heard,
    }
}

fn drop_of(times_s: &[f64], e: f64, half_width: f64) -> Drop {
    Drop {
        channel: 1,
        impacts: times_s.iter().map(|&t| impact(t)).collect(),
        bounces: times_s.len(),
        restitution: Some(Restitution {
            estimate: Estimate {
                value: e,
                std_error: Some(0.5 * half_width),
                interval95: Some([e - half_width, e + half_width]),
            },
            at_speed_m_per_s: Some(1.0),
            method: crate::report::Method::LeastSquares,
        }),
        ..Drop::empty()
    }
}

fn analysis(drops: Vec<Drop>) -> Analysis {
    Analysis {
        drops,
        rejected: Vec::new(),
        candidate: None,
        rejected_weak: 0,
        warnings: Vec::new(),
    }
}

/// The score of one drop found at these times.
fn scored(times_s: &[f64]) -> FileScore {
    score(
        &analysis(vec![drop_of(times_s, E, 0.01)]),
        &truth(),
        4.0,
        0.02,
    )
}

fn summed(files: Vec<FileScore>) -> Row {
    let tier = Tier {
        timing: "test".to_owned(),
        model: "constant".to_owned(),
        files,
    };
    Evaluation::of(&[tier], Some(1_000.0)).rows.remove(0)
}

fn onsets() -> Vec<f64> {
    truth().drops[0].onsets_s.clone()
}

#[test]
fn a_perfect_answer_scores_perfectly() {
    let row = summed(vec![scored(&onsets())]);
    assert_eq!((row.recall, row.precision), (Some(1.0), Some(1.0)));
    assert_eq!(
        (row.false_drops, row.lost_drops, row.split_drops),
        (0, 0, 0)
    );
    assert_eq!(row.timing_error_p95_s, Some(0.0));
    assert_eq!((row.efficiency, row.cycle_slips), (Some(0.0), Some(0.0)));
    assert!(row.restitution_error_p90.unwrap() < 1e-15);
    assert!(row.realised_error_p90.unwrap() < 1e-15);
    assert_eq!(row.coverage95, Some(1.0));
    assert_eq!((row.audio_s_per_s, row.of_limit), (Some(200.0), Some(0.2)));
}

#[test]
fn times_are_held_against_the_onsets_of_the_channel_that_a_drop_was_heard_on() {
    let mut truth = truth();
    let onsets_s = onsets()
        .into_iter()
        .zip([-3e-4, 0.0, 3e-4].into_iter().cycle());
    let second: Vec<f64> = onsets_s.map(|(t, later_s)| t + 5e-4 + later_s).collect();
    truth.drops[0].more_onsets_s = vec![second.clone()];
    for (channel, expected) in [(1, 3e-4), (2, 0.0)] {
        let mut drop = drop_of(&second, E, 0.01);
        drop.channel = channel;
        let hits = score(&analysis(vec![drop]), &truth, 4.0, 0.02).hits;
        let worst = hits.iter().map(|h| h.error_s.abs()).fold(0.0, f64::max);
        assert_eq!(hits.len(), 20);
        assert!((worst - expected).abs() < 1e-12, "{channel}: {worst}");
    }
}

#[test]
fn an_empty_answer_scores_no_recall_and_no_false_drop() {
    let row = summed(vec![score(&analysis(Vec::new()), &truth(), 4.0, 0.02)]);
    assert_eq!((row.recall, row.precision), (Some(0.0), None));
    assert_eq!((row.false_drops, row.lost_drops), (0, 1));
    assert_eq!((row.timing_error_median_s, row.coverage95), (None, None));
}

#[test]
fn what_is_lost_counts_as_wrong_in_every_quantile() {
    let empty = || score(&analysis(Vec::new()), &truth(), 4.0, 0.02);
    let mut files: Vec<FileScore> = (0..9).map(|_| scored(&onsets())).collect();
    files.push(empty());
    let row = summed(files.clone());
    assert_eq!(row.timing_error_median_s, Some(0.0));
    assert_eq!(row.timing_error_p95_s, None);
    assert!(row.restitution_error_p90.unwrap() < 1e-15);
    files.push(empty());
    let row = summed(files);
    assert_eq!((row.lost_drops, row.restitution_error_p90), (2, None));
    assert!(row.restitution_error_median.unwrap() < 1e-15);
}

#[test]
fn a_constant_delay_is_forgiven() {
    for delay in [-3e-3, 0.4e-3, 9e-3] {
        let late: Vec<f64> = onsets().iter().map(|t| t + delay).collect();
        let row = summed(vec![scored(&late)]);
        assert_eq!(row.recall, Some(1.0));
        assert!(row.timing_error_p95_s.unwrap() < 1e-12, "{delay}");
    }
}

#[test]
fn one_extra_impact_costs_precision_alone() {
    let mut times = onsets();
    times.insert(1, 1.2);
    let row = summed(vec![scored(&times)]);
    assert_eq!(row.precision, Some(20.0 / 21.0));
    assert_eq!((row.recall, row.false_drops), (Some(1.0), 0));
    assert_eq!(row.timing_error_p95_s, Some(0.0));
}

#[test]
fn one_missed_impact_costs_recall_alone() {
    let mut times = onsets();
    times.remove(7);
    let row = summed(vec![scored(&times)]);
    assert_eq!((row.recall, row.precision), (Some(0.95), Some(1.0)));
    assert_eq!(row.timing_error_p95_s, Some(0.0));
}

#[test]
fn one_doubled_impact_counts_once() {
    let mut times = onsets();
    times.insert(8, times[7] + 0.5e-3);
    let row = summed(vec![scored(&times)]);
    assert_eq!((row.recall, row.precision), (Some(1.0), Some(20.0 / 21.0)));
    assert_eq!(row.timing_error_p95_s, Some(0.0));
}

#[test]
fn one_late_impact_is_a_timing_error_or_a_slip_or_a_miss() {
    let late = |by: f64| {
        let mut times = onsets();
        times[7] += by;
        summed(vec![scored(&times)])
    };
    let error = late(20e-6);
    assert!((error.efficiency.unwrap() - 20.0 / 20.0_f64.sqrt()).abs() < 1e-6);
    assert!((error.error_over_stated.unwrap() - 10.0 / 20.0_f64.sqrt()).abs() < 1e-6);
    assert_eq!(error.cycle_slips, Some(0.0));
    let slip = late(200e-6);
    assert!(slip.efficiency.unwrap() < 1e-9);
    assert_eq!((slip.cycle_slips, slip.recall), (Some(0.05), Some(1.0)));
    let miss = late(3e-3);
    assert_eq!((miss.recall, miss.precision), (Some(0.95), Some(0.95)));
}

#[test]
fn an_inaudible_impact_may_be_found_or_not() {
    let mut reference = truth();
    reference.drops[0].audible[19] = false;
    let of = |times: &[f64]| {
        let analysis = analysis(vec![drop_of(times, E, 0.01)]);
        summed(vec![score(&analysis, &reference, 4.0, 0.02)])
    };
    for row in [of(&onsets()), of(&onsets()[..19])] {
        assert_eq!((row.audible, row.recall), (19, Some(1.0)));
        assert_eq!(row.precision, Some(1.0));
    }
}

#[test]
fn drops_are_false_lost_or_split() {
    let nothing = Reference::default();
    let found = analysis(vec![drop_of(&onsets(), E, 0.01)]);
    assert_eq!(
        summed(vec![score(&found, &nothing, 4.0, 0.0)]).false_drops,
        1
    );
    let (first, second) = (
        drop_of(&onsets()[..12], E, 0.01),
        drop_of(&onsets()[12..], E, 0.01),
    );
    let row = summed(vec![score(
        &analysis(vec![first, second]),
        &truth(),
        4.0,
        0.0,
    )]);
    assert_eq!(
        (row.split_drops, row.false_drops, row.lost_drops),
        (1, 0, 0)
    );
    let elsewhere = [1.1, 1.25, 1.37, 1.45];
    let row = summed(vec![score(
        &analysis(vec![drop_of(&elsewhere, E, 0.01)]),
        &truth(),
        4.0,
        0.0,
    )]);
    assert_eq!((row.false_drops, row.lost_drops), (1, 1));
}

#[test]
fn coverage_is_that_of_known_intervals() {
    let files = (0..100).map(|k| {
        // Off by 0 to 0.0099: intervals of half width 0.004 hold 41 of them.
        let off = 1e-4 * f64::from(k);
        let found = analysis(vec![drop_of(&onsets(), E + off, 0.004_05)]);
        score(&found, &truth(), 4.0, 0.02)
    });
    let row = summed(files.collect());
    assert_eq!(row.coverage95, Some(0.41));
    assert!((row.restitution_error_median.unwrap() - 0.004_95).abs() < 1e-12);
}

#[test]
fn walk_is_the_slope_of_error_against_level() {
    let mut drop = drop_of(&onsets(), E, 0.01);
    for (i, impact) in drop.impacts.iter_mut().enumerate() {
        let level = -2.0 * crate::units::real(i);
        impact.level_db = Some(level);
        impact.time_s -= 1e-7 * level;
    }
    let row = summed(vec![score(&analysis(vec![drop]), &truth(), 4.0, 0.02)]);
    assert!((row.walk_s_per_db.unwrap() + 1e-7).abs() < 1e-12);
    assert!(row.walk_std_s_per_db.unwrap() < 1e-12);
}

#[test]
fn labels_are_impacts_that_can_be_heard() {
    let text = "1,5\t1,5\tb\n\\\t100\t200\n0.5\t0.5\ta\n";
    let reference = Reference::from_labels(text).unwrap();
    assert_eq!(reference.drops[0].onsets_s, [0.5, 1.5]);
    assert_eq!(reference.drops[0].audible, [true, true]);
    let error = Reference::from_labels("one\ttwo\n")
        .unwrap_err()
        .to_string();
    assert!(error.contains("one"), "{error}");
}

#[test]
fn thresholds_complain_of_what_is_lost_and_only_grow_stricter() {
    let good = summed(vec![scored(&onsets())]);
    let mut times = onsets();
    times.truncate(10);
    let poor = summed(vec![scored(&times)]);
    let text = Thresholds::default().tightened([&poor]);
    let loose = Thresholds::from_toml(&text).unwrap();
    assert!(loose.complaints([&poor, &good]).is_empty());
    let strict = Thresholds::from_toml(&loose.tightened([&good])).unwrap();
    assert!(strict.complaints([&good]).is_empty());
    let complaints = strict.complaints([&poor]);
    assert!(
        complaints[0].starts_with("all: recall is 5.0"),
        "{complaints:?}"
    );
    assert_eq!(strict.tightened([&poor]), strict.tightened([&good]));
    assert_eq!(strict.complaints([]), ["all: not evaluated"]);
}
