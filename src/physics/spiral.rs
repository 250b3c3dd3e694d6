//! The spiral of the linear ball around its rest position, in units where only the damping ratio is left.
//!
//! See [`contact`](super::contact) for the equations. Every angle here is already divided by `s`, so that it is a time
//! in units of `1/ω_n` and stays finite as ζ → 1.

use super::{ReleaseRule, root};

/// `ζ`, and `s² = (1 − ζ)(1 + ζ)`, negative beyond critical damping.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spiral {
    zeta: f64,
    s_squared: f64,
}

/// Leaving: the speed `w` and the loss `u − w`, each to full precision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Outward {
    pub(super) speed: f64,
    pub(super) lost: f64,
}

impl Spiral {
    pub(super) fn new(zeta: f64) -> Self {
        Self {
            zeta,
            s_squared: (1.0 - zeta) * (1.0 + zeta),
        }
    }

    /// Time from the deepest point to the top, π/s; for zero force, to the least force after it, 2β/s.
    pub(super) fn turn(&self, rule: ReleaseRule) -> f64 {
        match rule {
            ReleaseRule::ZeroDisplacement => std::f64::consts::PI / libm::sqrt(self.s_squared),
            ReleaseRule::ZeroForce => 2.0 * self.time(1.0, self.zeta),
        }
    }

    /// `∠(x, s·y)/s`: the time in which the spiral turns from the direction of rest to this one.
    ///
    /// Past critical damping there are no turns but a hyperbolic angle, infinite where the direction is never reached.
    fn time(&self, y: f64, x: f64) -> f64 {
        if self.s_squared > 0.0 {
            let s = libm::sqrt(self.s_squared);
            libm::atan2(s * y, x) / s
        } else {
            let s = libm::sqrt(-self.s_squared);
            if x <= s * y {
                f64::INFINITY
            } else if s > 0.0 {
                libm::atanh(s * y / x) / s
            } else {
                y / x
            }
        }
    }

    /// Time from touching at speed `u` to the deepest point: `θ(u)/s`.
    pub(super) fn deepest(&self, u: f64) -> f64 {
        self.time(u, self.zeta * u - 1.0)
    }

    /// Time from leaving at speed `w` to the top that an unending spring would reach: `φ(w)/s`.
    pub(super) fn before_top(&self, w: f64) -> f64 {
        self.time(w, 1.0 + self.zeta * w)
    }

    /// Depth of the deepest point below the rest position.
    pub(super) fn depth(&self, u: f64) -> f64 {
        let beyond_critical = libm::sqrt((-self.s_squared).max(0.0));
        if u <= self.zeta + beyond_critical && self.s_squared <= 0.0 {
            // A slow ball sinks to the rest position without passing it.
            return 0.0;
        }
        let radius = if self.s_squared > 0.0 {
            libm::hypot(u - self.zeta, libm::sqrt(self.s_squared))
        } else {
            let from_center = u - self.zeta;
            libm::sqrt(from_center - beyond_critical) * libm::sqrt(from_center + beyond_critical)
        };
        radius * libm::exp(-self.zeta * self.deepest(u))
    }

    /// `½·ln(1 + 2ζy + y²)`, for either sign of `y`.
    fn log_radius(&self, y: f64) -> f64 {
        if y.abs() <= 1.0 {
            0.5 * libm::log1p(y * (y + 2.0 * self.zeta))
        } else {
            let inverse = 1.0 / y;
            libm::log(y.abs()) + 0.5 * libm::log1p(inverse * (inverse + 2.0 * self.zeta))
        }
    }

    /// `1 − 2ζy + y²`, divided by y² where that is above 1.
    fn approach(&self, y: f64) -> f64 {
        if y <= 1.0 {
            (y - self.zeta) * (y - self.zeta) + self.s_squared
        } else {
            let (direct, across) = (1.0 - self.zeta / y, self.s_squared / y / y);
            direct * direct + across
        }
    }

    /// `P(w)`.
    fn outward_integral(&self, w: f64) -> f64 {
        (self.log_radius(w) - self.zeta * self.before_top(w)).max(0.0)
    }

    /// `dP/dw`.
    fn outward_slope(&self, w: f64) -> f64 {
        if w <= 1.0 {
            w / (1.0 + 2.0 * self.zeta * w + w * w)
        } else {
            1.0 / (2.0 * self.zeta + w + 1.0 / w)
        }
    }

    /// The remainder of the impact for `P(w)`: `Q(u)` less the damping of the turn. Negative where the ball stays.
    fn left_over(&self, u: f64, turn: f64) -> f64 {
        if self.s_squared <= 0.0 && u <= self.zeta + libm::sqrt(-self.s_squared) {
            return f64::NEG_INFINITY;
        }
        self.log_radius(-u) - self.zeta * (self.deepest(u) + turn)
    }

    /// The speed `w` of leaving after an impact at `u`, `None` if it stays.
    pub(super) fn outward(&self, u: f64, turn: f64) -> Option<Outward> {
        let left = self.left_over(u, turn);
        if self.outward_integral(0.5 * u) < left {
            let lost = self.small_loss(u, turn);
            Some(Outward {
                speed: u - lost,
                lost,
            })
        } else if left > 0.0 {
            let speed = self.large_loss(u, left);
            Some(Outward {
                speed,
                lost: u - speed,
            })
        } else {
            None
        }
    }

    /// `w` below u/2, from `P(w) = left`.
    fn large_loss(&self, u: f64, left: f64) -> f64 {
        // Exact for ζ = 0, and an upper bound for the rest.
        let turned = 2.0 * (left + self.zeta * self.time(1.0, self.zeta));
        let guess = libm::sqrt(libm::expm1(turned)).min(0.5 * u);
        let target = libm::sqrt(2.0 * left);
        // √(2P) starts out as w and bends little: Newton needs four steps.
        root::increasing((0.0, 0.5 * u), guess, |w| {
            let rooted = libm::sqrt(2.0 * self.outward_integral(w));
            (rooted - target, self.outward_slope(w) / rooted)
        })
    }

    /// `d = u − w` below u/2, from an equation in which nothing cancels as d → 0:
    ///
    /// ```text
    /// Q(u) − Q(w) = 2πζ/s + P(w) − Q(w)
    /// ```
    ///
    /// Both sides are sums of positive terms, the left one about d·u/(1 + u²), the right one about ζ·(π … 2π).
    fn small_loss(&self, u: f64, turn: f64) -> f64 {
        let guess = self.damping_of_turn(u, turn) * (u + 1.0 / u);
        root::increasing((0.0, 0.5 * u), guess, |lost| {
            let w = u - lost;
            let value = self.approach_between(u, lost) - self.damping_of_turn(w, turn);
            (value, self.outward_slope(w))
        })
    }

    /// `Q(u) − Q(u − lost)`.
    fn approach_between(&self, u: f64, lost: f64) -> f64 {
        let w = u - lost;
        let scale = w.max(1.0);
        let ratio = (lost / scale) * ((u + w - 2.0 * self.zeta) / scale) / self.approach(w);
        // The angle between the two vectors, divided by scale² to keep large speeds from overflowing.
        let across = lost / scale / scale;
        let along =
            ((u - self.zeta) / scale) * ((w - self.zeta) / scale) + self.s_squared / scale / scale;
        0.5 * libm::log1p(ratio) + self.zeta * self.time(across, along)
    }

    /// `2πζ/s + P(w) − Q(w)`, or with the turn of zero force.
    fn damping_of_turn(&self, w: f64, turn: f64) -> f64 {
        let swing = 2.0 * self.zeta / (w + 1.0 / w);
        libm::atanh(swing) + self.zeta * (turn + self.deepest(w) - self.before_top(w))
    }

    /// The speed of impact at which the top just reaches the surface; `None` where it overflows.
    pub(super) fn grazing_speed(&self, turn: f64) -> Option<f64> {
        const HIGHEST: f64 = 1e150;
        if self.zeta == 0.0 {
            return Some(0.0);
        }
        if self.left_over(HIGHEST, turn) <= 0.0 {
            return None;
        }
        // Below, the ball stays: Q(u) < u²/(2(1 − ζ²)) and less than the turn alone takes.
        let lowest = 0.5 * self.zeta.min(1.0);
        let guess = libm::sqrt(libm::expm1((3.0 * self.zeta * turn).min(600.0)));
        Some(root::increasing((lowest, HIGHEST), guess, |u| {
            let value = self.left_over(u, turn);
            (value, u / (u * (u - 2.0 * self.zeta) + 1.0))
        }))
    }
}
