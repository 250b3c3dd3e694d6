//! What each bounce says of ln e, made linear in the times and in the parameters of the model.

use super::flights::Impact;

/// What is known beforehand of a parameter: a normal distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Known {
    /// Its centre.
    pub value: f64,
    /// Its standard deviation, > 0.
    pub std: f64,
}

/// A model of the intervals: constant e, and what is added to it.
///
/// # Formula
/// ```text
/// D_i = T_i + C,   ln e(v_j) = ln u(T_j) − ln w(T_{j−1}) = θ − p·ln(v_j/v̄) + σ_e·η_j
/// T = (atan a + arsinh a)/√K,   u ∝ a,   w ∝ a/√(1 + a²),   K = g²/v_t²
/// ```
/// `D_i` are the intervals between impacts, C is the time in contact (s), u and w are the speeds at which the ball
/// leaves and arrives, K is the drag of the air (s⁻²; 1.4 for a ping-pong ball), p is how e falls with speed, v̄ is the
/// geometric mean of the impact speeds.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Terms {
    /// C in seconds.
    pub contact: Option<Known>,
    /// K in s⁻².
    pub drag: Option<Known>,
    /// p.
    pub speed: Option<Known>,
}

/// Trial values of C and K, in which the model is not linear.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Values {
    pub contact_s: f64,
    pub drag_per_s2: f64,
}

/// The bounces around a trial of times and parameters.
#[derive(Debug, Clone)]
pub(super) struct Bounces {
    /// ln e of each bounce, by the times observed.
    pub ln_e: Vec<f64>,
    /// Its derivatives by the time of the impact before, its own and the one after.
    pub slopes: Vec<[f64; 3]>,
    /// How ln e of each bounce depends on each fitted parameter; ones for θ first.
    pub columns: Vec<Vec<f64>>,
    /// How ln of the derivative of ln e by the flight after it depends on each fitted parameter.
    pub stretching: Vec<Vec<f64>>,
    /// Mean ln of the speed of arrival, as a flight without air of so many seconds has it: `ln(2v/g)`.
    pub mean_ln_speed: f64,
}

impl Bounces {
    /// Made linear around trial times. None if a flight is not longer than the contact.
    pub(super) fn around(
        trial_s: &[f64],
        observed: &[Impact],
        terms: &Terms,
        values: Values,
    ) -> Option<Self> {
        let flights: Option<Vec<Ends>> = trial_s
            .windows(2)
            .map(|w| Ends::of(w[1] - w[0] - values.contact_s, values.drag_per_s2))
            .collect();
        let flights = flights?;
        let speeds: Vec<f64> = flights[..flights.len() - 1]
            .iter()
            .map(|f| f.ln_landing)
            .collect();
        let mean_ln_speed = speeds.iter().sum::<f64>() / crate::units::real(speeds.len().max(1));
        let off_s: Vec<f64> = observed
            .iter()
            .zip(trial_s)
            .map(|(i, t)| i.time_s - t)
            .collect();
        let pairs = || flights.windows(2).map(|w| (&w[0], &w[1]));
        let slopes: Vec<[f64; 3]> = pairs()
            .map(|(before, after)| {
                [
                    before.landing_slope,
                    -before.landing_slope - after.leaving_slope,
                    after.leaving_slope,
                ]
            })
            .collect();
        let ln_e = pairs()
            .zip(&slopes)
            .zip(off_s.windows(3))
            .map(|(((before, after), slopes), off)| {
                let moved: f64 = slopes.iter().zip(off).map(|(s, o)| s * o).sum();
                after.ln_leaving - before.ln_landing + moved
            })
            .collect();
        let mut columns = vec![vec![1.0; slopes.len()]];
        let mut stretching = vec![vec![0.0; slopes.len()]];
        if terms.contact.is_some() {
            // A longer contact means shorter flights: D stays, T = D − C.
            columns.push(
                pairs()
                    .map(|(b, a)| a.leaving_slope - b.landing_slope)
                    .collect(),
            );
            stretching.push(pairs().map(|(_, a)| a.leaving_slope).collect());
        }
        if terms.drag.is_some() {
            columns.push(
                pairs()
                    .map(|(b, a)| b.landing_by_drag - a.leaving_by_drag)
                    .collect(),
            );
            // τ·d(ln a)/dτ = 1 + K·T²/8 + …, and ln u(T) = ln T + K·T²/16 + …
            stretching.push(pairs().map(|(_, a)| 2.0 * a.leaving_by_drag).collect());
        }
        if terms.speed.is_some() {
            columns.push(speeds.iter().map(|s| mean_ln_speed - s).collect());
            stretching.push(vec![0.0; slopes.len()]);
        }
        Some(Self {
            ln_e,
            slopes,
            columns,
            stretching,
            mean_ln_speed,
        })
    }
}

/// The two ends of one flight.
#[derive(Debug, Clone, Copy)]
struct Ends {
    /// ln of the speeds, as the flight time without air that has them.
    ln_leaving: f64,
    ln_landing: f64,
    /// Their derivatives by the length of the flight.
    leaving_slope: f64,
    landing_slope: f64,
    /// Their derivatives by K.
    leaving_by_drag: f64,
    landing_by_drag: f64,
}

impl Ends {
    /// From the equation of [`Terms`]; its derivatives follow from `dτ/da = 1/(1+a²) + 1/√(1+a²)`, τ = T·√K.
    fn of(flight_s: f64, drag_per_s2: f64) -> Option<Self> {
        if !(flight_s > 0.0 && flight_s.is_finite()) {
            return None;
        }
        let tau = flight_s * drag_per_s2.max(0.0).sqrt();
        let a = leaving_speed(tau);
        let square = 1.0 + a * a;
        // τ·d(ln a)/dτ: 1 without drag.
        let stretch = if tau > SMALL {
            tau / (a * (1.0 / square + 1.0 / square.sqrt()))
        } else {
            1.0 + tau * tau / 8.0
        };
        let lifted = if tau > SMALL {
            (2.0 * a / tau).ln()
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
        let ln_leaving = flight_s.ln() + lifted;
        Some(Self {
            ln_leaving,
            ln_landing: ln_leaving - 0.5 * square.ln(),
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
        let step = (tau - a.atan() - a.asinh()) / (1.0 / square + 1.0 / square.sqrt());
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
