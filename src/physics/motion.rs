//! Position and speed during contact: equations (3), (7), (8) and (11).

use super::{LinearContact, Oscillator, check};
use crate::Error;

/// The two basic motions of the damped oscillator, at a time in units of `1/ω_n`.
///
/// ```text
/// S = exp(−ζτ)·sin(sτ)/s,   C = exp(−ζτ)·cos(sτ),   S′ = C − ζS,   K = 1 − C − ζS = ∫₀^τ S
/// ```
struct Basis {
    /// S.
    sine: f64,
    /// S′.
    slope: f64,
    /// K.
    sag: f64,
}

/// Up to this τ the series of K converges in [`SAG_TERMS`] terms; above it, 1 − C − ζS no longer cancels.
const SAG_SERIES_BELOW: f64 = 0.5;
const SAG_TERMS: u32 = 24;

impl Basis {
    fn at(zeta: f64, tau: f64) -> Self {
        let s_squared = (1.0 - zeta) * (1.0 + zeta);
        let s = libm::sqrt(s_squared.abs());
        let angle = s * tau;
        let (sine, cosine) = if s_squared > 0.0 {
            let decay = libm::exp(-zeta * tau);
            (decay * libm::sin(angle) / s, decay * libm::cos(angle))
        } else {
            // The sum and difference of two decays; as sinh and cosh times exp(−ζτ) they would overflow.
            let slow = libm::exp(-tau / (zeta + s));
            let gap = -libm::expm1(-2.0 * angle);
            let sine = if s > 0.0 {
                0.5 * slow * gap / s
            } else {
                tau * slow
            };
            (sine, slow * (1.0 - 0.5 * gap))
        };
        let slope = if s_squared < -0.25 {
            // C − ζS cancels as the fast decay dies out; here it is left out by itself.
            let (fast, slow) = (zeta + s, 1.0 / (zeta + s));
            (fast * libm::exp(-fast * tau) - slow * libm::exp(-slow * tau)) / (2.0 * s)
        } else {
            cosine - zeta * sine
        };
        let sag = if tau < SAG_SERIES_BELOW && zeta * tau < SAG_SERIES_BELOW {
            sag_series(zeta, tau)
        } else {
            1.0 - cosine - zeta * sine
        };
        Self { sine, slope, sag }
    }
}

/// `K` from its differential equation K″ + 2ζK′ + K = 1: each term follows from the two before.
fn sag_series(zeta: f64, tau: f64) -> f64 {
    let (mut before, mut term) = (0.0, 0.5 * tau * tau);
    let mut sum = term;
    for order in 2..SAG_TERMS {
        let order = f64::from(order);
        let next = -tau * (2.0 * zeta * term + tau * before / order) / (order + 1.0);
        (before, term) = (term, next);
        sum += next;
    }
    sum
}

impl LinearContact {
    /// Position at a time after touching, with the weight kept; holds from touching to leaving.
    ///
    /// ```text
    /// (3)  x = [((cg − 2kv0)/(2kω_d))·sin ω_d·t + (mg/k)·cos ω_d·t]·exp(−ct/2m) − mg/k
    /// (7)    = −(v0/ω_n)·S − (g/ω_n²)·(1 − C − ζS)
    /// S = exp(−ζω_n·t)·sin(ω_d·t)·ω_n/ω_d,   C = exp(−ζω_n·t)·cos(ω_d·t)
    /// ```
    ///
    /// `v0` is `speed_m_per_s`, `t` is `time_s`. The paper's (7) prints c/(2mω); it is `c/(2mω_d)`. Beyond critical
    /// damping sin and cos go over into sinh and cosh.
    ///
    /// # Errors
    /// [`Error::Argument`] where the speed is not positive, the time is negative, or either is not finite.
    pub fn position_m(&self, speed_m_per_s: f64, time_s: f64) -> Result<f64, Error> {
        let speed = check::positive("speed_m_per_s", speed_m_per_s)?;
        let time = check::non_negative("time_s", time_s)?;
        let frequency = self.oscillator().natural_frequency_rad_per_s();
        let basis = Basis::at(self.oscillator().damping_ratio(), frequency * time);
        let sag = self.gravity_m_per_s2() / frequency / frequency;
        Ok(-speed / frequency * basis.sine - sag * basis.sag)
    }

    /// Velocity at a time after touching, upward positive: the derivative of (3).
    ///
    /// ```text
    /// ẋ = −v0·(C − ζS) − (g/ω_n)·S
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] where the speed is not positive, the time is negative, or either is not finite.
    pub fn velocity_m_per_s(&self, speed_m_per_s: f64, time_s: f64) -> Result<f64, Error> {
        let speed = check::positive("speed_m_per_s", speed_m_per_s)?;
        let time = check::non_negative("time_s", time_s)?;
        let frequency = self.oscillator().natural_frequency_rad_per_s();
        let basis = Basis::at(self.oscillator().damping_ratio(), frequency * time);
        Ok(-speed * basis.slope - self.gravity_m_per_s2() / frequency * basis.sine)
    }
}

impl Oscillator {
    /// Position at a time after touching, with the weight left aside.
    ///
    /// ```text
    /// (8)  x = −(v0/ω_d)·exp(−ct/2m)·sin ω_d·t
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] where the speed is not positive, the time is negative, or either is not finite.
    pub fn weightless_position_m(&self, speed_m_per_s: f64, time_s: f64) -> Result<f64, Error> {
        let speed = check::positive("speed_m_per_s", speed_m_per_s)?;
        let time = check::non_negative("time_s", time_s)?;
        let frequency = self.natural_frequency_rad_per_s();
        let basis = Basis::at(self.damping_ratio(), frequency * time);
        Ok(-speed / frequency * basis.sine)
    }

    /// Velocity at a time after touching, with the weight left aside, upward positive.
    ///
    /// ```text
    /// (11)  ẋ = (c·v0/(2mω_d))·exp(−ct/2m)·sin ω_d·t − v0·exp(−ct/2m)·cos ω_d·t
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] where the speed is not positive, the time is negative, or either is not finite.
    pub fn weightless_velocity_m_per_s(
        &self,
        speed_m_per_s: f64,
        time_s: f64,
    ) -> Result<f64, Error> {
        let speed = check::positive("speed_m_per_s", speed_m_per_s)?;
        let time = check::non_negative("time_s", time_s)?;
        let frequency = self.natural_frequency_rad_per_s();
        Ok(-speed * Basis::at(self.damping_ratio(), frequency * time).slope)
    }
}
