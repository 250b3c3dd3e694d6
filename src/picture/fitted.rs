//! The flights that the model of a drop expects, for the lines in its pictures.

use crate::physics::BallModel;
use crate::report::Drop;
use crate::units::real;

/// A line lies on the flights once a round moves it by less than this share, and is moved no more after this number of rounds.
const REST: f64 = 1e-9;
const ROUNDS: usize = 100;

/// The intervals of a ball that lie nearest to those observed in the drop that it was fitted to, by their logarithms and
/// with these weights; fewer where the ball would not leave.
pub(super) fn nearest(ball: &BallModel, drop: &Drop, observed: &[Observed]) -> Vec<f64> {
    let first = observed
        .iter()
        .find_map(|o| Some((o.number, o.interval_s?)));
    let mean = drop.restitution.as_ref();
    let mean = mean.and_then(|r| Some((r.estimate.value, r.at_speed_m_per_s?)));
    let (Some((number, interval_s)), Some((e, mean_speed))) = (first, mean) else {
        return Vec::new();
    };
    let contact_s = ball.contact_time_s(mean_speed).unwrap_or(0.0);
    let flight_s = (interval_s - contact_s).max(0.1 * interval_s);
    // It arrived faster than it left by 1/e, and by as much again at each impact before.
    let earlier = e.powf(-1.0 - real(number));
    let mut speed = 0.5 * ball.flight().gravity_m_per_s2() * flight_s * earlier;
    for _ in 0..ROUNDS {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (o, fitted) in observed.iter().zip(ball.intervals(speed)) {
            let Some(interval_s) = o.interval_s else {
                continue;
            };
            sum += o.weight * (interval_s / fitted).ln();
            weights += o.weight;
        }
        let moved = if weights > 0.0 { sum / weights } else { 0.0 };
        speed *= moved.exp();
        if moved.abs() < REST {
            break;
        }
    }
    ball.intervals(speed).take(observed.len()).collect()
}

/// An interval to lay a line through.
#[derive(Debug, Clone, Copy)]
pub(super) struct Observed {
    /// Number of the impact before it, counted from 0.
    pub number: usize,
    /// Seconds; none where an end was not heard.
    pub interval_s: Option<f64>,
    /// How much it counts.
    pub weight: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::{Estimate, ModelKind};
    use crate::report::{Method, Restitution};

    #[test]
    fn the_line_of_a_ball_with_contact_and_a_power_of_speed_lies_on_its_flights() {
        let mut drop = Drop::empty();
        drop.restitution = Some(Restitution {
            estimate: Estimate::bare(0.9),
            at_speed_m_per_s: Some(1.0),
            method: Method::LeastSquares,
        });
        drop.model.selected = ModelKind::ContactSpeed;
        drop.model.parameters.contact_time_s = Some(Estimate::bare(1e-3));
        drop.model.parameters.drag_per_s2 = Some(Estimate::bare(1.2));
        drop.model.parameters.speed_exponent = Some(Estimate::bare(0.02));
        let ball = drop.ball_model(9.81).unwrap();
        let truth: Vec<f64> = ball.intervals(2.4).take(20).collect();
        assert!((truth[0] - 1e-3) < 2.0 * 0.9 * 2.4 / 9.81 && truth[1] < truth[0]);
        let observed = truth.iter().enumerate().map(|(number, &t)| Observed {
            number,
            interval_s: (number != 3).then_some(t),
            weight: 1.0,
        });
        let line = nearest(&ball, &drop, &observed.collect::<Vec<_>>());
        let worst = line.iter().zip(&truth).map(|(l, t)| (l / t).ln().abs());
        assert!(line.len() == 20 && worst.fold(0.0, f64::max) < 1e-4);
        let livelier = drop.ball_model_with(0.91, 9.81).unwrap();
        assert!(livelier.intervals(2.4).nth(19).unwrap() > truth[19]);
    }
}
