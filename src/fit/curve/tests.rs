use super::*;
use crate::random::SplitMix64;

/// e of a viscoelastic sphere to the order that counts.
fn sphere(speed: f64) -> f64 {
    1.0 - 0.08 * speed.powf(0.2)
}

/// Bounces of drops from 5 to 150 cm, each with a scatter of its own and of its drop.
fn bounces(rng: &mut SplitMix64, drops: usize, drop_std: f64) -> Vec<Point> {
    let mut points = Vec::new();
    for drop in 0..drops {
        let height = 0.05 * 30.0_f64.powf(real(drop) / real(drops - 1));
        let own = drop_std * rng.normal();
        let mut speed = (2.0 * 9.81 * height).sqrt();
        for _ in 0..12 {
            let std = 4e-5 / speed;
            let kept = sphere(speed) + own + 3e-3 * rng.normal();
            points.push(Point {
                drop,
                ln_speed: speed.ln(),
                restitution: kept + std * rng.normal(),
                std,
            });
            speed *= kept;
        }
    }
    points
}

/// Share of speeds, over the whole range and many batches, at which the band holds the curve.
fn held(drops: usize, drop_std: f64, batches: u64) -> f64 {
    let (mut inside, mut all) = (0, 0);
    for seed in 0..batches {
        let curve = Curve::of(&bounces(&mut SplitMix64::new(seed), drops, drop_std)).unwrap();
        let [low, high] = curve.speeds_m_per_s;
        for i in 0..=20 {
            let speed = low * (high / low).powf(real(i) / 20.0);
            let (e, beyond) = curve.at(speed);
            assert!(!beyond);
            let [least, most] = e.interval95.unwrap();
            inside += usize::from((least..=most).contains(&sphere(speed)));
            all += 1;
        }
    }
    real(inside) / real(all)
}

#[test]
fn the_band_holds_the_curve_of_a_viscoelastic_sphere() {
    for (drops, drop_std) in [(20, 0.0), (20, 4e-3), (8, 2e-3)] {
        let share = held(drops, drop_std, 200);
        assert!(
            (0.93..=0.97).contains(&share),
            "{drops} drops, {drop_std} between them: {share}"
        );
    }
}

#[test]
fn the_scatter_of_bounces_and_of_drops_is_told_apart() {
    let mean = |of: &dyn Fn(&Curve) -> f64| {
        let one = |seed| of(&Curve::of(&bounces(&mut SplitMix64::new(seed), 20, 4e-3)).unwrap());
        (0..50).map(one).sum::<f64>() / 50.0
    };
    let (bounce, drop) = (mean(&|c| c.bounce_std), mean(&|c| c.drop_std));
    assert!((bounce / 3e-3 - 1.0).abs() < 0.05, "{bounce}");
    assert!((drop / 4e-3 - 1.0).abs() < 0.1, "{drop}");
}

#[test]
fn beyond_the_speeds_heard_the_error_grows_and_that_is_said() {
    let curve = Curve::of(&bounces(&mut SplitMix64::new(1), 20, 0.0)).unwrap();
    let [_, high] = curve.speeds_m_per_s;
    let ((inside, not), (outside, beyond)) = (curve.at(high), curve.at(3.0 * high));
    assert!(!not && beyond && (inside.value - outside.value).abs() < 1e-12);
    let grown = outside.std_error.unwrap();
    assert!(grown > 0.05 * 3.0_f64.ln() * 0.8, "{grown}");
}

#[test]
fn two_drops_make_no_curve() {
    let points = bounces(&mut SplitMix64::new(1), 20, 0.0);
    let two: Vec<Point> = points.into_iter().filter(|p| p.drop < 2).collect();
    assert!(Curve::of(&two).is_none() && Curve::of(&[]).is_none());
}

#[test]
fn three_drops_without_a_common_speed_make_no_curve() {
    // Of each drop only the first bounces: 5 cm, 27 cm and 150 cm.
    let mut points = bounces(&mut SplitMix64::new(1), 3, 0.0);
    let mut seen = [0; 3];
    points.retain(|point| {
        seen[point.drop] += 1;
        seen[point.drop] <= 2
    });
    assert!(Curve::of(&points).is_none());
}
