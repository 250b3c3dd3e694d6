use super::*;
use crate::random::SplitMix64;
use statrs::distribution::{ChiSquared, Continuous, Normal};

fn member(group: usize, value: f64, std: f64) -> Member {
    Member {
        group,
        value,
        std,
        ln_speed: None,
    }
}

/// Two groups of drops that scatter by 0.003 beside claimed errors of 0.001 and 0.002, from heights by turns where the value
/// changes with the speed.
fn two(rng: &mut SplitMix64, each: usize, shift: f64, slope: f64, far: f64) -> Vec<Member> {
    (0..2 * each)
        .map(|i| {
            let (group, std) = (i % 2, if i % 3 == 0 { 2e-3 } else { 1e-3 });
            let ln_speed = 0.8 * real(i / 2) / real(each) + far * real(group);
            let value =
                0.8 + shift * real(group) + slope * ln_speed + 3e-3_f64.hypot(std) * rng.normal();
            Member {
                ln_speed: (slope.abs() > 0.0).then_some(ln_speed),
                ..member(group, value, std)
            }
        })
        .collect()
}

fn share_real(seed: u64, trials: usize, each: usize, shift: f64, slope: f64, far: f64) -> f64 {
    let mut rng = SplitMix64::new(seed);
    let real_ones = (0..trials).filter(|_| {
        let groups = Groups::of(&two(&mut rng, each, shift, slope, far), 2);
        groups.is_some_and(|g| g.differences[0].is_real())
    });
    real(real_ones.count()) / real(trials)
}

/// Probability that Student's test of this many degrees of freedom sees a difference of so many standard errors.
fn power(errors: f64, freedom: f64) -> f64 {
    let (normal, chi) = (Normal::standard(), ChiSquared::new(freedom).unwrap());
    let far = student(0.975, freedom);
    let step = 0.01;
    let places = (1..10_000).map(|i| step * real(i));
    let seen = places.map(|v| {
        let t = far * (v / freedom).sqrt();
        step * chi.pdf(v) * (normal.cdf(-t - errors) + normal.sf(t - errors))
    });
    seen.sum()
}

/// The standard error of the difference of two groups of five that `two` makes.
fn error_of_difference() -> f64 {
    let variance = |group: usize| -> f64 {
        let stds = (0..10)
            .filter(|i| i % 2 == group)
            .map(|i| if i % 3 == 0 { 2e-3 } else { 1e-3 });
        let weights: f64 = stds.map(|s: f64| 1.0 / (9e-6 + s * s)).sum();
        1.0 / weights
    };
    (variance(0) + variance(1)).sqrt()
}

#[test]
fn groups_that_do_not_differ_are_told_apart_in_one_of_twenty() {
    for (slope, far) in [(0.0, 0.0), (-0.02, 0.0), (-0.02, 0.3)] {
        let share = share_real(7, 4_000, 5, 0.0, slope, far);
        assert!(
            (0.04..=0.06).contains(&share),
            "slope {slope}, {far} apart: {share}"
        );
    }
}

#[test]
fn groups_that_differ_are_told_apart_as_often_as_students_test_does() {
    for errors in [1.0, 2.0, 4.0] {
        let share = share_real(11, 500, 5, errors * error_of_difference(), 0.0, 0.0);
        let expected = power(errors, 8.0);
        // Two standard errors of a share of 500, and one in fifty for weights that are estimated.
        let off = 2.0 * (expected * (1.0 - expected) / 500.0).sqrt() + 0.02;
        assert!(
            (share - expected).abs() < off,
            "{errors} standard errors: {share}, {expected}"
        );
    }
}

#[test]
fn without_claimed_errors_it_is_students_test() {
    let values = [[0.81, 0.83, 0.82], [0.84, 0.85, 0.86]];
    let members = values
        .iter()
        .zip(0..)
        .flat_map(|(of, g)| of.map(|x| member(g, x, 0.0)));
    let found = Groups::of(&members.collect::<Vec<_>>(), 2).unwrap();
    // Means 0.82 and 0.85, pooled variance 1e-4, standard error √(2e-4/3), t = 3.674 of 4.
    let Difference {
        difference, chance, ..
    } = found.differences[0];
    assert!((difference.value - 0.03).abs() < 1e-12);
    assert!((difference.std_error.unwrap() - (2e-4_f64 / 3.0).sqrt()).abs() < 1e-6);
    assert!((chance - 0.0213).abs() < 1e-3, "{chance}");
    assert!((found.between_drops - 0.01).abs() < 1e-4 && found.within < 1e-12);
    assert!((found.between_groups - (4.5e-4_f64 - 1e-4 / 3.0).sqrt()).abs() < 1e-6);
}

#[test]
fn drops_from_other_heights_are_compared_at_one_speed() {
    // One ball, e = 0.9 − 0.03·ln v without any scatter to speak of, one group from higher than the other.
    let speed = |g: usize, i: usize| 0.3 * real(i) + 0.5 * real(g);
    let made = |g: usize, i: usize| Member {
        group: g,
        value: 0.9 - 0.03 * speed(g, i) + 1e-5 * real(i % 2),
        std: 1e-5,
        ln_speed: Some(speed(g, i)),
    };
    let members: Vec<Member> = (0..10).map(|i| made(i % 2, i / 2)).collect();
    let found = Groups::of(&members, 2).unwrap();
    let difference = found.differences[0];
    assert!(
        difference.difference.value.abs() < 2e-5 && !difference.is_real(),
        "{difference:?}"
    );
    assert!((found.slope.unwrap().value + 0.03).abs() < 1e-4);
    assert!((found.at_speed_m_per_s.unwrap().ln() - 0.85).abs() < 1e-12);
}

#[test]
fn a_slope_that_the_drops_do_not_tell_is_in_the_error() {
    // Each group from a height of its own: nothing tells ball from height.
    let made = |g: usize, i: usize| Member {
        ln_speed: Some(real(g)),
        ..member(g, 0.8 - 0.01 * real(g) + 1e-3 * real(i), 1e-3)
    };
    let members: Vec<Member> = (0..10).map(|i| made(i % 2, i / 2)).collect();
    let found = Groups::of(&members, 2).unwrap();
    let std = found.differences[0].difference.std_error.unwrap();
    assert!(found.slope.is_none() && std > 0.05 * 0.79, "{std}");
    assert!(!found.differences[0].is_real());
}

#[test]
fn many_differences_are_corrected_together() {
    let mut rng = SplitMix64::new(5);
    let mut false_alarms = 0;
    for _ in 0..1_000 {
        let members = (0..20).map(|i| member(i % 4, 0.8 + 2e-3 * rng.normal(), 1e-3));
        let found = Groups::of(&members.collect::<Vec<_>>(), 4).unwrap();
        assert_eq!(found.differences.len(), 6);
        false_alarms += usize::from(found.differences.iter().any(Difference::is_real));
    }
    // All six together are wrong in no more than one of twenty, and not much less often.
    assert!((20..=60).contains(&false_alarms), "{false_alarms}");
}

#[test]
fn nothing_is_said_of_groups_without_drops_or_scatter() {
    let one = member(0, 0.8, 1e-3);
    assert!(Groups::of(&[one, member(1, 0.8, 1e-3)], 2).is_none());
    assert!(Groups::of(&[one, one, one], 2).is_none());
    assert!(Groups::of(&[one, one], 1).is_none());
}

#[test]
fn drops_of_one_ball_from_different_heights_are_levelled_where_a_change_is_seen() {
    let mut rng = SplitMix64::new(9);
    let mut made = |slope: f64| -> Vec<Member> {
        (0..12)
            .map(|i| Member {
                ln_speed: Some(0.2 * real(i)),
                ..member(0, 0.9 - slope * 0.2 * real(i) + 1e-3 * rng.normal(), 1e-3)
            })
            .collect()
    };
    let levelled = Levelled::of(&made(0.02)).unwrap();
    assert!((levelled.slope.value + 0.02).abs() < 2e-3);
    assert!(spread(&levelled.values).unwrap() < 2e-3);
    let seen = (0..400)
        .filter(|_| Levelled::of(&made(0.0)).is_some())
        .count();
    assert!((8..=34).contains(&seen), "{seen} of 400");
    assert!(Levelled::of(&made(0.02)[..3]).is_none());
}
