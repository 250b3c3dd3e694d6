//! Made impacts, timed together.

use std::cell::Cell;

use super::*;
use crate::random::SplitMix64;
use crate::signal::sound::Sound;
use crate::units::samples_in;

const RATE: f64 = 44_100.0;

/// A ball of two modes in noise of 1e-4: contacts of this length at full speed, longer for slow impacts as those of a
/// solid sphere if `hertz`.
struct Ball {
    contact_s: f64,
    hertz: bool,
    modes_hz: [f64; 2],
    decay_s: f64,
}

/// A ball that clicks, with a ring that decays so fast, in seconds.
const fn click(decay_s: f64) -> Ball {
    Ball {
        contact_s: 1e-4,
        hertz: false,
        modes_hz: [5_200.0, 9_700.0],
        decay_s,
    }
}

impl Ball {
    /// Pressure at a time after the touch of an impact at a share of full speed: each mode's answer to half a sine of
    /// force, by summing over it.
    fn sound(&self, t_s: f64, speed: f64) -> f64 {
        let contact_s = self.contact_s * if self.hertz { speed.powf(-0.2) } else { 1.0 };
        let steps = 40;
        let answer = |hz: f64| {
            let pieces = (0..steps).map(|k| {
                let s = contact_s * (real(k) + 0.5) / real(steps);
                let after = t_s - s;
                if after <= 0.0 {
                    return 0.0;
                }
                let force = (std::f64::consts::PI * s / contact_s).sin();
                force * (-after / self.decay_s).exp() * (std::f64::consts::TAU * hz * after).sin()
            });
            pieces.sum::<f64>() / real(steps)
        };
        speed * self.modes_hz.iter().map(|&hz| answer(hz)).sum::<f64>()
    }

    /// A recording of impacts at these times; their speeds fall as their flights do.
    fn recorded(&self, onsets_s: &[f64], seed: u64) -> Vec<f32> {
        let mut rng = SplitMix64::new(seed);
        let length = samples_in(onsets_s.last().unwrap() + 0.5, RATE);
        let mut sound: Vec<f64> = (0..length).map(|_| 1e-4 * rng.normal()).collect();
        let first_flight = onsets_s[1] - onsets_s[0];
        for (i, &onset) in onsets_s.iter().enumerate() {
            let flight = if i == 0 {
                first_flight
            } else {
                onset - onsets_s[i - 1]
            };
            let start = whole((onset * RATE).ceil());
            let until = (start + samples_in(12.0 * self.decay_s, RATE)).min(length);
            for (k, x) in sound[start..until].iter_mut().enumerate() {
                let t_s = real(start + k) / RATE - onset;
                *x += 0.5 * self.sound(t_s, flight / first_flight);
            }
        }
        #[expect(clippy::cast_possible_truncation, reason = "test samples")]
        sound.into_iter().map(|x| x as f32).collect()
    }
}

fn onsets(count: usize, first_flight_s: f64, ratio: f64) -> Vec<f64> {
    let (mut at, mut flight) = (0.612_345, first_flight_s);
    (0..count)
        .map(|_| {
            let now = at;
            at += flight;
            flight *= ratio;
            now
        })
        .collect()
}

/// Errors of the times, less their median, and stated errors, in microseconds; coarse times are off by up to 0.3 ms.
fn errors(ball: &Ball, onsets_s: &[f64]) -> Vec<(f64, f64)> {
    errors_in(&ball.recorded(onsets_s, 3), onsets_s)
}

/// Coarse times as a detector gives them that is sure of them.
fn seen(times_s: &[f64]) -> Vec<Impact> {
    let sure = |&time_s: &f64| Impact::heard(time_s, 1.5e-4);
    times_s.iter().map(sure).collect()
}

fn errors_in(samples: &[f32], onsets_s: &[f64]) -> Vec<(f64, f64)> {
    errors_from(samples, onsets_s, 4)
}

fn errors_from(samples: &[f32], onsets_s: &[f64], seed: u64) -> Vec<(f64, f64)> {
    let mut rng = SplitMix64::new(seed);
    let coarse: Vec<f64> = onsets_s
        .iter()
        .map(|t| t + 3e-4 * (2.0 * rng.uniform() - 1.0))
        .collect();
    let span_s = (coarse[0], coarse[coarse.len() - 1]);
    let sound = Whitened::around(Sound::from_start(samples, RATE), span_s);
    let timed = times(&sound, &seen(&coarse)).unwrap();
    let mut found: Vec<(f64, f64)> = timed
        .iter()
        .zip(onsets_s)
        .map(|(t, onset)| (1e6 * (t.time_s - onset), 1e6 * t.std_s))
        .collect();
    let mut sorted: Vec<f64> = found.iter().map(|f| f.0).collect();
    sorted.sort_by(f64::total_cmp);
    let median = sorted[sorted.len() / 2];
    for f in &mut found {
        f.0 -= median;
    }
    found
}

#[test]
fn impacts_that_overlap_are_timed_as_well_as_those_that_stand_alone() {
    let click = click(5e-3);
    // The last flights are 8 ms: shorter than the ring.
    let found = errors(&click, &onsets(30, 0.25, 0.89));
    for (i, (error, std)) in found.iter().enumerate() {
        assert!(
            error.abs() < 0.5 && *std < 0.5,
            "impact {i}: {error} ± {std} us"
        );
    }
    let squares: f64 = found.iter().map(|(e, s)| (e / s).powi(2)).sum();
    let ratio = (squares / 30.0).sqrt();
    assert!((0.4..2.0).contains(&ratio), "error over stated: {ratio}");
}

#[test]
fn the_last_impact_found_is_timed_by_its_sound_before_the_next_one() {
    let plate = Ball {
        modes_hz: [700.0, 5_200.0],
        ..click(30e-3)
    };
    let onsets_s = onsets(30, 0.25, 0.89);
    let samples = plate.recorded(&onsets_s, 3);
    for found in [26, 28, 29] {
        // The other impacts are heard, a flight of 14, 11 or 10 ms on, and nobody found them.
        let (error, std) = errors_in(&samples, &onsets_s[..found])[found - 1];
        assert!(
            error.abs() < 1.5 && std < 1.5,
            "of {found}: {error} ± {std} us"
        );
    }
}

#[test]
fn a_thud_is_timed_by_all_of_its_length() {
    let thud = Ball {
        contact_s: 4e-3,
        hertz: false,
        modes_hz: [170.0, 430.0],
        decay_s: 10e-3,
    };
    for (i, (error, _)) in errors(&thud, &onsets(14, 0.6, 0.82)).iter().enumerate() {
        assert!(error.abs() < 6.0, "impact {i}: {error} us");
    }
}

#[test]
fn few_thuds_in_noise_are_not_said_to_be_timed_by_the_noise_of_their_mean() {
    let thud = Ball {
        contact_s: 4e-3,
        hertz: false,
        modes_hz: [170.0, 430.0],
        decay_s: 10e-3,
    };
    let onsets_s = onsets(5, 0.6, 0.8);
    let (mut squares, mut count) = (0.0, 0.0);
    for seed in 1..=12 {
        let mut rng = SplitMix64::new(100 + seed);
        let mut samples = thud.recorded(&onsets_s, seed);
        for x in &mut samples {
            #[expect(clippy::cast_possible_truncation, reason = "test samples")]
            let noise = (0.002 * rng.normal()) as f32;
            *x += noise;
        }
        for (error, std) in errors_in(&samples, &onsets_s) {
            squares += (error / std).powi(2);
            count += 1.0;
        }
    }
    let ratio = f64::sqrt(squares / count);
    assert!((0.5..1.5).contains(&ratio), "error over stated: {ratio}");
}

#[test]
fn a_contact_that_lasts_longer_when_slow_does_not_make_times_walk() {
    let solid = Ball {
        contact_s: 4.5e-4,
        hertz: true,
        modes_hz: [2_900.0, 7_600.0],
        decay_s: 3e-3,
    };
    let found = errors(&solid, &onsets(24, 0.5, 0.88));
    // Half of what the contact takes longer would be 170 us from the first impact to the last.
    let (first, last) = (found[1].0, found[22].0);
    assert!((last - first).abs() < 25.0, "{first} us to {last} us");
}

#[test]
fn an_impact_unlike_the_others_keeps_the_detectors_time_and_says_so() {
    let click = click(3e-3);
    let onsets_s = onsets(12, 0.4, 0.85);
    let mut samples = click.recorded(&onsets_s, 1);
    let mut rng = SplitMix64::new(9);
    let odd = whole(onsets_s[5] * RATE);
    for x in &mut samples[odd..odd + 400] {
        #[expect(clippy::cast_possible_truncation, reason = "test samples")]
        let noise = (0.3 * rng.normal()) as f32;
        *x = noise;
    }
    let sound = Whitened::around(
        Sound::from_start(&samples, RATE),
        (onsets_s[0], onsets_s[11]),
    );
    let timed = times(&sound, &seen(&onsets_s)).unwrap();
    let stds: Vec<f64> = timed.iter().map(|t| t.std_s).collect();
    assert!(stds[5] > 1e-4, "stated {} s", stds[5]);
    let others = stds.iter().enumerate().filter(|&(i, _)| i != 5);
    for (i, std) in others {
        assert!(*std < 0.2 * stds[5], "impact {i} suffers: {std} s");
    }
    let moved = |i: usize| timed[i].time_s - onsets_s[i];
    assert!(
        (moved(5) - moved(4)).abs() < stds[5],
        "{} {} ± {}",
        moved(5),
        moved(4),
        stds[5]
    );
}

#[test]
fn times_do_not_depend_on_where_the_detector_saw_the_impacts() {
    let click = click(5e-3);
    let onsets_s = onsets(30, 0.25, 0.89);
    let samples = click.recorded(&onsets_s, 3);
    let [one, other] = [4, 5].map(|seed| errors_from(&samples, &onsets_s, seed));
    let (mut sum, mut weight) = (0.0, 0.0);
    for ((a, std), (b, _)) in one.iter().zip(&other) {
        sum += (b - a) / (std * std);
        weight += 1.0 / (std * std);
    }
    for (i, ((a, std), (b, _))) in one.iter().zip(&other).enumerate() {
        let moved = b - a - sum / weight;
        // Interpolation between samples is exact to some ten thousandths of one.
        assert!(
            moved.abs() < 0.1 * std + 1e-2,
            "impact {i}: {moved} ± {std} µs"
        );
    }
}

#[test]
fn where_a_soft_sound_begins_does_not_depend_on_where_the_detector_saw_it() {
    let thud = Ball {
        contact_s: 4e-3,
        hertz: false,
        modes_hz: [170.0, 430.0],
        decay_s: 10e-3,
    };
    let onsets_s = onsets(14, 0.6, 0.82);
    let samples = thud.recorded(&onsets_s, 3);
    let late_ms = [-2.5e-3, 0.0, 2.5e-3].map(|late_s| {
        let coarse: Vec<f64> = onsets_s.iter().map(|t| t + late_s).collect();
        let span_s = (coarse[0], coarse[coarse.len() - 1]);
        let sound = Whitened::around(Sound::from_start(&samples, RATE), span_s);
        let timed = times(&sound, &seen(&coarse)).unwrap();
        1e3 * (timed[0].time_s - onsets_s[0])
    });
    // It grows as long as the force does, which is half of the contact.
    for late in late_ms {
        assert!((0.0..2.0).contains(&late), "{late_ms:?} ms late");
        assert!((late - late_ms[0]).abs() < 0.05, "{late_ms:?} ms late");
    }
}

/// Times impacts by one template until they rest, and hands them over.
fn at_rest(ball: &Ball, onsets_s: &[f64], check: impl FnOnce(Joint<'_>)) {
    let samples = ball.recorded(onsets_s, 3);
    let span_s = (onsets_s[0], *onsets_s.last().unwrap());
    let sound = Whitened::around(Sound::from_start(&samples, RATE), span_s);
    let started = Started::of(&sound, &seen(onsets_s)).unwrap();
    let mut joint = Joint::of(&started, Aligned::of(&started).unwrap(), 1);
    assert!(joint.unlike() < UNLIKE);
    joint.search_and_settle();
    check(joint);
}

#[test]
fn impacts_at_rest_stay_where_they_are() {
    at_rest(&click(5e-3), &onsets(30, 0.25, 0.89), |mut joint| {
        let before = joint.now();
        joint.settle();
        assert!(joint.since(&before).rests());
    });
}

#[test]
fn settling_ends_once_what_it_goes_on_for_no_longer_holds() {
    at_rest(&click(5e-3), &onsets(30, 0.25, 0.89), |mut joint| {
        let places = joint.places.clone();
        let disturb = |joint: &mut Joint<'_>| {
            joint.places.clone_from(&places);
            for place in joint.places.iter_mut().step_by(2) {
                place.position += 0.5;
            }
        };
        let rounds = Cell::new(0);
        let count = |goes_on: bool| {
            rounds.set(rounds.get() + 1);
            goes_on
        };
        disturb(&mut joint);
        joint.settle_while(|_| count(true));
        assert!(rounds.replace(0) > 1);
        disturb(&mut joint);
        joint.settle_while(|_| count(false));
        assert_eq!(rounds.get(), 1);
    });
}

#[test]
fn an_impact_that_has_vanished_leaves_the_others_their_places() {
    at_rest(&click(5e-3), &onsets(12, 0.25, 0.89), |mut joint| {
        let before = joint.now();
        joint.places[4].amplitude = 0.0;
        joint.settle();
        for (i, ((place, _), (then, std))) in joint.now().iter().zip(&before).enumerate() {
            let moved = (place.position - then.position).abs();
            assert!(moved < 0.5 * std, "impact {i}: {moved} ± {std}");
        }
    });
}

#[test]
fn edges_of_sounds_that_are_alike_do_not_walk() {
    at_rest(&click(5e-3), &onsets(30, 0.25, 0.89), |joint| {
        let walk = walk_by_edges::walk_by_edges(&joint).unwrap();
        let u = &joint.started.contact_stretches;
        let (fast, slow) = (u[0], u[u.len() - 1]);
        let (shift, std) = (walk.shift(slow) - walk.shift(fast), walk.std(slow - fast));
        assert!(
            shift.abs() < 3.0 * std && std < 0.3,
            "{shift} ± {std} samples"
        );
    });
}
