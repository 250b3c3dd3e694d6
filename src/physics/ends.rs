//! The speeds at both ends of a flight from its length: free flight with drag, inverted.

/// The two ends of one flight.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Ends {
    /// ln of the speeds, as the flight time without air that has them.
    pub(crate) ln_leaving: f64,
    pub(crate) ln_landing: f64,
    /// Their derivatives by the length of the flight.
    pub(crate) leaving_slope: f64,
    pub(crate) landing_slope: f64,
    /// Their derivatives by K.
    pub(crate) leaving_by_drag: f64,
    pub(crate) landing_by_drag: f64,
}

impl Ends {
    /// From the length T of a flight and the drag K, s⁻². None if T is not positive and finite.
    ///
    /// # Formula
    /// ```text
    /// T = (atan a + arsinh a)/√K,   leaving ∝ a,   landing ∝ a/√(1 + a²),   K = g²/v_t²
    /// ```
    /// The equation of [`FlightLaw::hop`](super::FlightLaw::hop) for its speed; the derivatives follow from
    /// `dτ/da = 1/(1 + a²) + 1/√(1 + a²)`, τ = T·√K.
    pub(crate) fn of(flight_s: f64, drag_per_s2: f64) -> Option<Self> {
        if !(flight_s > 0.0 && flight_s.is_finite()) {
            return None;
        }
        let tau = flight_s * libm::sqrt(drag_per_s2.max(0.0));
        let a = leaving_speed(tau);
        let square = 1.0 + a * a;
        // τ·d(ln a)/dτ: 1 without drag.
        let stretch = if tau > SMALL {
            tau / (a * (1.0 / square + 1.0 / libm::sqrt(square)))
        } else {
            1.0 + tau * tau / 8.0
        };
        let lifted = if tau > SMALL {
            libm::log(2.0 * a / tau)
        } else {
            tau * tau / 16.0
        };
        // d/dK at fixed T: τ moves by τ/(2K), and ln(2a/τ) by (stretch − 1)·dτ/τ.
        let by_drag = if tau > SMALL {
            (stretch - 1.0) / (2.0 * drag_per_s2)
        } else {
            flight_s * flight_s / 16.0
        };
        let loss_by_drag = if tau > SMALL {
            a * a / square * stretch / (2.0 * drag_per_s2)
        } else {
            flight_s * flight_s / 8.0
        };
        let ln_leaving = libm::log(flight_s) + lifted;
        Some(Self {
            ln_leaving,
            ln_landing: ln_leaving - 0.5 * libm::log(square),
            leaving_slope: stretch / flight_s,
            landing_slope: stretch / (square * flight_s),
            leaving_by_drag: by_drag,
            landing_by_drag: by_drag - loss_by_drag,
        })
    }
}

/// Below this τ the next term of the series, of order τ⁴, is lost in rounding.
const SMALL: f64 = 1e-4;

/// a of `atan a + arsinh a = τ` by Newton's method, which converges from below in a few steps: the left side is concave.
fn leaving_speed(tau: f64) -> f64 {
    let mut a = 0.5 * tau;
    for _ in 0..8 {
        let square = 1.0 + a * a;
        let step =
            (tau - libm::atan(a) - libm::asinh(a)) / (1.0 / square + 1.0 / libm::sqrt(square));
        a += step;
        if step.abs() <= 1e-15 * a {
            break;
        }
    }
    a
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::FlightLaw;

    #[test]
    fn speeds_are_those_of_the_flight_law() {
        let law = FlightLaw::with_terminal_speed(9.81, 8.0).unwrap();
        let drag = (9.81_f64 / 8.0).powi(2);
        for speed in [0.01, 0.3, 2.0, 6.0] {
            let hop = law.hop(speed).unwrap();
            let ends = Ends::of(hop.time_s, drag).unwrap();
            assert!((ends.ln_leaving.exp() * 0.5 * 9.81 / speed - 1.0).abs() < 1e-9);
            let landing = ends.ln_landing.exp() * 0.5 * 9.81;
            assert!((landing / hop.landing_speed_m_per_s - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn derivatives_are_those_of_differences() {
        for (flight, drag) in [(0.5, 1.4), (0.05, 0.2), (0.7, 1e-6)] {
            let here = Ends::of(flight, drag).unwrap();
            let step = 1e-6;
            let (up, down) = (
                Ends::of(flight + step, drag).unwrap(),
                Ends::of(flight - step, drag).unwrap(),
            );
            let slope = (up.ln_landing - down.ln_landing) / (2.0 * step);
            assert!((slope / here.landing_slope - 1.0).abs() < 1e-6);
            let step = 1e-3 * drag;
            let (up, down) = (
                Ends::of(flight, drag + step).unwrap(),
                Ends::of(flight, drag - step).unwrap(),
            );
            for (high, low, slope) in [
                (up.ln_leaving, down.ln_leaving, here.leaving_by_drag),
                (up.ln_landing, down.ln_landing, here.landing_by_drag),
            ] {
                let measured = (high - low) / (2.0 * step);
                assert!(
                    (measured - slope).abs() < 1e-3 * slope.abs() + 1e-9,
                    "{flight} {drag}"
                );
            }
        }
    }
}
