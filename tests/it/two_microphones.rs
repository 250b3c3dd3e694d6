//! What `examples/two_microphones` prints rests on pairs that are right and a delay that strays do not move.

#[path = "../../examples/two_microphones/delays.rs"]
mod delays;

use delays::{Both, Delay, Timed, both, without_true};

/// Impacts of one ball in two channels: the second later by 0.4 ms and 10 µs more each second, one impact by 3 ms more.
fn channels() -> [Vec<Timed>; 2] {
    let times = (0..15_u8).map(|i| 1.0 + 4.0 * (1.0 - 0.9_f64.powi(i32::from(i))));
    let first: Vec<Timed> = times.map(|t| (t, 3e-6)).collect();
    let later = |i: usize, t: f64| t + 4e-4 + 1e-5 * t + if i == 4 { 3e-3 } else { 0.0 };
    let second = first.iter().enumerate();
    let second = second.map(|(i, (t, _))| (later(i, *t), 4e-6)).collect();
    [first, second]
}

#[test]
fn an_impact_that_one_channel_lacks_is_paired_with_no_other() {
    let [first, mut second] = channels();
    second.remove(6);
    let paired = both(&first, &second);
    assert_eq!(paired.len(), 14);
    assert!(paired.iter().all(|b| (b.time_s - first[6].0).abs() > 1e-3));
    assert!(paired.iter().all(|b| (b.std_s - 5e-6).abs() < 1e-12));
    // Two sounds of the second channel near one of the first: the nearest is the one.
    second.insert(3, (first[2].0 + 5e-3, 1e-6));
    assert_eq!(both(&first, &second), paired);
}

#[test]
fn a_delay_and_its_drift_are_found_beside_a_stray() {
    let [first, second] = channels();
    let paired = both(&first, &second);
    let delay = Delay::of(&paired).unwrap();
    assert!((delay.per_s - 1e-5).abs() < 1e-9, "{}", delay.per_s);
    let rests_s: Vec<f64> = paired.iter().map(|b| delay.rest_s(b)).collect();
    for (i, rest_s) in rests_s.iter().enumerate() {
        let expected = if i == 4 { 3e-3 } else { 0.0 };
        assert!((rest_s - expected).abs() < 1e-9, "{i}: {rest_s}");
    }
    assert_eq!(Delay::of(&paired[..1]), None);
}

#[test]
fn true_delays_are_taken_off_where_they_are_known() {
    let [first, second] = channels();
    let paired = both(&first, &second);
    let onsets_s: Vec<[f64; 2]> = (first.iter().zip(&second).skip(1))
        .map(|((a, _), (b, _))| [*a + 1e-4, *b + 1e-4])
        .collect();
    let rest = without_true(&paired, &onsets_s);
    assert_eq!(rest.len(), 14);
    assert!(rest.iter().all(|b: &Both| b.later_s.abs() < 1e-12));
    assert_eq!(without_true(&paired, &[]), paired);
}
