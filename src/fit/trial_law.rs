//! Trial laws: contact and loss at each impact by trial values of the parameters, with derivatives for the linear fit.
//!
//! All impacts are alike, of a linear ball with gravity in contact, or of viscoelastic spheres;
//! [`RestitutionLaw`](crate::physics::RestitutionLaw) has the formulas of the last.

use super::bounces::{ImpactLaw, Values};
use crate::physics::ends::Ends;
use crate::physics::{InterpolatedContact, VISCOELASTIC_POWER};
use crate::units::real;

/// A flight.
pub(super) struct Flight {
    pub ends: Ends,
    /// Derivative of the contact before it by C, by which it gets shorter: 1 but for a linear ball.
    pub shorter: f64,
}

/// The law's loss of ln e at one bounce, less that at the speed of reference, where ln e is θ.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Loss {
    pub ln: f64,
    /// Its derivatives by θ, by C, and by ln of the flight before.
    pub by_restitution: f64,
    pub by_contact: f64,
    pub by_ln_flight: f64,
}

/// The law at trial values of the parameters.
pub(super) struct TrialLaw {
    law: TrialKind,
    ln_restitution: f64,
}

enum TrialKind {
    Alike,
    Linear(InterpolatedContact),
    Viscoelastic,
}

impl TrialLaw {
    /// None if a ball with these values would not leave.
    pub(super) fn of(trial_s: &[f64], law: ImpactLaw, values: Values) -> Option<Self> {
        let flights = trial_s.windows(2).map(|w| w[1] - w[0] - values.contact_s);
        let shortest = flights.fold(f64::INFINITY, f64::min);
        let ln_restitution = values.ln_fast_restitution;
        let law = match law {
            ImpactLaw::Alike => TrialKind::Alike,
            ImpactLaw::Linear => TrialKind::Linear(InterpolatedContact::of(
                ln_restitution,
                values.contact_s / shortest,
            )?),
            ImpactLaw::Viscoelastic => TrialKind::Viscoelastic,
        };
        Some(Self {
            law,
            ln_restitution,
        })
    }

    /// The losses at these ln speeds of arrival (as flights in seconds), beyond that at the reference, and `ln(e/e₀)`
    /// there, e₀ being that of fast impacts.
    pub(super) fn losses(
        &self,
        values: Values,
        ln_speeds: &[f64],
        reference: f64,
    ) -> (Vec<Loss>, f64) {
        match &self.law {
            TrialKind::Alike => (vec![Loss::default(); ln_speeds.len()], 0.0),
            TrialKind::Linear(contact) => {
                self.with_gravity_in_contact(contact, values, ln_speeds, reference)
            }
            TrialKind::Viscoelastic => {
                let lost = |ln_speed: &f64| {
                    let factor = (VISCOELASTIC_POWER * (ln_speed - reference)).exp();
                    Loss {
                        ln: self.ln_restitution * (factor - 1.0),
                        by_restitution: factor - 1.0,
                        by_contact: 0.0,
                        by_ln_flight: self.ln_restitution * VISCOELASTIC_POWER * factor,
                    }
                };
                (ln_speeds.iter().map(lost).collect(), 0.0)
            }
        }
    }

    /// The losses of a linear ball by gravity in contact, counted from that at the speed of reference: the mean of the losses, which
    /// the slowest impacts dominate, belongs to no known speed.
    ///
    /// # Formula
    /// With `δ(s, e₀) ≈ −s·h(e₀)`, `κ = d ln h/d ln e₀ ≈ 1/l − 2l/(π² + l²) − 1/(1 + e₀)`, l = ln e₀, and
    /// `θ = l + δ̄`, δ̄ the loss at the reference: `dl = (dθ − δ̄_C·dC)/(1 + κδ̄)`.
    fn with_gravity_in_contact(
        &self,
        contact: &InterpolatedContact,
        values: Values,
        ln_speeds: &[f64],
        reference: f64,
    ) -> (Vec<Loss>, f64) {
        let at = |ln_speed: f64| {
            let flight_s = ln_speed.exp();
            let s = values.contact_s / flight_s;
            let (ln, slope) = contact.at(s).loss;
            Loss {
                ln,
                by_restitution: 0.0,
                by_contact: slope / flight_s,
                by_ln_flight: -s * slope,
            }
        };
        let middle = at(reference);
        let l = self.ln_restitution;
        let kappa =
            1.0 / l - 2.0 * l / (std::f64::consts::PI.powi(2) + l * l) - 1.0 / (1.0 + l.exp());
        let by_fast = kappa / (1.0 + kappa * middle.ln).max(LEAST_SLOPE);
        let beyond = |ln_speed: &f64| {
            let own = at(*ln_speed);
            let ln = own.ln - middle.ln;
            let by_restitution = by_fast * ln;
            Loss {
                ln,
                by_restitution,
                by_contact: own.by_contact - (1.0 + by_restitution) * middle.by_contact,
                by_ln_flight: own.by_ln_flight,
            }
        };
        (ln_speeds.iter().map(beyond).collect(), middle.ln)
    }

    /// The contact after a flight of this length, and its derivative by C.
    fn contact(&self, contact_s: f64, flight_s: f64) -> (f64, f64) {
        let TrialKind::Linear(contact) = &self.law else {
            return (contact_s, 1.0);
        };
        let s = contact_s / flight_s;
        let (longer, slope) = contact.at(s).longer;
        (contact_s * longer, longer + s * slope)
    }
}

/// Least derivative of θ by `ln e₀`.
const LEAST_SLOPE: f64 = 0.2;

/// The flights between trial times. None if one is not longer than the contact before it.
pub(super) fn flights(trial_s: &[f64], values: Values, law: &TrialLaw) -> Option<Vec<Flight>> {
    // The flight before the first interval was longer by 1/e.
    let first_s = trial_s[1] - trial_s[0] - values.contact_s;
    let mut before_s = first_s / law.ln_restitution.exp();
    let flight = |w: &[f64]| {
        let (contact_s, shorter) = law.contact(values.contact_s, before_s);
        let ends = Ends::of(w[1] - w[0] - contact_s, values.drag_per_s2)?;
        before_s = ends.ln_landing.exp();
        Some(Flight { ends, shorter })
    };
    trial_s.windows(2).map(flight).collect()
}

pub(super) fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = real(values.len().max(1));
    values.sum::<f64>() / count
}
