//! The observation of ln e by each bounce, linearised in the times and in the parameters of the model.

use super::bend::{BENDS, Bends};
use super::trial_law::{self, Flight, Loss, TrialLaw};
use crate::impact::Impact;
use crate::physics::priors::Known;

/// A model of the intervals: constant e, and what is added to it. What is not has the value 0.
///
/// # Formula
/// ```text
/// D_i = T_i + C,   ln e(v_j) = ln u(T_j) − ln w(T_{j−1}) = θ − p·ln(v_j/v̄) + A·f(v_j) + σ_e·η_j
/// T = (atan a + arsinh a)/√K,   u ∝ a,   w ∝ a/√(1 + a²),   K = g²/v_t²
/// ```
/// `D_i` are the intervals between impacts, C is the time in contact (s), u and w are the speeds at which the ball
/// leaves and arrives, K is the drag of the air (s⁻²; 1.4 for a ping-pong ball), p is how e falls with speed, f is a
/// smooth departure of unit size ([`Bends`]) that is 0 at v̄, a speed of reference: the geometric mean of the impact speeds
/// where none is given.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Terms {
    /// C in seconds.
    pub contact: Option<Known>,
    /// K in s⁻².
    pub drag: Option<Known>,
    /// p.
    pub speed: Option<Known>,
    /// A.
    pub bend: Option<f64>,
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

/// Places of the parameters: θ, C, K, p, and the weights of the departure's functions.
pub(super) const CONTACT: usize = 1;
pub(super) const DRAG: usize = 2;
pub(super) const SPEED: usize = 3;
pub(super) const FIRST_BEND: usize = 4;
/// Their number.
pub(super) const PARAMETERS: usize = FIRST_BEND + BENDS;

/// The bounces around a trial of times and parameters.
#[derive(Debug, Clone)]
pub(super) struct Bounces {
    /// ln e of each bounce, by the times observed.
    pub ln_e: Vec<f64>,
    /// Its derivatives by the time of the impact before, its own and the one after.
    pub slopes: Vec<[f64; 3]>,
    /// Derivative of ln e of each bounce by each parameter, at the parameter's place.
    pub design: Vec<[f64; PARAMETERS]>,
    /// ln of the derivative of ln e by the flight after each bounce, …
    pub ln_stretch: Vec<f64>,
    /// … and its derivative by C and K.
    pub stretching: Vec<[f64; 2]>,
    /// `ln(e/e₀)` by gravity in contact at the speed of reference: θ is ln e there, and e₀ that of fast impacts.
    pub middle_loss: f64,
    /// ln of the speed of reference, as the length of its flight without air in seconds: `ln(2v/g)`.
    pub reference: f64,
}

impl Bounces {
    /// Linearised around trial times, by a reference of ln speed or else their own mean. None if a flight is not longer than
    /// the contact.
    pub(super) fn around(
        trial_s: &[f64],
        observed: &[Impact],
        law: ImpactLaw,
        values: Values,
        reference: Option<f64>,
    ) -> Option<Self> {
        let law = TrialLaw::of(trial_s, law, values)?;
        let flights = trial_law::flights(trial_s, values, &law)?;
        let arriving = &flights[..flights.len() - 1];
        let ln_speeds: Vec<f64> = arriving.iter().map(|f| f.ends.ln_landing).collect();
        let reference = reference.unwrap_or_else(|| trial_law::mean(ln_speeds.iter().copied()));
        let (lost, middle_loss) = law.losses(values, &ln_speeds, reference);
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
        let bends = Bends::over(&ln_speeds, reference);
        let (design, stretching) = pairs()
            .zip(&ln_speeds)
            .map(|(((before, after), lost), ln_speed)| {
                let mut design = [0.0; PARAMETERS];
                let by_flight = dependence(before, after, lost);
                design[..SPEED].copy_from_slice(&by_flight.0);
                design[SPEED] = reference - ln_speed;
                design[FIRST_BEND..].copy_from_slice(&bends.at(*ln_speed));
                (design, by_flight.1)
            })
            .unzip();
        Some(Self {
            ln_e,
            ln_stretch: slopes.iter().map(|s| s[2].ln()).collect(),
            slopes,
            design,
            stretching,
            middle_loss,
            reference,
        })
    }
}

/// Derivatives by θ, C and K of ln e of a bounce, and by C and K of ln of its derivative by the flight after it.
fn dependence(before: &Flight, after: &Flight, lost: &Loss) -> ([f64; 3], [f64; 2]) {
    let (shorter_before, shorter_after) = (before.shorter, after.shorter);
    let (before, after) = (&before.ends, &after.ends);
    // A longer contact means shorter flights: D stays, T = D − C.
    let stretching = after.leaving_slope * shorter_after;
    let contact = stretching - before.landing_slope * shorter_before + lost.by_contact;
    let drag = before.landing_by_drag - after.leaving_by_drag;
    (
        [1.0 + lost.by_restitution, contact, drag],
        // τ·d(ln a)/dτ = 1 + K·T²/8 + …, and ln u(T) = ln T + K·T²/16 + …
        [stretching, 2.0 * after.leaving_by_drag],
    )
}
