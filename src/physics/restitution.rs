//! The coefficient of restitution, precise at both ends: near 0 and near 1.

use super::check;
use crate::Error;

/// A coefficient of restitution `e`, the ratio of rebound speed to impact speed.
///
/// `e`, `1 − e` and `ln e` are kept side by side, each to full precision: a drop depends on `1 − e` where the ball is
/// lively and on `ln e` where it is dead, and neither can be had from a rounded `e`.
///
/// Made from numbers, `e` lies strictly between 0 and 1. Only the contact of an undamped ball gives
/// [`ELASTIC`](Self::ELASTIC).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Restitution {
    value: f64,
    one_minus: f64,
    ln: f64,
}

impl Restitution {
    /// `e = 1`: nothing is lost. The outcome of an undamped contact; such a ball never comes to rest.
    pub const ELASTIC: Self = Self {
        value: 1.0,
        one_minus: 0.0,
        ln: 0.0,
    };

    /// From `e`, between 0 and 1, both excluded.
    ///
    /// # Errors
    /// [`Error::Argument`] naming `restitution` outside this range.
    pub fn new(e: f64) -> Result<Self, Error> {
        if (f64::MIN_POSITIVE..1.0).contains(&e) {
            Ok(Self::from_trusted_value(e))
        } else {
            Err(Error::argument("restitution", e, "0 < e < 1"))
        }
    }

    /// From `1 − e`, between 0 and 1, both excluded. Keeps losses far below the 1e-16 that a rounded `e` can hold.
    ///
    /// # Errors
    /// [`Error::Argument`] naming `one_minus_restitution` outside this range (1e-60 at the lower end).
    pub fn from_one_minus(one_minus: f64) -> Result<Self, Error> {
        if (1e-60..1.0).contains(&one_minus) {
            Ok(Self::from_trusted_loss(one_minus))
        } else {
            Err(Error::argument(
                "one_minus_restitution",
                one_minus,
                "0 < 1 - e < 1 (from 1e-60)",
            ))
        }
    }

    /// From `ln e`, negative. `e` itself may underflow to 0; `ln e` stays.
    ///
    /// # Errors
    /// [`Error::Argument`] naming `ln_restitution` where it is not negative, or beyond −1e60.
    pub fn from_ln(ln: f64) -> Result<Self, Error> {
        match check::positive("ln_restitution", -ln) {
            Ok(_) => Ok(Self::from_trusted_ln(ln)),
            Err(_) => Err(Error::argument(
                "ln_restitution",
                ln,
                "a number < 0 (-1e60 to -1e-60)",
            )),
        }
    }

    /// `e` itself; 0 where it underflows.
    #[must_use]
    pub const fn value(self) -> f64 {
        self.value
    }

    /// `1 − e`, without the cancellation of subtracting.
    #[must_use]
    pub const fn one_minus(self) -> f64 {
        self.one_minus
    }

    /// `ln e`, negative; 0 only for [`ELASTIC`](Self::ELASTIC).
    #[must_use]
    pub const fn ln(self) -> f64 {
        self.ln
    }

    /// Speed after an impact at this speed.
    ///
    /// A lively ball loses what `1 − e` says: the rounding of `e` would add up over thousands of bounces.
    #[must_use]
    pub fn rebound_speed_m_per_s(self, impact_speed_m_per_s: f64) -> f64 {
        if self.one_minus < 0.5 {
            impact_speed_m_per_s - self.one_minus * impact_speed_m_per_s
        } else {
            self.value * impact_speed_m_per_s
        }
    }

    pub(super) fn from_trusted_value(value: f64) -> Self {
        let one_minus = 1.0 - value;
        // From ½ up the subtraction is exact, and ln1p of it keeps what ln of a number near 1 would lose.
        let ln = if value >= 0.5 {
            libm::log1p(-one_minus)
        } else {
            libm::log(value)
        };
        Self {
            value,
            one_minus,
            ln,
        }
    }

    pub(super) fn from_trusted_loss(one_minus: f64) -> Self {
        Self {
            value: 1.0 - one_minus,
            one_minus,
            // Adding 0 turns the −0 of an elastic contact into 0.
            ln: libm::log1p(-one_minus) + 0.0,
        }
    }

    pub(super) fn from_trusted_ln(ln: f64) -> Self {
        Self {
            value: libm::exp(ln),
            one_minus: -libm::expm1(ln),
            ln,
        }
    }

    /// `eⁿ`; 0 where it underflows.
    pub(super) fn power(self, n: f64) -> f64 {
        libm::exp(n * self.ln)
    }

    /// `√(π² + (ln e)²)`, which (14), (16), (17), (20) and (25) share.
    pub(super) fn pi_norm(self) -> f64 {
        libm::sqrt(std::f64::consts::PI * std::f64::consts::PI + self.ln * self.ln)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loss_far_below_rounding_survives() {
        let e = Restitution::from_one_minus(1e-40).unwrap();
        assert_eq!(e.value(), 1.0);
        assert_eq!(e.one_minus(), 1e-40);
        assert_eq!(e.ln(), -1e-40);
    }

    #[test]
    fn an_underflowing_value_keeps_its_logarithm() {
        let e = Restitution::from_ln(-1e5).unwrap();
        assert_eq!((e.value(), e.one_minus(), e.ln()), (0.0, 1.0, -1e5));
    }

    #[test]
    fn what_is_given_comes_back_unchanged() {
        for value in [1e-300, 1e-6, 0.3, 0.5, 0.93, 1.0 - 1e-12] {
            assert_eq!(Restitution::new(value).unwrap().value(), value);
        }
    }

    #[test]
    fn outside_of_0_and_1_is_refused_with_the_range() {
        for value in [0.0, 1.0, -0.1, 1.5, f64::NAN, f64::INFINITY] {
            let error = Restitution::new(value).unwrap_err().to_string();
            assert!(
                error.contains("restitution") && error.contains("0 < e < 1"),
                "{error}"
            );
        }
        assert!(Restitution::from_one_minus(0.0).is_err());
        assert!(Restitution::from_one_minus(1.0).is_err());
        assert!(Restitution::from_ln(0.0).is_err());
        assert!(Restitution::from_ln(f64::NEG_INFINITY).is_err());
    }
}
