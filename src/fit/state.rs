//! A trial of times and parameters, settled by rounds of linear fits.

use super::bounces::{Bounces, Law, Terms, Values};
use super::flights::Impact;
use super::least_squares::{Prior, Solution};
use super::noise::{Noise, Sizes};
use super::posterior::likeliest;
use crate::physics::priors::Known;
use crate::statistics::upper_median;

/// Rounds in which the model is made linear anew around the times and parameters found.
const ROUNDS: usize = 5;
/// An impact that was not heard may be off by this share of the flights around it.
const UNHEARD: f64 = 0.3;
/// The model is linear enough where nothing moves by more than this: times as shares of the flights, K in s⁻².
const SETTLED: f64 = 1e-3;
/// A model that still moves by this much after the last round has no solution near.
const RUNAWAY: f64 = 0.2;
/// C is shorter than any interval by this share, K no greater than that of a balloon.
const LONGEST_CONTACT: f64 = 0.9;
/// A linear ball on which its weight rests for longer would hardly leave.
const LONGEST_LINEAR_CONTACT: f64 = 0.45;
/// e of a linear ball is below 1 by this at least, or it has no damping.
const LEAST_LN_LOSS: f64 = -1e-4;
const GREATEST_DRAG: f64 = 100.0;

/// A trial of times and parameters.
#[derive(Debug, Clone)]
pub(super) struct State<'a> {
    pub impacts: &'a [Impact],
    pub terms: Terms,
    trial_s: Vec<f64>,
    /// The shorter flight next to each impact, in seconds.
    shorter: Vec<f64>,
    pub values: Values,
    /// Squares of the times' standard errors.
    pub time_variances: Vec<f64>,
    /// By how much the variance of each bounce is greater than usual.
    pub wildness: Vec<f64>,
}

impl<'a> State<'a> {
    pub(super) fn new(impacts: &'a [Impact], terms: &Terms) -> Self {
        let trial_s: Vec<f64> = impacts.iter().map(|i| i.time_s).collect();
        let shorter: Vec<f64> = (0..impacts.len())
            .map(|k| shorter_flight(&trial_s, k))
            .collect();
        let time_variances = (0..impacts.len())
            .map(|k| {
                let std_s = if impacts[k].heard {
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
            trial_s,
            shorter,
            values: Values::default(),
            time_variances,
            wildness: vec![1.0; impacts.len() - 2],
        };
        state.values.ln_fast_restitution = state.middle_ratio().ln().min(LEAST_LN_LOSS);
        state.set_values(centre(terms.contact), centre(terms.drag));
        state
    }

    fn set_values(&mut self, contact_s: f64, drag_per_s2: f64) {
        let shortest = self.trial_s.windows(2).map(|w| w[1] - w[0]);
        let shortest = shortest.fold(f64::INFINITY, f64::min);
        let longest = self.longest_contact() * shortest.max(0.0);
        self.values.contact_s = contact_s.clamp(0.0, longest);
        self.values.drag_per_s2 = drag_per_s2.clamp(0.0, GREATEST_DRAG);
    }

    /// C in shortest intervals.
    fn longest_contact(&self) -> f64 {
        if self.terms.law == Law::Linear {
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
        Bounces::around(&self.trial_s, self.impacts, &self.terms, self.values)
    }

    pub(super) fn noise(&self, bounces: &Bounces) -> Noise {
        Noise::new(bounces, &self.time_variances, self.wildness.clone())
    }

    /// What is known of each fitted parameter, counted from its trial value.
    pub(super) fn priors(&self) -> Vec<Prior> {
        let mut priors = vec![Prior::FLAT];
        for (known, trial, least) in [
            (self.terms.contact, self.values.contact_s, 0.0),
            (self.terms.drag, self.values.drag_per_s2, 0.0),
            (self.terms.speed, 0.0, f64::NEG_INFINITY),
        ] {
            priors.extend(known.map(|k| Prior::new(k.value - trial, k.std, least - trial)));
        }
        priors
    }

    /// Finds times and parameters by rounds of linear fits at the likeliest noise.
    pub(super) fn settle(&mut self) -> Option<()> {
        let mut moved = f64::INFINITY;
        for _ in 0..ROUNDS {
            let bounces = self.bounces()?;
            let noise = self.noise(&bounces);
            let (sizes, solution) = likeliest(&bounces, &noise, &self.priors())?;
            moved = self.step(&bounces, &noise, sizes, &solution)?;
            if moved < SETTLED {
                break;
            }
        }
        (moved < RUNAWAY).then_some(())
    }

    /// Moves the trial to a solution: the times to where the noise of each is most likely to have come from. Gives the
    /// largest move as a share of what it may be off.
    fn step(
        &mut self,
        bounces: &Bounces,
        noise: &Noise,
        sizes: Sizes,
        solution: &Solution,
    ) -> Option<f64> {
        let pulls = pulls(bounces, noise, sizes, solution)?;
        let mut largest: f64 = 0.0;
        for (k, trial_s) in self.trial_s.iter_mut().enumerate() {
            let off_s =
                sizes.timing.powi(2) * self.time_variances[k] * time_pull(bounces, &pulls, k);
            let next_s = self.impacts[k].time_s - off_s;
            largest = largest.max((next_s - *trial_s).abs() / self.shorter[k]);
            *trial_s = next_s;
        }
        let mut fitted = solution.values.iter().skip(1);
        let mut next =
            |known: Option<Known>| known.and_then(|_| fitted.next()).copied().unwrap_or(0.0);
        let (contact, drag) = (next(self.terms.contact), next(self.terms.drag));
        let (contact_s, drag_per_s2) = (
            self.values.contact_s + contact,
            self.values.drag_per_s2 + drag,
        );
        let before = self.values;
        let fast = solution.values[0] - bounces.middle_loss;
        self.values.ln_fast_restitution = fast.min(LEAST_LN_LOSS);
        self.set_values(contact_s, drag_per_s2);
        let shortest = self.shorter.iter().copied().fold(f64::INFINITY, f64::min);
        // A value that is held back at its greatest is no solution.
        let held_back =
            contact_s > self.longest_contact() * shortest || drag_per_s2 > GREATEST_DRAG;
        if held_back {
            return Some(f64::INFINITY);
        }
        Some(
            largest
                .max((self.values.contact_s - before.contact_s).abs() / shortest)
                .max((self.values.drag_per_s2 - before.drag_per_s2).abs())
                .max((self.values.ln_fast_restitution - before.ln_fast_restitution).abs()),
        )
    }
}

/// Times are not taken to be better than this, in seconds: a hundredth of a sample at 192 kHz.
const LEAST_TIME_STD_S: f64 = 5e-8;

fn shorter_flight(times_s: &[f64], impact: usize) -> f64 {
    let near = &times_s[impact.saturating_sub(1)..(impact + 2).min(times_s.len())];
    near.windows(2)
        .map(|w| w[1] - w[0])
        .fold(f64::INFINITY, f64::min)
}

/// `Σ⁻¹·(z − Xβ)`: how hard each bounce pulls at the fit.
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
