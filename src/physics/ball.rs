//! The ball as mass, spring and damper: equations (2), (4), (5), (9), (12) to (17), (26), (27) and (29).

use std::f64::consts::PI;

use super::{Restitution, check};
use crate::Error;

/// The ball per unit of mass: all that its motion depends on.
///
/// In the formulas `ω_n` is [`natural_frequency_rad_per_s`](Self::natural_frequency_rad_per_s), `ζ`
/// [`damping_ratio`](Self::damping_ratio), `e` the restitution and `ΔT` the contact time. The equations of the paper
/// take the ball to leave at zero displacement and leave its weight aside during contact; [`LinearContact`] does
/// neither.
///
/// [`LinearContact`]: super::LinearContact
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Oscillator {
    natural_frequency_rad_per_s: f64,
    damping_ratio: f64,
}

impl Oscillator {
    /// From natural frequency and damping ratio.
    ///
    /// # Errors
    /// [`Error::Argument`] where the frequency is not positive, the damping ratio is negative, or either is not finite.
    pub fn new(natural_frequency_rad_per_s: f64, damping_ratio: f64) -> Result<Self, Error> {
        Ok(Self {
            natural_frequency_rad_per_s: check::positive(
                "natural_frequency_rad_per_s",
                natural_frequency_rad_per_s,
            )?,
            damping_ratio: check::non_negative("damping_ratio", damping_ratio)?,
        })
    }

    /// The ball with this restitution and contact time.
    ///
    /// ```text
    /// (16)  ω_n = √(π² + (ln e)²)/ΔT
    /// (17)  ζ = −ln e/√(π² + (ln e)²)
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] naming `contact_time_s` where it is not positive and finite.
    pub fn from_contact(restitution: Restitution, contact_time_s: f64) -> Result<Self, Error> {
        let contact_time = check::positive("contact_time_s", contact_time_s)?;
        Ok(Self {
            natural_frequency_rad_per_s: restitution.pi_norm() / contact_time,
            damping_ratio: damping_ratio(restitution),
        })
    }

    /// `ω_n = √(k/m)`.
    #[must_use]
    pub const fn natural_frequency_rad_per_s(&self) -> f64 {
        self.natural_frequency_rad_per_s
    }

    /// `ζ = c/(2√(km))`.
    #[must_use]
    pub const fn damping_ratio(&self) -> f64 {
        self.damping_ratio
    }

    /// `k/m = ω_n²`, in s⁻² (the paper prints s²).
    #[must_use]
    pub fn stiffness_per_mass_per_s2(&self) -> f64 {
        self.natural_frequency_rad_per_s * self.natural_frequency_rad_per_s
    }

    /// `c/m = 2ζω_n`, in s⁻¹.
    #[must_use]
    pub fn damping_per_mass_per_s(&self) -> f64 {
        2.0 * self.damping_ratio * self.natural_frequency_rad_per_s
    }

    /// Frequency at which the damped ball would swing.
    ///
    /// ```text
    /// (4)  ω_d = √(4km − c²)/(2m) = ω_n·√((1 − ζ)(1 + ζ))
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] naming `damping_ratio` from 1 up: then it does not swing.
    pub fn damped_frequency_rad_per_s(&self) -> Result<f64, Error> {
        Ok(self.natural_frequency_rad_per_s * self.underdamping()?)
    }

    /// Contact time with the weight left aside.
    ///
    /// ```text
    /// (9)  ΔT = π/ω_d
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] naming `damping_ratio` from 1 up.
    pub fn contact_time_s(&self) -> Result<f64, Error> {
        Ok(PI / self.damped_frequency_rad_per_s()?)
    }

    /// Contact time of a lightly damped ball.
    ///
    /// ```text
    /// (27)  ΔT ≅ π/ω_n      for ζ² ≪ 1
    /// ```
    #[must_use]
    pub fn contact_time_approx_s(&self) -> f64 {
        PI / self.natural_frequency_rad_per_s
    }

    /// Restitution with the weight left aside; [`Restitution::ELASTIC`] without damping.
    ///
    /// ```text
    /// (12)  v1 = v0·e
    /// (13)  e = exp(−cπ/(2mω_d)) = exp(−πζ/√((1 − ζ)(1 + ζ)))
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] naming `damping_ratio` from 1 up.
    pub fn restitution(&self) -> Result<Restitution, Error> {
        let underdamping = self.underdamping()?;
        Ok(Restitution::from_trusted_ln(
            -PI * self.damping_ratio / underdamping,
        ))
    }

    /// Static compression of the resting ball.
    ///
    /// ```text
    /// (5)  x* = −mg/k = −g/ω_n²
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] naming `gravity_m_per_s2` where it is not positive and finite.
    pub fn rest_position_m(&self, gravity_m_per_s2: f64) -> Result<f64, Error> {
        let gravity = check::positive("gravity_m_per_s2", gravity_m_per_s2)?;
        Ok(-gravity / self.natural_frequency_rad_per_s / self.natural_frequency_rad_per_s)
    }

    /// `√(1 − ζ²)`, from factors so that ζ near 1 keeps its distance from it.
    pub(super) fn underdamping(&self) -> Result<f64, Error> {
        if self.damping_ratio < 1.0 {
            Ok(libm::sqrt(
                (1.0 - self.damping_ratio) * (1.0 + self.damping_ratio),
            ))
        } else {
            Err(Error::argument(
                "damping_ratio",
                self.damping_ratio,
                "0 ≤ ζ < 1 (c² < 4km)",
            ))
        }
    }
}

/// Damping ratio of a ball with this restitution.
///
/// ```text
/// (17)  ζ = −ln e/√(π² + (ln e)²)
/// ```
#[must_use]
pub fn damping_ratio(restitution: Restitution) -> f64 {
    -restitution.ln() / restitution.pi_norm()
}

/// The same for a lively ball.
///
/// ```text
/// (29)  ζ ≅ −ln e/π      for |ln e| ≪ π
/// ```
#[must_use]
pub fn damping_ratio_approx(restitution: Restitution) -> f64 {
    -restitution.ln() / PI
}

/// Mass, stiffness and damping: equation (2).
///
/// ```text
/// (2)  m·ẍ + c·ẋ + k·x = −m·g      x(0) = 0, ẋ(0) = −v0
/// ```
///
/// `m` is [`mass_kg`](Self::mass_kg), `k` [`stiffness_n_per_m`](Self::stiffness_n_per_m), `c`
/// [`damping_n_s_per_m`](Self::damping_n_s_per_m).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ball {
    mass_kg: f64,
    stiffness_n_per_m: f64,
    damping_n_s_per_m: f64,
}

impl Ball {
    /// From mass, stiffness and damping.
    ///
    /// # Errors
    /// [`Error::Argument`] where mass or stiffness is not positive, damping is negative, or any is not finite.
    pub fn new(
        mass_kg: f64,
        stiffness_n_per_m: f64,
        damping_n_s_per_m: f64,
    ) -> Result<Self, Error> {
        Ok(Self {
            mass_kg: check::positive("mass_kg", mass_kg)?,
            stiffness_n_per_m: check::positive("stiffness_n_per_m", stiffness_n_per_m)?,
            damping_n_s_per_m: check::non_negative("damping_n_s_per_m", damping_n_s_per_m)?,
        })
    }

    /// The ball of this mass with this restitution and contact time.
    ///
    /// ```text
    /// (14)  k = (m/ΔT²)·(π² + (ln e)²)
    /// (15)  c = −(2m/ΔT)·ln e
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] where mass or contact time is not positive and finite.
    pub fn from_contact(
        mass_kg: f64,
        restitution: Restitution,
        contact_time_s: f64,
    ) -> Result<Self, Error> {
        let mass = check::positive("mass_kg", mass_kg)?;
        let oscillator = Oscillator::from_contact(restitution, contact_time_s)?;
        Ok(Self {
            mass_kg,
            stiffness_n_per_m: mass * oscillator.stiffness_per_mass_per_s2(),
            damping_n_s_per_m: -2.0 * mass / contact_time_s * restitution.ln(),
        })
    }

    /// Mass.
    #[must_use]
    pub const fn mass_kg(&self) -> f64 {
        self.mass_kg
    }

    /// Stiffness of the spring. (The paper's "N/mm (or kPa)" is N/mm: a stiffness is no pressure.)
    #[must_use]
    pub const fn stiffness_n_per_m(&self) -> f64 {
        self.stiffness_n_per_m
    }

    /// Damping coefficient.
    #[must_use]
    pub const fn damping_n_s_per_m(&self) -> f64 {
        self.damping_n_s_per_m
    }

    /// The same ball per unit of mass: `ω_n = √(k/m)`, `ζ = c/(2√(km))`.
    #[must_use]
    pub fn oscillator(&self) -> Oscillator {
        Oscillator {
            natural_frequency_rad_per_s: libm::sqrt(self.stiffness_n_per_m / self.mass_kg),
            damping_ratio: 0.5 * self.damping_n_s_per_m
                / libm::sqrt(self.stiffness_n_per_m * self.mass_kg),
        }
    }

    /// Stiffness of a lively ball with this contact time.
    ///
    /// ```text
    /// (26)  k ≅ m·(π/ΔT)²      for |ln e| ≪ π
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] where mass or contact time is not positive and finite.
    pub fn stiffness_approx_n_per_m(mass_kg: f64, contact_time_s: f64) -> Result<f64, Error> {
        let mass = check::positive("mass_kg", mass_kg)?;
        let frequency = PI / check::positive("contact_time_s", contact_time_s)?;
        Ok(mass * frequency * frequency)
    }
}
