//! From the drops of many balls to the verdict on each and on the lot, by the statistics of the rule.

use super::Rule;
use super::catalogue::Mean;
use super::verdict::outcome;
use crate::fit::Estimate;
use crate::report::rule::{BallJudged, LotJudged, Outcome};
use crate::statistics::NORMAL95;
use crate::units::real;

/// A rebound in metres and its standard error, if it has one.
type Rebound = (f64, Option<f64>);

/// Judges balls by the rebounds of their drops, each with the name of its ball; a drop may have none.
///
/// The mean of a ball's drops is the one that the rule asks for. Its error is that of one drop and no smaller: most of it, that
/// of the height, the contact and the drag, is the same in all. A lot passes where every ball does and there are as many as the
/// rule takes, and fails where one fails.
#[must_use]
pub fn judge_lot(rule: &Rule, drops: &[(String, Option<Rebound>)]) -> LotJudged {
    let mut names: Vec<&String> = Vec::new();
    for (name, _) in drops {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    let one = |name: &&String| {
        let own = drops.iter().filter(|(n, _)| n == *name);
        let rebounds: Vec<Rebound> = own.filter_map(|(_, rebound)| *rebound).collect();
        ball(rule, name, &rebounds)
    };
    let balls = names.iter().map(one);
    let balls: Vec<BallJudged> = balls.collect();
    let (outcome, why) = lot(rule, &balls);
    LotJudged {
        name: rule.name.to_owned(),
        source: rule.source.to_owned(),
        drop_height_m: rule.drop_height_m,
        allowed_m: rule.allowed_m,
        outcome,
        why,
        balls,
    }
}

fn lot(rule: &Rule, balls: &[BallJudged]) -> (Outcome, Option<String>) {
    let any = |outcome: Outcome| balls.iter().any(|ball| ball.outcome == outcome);
    if any(Outcome::Fail) {
        return (Outcome::Fail, None);
    }
    let missing = rule.balls.filter(|asked| balls.len() < *asked);
    let missing =
        missing.map(|asked| format!("{} of the {asked} balls that the rule takes", balls.len()));
    match missing {
        Some(missing) => (Outcome::Undecided, Some(missing)),
        None if balls.is_empty() || any(Outcome::Undecided) => (Outcome::Undecided, None),
        None => (Outcome::Pass, None),
    }
}

fn ball(rule: &Rule, name: &str, rebounds: &[Rebound]) -> BallJudged {
    let mean = mean(rule.mean, rebounds);
    let values = || rebounds.iter().map(|(value, _)| *value);
    let most = values().fold(f64::NEG_INFINITY, f64::max);
    let spread_m = (rebounds.len() > 1).then(|| most - values().fold(f64::INFINITY, f64::min));
    let by_mean = mean.map_or(Outcome::Undecided, |mean| outcome(mean, rule.allowed_m));
    let (outcome, why) =
        by_spread(rule, spread_m, mean).unwrap_or_else(|| counted(rule, rebounds.len(), by_mean));
    BallJudged {
        name: name.to_owned(),
        drops: rebounds.len(),
        outcome,
        rebound_m: mean,
        spread_m,
        why,
    }
}

/// The verdict by the mean, which takes as many drops as the rule asks for to pass.
fn counted(rule: &Rule, drops: usize, by_mean: Outcome) -> (Outcome, Option<String>) {
    match rule.drops.filter(|asked| drops < *asked) {
        Some(asked) if by_mean != Outcome::Fail => (
            Outcome::Undecided,
            Some(format!("the rule takes {asked} drops")),
        ),
        _ => (by_mean, None),
    }
}

/// Rebounds that are farther apart than the rule allows, beyond the errors of two.
fn by_spread(
    rule: &Rule,
    spread_m: Option<f64>,
    mean: Option<Estimate>,
) -> Option<(Outcome, Option<String>)> {
    let (spread_m, allowed) = (spread_m?, rule.allowed_spread?);
    let reach = NORMAL95 * std::f64::consts::SQRT_2 * mean?.std_error?;
    let beyond = spread_m - allowed.greatest_m;
    let why = format!(
        "its rebounds differ by {:.1} cm where {:.1} are allowed",
        100.0 * spread_m,
        100.0 * allowed.greatest_m
    );
    match () {
        () if beyond > reach => Some((Outcome::Fail, Some(why))),
        () if beyond > -reach.min(0.5 * allowed.greatest_m) => {
            Some((Outcome::Undecided, Some(why)))
        }
        () => None,
    }
}

/// The mean with the error of one; without one where a rebound has none.
fn mean(kind: Mean, rebounds: &[Rebound]) -> Option<Estimate> {
    let count = real(rebounds.len());
    if rebounds.is_empty() {
        return None;
    }
    let sum = |of: &dyn Fn(f64) -> f64| rebounds.iter().map(|(value, _)| of(*value)).sum::<f64>();
    let value = match kind {
        Mean::Arithmetic => sum(&|x| x) / count,
        Mean::Geometric => (sum(&f64::ln) / count).exp(),
    };
    let stds: Option<Vec<f64>> = rebounds.iter().map(|(_, std)| *std).collect();
    let std = stds.map(|stds| (stds.iter().map(|s| s * s).sum::<f64>() / count).sqrt());
    Some(Estimate {
        value,
        std_error: std,
        interval95: std.map(|s| [value - NORMAL95 * s, value + NORMAL95 * s]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rules::rule;

    fn drops(balls: usize, of_ball: impl Fn(usize) -> Vec<f64>) -> Vec<(String, Option<Rebound>)> {
        let named = |i: usize| {
            of_ball(i)
                .into_iter()
                .map(move |h| (format!("ball {i}"), Some((h, Some(5e-4)))))
        };
        (0..balls).flat_map(named).collect()
    }

    #[test]
    fn a_ball_has_the_mean_of_its_rule_with_the_error_of_one_drop() {
        let lot = judge_lot(
            &rule("ittf-ball").unwrap(),
            &drops(1, |_| vec![0.25, 0.252, 0.26]),
        );
        let ball = &lot.balls[0];
        let mean = ball.rebound_m.unwrap();
        assert!((mean.value - (0.25_f64 * 0.252 * 0.26).cbrt()).abs() < 1e-12);
        assert!((mean.std_error.unwrap() - 5e-4).abs() < 1e-12);
        assert!((ball.spread_m.unwrap() - 0.01).abs() < 1e-12);
        assert_eq!((ball.drops, ball.outcome), (3, Outcome::Pass));
    }

    #[test]
    fn a_lot_passes_with_all_its_balls_and_fails_with_one() {
        let ittf = rule("ittf-ball").unwrap();
        let good = |_: usize| vec![0.25; 3];
        assert_eq!(judge_lot(&ittf, &drops(24, good)).outcome, Outcome::Pass);
        let short = judge_lot(&ittf, &drops(12, good));
        assert_eq!(short.outcome, Outcome::Undecided);
        assert!(short.why.unwrap().starts_with("12 of the 24 balls"));
        let bad = judge_lot(
            &ittf,
            &drops(24, |i| {
                if i == 7 {
                    vec![0.237; 3]
                } else {
                    vec![0.25; 3]
                }
            }),
        );
        assert_eq!(
            (bad.outcome, bad.balls[7].outcome),
            (Outcome::Fail, Outcome::Fail)
        );
        let near = judge_lot(
            &ittf,
            &drops(24, |i| {
                if i == 7 {
                    vec![0.2405; 3]
                } else {
                    vec![0.25; 3]
                }
            }),
        );
        assert_eq!(
            (near.outcome, near.balls[7].outcome),
            (Outcome::Undecided, Outcome::Undecided)
        );
        assert_eq!(judge_lot(&ittf, &[]).outcome, Outcome::Undecided);
    }

    #[test]
    fn too_few_drops_decide_nothing_but_a_fail() {
        let ittf = rule("ittf-ball").unwrap();
        let few = judge_lot(&ittf, &drops(1, |_| vec![0.25, 0.25]));
        assert!(few.balls[0].why.as_ref().unwrap().contains("takes 3 drops"));
        assert_eq!(few.balls[0].outcome, Outcome::Undecided);
        assert_eq!(
            judge_lot(&ittf, &drops(1, |_| vec![0.2])).outcome,
            Outcome::Fail
        );
        let none = judge_lot(&ittf, &[("a".to_owned(), None)]);
        assert_eq!(
            (none.balls[0].drops, none.balls[0].outcome),
            (0, Outcome::Undecided)
        );
    }

    #[test]
    fn rebounds_too_far_apart_fail_whatever_their_mean() {
        let fifa = rule("fifa-pro").unwrap();
        let spread = |by: f64| {
            let of = move |_: usize| {
                (0..10)
                    .map(|i| 1.45 + by * (f64::from(i) / 9.0 - 0.5))
                    .collect()
            };
            judge_lot(&fifa, &drops(1, of)).balls[0].outcome
        };
        assert_eq!(spread(0.05), Outcome::Pass);
        assert_eq!(spread(0.12), Outcome::Fail);
        assert_eq!(spread(0.1), Outcome::Undecided);
    }
}
