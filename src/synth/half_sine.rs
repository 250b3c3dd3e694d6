//! The answer of one mode to the force of a contact, in closed form.

use super::scene::Mode;

/// A complex number, as two reals.
pub(super) type Complex = (f64, f64);

/// The answer of one mode to the force of a contact: see [`Sound`](super::sound::Sound).
pub(super) struct HalfSine {
    pub(super) lambda: Complex,
    omega: f64,
    contact_time_s: f64,
    /// λ² + Ω².
    denominator: Complex,
}

impl HalfSine {
    pub(super) fn new(mode: &Mode, contact_time_s: f64) -> Self {
        let lambda = (
            -1.0 / mode.decay_s,
            std::f64::consts::TAU * mode.frequency_hz,
        );
        let omega = std::f64::consts::PI / contact_time_s;
        let square = product(lambda, lambda);
        Self {
            lambda,
            omega,
            contact_time_s,
            denominator: (square.0 + omega * omega, square.1),
        }
    }

    /// The force F(t), in its own greatest.
    pub(super) fn force(&self, t_s: f64) -> f64 {
        if t_s <= 0.0 || t_s >= self.contact_time_s {
            return 0.0;
        }
        libm::sin(self.omega * t_s)
    }

    /// z(t) of [`Sound`](super::sound::Sound); 0 before the touch. Both exponents fall, so nothing overflows.
    pub(super) fn answer(&self, t_s: f64) -> Complex {
        if t_s <= 0.0 {
            return (0.0, 0.0);
        }
        let tau = t_s.min(self.contact_time_s);
        let (sin, cos) = (libm::sin(self.omega * tau), libm::cos(self.omega * tau));
        let free = exponential(self.lambda, t_s);
        let forced = product(
            exponential(self.lambda, t_s - tau),
            (self.lambda.0 * sin + self.omega * cos, self.lambda.1 * sin),
        );
        let numerator = (
            self.omega * free.0 - forced.0,
            self.omega * free.1 - forced.1,
        );
        quotient(numerator, self.denominator)
    }
}

/// exp(λt).
pub(super) fn exponential(lambda: Complex, t_s: f64) -> Complex {
    let size = libm::exp(lambda.0 * t_s);
    (
        size * libm::cos(lambda.1 * t_s),
        size * libm::sin(lambda.1 * t_s),
    )
}

pub(super) fn product(a: Complex, b: Complex) -> Complex {
    (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
}

fn quotient(a: Complex, b: Complex) -> Complex {
    let size = b.0 * b.0 + b.1 * b.1;
    (
        (a.0 * b.0 + a.1 * b.1) / size,
        (a.1 * b.0 - a.0 * b.1) / size,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::real;

    const MODE: Mode = Mode {
        frequency_hz: 900.0,
        decay_s: 4e-3,
        level: 1.0,
    };

    #[test]
    fn the_closed_form_is_the_integral() {
        let contact = 1.3e-3;
        for t in [0.2e-3, 1.0e-3, 1.3e-3, 2.0e-3, 7.0e-3] {
            // The definition, summed by the midpoint rule.
            let steps = 20_000;
            let ds = f64::min(t, contact) / real(steps);
            let sum: f64 = (0..steps)
                .map(|k| {
                    let s = (real(k) + 0.5) * ds;
                    let ring = (-(t - s) / MODE.decay_s).exp()
                        * (std::f64::consts::TAU * MODE.frequency_hz * (t - s)).sin();
                    ring * (std::f64::consts::PI * s / contact).sin() * ds
                })
                .sum();
            let closed = HalfSine::new(&MODE, contact).answer(t).1;
            assert!((closed - sum).abs() < 1e-8 * contact, "{t}: {closed} {sum}");
        }
    }
}
