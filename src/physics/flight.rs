//! Flight between impacts: equation (1) of the paper, and the same with the drag, buoyancy and added mass of air.

use super::check;
use crate::Error;

/// A ball as the air sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    /// Mass, > 0.
    pub mass_kg: f64,
    /// Diameter, > 0.
    pub diameter_m: f64,
}

/// The air around the ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air {
    /// Density. Default 1.204 kg/m³: dry air at 20 °C and 1013.25 hPa.
    pub density_kg_per_m3: f64,
    /// Drag coefficient. Default 0.45: the middle of 0.4–0.5, which hold for a smooth sphere at Reynolds numbers from
    /// 1e3 to 2e5.
    pub drag_coefficient: f64,
}

/// Relative standard error of the drag of a ball whose mass and diameter are known: [`Air::drag_coefficient`] is known to
/// 6 % (0.4 to 0.5), mass and diameter add a little.
pub const DRAG_RELATIVE_STD: f64 = 0.07;

impl Default for Air {
    fn default() -> Self {
        Self {
            density_kg_per_m3: 1.204,
            drag_coefficient: 0.45,
        }
    }
}

/// Speed at which quadratic drag balances the weight, buoyancy left aside.
///
/// ```text
/// v_t = √(2mg / (ρ C_d A)),   A = πd²/4
/// ```
///
/// # Errors
/// [`Error::Argument`] for anything that is not positive and finite.
pub fn terminal_speed_m_per_s(
    gravity_m_per_s2: f64,
    sphere: Sphere,
    air: Air,
) -> Result<f64, Error> {
    let g = check::positive("gravity_m_per_s2", gravity_m_per_s2)?;
    let mass = check::positive("mass_kg", sphere.mass_kg)?;
    let diameter = check::positive("diameter_m", sphere.diameter_m)?;
    let density = check::positive("density_kg_per_m3", air.density_kg_per_m3)?;
    let coefficient = check::positive("drag_coefficient", air.drag_coefficient)?;
    let area = std::f64::consts::FRAC_PI_4 * diameter * diameter;
    check::positive(
        "terminal_speed_m_per_s",
        libm::sqrt((mass / density) * (g / coefficient) * (2.0 / area)),
    )
}

/// Share of the ball's mass that the air it displaces has.
///
/// ```text
/// β = ρ·(πd³/6)/m
/// ```
///
/// # Errors
/// [`Error::Argument`] for anything that is not positive and finite, and naming `mass_kg` where the ball would float
/// (β ≥ 1).
pub fn displaced_mass_fraction(sphere: Sphere, air: Air) -> Result<f64, Error> {
    let mass = check::positive("mass_kg", sphere.mass_kg)?;
    let diameter = check::positive("diameter_m", sphere.diameter_m)?;
    let density = check::positive("density_kg_per_m3", air.density_kg_per_m3)?;
    let volume = std::f64::consts::FRAC_PI_6 * diameter * diameter * diameter;
    let fraction = (density / mass) * volume;
    if fraction < 1.0 {
        Ok(fraction)
    } else {
        Err(Error::argument(
            "mass_kg",
            mass,
            "more than the mass of the air displaced",
        ))
    }
}

/// What gravity is for a ball in air that displaces the share `β` of its mass: the air carries β of the weight, and half as
/// much air moves with the ball.
///
/// ```text
/// g_eff = g·(1−β)/(1+β/2)
/// ```
#[must_use]
pub fn gravity_in_air_m_per_s2(gravity_m_per_s2: f64, displaced_mass_fraction: f64) -> f64 {
    gravity_m_per_s2 * ((1.0 - displaced_mass_fraction) / (1.0 + 0.5 * displaced_mass_fraction))
}

/// A fall from rest.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Fall {
    /// From release to touching.
    pub time_s: f64,
    /// Speed on touching.
    pub landing_speed_m_per_s: f64,
}

/// The way up.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Rise {
    /// From leaving to the top.
    pub time_s: f64,
    /// Height of the top above the start.
    pub height_m: f64,
}

/// One flight, from leaving the surface to touching it again at the same height.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Hop {
    /// From leaving to touching.
    pub time_s: f64,
    /// Height of the top above the surface.
    pub apex_m: f64,
    /// Speed on touching; less than at the start if there is drag.
    pub landing_speed_m_per_s: f64,
}

/// The law of free flight: gravity, and optionally quadratic drag.
///
/// ```text
/// (1)  ẍ = −g
///      ẍ = −g·(1 ± ẋ²/v_t²)      with drag: + going up, − coming down
/// ```
///
/// `g` is [`gravity_m_per_s2`](Self::gravity_m_per_s2), `v_t`
/// [`terminal_speed_m_per_s`](Self::terminal_speed_m_per_s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlightLaw {
    gravity_m_per_s2: f64,
    terminal_speed_m_per_s: Option<f64>,
}

impl FlightLaw {
    /// Free fall, equation (1).
    ///
    /// # Errors
    /// [`Error::Argument`] where gravity is not positive and finite.
    pub fn without_air(gravity_m_per_s2: f64) -> Result<Self, Error> {
        Ok(Self {
            gravity_m_per_s2: check::positive("gravity_m_per_s2", gravity_m_per_s2)?,
            terminal_speed_m_per_s: None,
        })
    }

    /// Quadratic drag with a known terminal speed.
    ///
    /// # Errors
    /// [`Error::Argument`] where either number is not positive and finite.
    pub fn with_terminal_speed(
        gravity_m_per_s2: f64,
        terminal_speed_m_per_s: f64,
    ) -> Result<Self, Error> {
        Ok(Self {
            terminal_speed_m_per_s: Some(check::positive(
                "terminal_speed_m_per_s",
                terminal_speed_m_per_s,
            )?),
            ..Self::without_air(gravity_m_per_s2)?
        })
    }

    /// Quadratic drag of a known strength; 0 is none.
    ///
    /// ```text
    /// K = (g/v_t)²      1.4 s⁻² for a ping-pong ball, 0.02 for one of steel
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] where gravity is not positive, the drag is negative, or either is not finite.
    pub fn with_drag(gravity_m_per_s2: f64, drag_per_s2: f64) -> Result<Self, Error> {
        if check::non_negative("drag_per_s2", drag_per_s2)? > 0.0 {
            let terminal_speed = gravity_m_per_s2 / libm::sqrt(drag_per_s2);
            Self::with_terminal_speed(gravity_m_per_s2, terminal_speed)
        } else {
            Self::without_air(gravity_m_per_s2)
        }
    }

    /// Drag, buoyancy and added mass of a sphere in air.
    ///
    /// ```text
    /// v_t² = 2m(1−β)g / (ρ C_d A)
    /// ```
    ///
    /// `β` is [`displaced_mass_fraction`], and gravity that of [`gravity_in_air_m_per_s2`]. From here on `g` means `g_eff`.
    ///
    /// # Errors
    /// [`Error::Argument`] for anything that is not positive and finite, or a ball that floats.
    pub fn in_air(gravity_m_per_s2: f64, sphere: Sphere, air: Air) -> Result<Self, Error> {
        let fraction = displaced_mass_fraction(sphere, air)?;
        let in_vacuum = terminal_speed_m_per_s(gravity_m_per_s2, sphere, air)?;
        Self::with_terminal_speed(
            gravity_in_air_m_per_s2(gravity_m_per_s2, fraction),
            in_vacuum * libm::sqrt(1.0 - fraction),
        )
    }

    /// Acceleration of the ball at rest in the air: gravity less buoyancy, slowed by added mass.
    #[must_use]
    pub const fn gravity_m_per_s2(&self) -> f64 {
        self.gravity_m_per_s2
    }

    /// Terminal speed, or `None` without drag.
    #[must_use]
    pub const fn terminal_speed_m_per_s(&self) -> Option<f64> {
        self.terminal_speed_m_per_s
    }

    /// K, the strength of the drag in s⁻²: 0 without. See [`with_drag`](Self::with_drag).
    #[must_use]
    pub fn drag_per_s2(&self) -> f64 {
        let rate = |terminal| self.gravity_m_per_s2 / terminal;
        self.terminal_speed_m_per_s
            .map_or(0.0, |terminal| rate(terminal) * rate(terminal))
    }

    /// A fall from rest.
    ///
    /// ```text
    /// t = √(2h/g),                     v = √(2gh)                  without drag
    /// t = (v_t/g)·arcosh(exp(y)),      v = v_t·√(1 − exp(−2y))     y = gh/v_t²
    /// ```
    ///
    /// The drag forms are evaluated through expm1 and ln1p, so they pass into the drag-free ones as `v_t` grows.
    ///
    /// # Errors
    /// [`Error::Argument`] where the height is not positive and finite.
    pub fn fall(&self, height_m: f64) -> Result<Fall, Error> {
        check::positive("height_m", height_m).map(|height| self.fall_from(height))
    }

    /// The way up of a ball with this speed.
    ///
    /// ```text
    /// t = v/g,                 h = v²/2g                     without drag
    /// t = (v_t/g)·atan(a),     h = (v_t²/2g)·ln(1 + a²)      a = v/v_t
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] where the speed is not positive and finite.
    pub fn rise(&self, speed_m_per_s: f64) -> Result<Rise, Error> {
        check::positive("speed_m_per_s", speed_m_per_s).map(|speed| self.rise_at(speed))
    }

    /// A whole flight that starts at the surface with the given upward speed.
    ///
    /// ```text
    /// T = 2v/g                              without drag
    /// T = (v_t/g)·(atan(a) + arsinh(a)),    landing at v/√(1 + a²),   a = v/v_t
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] where the speed is not positive and finite.
    pub fn hop(&self, speed_m_per_s: f64) -> Result<Hop, Error> {
        check::positive("speed_m_per_s", speed_m_per_s).map(|speed| self.hop_at(speed))
    }

    pub(super) fn fall_from(&self, height: f64) -> Fall {
        let g = self.gravity_m_per_s2;
        let Some(terminal) = self.terminal_speed_m_per_s else {
            return Fall {
                time_s: libm::sqrt(2.0 * height / g),
                landing_speed_m_per_s: libm::sqrt(2.0 * g * height),
            };
        };
        let y = (g * height / terminal) / terminal;
        let share = libm::sqrt(-libm::expm1(-2.0 * y));
        // arcosh(exp(y)) with exp(y) factored out of its logarithm: neither overflows nor cancels.
        Fall {
            time_s: (terminal / g) * (y + libm::log1p(share)),
            landing_speed_m_per_s: terminal * share,
        }
    }

    pub(super) fn rise_at(&self, speed: f64) -> Rise {
        let g = self.gravity_m_per_s2;
        let Some(terminal) = self.terminal_speed_m_per_s else {
            return Rise {
                time_s: speed / g,
                height_m: speed * (speed / (2.0 * g)),
            };
        };
        let a = speed / terminal;
        Rise {
            time_s: (terminal / g) * libm::atan(a),
            height_m: terminal * (terminal / (2.0 * g)) * libm::log1p(a * a),
        }
    }

    pub(super) fn hop_at(&self, speed: f64) -> Hop {
        let rise = self.rise_at(speed);
        let (fall_time, landing_speed_m_per_s) = match self.terminal_speed_m_per_s {
            None => (rise.time_s, speed),
            Some(terminal) => {
                let a = speed / terminal;
                let time = (terminal / self.gravity_m_per_s2) * libm::asinh(a);
                (time, speed / libm::hypot(1.0, a))
            }
        };
        Hop {
            time_s: rise.time_s + fall_time,
            apex_m: rise.height_m,
            landing_speed_m_per_s,
        }
    }
}
