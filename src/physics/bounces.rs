//! A ball of constant restitution and contact time, from release to rest: equations (18) to (25), (28) and (30).

use super::{Restitution, check};
use crate::Error;

/// The bounces of a ball dropped from rest, with the same restitution and contact time at each, without drag.
///
/// In the formulas `h0` is [`height_m`](Self::height_m), `g` [`gravity_m_per_s2`](Self::gravity_m_per_s2), `e` the
/// restitution and `n` the number of bounces. `n` impacts bound `n − 1` whole flights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BounceSeries {
    height_m: f64,
    gravity_m_per_s2: f64,
}

impl BounceSeries {
    /// A ball released from rest `height_m` above the surface, measured at its lowest point.
    ///
    /// # Errors
    /// [`Error::Argument`] naming `height_m` or `gravity_m_per_s2` where it is not positive and finite.
    pub fn new(height_m: f64, gravity_m_per_s2: f64) -> Result<Self, Error> {
        Ok(Self {
            height_m: check::positive("height_m", height_m)?,
            gravity_m_per_s2: check::positive("gravity_m_per_s2", gravity_m_per_s2)?,
        })
    }

    /// Height of release.
    #[must_use]
    pub const fn height_m(&self) -> f64 {
        self.height_m
    }

    /// Acceleration of free fall.
    #[must_use]
    pub const fn gravity_m_per_s2(&self) -> f64 {
        self.gravity_m_per_s2
    }

    /// `√(h0/g)`, the unit of time of the whole series.
    pub(super) fn time_scale_s(&self) -> f64 {
        libm::sqrt(self.height_m / self.gravity_m_per_s2)
    }

    /// Time of the first fall.
    ///
    /// ```text
    /// T_0/2 = √(2h0/g)
    /// ```
    #[must_use]
    pub fn first_fall_s(&self) -> f64 {
        libm::sqrt(2.0 * self.height_m / self.gravity_m_per_s2)
    }

    /// Speed of the first impact, `v0`.
    ///
    /// ```text
    /// v0 = √(2·g·h0)
    /// ```
    #[must_use]
    pub fn first_impact_speed_m_per_s(&self) -> f64 {
        libm::sqrt(2.0 * self.gravity_m_per_s2 * self.height_m)
    }

    /// Height after bounce `i`; 0 where it underflows.
    ///
    /// ```text
    /// (18)  h_i = e^(2i)·h0
    /// ```
    #[must_use]
    pub fn height_after_m(&self, restitution: Restitution, bounce: usize) -> f64 {
        restitution.power(2.0 * crate::units::real(bounce)) * self.height_m
    }

    /// Duration of the flight after bounce `i`; 0 where it underflows.
    ///
    /// ```text
    /// T_i = e^i·T_0,   T_0 = 2·√(2h0/g)
    /// ```
    #[must_use]
    pub fn flight_after_s(&self, restitution: Restitution, bounce: usize) -> f64 {
        2.0 * restitution.power(crate::units::real(bounce)) * self.first_fall_s()
    }

    /// After how many bounces the rest condition holds: round up for a count. 0 if it holds before the first.
    ///
    /// ```text
    /// (19)  h_n = e^(2n)·h0 ≤ mg/k   ⇔   n ≥ ln(ΔT/√((h0/g)·(π² + (ln e)²))) / ln e
    /// ```
    ///
    /// `ΔT` is `contact_time_s`. This is the paper's condition; the ball of equation (3) stops leaving at another speed,
    /// see [`LinearContact::least_leaving_speed_m_per_s`](super::LinearContact::least_leaving_speed_m_per_s).
    ///
    /// # Errors
    /// [`Error::Argument`] where the contact time is not positive and finite, or the ball is elastic and never rests.
    pub fn bounces_to_rest(
        &self,
        restitution: Restitution,
        contact_time_s: f64,
    ) -> Result<f64, Error> {
        let contact_time = check::positive("contact_time_s", contact_time_s)?;
        if restitution.ln() >= 0.0 {
            return Err(Error::argument(
                "restitution",
                restitution.value(),
                "0 < e < 1",
            ));
        }
        let at_once = self.time_scale_s() * restitution.pi_norm();
        let decay = libm::log(contact_time / at_once);
        Ok((decay / restitution.ln()).max(0.0))
    }

    /// Contact time with which the ball comes to rest after exactly `n` bounces; 0 where it underflows.
    ///
    /// ```text
    /// (20)  ΔT = eⁿ·√((h0/g)·(π² + (ln e)²))
    /// ```
    ///
    /// Since ΔT ∝ eⁿ this amplifies an error of e some n times, see
    /// [`contact_time_amplification`](Self::contact_time_amplification); the paper puts e rounded to two digits in.
    ///
    /// # Errors
    /// [`Error::Argument`] naming `bounces` where it is 0.
    pub fn rest_contact_time_s(
        &self,
        restitution: Restitution,
        bounces: usize,
    ) -> Result<f64, Error> {
        let n = check::bounces("bounces", bounces)?;
        Ok(restitution.power(n) * self.time_scale_s() * restitution.pi_norm())
    }

    /// The same for a lively ball; 0 where it underflows.
    ///
    /// ```text
    /// (28)  ΔT ≅ eⁿ·π·√(h0/g)      for |ln e| ≪ π
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] naming `bounces` where it is 0.
    pub fn rest_contact_time_approx_s(
        &self,
        restitution: Restitution,
        bounces: usize,
    ) -> Result<f64, Error> {
        let n = check::bounces("bounces", bounces)?;
        Ok(restitution.power(n) * self.time_scale_s() * std::f64::consts::PI)
    }

    /// Factor by which (20) magnifies a relative error of e: the condition of every ΔT that comes from it.
    ///
    /// ```text
    /// d ln ΔT / d ln e = n + ln e/(π² + (ln e)²)      ≈ n
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] naming `bounces` where it is 0.
    pub fn contact_time_amplification(
        restitution: Restitution,
        bounces: usize,
    ) -> Result<f64, Error> {
        let n = check::bounces("bounces", bounces)?;
        let norm = restitution.pi_norm();
        Ok(n + restitution.ln() / norm / norm)
    }

    /// Time in the air until the n-th impact.
    ///
    /// ```text
    /// (22)  T_flight = T_0/2 + T_1 + … + T_(n−1)
    /// (24)           = √(2h0/g)·(1 + e − 2eⁿ)/(1 − e)
    /// ```
    ///
    /// The paper's (22) adds `T_n`, but its closed form does not, and is right. The paper's (24) prints the bracket under
    /// the root; the derivation, and the paper's own numbers, have it beside.
    ///
    /// # Errors
    /// [`Error::Argument`] naming `bounces` where it is 0.
    pub fn flight_time_s(&self, restitution: Restitution, bounces: usize) -> Result<f64, Error> {
        let n = check::bounces("bounces", bounces)?;
        Ok(self.first_fall_s() * (1.0 + later_flights(restitution, n)))
    }

    /// Time from release to rest for a known contact time.
    ///
    /// ```text
    /// (21)  T_total = T_flight + T_contact
    /// (23)  T_contact = n·ΔT
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] where `bounces` is 0 or the contact time is negative or not finite.
    pub fn total_time_with_contact_s(
        &self,
        restitution: Restitution,
        bounces: usize,
        contact_time_s: f64,
    ) -> Result<f64, Error> {
        let contact = check::non_negative("contact_time_s", contact_time_s)?;
        let flight = self.flight_time_s(restitution, bounces)?;
        Ok(flight + crate::units::real(bounces) * contact)
    }

    /// Time from release to rest of the ball whose contact time is that of (20).
    ///
    /// ```text
    /// (25)  T_total = √(h0/g)·[√2·(1 + e − 2eⁿ)/(1 − e) + n·eⁿ·√(π² + (ln e)²)]
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] naming `bounces` where it is 0.
    pub fn total_time_s(&self, restitution: Restitution, bounces: usize) -> Result<f64, Error> {
        let contact = self.rest_contact_time_s(restitution, bounces)?;
        let flight = self.flight_time_s(restitution, bounces)?;
        Ok(flight + crate::units::real(bounces) * contact)
    }

    /// Time from release to rest of a ball that bounces without end and without contact time.
    ///
    /// ```text
    /// (30)  T_total ≅ √(2h0/g)·(1 + e)/(1 − e)      for large n
    /// ```
    ///
    /// The paper prints the bracket under the root, as in (24).
    ///
    /// # Errors
    /// [`Error::Argument`] where the ball is elastic: it never rests.
    pub fn total_time_approx_s(&self, restitution: Restitution) -> Result<f64, Error> {
        if restitution.one_minus() > 0.0 {
            Ok(self.first_fall_s() * ((1.0 + restitution.value()) / restitution.one_minus()))
        } else {
            Err(Error::argument(
                "restitution",
                restitution.value(),
                "0 < e < 1",
            ))
        }
    }
}

/// Flights after the first fall, in units of that fall.
///
/// ```text
/// 2e + 2e² + … + 2e^(n−1) = 2·(1 − e^(n−1))/(1/e − 1)
/// ```
///
/// The difference 1 + e − 2eⁿ of (24) cancels as e → 1; here every term is positive.
pub(super) fn later_flights(restitution: Restitution, n: f64) -> f64 {
    let loss = -restitution.ln();
    if loss > 0.0 {
        -2.0 * libm::expm1((1.0 - n) * loss) / libm::expm1(loss)
    } else {
        2.0 * (n - 1.0)
    }
}
