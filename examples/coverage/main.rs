//! How often the 95 % interval of e holds the e that made the impact times, from times alone.
//!
//! ```text
//! cargo run --release --example coverage [drops a cell] > docs/coverage.md
//! ```
//!
//! Each cell is fitted on the model that made it and, for a tenth of the drops, by `auto`. The spread of ln e stands beside
//! the least that an unbiased estimate can have where the sizes of both noises are known (Cramér and Rao).
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "an example prints, and stops at the first surprise"
)]

mod laws;
mod outside;

use std::sync::Mutex;
use std::thread;

use bounce_audio::fit::ModelKind;
use bounce_audio::fit::model_selection::{Choice, Inputs, Selection, select};
use bounce_audio::impact::Impact;
use bounce_audio::physics::{
    BallModel, Bounce, FlightLaw, Oscillator, Rebound, ReleaseRule, Restitution, RestitutionLaw,
    VISCOELASTIC_POWER,
};
use bounce_audio::random::SplitMix64;
use bounce_audio::units::real;

const GRAVITY: f64 = 9.81;
/// The first flight, in seconds.
const FIRST_S: f64 = 0.8;
/// Flights are longer than this, and than ten errors of a time, in every cell.
const SHORTEST_S: f64 = 4e-3;
/// Models that differ by less than this many nats are not told apart.
const ALIKE: f64 = 3.0;

/// What makes the times of a cell, and the model that it is fitted on.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Ball {
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
    fn name(self) -> String {
        match self {
            Self::Constant => "constant".to_owned(),
            Self::Contact { contact_s } => format!("contact {} ms", 1e3 * contact_s),
            Self::Drag { per_s2 } => format!("drag {per_s2} s⁻²"),
            Self::Linear { contact_s } => format!("linear {} ms", 1e3 * contact_s),
            Self::Viscoelastic => "viscoelastic".to_owned(),
        }
    }

    fn choice(self) -> Choice {
        match self {
            Self::Constant => Choice::Constant,
            Self::Contact { .. } => Choice::Contact,
            Self::Drag { .. } => Choice::Drag,
            Self::Linear { .. } => Choice::Linear,
            Self::Viscoelastic => Choice::Viscoelastic,
        }
    }

    fn kind(self) -> ModelKind {
        match self {
            Self::Constant => ModelKind::Constant,
            Self::Contact { .. } => ModelKind::Contact,
            Self::Drag { .. } => ModelKind::Drag,
            Self::Linear { .. } => ModelKind::Linear,
            Self::Viscoelastic => ModelKind::Viscoelastic,
        }
    }

    fn contact_s(self) -> Option<f64> {
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
struct Cell {
    ball: Ball,
    e: f64,
    impacts: usize,
    time_std_s: f64,
    bounce_std: f64,
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

    /// A drop and its own ln e.
    fn drop(&self, rng: &mut SplitMix64) -> Option<(Vec<Impact>, f64)> {
        let scatter: Vec<f64> = (2..self.impacts)
            .map(|_| self.bounce_std * rng.normal())
            .collect();
        let (times, ln_e) = self.times(self.e.ln(), FIRST_S, &scatter)?;
        let impacts = times
            .into_iter()
            .map(|time_s| Impact::heard(time_s + self.time_std_s * rng.normal(), self.time_std_s));
        Some((impacts.collect(), ln_e))
    }

    /// The least standard deviation of an unbiased ln e: start, first flight and contact or drag unknown.
    fn bound(&self) -> Option<f64> {
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

/// What came of the drops of a cell.
#[derive(Debug, Default)]
struct Tally {
    drops: usize,
    held: usize,
    squares: f64,
    variances: f64,
    contact_held: usize,
    auto_drops: usize,
    auto_held: usize,
    auto_right: usize,
}

impl Tally {
    fn of(cell: &Cell, drops: usize, seed: u64) -> Self {
        let mut rng = SplitMix64::new(seed);
        let mut tally = Self::default();
        let inputs = Inputs::default();
        for i in 0..drops {
            let Some((impacts, ln_e)) = cell.drop(&mut rng) else {
                continue;
            };
            tally.drops += 1;
            if let Some(selection) = select(&impacts, &[], &inputs, cell.ball.choice()) {
                tally.add(&selection, cell, ln_e);
            }
            if i % 10 == 0 {
                tally.auto_drops += 1;
                if let Some(auto) = select(&impacts, &[], &inputs, Choice::Auto) {
                    tally.auto_held += usize::from(holds(&auto, ln_e));
                    tally.auto_right += usize::from(is_right(&auto, cell.ball.kind()));
                }
            }
        }
        tally
    }

    fn add(&mut self, selection: &Selection, cell: &Cell, ln_e: f64) {
        let fitted = selection.fit.ln_restitution;
        self.held += usize::from(holds(selection, ln_e));
        self.squares += (fitted.value - ln_e).powi(2);
        self.variances += fitted.std.unwrap_or(0.0).powi(2);
        let ends = selection.fit.contact_s.and_then(|c| c.interval95);
        if let (Some([low, high]), Some(contact_s)) = (ends, cell.ball.contact_s()) {
            self.contact_held += usize::from(low <= contact_s && contact_s <= high);
        }
    }
}

fn holds(selection: &Selection, ln_e: f64) -> bool {
    let ends = selection.fit.ln_restitution.interval95;
    ends.is_some_and(|[low, high]| low <= ln_e && ln_e <= high)
}

/// Whether this model was taken, or one that cannot be told from it.
fn is_right(selection: &Selection, kind: ModelKind) -> bool {
    let gain = |kind: ModelKind| {
        let found = selection.candidates.iter().find(|c| c.model == kind);
        found.map_or(f64::NEG_INFINITY, |c| c.gain_nats)
    };
    selection.selected == kind || gain(selection.selected) - gain(kind) < ALIKE
}

fn cells() -> Vec<Cell> {
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

/// One line of the table.
fn line(cell: &Cell, tally: &Tally) -> String {
    let share = |part: usize, of: usize| real(part) / real(of.max(1));
    let spread = (tally.squares / real(tally.drops.max(1))).sqrt();
    let stated = (tally.variances / real(tally.drops.max(1))).sqrt();
    let contact = match cell.ball.contact_s() {
        Some(_) => format!("{:.3}", share(tally.contact_held, tally.drops)),
        None => String::new(),
    };
    let bound = cell
        .bound()
        .map_or(String::new(), |b| format!("{:.2}", spread / b));
    format!(
        "| {} | {} | {} | {} | {} | {:.3} | {contact} | {:.3} | {:.2} | {spread:.1e} | {:.2} | {bound} |",
        cell.ball.name(),
        cell.e,
        cell.impacts,
        1e6 * cell.time_std_s,
        100.0 * cell.bounce_std,
        share(tally.held, tally.drops),
        share(tally.auto_held, tally.auto_drops),
        share(tally.auto_right, tally.auto_drops),
        spread / stated,
    )
}

fn main() {
    if std::env::args().nth(1).is_some_and(|a| a == "outside") {
        let drops = std::env::args().nth(2).map_or(300, |a| a.parse().unwrap());
        return outside::print(drops);
    }
    let drops: usize = std::env::args().nth(1).map_or(500, |a| a.parse().unwrap());
    let cells = cells();
    let lines = Mutex::new(vec![String::new(); cells.len()]);
    let next = std::sync::atomic::AtomicUsize::new(0);
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let i = next.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                    let Some(cell) = cells.get(i) else { break };
                    let seed = u64::try_from(i).unwrap();
                    let text = line(cell, &Tally::of(cell, drops, seed));
                    lines.lock().unwrap()[i] = text;
                }
            });
        }
    });
    let error = (0.95 * 0.05 / real(drops)).sqrt();
    println!("# How often the interval holds e\n");
    println!(
        "Made by `cargo run --release --example coverage {drops} > docs/coverage.md`: {drops} drops a cell, so a share"
    );
    println!(
        "of 0.95 is known to ± {error:.3} (one standard deviation); `auto` is tried on a tenth of them. The first flight"
    );
    println!(
        "lasts {FIRST_S} s; cells whose shortest flight is below {} ms or ten errors of a time are left out.\n",
        1e3 * SHORTEST_S
    );
    println!(
        "- ball: the model that made the times and on which they are fitted; n: impacts; σ_t: error of each time, as stated;"
    );
    println!("  σ_e: scatter of each bounce.");
    println!(
        "- holds e, holds C, auto holds: how often the 95 % interval of e, of the contact time, and of e by `auto` hold the truth."
    );
    println!("- auto right: how often `auto` takes this model or one within {ALIKE} nats of it.");
    println!(
        "- spread: root mean square error of ln e; over stated; over the least that is possible with known σ_t and σ_e.\n"
    );
    println!(
        "| ball | e | n | σ_t µs | σ_e % | holds e | holds C | auto holds | auto right | spread | /stated | /least |"
    );
    println!("|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|");
    for line in lines.into_inner().unwrap() {
        println!("{line}");
    }
}
