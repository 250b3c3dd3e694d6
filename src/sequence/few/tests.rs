use super::*;

/// Sounds of one kind at these times and levels.
fn sounds(at: &[(f64, f64)]) -> Vec<ClearSound> {
    let sound = |&(time_s, level)| ClearSound {
        time_s,
        jitter_s: 2e-4,
        level,
        is_short: true,
        is_new: true,
        profile: Profile::new([1.0, 4.0, 2.0].into_iter()),
    };
    at.iter().map(sound).collect()
}

fn found(at: &[(f64, f64)], longest_flight_s: Option<f64>) -> Option<usize> {
    let few = few_impacts(&sounds(at), 6.0, longest_flight_s)?;
    few.are_enough().then_some(few.impacts.len())
}

const TWO: [(f64, f64); 2] = [(1.0, -2.0), (1.6, -2.3)];

#[test]
fn two_like_sounds_alone_are_two_impacts_and_three_that_shrink_are_three() {
    assert_eq!(found(&TWO, Some(0.8)), Some(2));
    assert_eq!(found(&[TWO[0], TWO[1], (2.05, -2.6)], Some(0.8)), Some(3));
    assert_eq!(found(&[TWO[0], TWO[1], (2.05, -2.6)], None), Some(3));
}

#[test]
fn a_flight_that_the_height_does_not_allow_is_none() {
    assert_eq!(found(&TWO, Some(0.55)), None);
    assert_eq!(found(&TWO, Some(2.5)), None);
}

#[test]
fn one_sound_has_no_flight() {
    assert_eq!(found(&TWO[..1], Some(0.8)), None);
    assert!(few_impacts(&[], 6.0, None).is_none());
}

#[test]
fn more_sounds_like_them_leave_no_drop() {
    let claps = [TWO[0], TWO[1], (3.1, -2.1), (4.4, -1.9)];
    assert_eq!(found(&claps, Some(0.8)), None);
    assert_eq!(found(&claps, None), None);
}

#[test]
fn three_even_sounds_are_a_hand_where_the_height_makes_the_ball_lose_more() {
    let even = [(1.0, -2.0), (1.5, -2.2), (1.99, -2.1)];
    assert_eq!(found(&even, Some(0.8)), None);
    let longer = [(1.0, -2.0), (1.5, -2.2), (2.1, -2.4)];
    assert_eq!(found(&longer, None), None);
}

#[test]
fn much_fainter_sounds_between_them_change_nothing() {
    let mut at = vec![(0.3, -8.0), (1.2, -8.3), (1.3, -8.2), (2.4, -7.9)];
    at.extend(TWO);
    at.sort_by(|a, b| a.0.total_cmp(&b.0));
    assert_eq!(found(&at, Some(0.8)), Some(2));
}

#[test]
fn two_sounds_that_last_long_are_not_enough() {
    let mut long = sounds(&TWO);
    long.iter_mut().for_each(|sound| sound.is_short = false);
    let few = few_impacts(&long, 6.0, Some(0.8));
    assert!(!few.is_some_and(|few| few.are_enough()));
}

#[test]
fn what_only_changes_another_sound_is_no_impact_and_stands_beside_those_that_are() {
    let mut changing = sounds(&TWO);
    changing[1].is_new = false;
    assert!(few_impacts(&changing, 6.0, Some(0.8)).is_none());
    let nats = |is_new: bool| {
        let mut sounds = sounds(&[TWO[0], TWO[1], (3.0, -2.2)]);
        sounds[2].is_new = is_new;
        few_impacts(&sounds, 6.0, Some(0.8)).unwrap().nats
    };
    assert!((nats(true) - nats(false)).abs() < 1e-9);
}

#[test]
fn a_sound_of_another_kind_counts_while_it_is_not_much_fainter() {
    let nats = |level: f64| {
        let mut sounds = sounds(&[TWO[0], (1.3, level), TWO[1]]);
        sounds[1].profile = Profile::new([0.0, 0.0, 0.0, 5.0].into_iter());
        few_impacts(&sounds, 6.0, Some(0.8)).unwrap().nats
    };
    let (comparable, faint) = (nats(-3.0), nats(-4.0));
    assert!(comparable < faint - 1.0, "{comparable} {faint}");
}
