//! Errors of the ball's parameters from errors of restitution and contact time, to first order.

use super::{BounceSeries, InputErrors, Inversion, Restitution, check};
use crate::Error;

/// Standard errors of restitution and contact time, and how they hang together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactErrors {
    /// Standard error of e, absolute.
    pub restitution: f64,
    /// Standard error of ΔT.
    pub contact_time_s: f64,
    /// Correlation of the two errors, −1 to 1: 0 where ΔT was measured by itself, near 1 where (20) made it from e.
    pub correlation: f64,
}

/// Standard errors of a ball's parameters, each relative to its value: 0.01 is one percent.
///
/// Those of k and c hold for k/m and c/m; an error of the mass comes on top, squared and added.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ParameterErrors {
    /// Of k, by (14).
    pub stiffness: f64,
    /// Of c, by (15).
    pub damping: f64,
    /// Of `ω_n`, by (16).
    pub natural_frequency: f64,
    /// Of ζ, by (17).
    pub damping_ratio: f64,
}

impl ParameterErrors {
    /// Errors of (14) to (17).
    ///
    /// ```text
    /// d ln k   = 2L/(π² + L²)·dL − 2·d ln ΔT        L = ln e, dL = de/e
    /// d ln c   = dL/L − d ln ΔT
    /// d ln ω_n = L/(π² + L²)·dL − d ln ΔT
    /// d ln ζ   = π²/(L·(π² + L²))·dL
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] where an error is negative or not finite, the correlation is beyond ±1, the contact time is
    /// not positive, or the restitution is elastic or so small that it underflows.
    pub fn new(
        restitution: Restitution,
        contact_time_s: f64,
        errors: &ContactErrors,
    ) -> Result<Self, Error> {
        let e = restitution.value();
        if e <= 0.0 || restitution.ln() >= 0.0 {
            return Err(Error::argument("restitution", e, "0 < e < 1"));
        }
        let contact_time = check::positive("contact_time_s", contact_time_s)?;
        let relative = [
            check::non_negative("std_error.restitution", errors.restitution)? / e,
            check::non_negative("std_error.contact_time_s", errors.contact_time_s)? / contact_time,
        ];
        if !(-1.0..=1.0).contains(&errors.correlation) {
            let range = "a number from -1 to 1";
            return Err(Error::argument("correlation", errors.correlation, range));
        }
        let combine = |per_ln_e: f64, per_ln_contact_time: f64| {
            let [a, b] = [per_ln_e * relative[0], per_ln_contact_time * relative[1]];
            // Clamped, for with a correlation of ±1 the rounding of a difference of squares may fall below 0.
            libm::sqrt((a * a + b * b + 2.0 * errors.correlation * a * b).max(0.0))
        };
        let (ln, norm) = (restitution.ln(), restitution.pi_norm());
        let pull = ln / norm / norm;
        let pi_share = std::f64::consts::PI / norm;
        Ok(Self {
            stiffness: combine(2.0 * pull, -2.0),
            damping: combine(1.0 / ln, -1.0),
            natural_frequency: combine(pull, -1.0),
            damping_ratio: combine(pi_share * pi_share / ln, 0.0),
        })
    }
}

impl BounceSeries {
    /// Errors of e from (25) or (30) and of the ΔT that (20) makes from it, from those of the inputs.
    ///
    /// ```text
    /// d ln ΔT = (n + L/(π² + L²))·dL + ½·d ln h0 − ½·d ln g      L = ln e
    /// ```
    ///
    /// Here the n-fold amplification of (20) enters the error bar.
    ///
    /// # Errors
    /// [`Error::Argument`] naming what is out of range.
    pub fn rest_contact_errors(
        &self,
        bounces: usize,
        found: &Inversion,
        errors: &InputErrors,
    ) -> Result<ContactErrors, Error> {
        let restitution = found.std_error(errors)?;
        let contact_time = self.rest_contact_time_s(found.restitution, bounces)?;
        let amplification = Self::contact_time_amplification(found.restitution, bounces)?;
        // One entry per input: by how much it moves e, and ln ΔT beyond what e does.
        let parts = [
            (found.per_total_time_per_s * errors.total_time_s, 0.0),
            (
                found.per_height_per_m * errors.height_m,
                0.5 * errors.height_m / self.height_m(),
            ),
            (
                found.per_gravity_s2_per_m * errors.gravity_m_per_s2,
                -0.5 * errors.gravity_m_per_s2 / self.gravity_m_per_s2(),
            ),
            (found.per_contact_time_per_s * errors.contact_time_s, 0.0),
        ];
        let (mut variance, mut covariance) = (0.0, 0.0);
        for (moves_e, direct) in parts {
            let moves_time = amplification * (moves_e / found.restitution.value()) + direct;
            variance += moves_time * moves_time;
            covariance += moves_e * moves_time;
        }
        let relative = libm::sqrt(variance);
        let product = restitution * relative;
        Ok(ContactErrors {
            restitution,
            contact_time_s: contact_time * relative,
            correlation: if product > 0.0 {
                (covariance / product).clamp(-1.0, 1.0)
            } else {
                0.0
            },
        })
    }
}
