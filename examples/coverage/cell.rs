//! The cells of the table: balls, errors and scatters, and the least error that is possible with them.

use bounce_audio::fit::ModelKind;
use bounce_audio::fit::model_selection::Choice;
use bounce_audio::impact::Impact;
use bounce_audio::physics::{
    BallModel, Bounce, FlightLaw, Oscillator, Rebound, ReleaseRule, Restitution, RestitutionLaw,
    VISCOELASTIC_POWER,
};
use bounce_audio::random::SplitMix64;
use bounce_audio::units::real;

use crate::{FIRST_S, GRAVITY, SHORTEST_S};

/// What makes the times of a cell, and the model that it is fitted on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Ball {
    Constant,
    Contact {
        contact_s: f64,
    },
    Drag {
        per_s2: f64,
    },
    Linear {
        contact_s: f64,
    },
    /// With this e at the first impact.
    Viscoelastic,
}

impl Ball {
    pub(crate) fn name(self) -> String {
        match self {
            Self::Constant => "constant".to_owned(),
            Self::Contact { contact_s } => format!("contact {} ms", 1e3 * contact_s),
            Self::Drag { per_s2 } => format!("drag {per_s2} s⁻²"),
            Self::Linear { contact_s } => format!("linear {} ms", 1e3 * contact_s),
            Self::Viscoelastic => "viscoelastic".to_owned(),
        }
    }

    pub(crate) fn choice(self) -> Choice {
        match self {
            Self::Constant => Choice::Constant,
            Self::Contact { .. } => Choice::Contact,
            Self::Drag { .. } => Choice::Drag,
            Self::Linear { .. } => Choice::Linear,
            Self::Viscoelastic => Choice::Viscoelastic,
        }
    }

    pub(crate) fn kind(self) -> ModelKind {
        match self {
            Self::Constant => ModelKind::Constant,
            Self::Contact { .. } => ModelKind::Contact,
            Self::Drag { .. } => ModelKind::Drag,
            Self::Linear { .. } => ModelKind::Linear,
            Self::Viscoelastic => ModelKind::Viscoelastic,
        }
    }

    pub(crate) fn contact_s(self) -> Option<f64> {
        match self {
            Self::Contact { contact_s } | Self::Linear { contact_s } => Some(contact_s),
            _ => None,
        }
    }

    /// The ball with this e, of fast impacts or at the first; none if no ball of this kind has it.
    fn model(self, ln_e: f64, first_speed: f64) -> Option<BallModel> {
        let drag_per_s2 = match self {
            Self::Drag { per_s2 } => per_s2,
            _ => 0.0,
        };
        let flight = FlightLaw::with_drag(GRAVITY, drag_per_s2).unwrap();
        let e = Restitution::from_ln(ln_e).unwrap();
        let bounce = match self {
            Self::Linear { contact_s } => Bounce::Linear {
                ball: Oscillator::from_contact(e, contact_s).unwrap(),
                release_rule: ReleaseRule::ZeroDisplacement,
            },
            Self::Viscoelastic => Bounce::Given {
                restitution: viscoelastic(e.value(), first_speed)?,
                contact_time_s: 0.0,
            },
            _ => Bounce::Given {
                restitution: RestitutionLaw::Constant(e),
                contact_time_s: self.contact_s().unwrap_or(0.0),
            },
        };
        Some(BallModel::new(flight, bounce).unwrap())
    }
}

/// The viscoelastic sphere with this e at this speed: `y − ⅗y² = 1 − e` there, `y ∝ v^(1/5)`; none for an e that the series
/// does not reach.
fn viscoelastic(e: f64, speed: f64) -> Option<RestitutionLaw> {
    let root = (1.0 - 2.4 * (1.0 - e)).sqrt();
    let y = root.is_finite().then_some((1.0 - root) / 1.2)?;
    let gamma1 = y / speed.powf(VISCOELASTIC_POWER);
    Some(RestitutionLaw::Viscoelastic {
        gamma1,
        gamma2: 0.6 * gamma1 * gamma1,
    })
}

#[derive(Debug, Clone, Copy)]
pub(crate) struct Cell {
    pub(crate) ball: Ball,
    pub(crate) e: f64,
    pub(crate) impacts: usize,
    pub(crate) time_std_s: f64,
    pub(crate) bounce_std: f64,
}

impl Cell {
    /// The times without their errors for a scatter of each bounce, and ln e at the mean speed; none if the ball comes to
    /// rest.
    fn times(&self, ln_e: f64, first_s: f64, scatter: &[f64]) -> Option<(Vec<f64>, f64)> {
        let first_speed = 0.5 * GRAVITY * first_s;
        let ball = self.ball.model(ln_e, first_speed)?;
        let mut times = vec![0.0];
        let (mut at_s, mut speed, mut ln_speeds) = (0.0, first_speed, 0.0);
        let mut contact_s = self.ball.contact_s().unwrap_or(0.0);
        for scatter in scatter {
            let hop = ball.flight().hop(speed).unwrap();
            at_s += contact_s + hop.time_s;
            times.push(at_s);
            let arriving = hop.landing_speed_m_per_s;
            let Rebound::Leaves(leaving) = ball.rebound(arriving).unwrap() else {
                return None;
            };
            contact_s = leaving.contact_time_s;
            ln_speeds += arriving.ln();
            speed = arriving * (leaving.restitution.ln() + scatter).exp();
        }
        let hop = ball.flight().hop(speed).unwrap();
        times.push(at_s + contact_s + hop.time_s);
        let mean_speed = (ln_speeds / real(scatter.len())).exp();
        Some((times, ball.restitution(mean_speed)?.ln()))
    }

    fn is_in_reach(&self) -> bool {
        let made = self.times(self.e.ln(), FIRST_S, &vec![0.0; self.impacts - 2]);
        made.is_some_and(|(times, _)| {
            let contact_s = self.ball.contact_s().unwrap_or(0.0);
            let last = times[times.len() - 1] - times[times.len() - 2] - contact_s;
            last > SHORTEST_S.max(10.0 * self.time_std_s)
        })
    }

    /// A drop and the ball that made it.
    pub(crate) fn drop(&self, rng: &mut SplitMix64) -> Option<(Vec<Impact>, BallModel)> {
        let scatter: Vec<f64> = (2..self.impacts)
            .map(|_| self.bounce_std * rng.normal())
            .collect();
        let (times, _) = self.times(self.e.ln(), FIRST_S, &scatter)?;
        let ball = self.ball.model(self.e.ln(), 0.5 * GRAVITY * FIRST_S)?;
        let impacts = times
            .into_iter()
            .map(|time_s| Impact::heard(time_s + self.time_std_s * rng.normal(), self.time_std_s));
        Some((impacts.collect(), ball))
    }

    /// The least standard deviation of an unbiased ln e: start, first flight and contact or drag unknown.
    pub(crate) fn bound(&self) -> Option<f64> {
        let none = vec![0.0; self.impacts - 2];
        let ln_e = self.e.ln();
        let base = self.times(ln_e, FIRST_S, &none)?.0;
        let derivative = |moved: Vec<f64>, step: f64| -> Vec<f64> {
            moved
                .iter()
                .zip(&base)
                .map(|(m, b)| (m - b) / step)
                .collect()
        };
        const STEP: f64 = 1e-6;
        let mut slopes = vec![
            derivative(self.times(ln_e + STEP, FIRST_S, &none)?.0, STEP),
            vec![1.0; base.len()],
            derivative(self.times(ln_e, FIRST_S + STEP, &none)?.0, STEP),
        ];
        let ball = match self.ball {
            Ball::Constant | Ball::Viscoelastic => None,
            Ball::Contact { contact_s } => Some(Ball::Contact {
                contact_s: contact_s + STEP,
            }),
            Ball::Linear { contact_s } => Some(Ball::Linear {
                contact_s: contact_s + STEP,
            }),
            Ball::Drag { per_s2 } => Some(Ball::Drag {
                per_s2: per_s2 + STEP,
            }),
        };
        if let Some(ball) = ball {
            let moved = Self { ball, ..*self };
            slopes.push(derivative(moved.times(ln_e, FIRST_S, &none)?.0, STEP));
        }
        let mut covariance = vec![vec![0.0; base.len()]; base.len()];
        for (i, row) in covariance.iter_mut().enumerate() {
            row[i] = self.time_std_s.powi(2);
        }
        for bounce in 0..none.len() {
            let mut scatter = none.clone();
            scatter[bounce] = STEP;
            let slope = derivative(self.times(ln_e, FIRST_S, &scatter)?.0, STEP);
            for (row, a) in covariance.iter_mut().zip(&slope) {
                for (c, b) in row.iter_mut().zip(&slope) {
                    *c += self.bounce_std.powi(2) * a * b;
                }
            }
        }
        let solved: Vec<Vec<f64>> = slopes.iter().map(|s| solve(&covariance, s)).collect();
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let rows = slopes
            .iter()
            .map(|a| solved.iter().map(|b| product(a, b)).collect());
        let information: Vec<Vec<f64>> = rows.collect();
        let mut first = vec![0.0; slopes.len()];
        first[0] = 1.0;
        Some(solve(&information, &first)[0].sqrt())
    }
}

/// Solves a positive definite system by Cholesky's factors, the diagonal scaled to 1.
fn solve(matrix: &[Vec<f64>], right: &[f64]) -> Vec<f64> {
    let n = right.len();
    let scale: Vec<f64> = (0..n).map(|i| matrix[i][i].sqrt()).collect();
    let mut lower = vec![vec![0.0; n]; n];
    let mut x: Vec<f64> = right.iter().zip(&scale).map(|(r, s)| r / s).collect();
    for i in 0..n {
        for j in 0..=i {
            let known: f64 = (0..j).map(|k| lower[i][k] * lower[j][k]).sum();
            let left = matrix[i][j] / (scale[i] * scale[j]) - known;
            lower[i][j] = if i == j {
                left.max(1e-15).sqrt()
            } else {
                left / lower[j][j]
            };
        }
    }
    for i in 0..n {
        let known: f64 = (0..i).map(|k| lower[i][k] * x[k]).sum();
        x[i] = (x[i] - known) / lower[i][i];
    }
    for i in (0..n).rev() {
        let known: f64 = (i + 1..n).map(|k| lower[k][i] * x[k]).sum();
        x[i] = (x[i] - known) / lower[i][i];
    }
    x.iter().zip(&scale).map(|(x, s)| x / s).collect()
}

pub(crate) fn cells() -> Vec<Cell> {
    let mut cells = Vec::new();
    for ball in [
        Ball::Constant,
        Ball::Contact { contact_s: 1e-3 },
        Ball::Contact { contact_s: 5e-3 },
        Ball::Drag { per_s2: 1.4 },
        Ball::Linear { contact_s: 1e-3 },
        Ball::Linear { contact_s: 5e-3 },
        Ball::Viscoelastic,
    ] {
        for e in [0.4, 0.6, 0.8, 0.93, 0.98] {
            for impacts in [4, 5, 8, 12, 20, 50, 150] {
                for time_std_s in [1e-6, 3e-5, 1e-3] {
                    for bounce_std in [0.0, 0.005, 0.02] {
                        let cell = Cell {
                            ball,
                            e,
                            impacts,
                            time_std_s,
                            bounce_std,
                        };
                        if cell.is_in_reach() {
                            cells.push(cell);
                        }
                    }
                }
            }
        }
    }
    cells
}
