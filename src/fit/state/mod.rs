//! A trial of times and parameters, and its convergence to a solution by rounds of linear fits.

use super::bounces::{
    Bounces, CONTACT, DRAG, FIRST_BEND, ImpactLaw, PARAMETERS, SPEED, Terms, Values,
};
use super::noise::{Noise, Sizes};
use super::posterior::likeliest;
use super::prior::{Prior, Priors};
use super::solution::Solution;
use super::unfitted::Unfitted;
use crate::impact::Impact;
use crate::physics::priors::Known;
use crate::statistics::upper_median;

/// The model is made linear anew around the times and parameters found until none of them moves by more than this share
/// of its own standard error.
const CONVERGED: f64 = 0.05;
/// Most rounds: a trial that has not converged by then has no solution near; five to ten are usual.
const MOST_ROUNDS: usize = 60;
/// Standard deviation of an impact that was not heard, as a share of the shorter flight beside it.
const UNHEARD: f64 = 0.3;
/// Longest C, in shortest intervals.
const LONGEST_CONTACT: f64 = 0.9;
/// Longest C of a linear ball, in shortest intervals: without damping gravity in contact makes each longer than two C, and
/// damping shortens the last of them a little.
const LONGEST_LINEAR_CONTACT: f64 = 0.55;
/// Greatest ln e of fast impacts: at 0 a linear ball has no damping.
const GREATEST_LN_FAST: f64 = -1e-4;
/// Greatest K in s⁻²: that of a balloon.
const GREATEST_DRAG: f64 = 100.0;

/// A trial of times and parameters.
#[derive(Debug, Clone)]
pub(super) struct State<'a> {
    pub impacts: &'a [Impact],
    /// The model about whose solution the others are made linear.
    pub terms: Terms,
    /// ln of the speed where e is stated; the mean over the trial where none is given.
    pub reference: Option<f64>,
    /// Bounces that are left out, the first being number 0.
    left_out: Vec<usize>,
    trial_s: Vec<f64>,
    /// The shorter flight next to each impact, in seconds.
    shorter: Vec<f64>,
    pub values: Values,
    /// Squares of the times' standard errors.
    pub time_variances: Vec<f64>,
    /// Variance of each bounce over the usual one.
    pub variance_inflation: Vec<f64>,
}

impl<'a> State<'a> {
    /// Of impacts among which these bounces, by the number of the impact from 0, have no say.
    pub(super) fn new(impacts: &'a [Impact], odd: &[usize], terms: &Terms) -> Self {
        let trial_s: Vec<f64> = impacts.iter().map(|i| i.time_s).collect();
        let shorter: Vec<f64> = (0..impacts.len())
            .map(|k| shorter_flight(&trial_s, k))
            .collect();
        let time_variances = (0..impacts.len())
            .map(|k| {
                let std_s = if impacts[k].is_heard() {
                    impacts[k].std_s.max(LEAST_TIME_STD_S)
                } else {
                    UNHEARD * shorter[k]
                };
                std_s * std_s
            })
            .collect();
        let centre = |known: Option<Known>| known.map_or(0.0, |k| k.value);
        let mut state = Self {
            impacts,
            terms: *terms,
            reference: None,
            left_out: odd.iter().map(|impact| impact - 1).collect(),
            trial_s,
            shorter,
            values: Values::default(),
            time_variances,
            variance_inflation: vec![1.0; impacts.len() - 2],
        };
        state.values = state.possible(Values {
            contact_s: centre(terms.contact),
            drag_per_s2: centre(terms.drag),
            ln_fast_restitution: state.middle_ratio().ln(),
        });
        state
    }

    /// Takes over what another trial doubts: its outliers.
    pub(super) fn doubt_like(&mut self, other: &Self) {
        self.time_variances.clone_from(&other.time_variances);
        self.variance_inflation
            .clone_from(&other.variance_inflation);
    }

    /// The nearest values that the parameters can have.
    fn possible(&self, values: Values) -> Values {
        Values {
            contact_s: values.contact_s.clamp(0.0, self.greatest_contact_s()),
            drag_per_s2: values.drag_per_s2.clamp(0.0, GREATEST_DRAG),
            ln_fast_restitution: values.ln_fast_restitution.min(GREATEST_LN_FAST),
        }
    }

    /// The longest C that fits the shortest interval.
    fn greatest_contact_s(&self) -> f64 {
        let intervals = self.trial_s.windows(2).map(|w| w[1] - w[0]);
        self.longest_contact() * intervals.fold(f64::INFINITY, f64::min).max(0.0)
    }

    /// C in shortest intervals.
    fn longest_contact(&self) -> f64 {
        if self.terms.law == ImpactLaw::Linear {
            LONGEST_LINEAR_CONTACT
        } else {
            LONGEST_CONTACT
        }
    }

    /// The median ratio of intervals.
    fn middle_ratio(&self) -> f64 {
        let triples = self.trial_s.windows(3);
        let ratios = triples.map(|t| (t[2] - t[1]) / (t[1] - t[0]));
        upper_median(ratios).unwrap_or(1.0)
    }

    /// The length of the shorter flight next to an impact.
    pub(super) fn shorter_flight(&self, impact: usize) -> f64 {
        self.shorter[impact]
    }

    pub(super) fn bounces(&self) -> Option<Bounces> {
        let (law, values) = (self.terms.law, self.values);
        Bounces::around(&self.trial_s, self.impacts, law, values, self.reference)
    }

    pub(super) fn noise(&self, bounces: &Bounces) -> Noise {
        Noise::new(
            bounces,
            &self.time_variances,
            self.variance_inflation.clone(),
        )
        .leaving_out(&self.left_out)
    }

    /// The priors of the model.
    pub(super) fn priors(&self) -> Priors {
        self.priors_of(&self.terms)
    }

    /// The priors of any model, counted from the trial values.
    pub(super) fn priors_of(&self, terms: &Terms) -> Priors {
        let mut priors = [Prior::ABSENT; PARAMETERS];
        priors[0] = Prior::FLAT;
        let of_bounded = [terms.contact, terms.drag];
        for ((place, trial, greatest), known) in self.bounds().into_iter().zip(of_bounded) {
            if let Some(known) = known {
                let prior = Prior::new(known.value - trial, known.std, -trial);
                priors[place] = prior.up_to(greatest - trial);
            }
        }
        if let Some(known) = terms.speed {
            priors[SPEED] = Prior::new(known.value, known.std, f64::NEG_INFINITY);
        }
        if let Some(amplitude) = terms.bend {
            priors[FIRST_BEND..].fill(Prior::new(0.0, amplitude, f64::NEG_INFINITY));
        }
        priors
    }

    /// Finds times and parameters by rounds of linear fits at the likeliest noise.
    ///
    /// # Errors
    /// If they do not converge, or only where a parameter is held at its greatest value.
    pub(super) fn converge(&mut self) -> Result<(), Unfitted> {
        self.converge_to(CONVERGED, MOST_ROUNDS)
    }

    /// The step is damped: a trial that turns round oscillates about a solution and moves by half as much, one that goes on
    /// by twice as much.
    fn converge_to(&mut self, rest: f64, rounds: usize) -> Result<(), Unfitted> {
        let (mut share, mut before): (f64, Vec<f64>) = (1.0, Vec::new());
        for _ in 0..rounds {
            let bounces = self.bounces().ok_or(Unfitted::NoFlight)?;
            let noise = self.noise(&bounces);
            let solved = likeliest(&bounces, &noise, &self.priors());
            let (sizes, solution) = solved.ok_or(Unfitted::NoNoise)?;
            let step = self.step(&bounces, &noise, sizes, solution);
            let step = step.ok_or(Unfitted::NoNoise)?;
            if step.in_stds.iter().all(|m| m.abs() < rest) {
                return if step.held_back {
                    Err(Unfitted::Bound)
                } else {
                    Ok(())
                };
            }
            let turned: f64 = step.in_stds.iter().zip(&before).map(|(a, b)| a * b).sum();
            share = if turned < 0.0 {
                (0.5 * share).max(LEAST_SHARE)
            } else {
                (2.0 * share).min(1.0)
            };
            self.go(&step, share);
            before = step.in_stds;
        }
        Err(Unfitted::Restless)
    }

    /// The step from the trial to a solution, for the times to their conditional means given the bounces.
    fn step(
        &self,
        bounces: &Bounces,
        noise: &Noise,
        sizes: Sizes,
        mut solution: Solution,
    ) -> Option<Step> {
        let stds: [f64; PARAMETERS] = std::array::from_fn(|i| solution.covariance[i][i].sqrt());
        let held_back = self.hold(&mut solution);
        let pulls = pulls(bounces, noise, sizes, &solution)?;
        let mut moves_s = Vec::with_capacity(self.trial_s.len());
        let mut in_stds = Vec::with_capacity(self.trial_s.len() + PARAMETERS);
        for (k, trial_s) in self.trial_s.iter().enumerate() {
            let variance = sizes.timing.powi(2) * self.time_variances[k];
            let solved_s = self.impacts[k].time_s - variance * time_pull(bounces, &pulls, k);
            moves_s.push(solved_s - trial_s);
            in_stds.push((solved_s - trial_s) / variance.sqrt());
        }
        let ln_fast = (solution.values[0] - bounces.middle_loss).min(GREATEST_LN_FAST);
        let mut moves = [0.0; PARAMETERS];
        moves[0] = ln_fast - self.values.ln_fast_restitution;
        moves[CONTACT] = solution.values[CONTACT];
        moves[DRAG] = solution.values[DRAG];
        let parameters = moves.iter().zip(stds).filter(|(_, std)| *std > 0.0);
        in_stds.extend(parameters.map(|(m, std)| m / std));
        Some(Step {
            moves_s,
            moves: Values {
                contact_s: moves[CONTACT],
                drag_per_s2: moves[DRAG],
                ln_fast_restitution: moves[0],
            },
            in_stds,
            held_back,
        })
    }

    /// Place, trial value and greatest value of C and K.
    fn bounds(&self) -> [(usize, f64, f64); 2] {
        let contact = (CONTACT, self.values.contact_s, self.greatest_contact_s());
        [contact, (DRAG, self.values.drag_per_s2, GREATEST_DRAG)]
    }

    /// Holds C and K of a solution within their ranges; gives whether one would be greater.
    fn hold(&self, solution: &mut Solution) -> bool {
        let bounds = self.bounds();
        let mut held_back = false;
        // Holding the second moves the first, which may then have to be held.
        for (place, now, greatest) in [bounds[0], bounds[1], bounds[0]] {
            let wanted = now + solution.values[place];
            if !(0.0..=greatest).contains(&wanted) {
                held_back |= wanted > greatest;
                solution.fix(place, wanted.clamp(0.0, greatest) - now);
            }
        }
        held_back
    }

    /// Goes a share of the step.
    fn go(&mut self, step: &Step, share: f64) {
        for (trial_s, move_s) in self.trial_s.iter_mut().zip(&step.moves_s) {
            *trial_s += share * move_s;
        }
        let (now, moves) = (self.values, step.moves);
        self.values = self.possible(Values {
            contact_s: now.contact_s + share * moves.contact_s,
            drag_per_s2: now.drag_per_s2 + share * moves.drag_per_s2,
            ln_fast_restitution: now.ln_fast_restitution + share * moves.ln_fast_restitution,
        });
    }
}

/// Least share of a step.
const LEAST_SHARE: f64 = 0.125;

/// The step from a trial to the solution around it.
#[derive(Debug)]
struct Step {
    /// Of the times, in seconds.
    moves_s: Vec<f64>,
    /// Of the parameters.
    moves: Values,
    /// The moves of all times and parameters, each in its own standard errors.
    in_stds: Vec<f64>,
    /// Whether a parameter would exceed its range.
    held_back: bool,
}

/// Least standard error of a time, in seconds: a hundredth of a sample at 192 kHz.
const LEAST_TIME_STD_S: f64 = 5e-8;

fn shorter_flight(times_s: &[f64], impact: usize) -> f64 {
    let near = &times_s[impact.saturating_sub(1)..(impact + 2).min(times_s.len())];
    near.windows(2)
        .map(|w| w[1] - w[0])
        .fold(f64::INFINITY, f64::min)
}

/// `Σ⁻¹·(z − Xβ)`: the pull of each bounce at the fit.
pub(super) fn pulls(
    bounces: &Bounces,
    noise: &Noise,
    sizes: Sizes,
    solution: &Solution,
) -> Option<Vec<f64>> {
    let mut left = bounces.ln_e.clone();
    for (left, row) in left.iter_mut().zip(&bounces.design) {
        let explained = row.iter().zip(&solution.values).map(|(x, b)| x * b);
        *left -= explained.sum::<f64>();
    }
    Some(noise.factors(sizes)?.solve(&left))
}

/// The part of `Aᵀ·pulls` that belongs to one time.
pub(super) fn time_pull(bounces: &Bounces, pulls: &[f64], time: usize) -> f64 {
    (0..3)
        .filter_map(|side| {
            let bounce = time.checked_sub(side)?;
            Some(bounces.slopes.get(bounce)?[side] * pulls[bounce])
        })
        .sum()
}

#[cfg(test)]
mod tests;
