//! Contact of the linear ball with its weight kept: equation (3) solved exactly, at every impact speed.
//!
//! Lengths are measured in `g/ω_n²`, times in `1/ω_n` and speeds in `g/ω_n`, where (2) has one parameter left, ζ:
//!
//! ```text
//! X″ + 2ζX′ + X = −1,   X(0) = 0,   X′(0) = −u,   u = v·ω_n/g,   s = √(1 − ζ²)
//! ```
//!
//! In the plane of (X + 1, X′) the motion is a logarithmic spiral around the rest position, so the time and the speed
//! of leaving follow from angles and logarithms alone, without searching along the motion in time: it passes its
//! deepest point at the angle θ(u), would pass its highest point half a turn later, and crosses X = 0 in between, an
//! angle φ(w) before the top, if that top lies above X = 0:
//!
//! ```text
//! P(w) = Q(u) − (ζ/s)·(π + τ),   ω_n·ΔT = (θ(u) + τ − φ(w))/s,   τ = π      w = v1·ω_n/g, v1: rebound speed
//!
//! P(w) = ∫₀ʷ y dy/(1 + 2ζy + y²) = ½·ln(1 + 2ζw + w²) − (ζ/s)·φ(w),         φ(w) = ∠(1 + ζw, sw)
//! Q(u) = ∫₀ᵘ y dy/(1 − 2ζy + y²) = ½·ln(1 − 2ζu + u²) − (ζ/s)·(θ(u) − π),   θ(u) = ∠(ζu − 1, su)
//! ```
//!
//! `∠(x, y)` is the angle of the vector, 0 to π. P grows with w from 0 and Q grows with u: there is no rebound where the
//! right side is ≤ 0, one root where it is not, and no later crossing to mistake it for.
//!
//! The contact force runs along the same spiral, turned. Under [`ReleaseRule::ZeroForce`] the equations hold with
//! τ = 2β instead of π, where cos β = ζ, and the ball leaves at w + 2ζ. Written with times (angles divided by s, which go
//! over from arctangents into areatangents) this form holds for ζ ≥ 1 too.

use super::{Oscillator, Restitution, check, root, spiral::Spiral};
use crate::Error;

/// When contact ends.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, Hash, Default, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum ReleaseRule {
    /// When the ball is back at `x = 0`, undeformed: the paper's rule, which (14) to (17) invert. The damper pulls the
    /// ball back just before.
    #[default]
    ZeroDisplacement,
    /// When the force `−k·x − c·ẋ` falls to zero: a surface cannot pull. The ball leaves while still deformed.
    ZeroForce,
}

/// How a contact ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rebound {
    /// The ball leaves the surface.
    Leaves(Leaving),
    /// The ball never leaves: it settles at the rest position (5).
    Stays,
}

/// The end of a contact that ends.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Leaving {
    /// From touching to leaving, ΔT.
    pub contact_time_s: f64,
    /// Upward speed on leaving, v1: (12) with the weight kept.
    pub speed_m_per_s: f64,
    /// Position on leaving: 0, or below 0 under [`ReleaseRule::ZeroForce`].
    pub position_m: f64,
    /// Ratio of the speeds, (10). [`Restitution::ELASTIC`] without damping.
    pub restitution: Restitution,
    /// The rule under which all this holds.
    pub release_rule: ReleaseRule,
}

/// A linear ball on a surface, with its weight and a release rule.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinearContact {
    oscillator: Oscillator,
    gravity_m_per_s2: f64,
    release_rule: ReleaseRule,
    spiral: Spiral,
}

impl LinearContact {
    /// A ball, gravity and a release rule.
    ///
    /// # Errors
    /// [`Error::Argument`] where gravity is not positive and finite, and naming `damping_ratio` where it is 1 or more
    /// under [`ReleaseRule::ZeroDisplacement`]: such a ball creeps back and never reaches `x = 0`.
    pub fn new(
        oscillator: Oscillator,
        gravity_m_per_s2: f64,
        release_rule: ReleaseRule,
    ) -> Result<Self, Error> {
        if release_rule == ReleaseRule::ZeroDisplacement {
            oscillator.underdamping()?;
        }
        Ok(Self {
            oscillator,
            gravity_m_per_s2: check::positive("gravity_m_per_s2", gravity_m_per_s2)?,
            release_rule,
            spiral: Spiral::new(oscillator.damping_ratio()),
        })
    }

    /// The ball with this restitution at one speed, of which fast impacts last so long; it leaves at zero displacement.
    ///
    /// Its restitution without weight, e₀, is the root of `e(v; e₀) = e`, which lies between e and 1: e(v) grows with e₀.
    ///
    /// # Errors
    /// [`Error::Argument`] for an undamped ball, and where speed, contact time or gravity is not positive and finite.
    pub fn with_restitution_at(
        restitution: Restitution,
        speed_m_per_s: f64,
        contact_time_s: f64,
        gravity_m_per_s2: f64,
    ) -> Result<Self, Error> {
        let speed = check::positive("speed_m_per_s", speed_m_per_s)?;
        let of = |ln_loss: f64| {
            let fast = Restitution::from_ln(-ln_loss)?;
            let ball = Oscillator::from_contact(fast, contact_time_s)?;
            Self::new(ball, gravity_m_per_s2, ReleaseRule::ZeroDisplacement)
        };
        let ln_loss = check::positive("ln_loss", -restitution.ln())?;
        // Refuses what is out of range before the search, which cannot.
        of(ln_loss)?;
        let lost_more = |fast: f64| match of(fast).map(|contact| contact.rebound_at(speed)) {
            // Nearly the whole loss goes with that of fast impacts.
            Ok(Rebound::Leaves(leaving)) => {
                let ln = leaving.restitution.ln();
                (-ln - ln_loss, -ln / fast)
            }
            Ok(Rebound::Stays) | Err(_) => (f64::INFINITY, f64::NAN),
        };
        of(root::increasing((0.0, ln_loss), 0.9 * ln_loss, lost_more))
    }

    /// The ball.
    #[must_use]
    pub const fn oscillator(&self) -> Oscillator {
        self.oscillator
    }

    /// Acceleration of free fall.
    #[must_use]
    pub const fn gravity_m_per_s2(&self) -> f64 {
        self.gravity_m_per_s2
    }

    /// When contact ends.
    #[must_use]
    pub const fn release_rule(&self) -> ReleaseRule {
        self.release_rule
    }

    /// The outcome of an impact at `speed_m_per_s`: the first solution of (6), exactly, and (10) from it.
    ///
    /// ```text
    /// (6)   x(ΔT) = 0
    /// (10)  e = |ẋ(ΔT)/ẋ(0)|
    /// ```
    ///
    /// With `g/(ω_n·v) → 0` it tends to (9), (12) and (13). `g/(ω_n·v)` is the number that is small for those; the paper's
    /// "mg/k ≪ 1" has a dimension.
    ///
    /// # Errors
    /// [`Error::Argument`] naming `speed_m_per_s` where it is not positive and finite.
    pub fn rebound(&self, speed_m_per_s: f64) -> Result<Rebound, Error> {
        check::positive("speed_m_per_s", speed_m_per_s).map(|speed| self.rebound_at(speed))
    }

    pub(super) fn rebound_at(&self, speed: f64) -> Rebound {
        let frequency = self.oscillator.natural_frequency_rad_per_s();
        let impact = speed / self.gravity_m_per_s2 * frequency;
        let turn = self.spiral.turn(self.release_rule);
        let Some(outward) = self.spiral.outward(impact, turn) else {
            return Rebound::Stays;
        };
        let zeta = self.oscillator.damping_ratio();
        let extra = match self.release_rule {
            ReleaseRule::ZeroDisplacement => 0.0,
            ReleaseRule::ZeroForce => 2.0 * zeta,
        };
        let restitution = if outward.lost < 0.5 * impact {
            Restitution::from_trusted_loss((outward.lost - extra) / impact)
        } else {
            Restitution::from_trusted_value((outward.speed + extra) / impact)
        };
        let time = self.spiral.deepest(impact) + turn - self.spiral.before_top(outward.speed);
        let sag = self.gravity_m_per_s2 / frequency / frequency;
        Rebound::Leaves(Leaving {
            contact_time_s: time / frequency,
            speed_m_per_s: restitution.rebound_speed_m_per_s(speed),
            position_m: 0.0 - extra * (outward.speed + extra) * sag,
            restitution,
            release_rule: self.release_rule,
        })
    }

    /// The impact speed below which the ball no longer leaves; 0 without damping, `None` where no speed up to 1e60 m/s
    /// makes it leave.
    ///
    /// ```text
    /// Q(u) = 2πζ/s,   v = u·g/ω_n
    /// ```
    ///
    /// The paper's (19) puts it at `v = √2·g/ω_n` for every ball; it is `0.71·g/ω_n` at e = 0.9 and 2.95 at 0.5. At zero
    /// displacement the ball leaves with speed 0 there, under zero force it leaves with `2ζ·g/ω_n` and does not get off
    /// the surface.
    #[must_use]
    pub fn least_leaving_speed_m_per_s(&self) -> Option<f64> {
        let unit = self.gravity_m_per_s2 / self.oscillator.natural_frequency_rad_per_s();
        let turn = self.spiral.turn(self.release_rule);
        let speed = self.spiral.grazing_speed(turn)? * unit;
        (speed <= 1e60).then_some(speed)
    }

    /// The deepest position during contact, negative.
    ///
    /// # Errors
    /// [`Error::Argument`] naming `speed_m_per_s` where it is not positive and finite.
    pub fn deepest_position_m(&self, speed_m_per_s: f64) -> Result<f64, Error> {
        let speed = check::positive("speed_m_per_s", speed_m_per_s)?;
        let frequency = self.oscillator.natural_frequency_rad_per_s();
        let impact = speed / self.gravity_m_per_s2 * frequency;
        let sag = self.gravity_m_per_s2 / frequency / frequency;
        Ok(-sag * (1.0 + self.spiral.depth(impact)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ball_made_from_its_restitution_at_one_speed_has_it_there() {
        for (e, speed, contact_time_s) in [
            (0.9, 1.2, 1e-3),
            (0.75, 0.4, 12e-3),
            (0.5, 0.2, 5e-3),
            (0.99, 0.05, 8e-3),
        ] {
            let restitution = Restitution::new(e).unwrap();
            let contact =
                LinearContact::with_restitution_at(restitution, speed, contact_time_s, 9.81)
                    .unwrap();
            let Rebound::Leaves(leaving) = contact.rebound(speed).unwrap() else {
                panic!("it leaves");
            };
            assert!(
                (leaving.restitution.ln() / e.ln() - 1.0).abs() < 1e-12,
                "{e}"
            );
            let Rebound::Leaves(fast) = contact.rebound(1e6).unwrap() else {
                panic!("it leaves");
            };
            assert!(fast.restitution.value() > e);
            assert!((fast.contact_time_s / contact_time_s - 1.0).abs() < 1e-6);
        }
        let elastic = LinearContact::with_restitution_at(Restitution::ELASTIC, 1.0, 1e-3, 9.81);
        assert!(elastic.is_err());
    }
}
