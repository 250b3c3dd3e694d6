use super::*;
use crate::random::SplitMix64;

/// Standard error of the times.
const JITTER_S: f64 = 10e-6;

/// Impacts whose flight i + 1 is this factor of flight i, with times that err.
fn drop(count: usize, seed: u64, ratio: impl Fn(usize) -> f64) -> Vec<Impact> {
    let mut rng = SplitMix64::new(seed);
    let (mut time_s, mut flight_s) = (1.0, 0.5);
    let mut impact = |i: usize| {
        if i > 0 {
            time_s += flight_s;
            flight_s *= ratio(i);
        }
        Impact::heard(time_s + JITTER_S * rng.normal(), JITTER_S)
    };
    (0..count).map(&mut impact).collect()
}

/// Numbers and kinds of the irregular bounces.
fn found(impacts: &[Impact]) -> Vec<(usize, Kind)> {
    let irregular = Regularity::of(impacts).irregular;
    irregular.iter().map(|f| (f.impact, f.kind)).collect()
}

#[test]
fn odd_bounces_are_named_and_left_out_of_the_ratio() {
    let lossy = |i| if i == 8 || i == 11 { 0.75 } else { 0.93 };
    for seed in 0..20 {
        let impacts = drop(25, seed, lossy);
        assert_eq!(found(&impacts), [(8, Kind::Odd), (11, Kind::Odd)]);
        let regularity = Regularity::of(&impacts);
        let odd = regularity.irregular[0];
        assert!((odd.ratio - 0.75).abs() < 1e-2 && (odd.expected - 0.93).abs() < 5e-3);
        let flights = Flights::regular(&impacts, &regularity);
        assert!((flights.ratio().unwrap().value - 0.93).abs() < 1e-3);
    }
}

#[test]
fn a_flight_that_lost_time_is_no_odd_bounce() {
    let mut impacts = drop(25, 1, |_| 0.93);
    for impact in &mut impacts[10..] {
        impact.time_s -= 26e-3;
    }
    assert_eq!(found(&impacts), [(9, Kind::LostTime)]);
    let flights = Flights::regular(&impacts, &Regularity::of(&impacts));
    assert!((flights.ratio().unwrap().value - 0.93).abs() < 1e-3);
}

#[test]
fn the_part_that_lasts_longer_has_the_e_of_a_drop_in_which_it_changes() {
    // The last has more bounces after the change than before it.
    for (change, after, longer) in [(8, 0.96, 0.96), (20, 0.87, 0.92), (12, 0.87, 0.92)] {
        let impacts = drop(28, 3, |i| if i < change { 0.92 } else { after });
        let regularity = Regularity::of(&impacts);
        assert_eq!(found(&impacts), [(change, Kind::Changed)]);
        let ratio = Flights::regular(&impacts, &regularity).ratio().unwrap();
        assert!((ratio.value - longer).abs() < 2e-3, "{ratio:?}");
        // The parts share the flight before the change.
        let ends = [Some(regularity.part), regularity.other].map(|p| p.unwrap().len());
        assert_eq!(ends.iter().sum::<usize>(), 28 + 2);
    }
}

#[test]
fn one_wrong_time_is_no_irregular_bounce() {
    let mut impacts = drop(25, 1, |_| 0.93);
    impacts[12].time_s += 20e-3;
    assert_eq!(found(&impacts), []);
}

#[test]
fn clean_drops_with_trends_and_scatter_have_no_irregular_bounce() {
    let mut rng = SplitMix64::new(7);
    let scatter: Vec<f64> = (0..40).map(|_| rng.normal()).collect();
    let mut named = 0;
    for seed in 0..100 {
        let shift = usize::try_from(seed % 7).unwrap();
        let drags = drop(30, seed, |i| 0.93 - 0.08 * (-0.25 * real(i)).exp());
        // A contact of 2 ms stands in every interval, and shows in the last.
        let slows = drop(20, seed, |i| {
            0.86 - 2e-3 * 1.16_f64.powi(i32::try_from(i).unwrap())
        });
        let rough = drop(30, seed, |i| 0.9 * (0.02 * scatter[i + shift]).exp());
        named += [drags, slows, rough]
            .iter()
            .filter(|d| !found(d).is_empty())
            .count();
    }
    assert!(named <= 3, "{named} of 300");
}

#[test]
fn bounces_that_alternate_are_told_from_those_that_scatter() {
    let ratios = |impacts: &[Impact]| Regularity::of(impacts).alternation.map(|a| a.ratios());
    let turns = drop(25, 1, |i| if i % 2 == 0 { 0.88 } else { 0.80 });
    assert_eq!(found(&turns), []);
    let [greater, less] = ratios(&turns).unwrap();
    assert!((greater - 0.88).abs() < 5e-3 && (less - 0.80).abs() < 5e-3);
    let mut alarms = 0;
    for seed in 0..200 {
        let mut rng = SplitMix64::new(seed);
        let scatter: Vec<f64> = (0..30).map(|_| rng.normal()).collect();
        alarms += usize::from(ratios(&drop(30, seed, |i| 0.9 + 0.01 * scatter[i])).is_some());
        alarms += usize::from(ratios(&drop(30, seed, |_| 0.8)).is_some());
    }
    assert!(alarms <= 3, "{alarms} of 400");
}
