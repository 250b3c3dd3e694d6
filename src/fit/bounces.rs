//! The observation of ln e by each bounce, linearised in the times and in the parameters of the model.

use super::trial_law::{self, Flight, Loss, TrialLaw};
use crate::impact::Impact;
use crate::physics::priors::Known;

/// A model of the intervals: constant e, and what is added to it.
///
/// # Formula
/// ```text
/// D_i = T_i + C,   ln e(v_j) = ln u(T_j) − ln w(T_{j−1}) = θ − p·ln(v_j/v̄) + σ_e·η_j
/// T = (atan a + arsinh a)/√K,   u ∝ a,   w ∝ a/√(1 + a²),   K = g²/v_t²
/// ```
/// `D_i` are the intervals between impacts, C is the time in contact (s), u and w are the speeds at which the ball
/// leaves and arrives, K is the drag of the air (s⁻²; 1.4 for a ping-pong ball), p is how e falls with speed, v̄ is the
/// geometric mean of the impact speeds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Terms {
    /// C in seconds.
    pub contact: Option<Known>,
    /// K in s⁻².
    pub drag: Option<Known>,
    /// p.
    pub speed: Option<Known>,
    /// Dependence of contact and e on the impact speed.
    pub law: ImpactLaw,
}

/// Dependence of contact and e on the impact speed that follows from C and e themselves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum ImpactLaw {
    /// All impacts alike.
    #[default]
    Alike,
    /// A linear ball with gravity in contact: slow impacts last longer and lose more; C is that of fast ones.
    Linear,
    /// Viscoelastic spheres: `ln e(v) = θ·(v/v̄)^(1/5)`, slow impacts lose less (Ramírez, Pöschel, Brilliantov and
    /// Schwager 1999; of their series `1 − e = y − ⅗y² + …` in `y ∝ v^(1/5)`, this is right to 0.1·y²).
    Viscoelastic,
}

/// Trial values of C, K and, for a linear ball, e of fast impacts, in which the model is not linear.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Values {
    pub contact_s: f64,
    pub drag_per_s2: f64,
    pub ln_fast_restitution: f64,
}

/// Parameters of the largest model: θ, C, K and p.
pub(super) const MOST_PARAMETERS: usize = 4;

/// The bounces around a trial of times and parameters.
#[derive(Debug, Clone)]
pub(super) struct Bounces {
    /// ln e of each bounce, by the times observed.
    pub ln_e: Vec<f64>,
    /// Its derivatives by the time of the impact before, its own and the one after.
    pub slopes: Vec<[f64; 3]>,
    /// Number of fitted parameters.
    pub parameters: usize,
    /// Derivative of ln e of each bounce by each fitted parameter; 1 for θ first, 0 past the last.
    pub design: Vec<[f64; MOST_PARAMETERS]>,
    /// ln of the derivative of ln e by the flight after each bounce, …
    pub ln_stretch: Vec<f64>,
    /// … and its derivative by each fitted parameter.
    pub stretching: Vec<[f64; MOST_PARAMETERS]>,
    /// `ln(e/e₀)` by gravity in contact at the mean speed: θ is ln e there, and e₀ that of fast impacts.
    pub middle_loss: f64,
    /// Mean ln of the speed of arrival, as the length of its flight without air in seconds: `ln(2v/g)`.
    pub mean_ln_speed: f64,
}

impl Bounces {
    /// Linearised around trial times. None if a flight is not longer than the contact.
    pub(super) fn around(
        trial_s: &[f64],
        observed: &[Impact],
        terms: &Terms,
        values: Values,
    ) -> Option<Self> {
        let law = TrialLaw::of(trial_s, terms, values)?;
        let flights = trial_law::flights(trial_s, values, &law)?;
        let arriving = &flights[..flights.len() - 1];
        let speeds: Vec<f64> = arriving.iter().map(|f| f.ends.ln_landing).collect();
        let mean_ln_speed = trial_law::mean(speeds.iter().copied());
        let (lost, middle_loss) = law.losses(values, &speeds, mean_ln_speed);
        let ln_restitution = values.ln_fast_restitution + middle_loss;
        let off_s: Vec<f64> = observed
            .iter()
            .zip(trial_s)
            .map(|(i, t)| i.time_s - t)
            .collect();
        let pairs = || flights.windows(2).map(|w| (&w[0], &w[1])).zip(&lost);
        let slopes: Vec<[f64; 3]> = pairs()
            .map(|((before, after), lost)| {
                let landing = before.ends.landing_slope * (1.0 + lost.by_ln_flight);
                let leaving = after.ends.leaving_slope;
                [landing, -landing - leaving, leaving]
            })
            .collect();
        let ln_e = pairs()
            .zip(&slopes)
            .zip(off_s.windows(3))
            .map(|((((before, after), lost), slopes), off)| {
                let moved: f64 = slopes.iter().zip(off).map(|(s, o)| s * o).sum();
                let observed = after.ends.ln_leaving - before.ends.ln_landing + moved;
                // Linear around the trial's θ: the part of the loss that follows from θ is no observation.
                observed - lost.ln + lost.by_restitution * ln_restitution
            })
            .collect();
        let (design, stretching) = pairs()
            .zip(&speeds)
            .map(|(((before, after), lost), speed)| {
                terms.dependence(before, after, lost, mean_ln_speed - speed)
            })
            .unzip();
        Some(Self {
            ln_e,
            ln_stretch: slopes.iter().map(|s| s[2].ln()).collect(),
            slopes,
            parameters: 1 + terms.count(),
            design,
            stretching,
            middle_loss,
            mean_ln_speed,
        })
    }
}

impl Terms {
    /// Numbers of C and K among the fitted parameters, θ being number 0.
    pub(super) fn places(&self) -> [Option<usize>; 2] {
        let contact = self.contact.map(|_| 1);
        let drag = self.drag.map(|_| 1 + usize::from(contact.is_some()));
        [contact, drag]
    }

    /// Number of parameters fitted beside θ.
    pub(super) fn count(&self) -> usize {
        let terms = [self.contact, self.drag, self.speed];
        terms.iter().filter(|t| t.is_some()).count()
    }

    /// Derivatives by each fitted parameter of ln e of a bounce, and of ln of its derivative by the flight after it.
    fn dependence(
        &self,
        before: &Flight,
        after: &Flight,
        lost: &Loss,
        slower: f64,
    ) -> ([f64; MOST_PARAMETERS], [f64; MOST_PARAMETERS]) {
        let (shorter_before, shorter_after) = (before.shorter, after.shorter);
        let (before, after) = (&before.ends, &after.ends);
        // A longer contact means shorter flights: D stays, T = D − C.
        let contact = (
            after.leaving_slope * shorter_after - before.landing_slope * shorter_before
                + lost.by_contact,
            after.leaving_slope * shorter_after,
        );
        // τ·d(ln a)/dτ = 1 + K·T²/8 + …, and ln u(T) = ln T + K·T²/16 + …
        let drag = (
            before.landing_by_drag - after.leaving_by_drag,
            2.0 * after.leaving_by_drag,
        );
        let fitted = [
            Some((1.0 + lost.by_restitution, 0.0)),
            self.contact.map(|_| contact),
            self.drag.map(|_| drag),
            self.speed.map(|_| (slower, 0.0)),
        ];
        let (mut design, mut stretching) = ([0.0; MOST_PARAMETERS], [0.0; MOST_PARAMETERS]);
        for (i, term) in fitted.into_iter().flatten().enumerate() {
            (design[i], stretching[i]) = term;
        }
        (design, stretching)
    }
}
