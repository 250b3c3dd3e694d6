//! Restitution that depends on the impact speed.

use super::{Restitution, check};
use crate::Error;

/// The power of the impact speed that the loss of viscoelastic spheres goes with: `1 − e ∝ v^(1/5)`, and to second order
/// `ln e ∝ v^(1/5)`.
pub const VISCOELASTIC_POWER: f64 = 0.2;

/// Restitution as a function of the speed of impact.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum RestitutionLaw {
    /// The same at every speed: the paper's assumption.
    Constant(Restitution),
    /// A viscoelastic sphere, to second order; livelier the slower it hits.
    ///
    /// ```text
    /// e = 1 − γ₁·v^(1/5) + γ₂·v^(2/5)
    /// ```
    Viscoelastic {
        /// `γ₁`, in (s/m)^(1/5), > 0.
        gamma1: f64,
        /// `γ₂`, in (s/m)^(2/5), ≥ 0; 3γ₁²/5 follows from theory.
        gamma2: f64,
    },
    /// A power of the speed above a yield speed, constant below it; a plastic ball has p = ¼.
    ///
    /// ```text
    /// e = e_y·(max(v, v_y)/v_y)^(−p)
    /// ```
    Power {
        /// `e_y`.
        restitution_at_yield: Restitution,
        /// `v_y`, > 0.
        yield_speed_m_per_s: f64,
        /// `p`, ≥ 0.
        exponent: f64,
    },
    /// A power of the speed through e at one speed, as it is fitted to the impacts of a drop. Drawn out to speeds where it
    /// would gain, it is 1 less a rounding.
    ///
    /// ```text
    /// e = ē·(v/v̄)^(−p)
    /// ```
    SpeedPower {
        /// `ē`.
        restitution: Restitution,
        /// `v̄`, > 0.
        at_speed_m_per_s: f64,
        /// `p`; below 0 where fast impacts lose less.
        exponent: f64,
    },
    /// Viscoelastic spheres through e at one speed, as they are fitted to the impacts of a drop: right to `0.1·y²` of the
    /// theory's series `1 − e = y − ⅗y² + …` in `y ∝ v^(1/5)` (Ramírez, Pöschel, Brilliantov and Schwager 1999).
    ///
    /// ```text
    /// ln e = ln ē·(v/v̄)^(1/5)
    /// ```
    FifthRoot {
        /// `ē`.
        restitution: Restitution,
        /// `v̄`, > 0.
        at_speed_m_per_s: f64,
    },
}

/// The least loss of a law that is drawn out to any speed: however far, no ball gains.
const LEAST_LN_LOSS: f64 = f64::EPSILON;

impl RestitutionLaw {
    /// Restitution at an impact speed.
    ///
    /// # Errors
    /// [`Error::Argument`] where a parameter or the speed is out of range, or the law leaves 0 < e < 1 at this or a
    /// lower speed.
    pub fn at(&self, speed_m_per_s: f64) -> Result<Restitution, Error> {
        let speed = check::positive("speed_m_per_s", speed_m_per_s)?;
        match *self {
            Self::Constant(restitution) => check_lossy(restitution)?,
            Self::Viscoelastic { gamma1, gamma2 } => check_viscoelastic(gamma1, gamma2, speed)?,
            Self::Power {
                restitution_at_yield,
                yield_speed_m_per_s,
                exponent,
            } => {
                check_lossy(restitution_at_yield)?;
                check::positive("yield_speed_m_per_s", yield_speed_m_per_s)?;
                check::non_negative("exponent", exponent)?;
            }
            Self::SpeedPower {
                restitution,
                at_speed_m_per_s,
                exponent,
            } => {
                check_lossy(restitution)?;
                check::positive("at_speed_m_per_s", at_speed_m_per_s)?;
                check::non_negative("exponent", exponent.abs())?;
            }
            Self::FifthRoot {
                restitution,
                at_speed_m_per_s,
            } => {
                check_lossy(restitution)?;
                check::positive("at_speed_m_per_s", at_speed_m_per_s)?;
            }
        }
        Ok(self.at_trusted(speed))
    }

    /// The same for a law that was checked at a higher speed.
    pub(super) fn at_trusted(&self, speed: f64) -> Restitution {
        match *self {
            Self::Constant(restitution) => restitution,
            Self::Viscoelastic { gamma1, gamma2 } => {
                let root = libm::pow(speed, VISCOELASTIC_POWER);
                Restitution::from_trusted_loss(root * (gamma1 - gamma2 * root))
            }
            Self::Power {
                restitution_at_yield,
                yield_speed_m_per_s,
                exponent,
            } => {
                let excess = libm::log((speed / yield_speed_m_per_s).max(1.0));
                Restitution::from_trusted_ln(restitution_at_yield.ln() - exponent * excess)
            }
            Self::SpeedPower {
                restitution,
                at_speed_m_per_s,
                exponent,
            } => {
                let ln = restitution.ln() - exponent * libm::log(speed / at_speed_m_per_s);
                Restitution::from_trusted_ln(ln.min(-LEAST_LN_LOSS))
            }
            Self::FifthRoot {
                restitution,
                at_speed_m_per_s,
            } => {
                let factor = libm::pow(speed / at_speed_m_per_s, VISCOELASTIC_POWER);
                Restitution::from_trusted_ln((restitution.ln() * factor).min(-LEAST_LN_LOSS))
            }
        }
    }
}

/// A law gives 0 < e < 1; only a contact without damping is elastic.
fn check_lossy(restitution: Restitution) -> Result<(), Error> {
    if restitution.one_minus() > 0.0 {
        Ok(())
    } else {
        Err(Error::argument("restitution", 1.0, "0 < e < 1"))
    }
}

/// The loss γ₁y − γ₂y² in y = v^(1/5) must stay between 0 and 1 from this speed down to rest.
fn check_viscoelastic(gamma1: f64, gamma2: f64, speed: f64) -> Result<(), Error> {
    check::positive("gamma1", gamma1)?;
    check::non_negative("gamma2", gamma2)?;
    let root = libm::pow(speed, VISCOELASTIC_POWER);
    let loss = |y: f64| y * (gamma1 - gamma2 * y);
    // The loss is largest at y = γ₁/2γ₂, if the ball ever hits that fast.
    let greatest = loss((0.5 * gamma1 / gamma2).min(root));
    if loss(root) <= 0.0 {
        let expected = "γ₂ < γ₁·v^(-1/5), so that e < 1";
        Err(Error::argument("gamma2", gamma2, expected))
    } else if greatest >= 1.0 {
        let expected = "γ₁·v^(1/5) - γ₂·v^(2/5) < 1, so that e > 0";
        Err(Error::argument("gamma1", gamma1, expected))
    } else {
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_law_gives_its_formula() {
        let e = Restitution::new(0.8).unwrap();
        let visco = RestitutionLaw::Viscoelastic {
            gamma1: 0.1,
            gamma2: 0.006,
        };
        let plastic = RestitutionLaw::Power {
            restitution_at_yield: e,
            yield_speed_m_per_s: 0.5,
            exponent: 0.25,
        };
        let power = RestitutionLaw::SpeedPower {
            restitution: e,
            at_speed_m_per_s: 2.0,
            exponent: 0.25,
        };
        let fifth_root = RestitutionLaw::FifthRoot {
            restitution: e,
            at_speed_m_per_s: 2.0,
        };
        for (law, speed, expected) in [
            (RestitutionLaw::Constant(e), 3.0, 0.8),
            (visco, 32.0, 1.0 - 0.2 + 0.024),
            (visco, 1.0, 0.906),
            (plastic, 8.0, 0.4),
            (plastic, 0.1, 0.8),
            (power, 32.0, 0.4),
            (power, 2.0, 0.8),
            (fifth_root, 2.0, 0.8),
            (fifth_root, 64.0, 0.64),
            (fifth_root, 0.0625, 0.8_f64.sqrt()),
        ] {
            let got = law.at(speed).unwrap().value();
            assert!((got - expected).abs() < 1e-15, "{law:?} at {speed}: {got}");
        }
    }

    #[test]
    fn a_power_of_the_speed_drawn_out_to_slow_impacts_never_gains() {
        let law = RestitutionLaw::SpeedPower {
            restitution: Restitution::new(0.9).unwrap(),
            at_speed_m_per_s: 1.0,
            exponent: 0.25,
        };
        assert!(law.at(0.9).unwrap().value() > 0.9);
        let slow = law.at(1e-3).unwrap();
        assert!(slow.value() < 1.0 && slow.one_minus() < 1e-15);
    }

    #[test]
    fn a_law_that_leaves_0_to_1_is_refused() {
        for (gamma1, gamma2) in [
            (2.0, 0.0),
            (0.1, 0.2),
            (0.0, 0.0),
            (f64::NAN, 0.0),
            (9.0, 4.6),
        ] {
            let law = RestitutionLaw::Viscoelastic { gamma1, gamma2 };
            assert!(law.at(1.0).is_err(), "{law:?}");
        }
    }
}
