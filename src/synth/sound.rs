//! The sound of one impact: damped modes driven by the force of the contact, in closed form.

use super::instant_s;
use super::scene::Mode;
use crate::units::samples_in;

/// A sound is followed until its modes have fallen by this many times 1/e: 60 dB more than a 16-bit recording holds.
const DECAYS: f64 = 18.0;

/// A complex number, as two reals.
type Complex = (f64, f64);

/// What an impact of a ball sounds like.
///
/// # Formula
/// The force is half a sine, `F(t) = sin(Ωt)` for 0 < t < ΔT with Ω = π/ΔT. A mode answers a knock with
/// `Im exp(λt)`, λ = −1/decay + i·2π·frequency, so it answers the force with
/// ```text
/// y(t) = Im ∫₀^τ exp(λ(t − s)) sin(Ωs) ds,   τ = min(t, ΔT)
///      = Im exp(λt)·[Ω − exp(−λτ)·(λ sin Ωτ + Ω cos Ωτ)] / (λ² + Ω²)
/// ```
/// It is evaluated at each sample's own instant, so an impact may fall anywhere between two samples.
#[derive(Debug, Clone)]
pub struct Sound {
    modes: Vec<Mode>,
    levels: Vec<f64>,
    contact_time_s: f64,
}

impl Sound {
    /// The sound of modes excited by a contact of this length in seconds.
    #[must_use]
    pub fn new(modes: &[Mode], contact_time_s: f64) -> Self {
        Self {
            modes: modes.to_vec(),
            levels: modes.iter().map(|m| m.level).collect(),
            contact_time_s,
        }
    }

    /// The same sound with each mode's level multiplied.
    #[must_use]
    pub fn with_levels(&self, factors: &[f64]) -> Self {
        let levels = self
            .modes
            .iter()
            .zip(factors)
            .map(|(m, f)| m.level * f)
            .collect();
        Self {
            levels,
            ..self.clone()
        }
    }

    /// Pressure at `t_s` seconds after the touch; 0 before it.
    #[must_use]
    pub fn at(&self, t_s: f64) -> f64 {
        let parts = self
            .modes
            .iter()
            .zip(&self.levels)
            .map(|(m, level)| level * response(m, self.contact_time_s, t_s));
        parts.sum()
    }

    /// Adds the sound of an impact at `onset_s` to samples, times `gain`; gives the sum of its squares.
    pub fn add(&self, samples: &mut [f64], rate: f64, onset_s: f64, gain: f64) -> f64 {
        let longest = self.modes.iter().map(|m| m.decay_s).fold(0.0, f64::max);
        let first = samples_in(onset_s, rate).min(samples.len());
        let end = samples_in(onset_s + self.contact_time_s + DECAYS * longest, rate)
            .clamp(first, samples.len());
        let mut energy = 0.0;
        for (i, sample) in samples[first..end].iter_mut().enumerate() {
            let pressure = gain * self.at(instant_s(first + i, rate) - onset_s);
            *sample += pressure;
            energy += pressure * pressure;
        }
        energy
    }
}

/// y(t) of [`Sound`] for one mode, normalised by ΔT so that a short contact and a long one of equal force compare.
fn response(mode: &Mode, contact_time_s: f64, t_s: f64) -> f64 {
    if t_s <= 0.0 {
        return 0.0;
    }
    let lambda: Complex = (
        -1.0 / mode.decay_s,
        std::f64::consts::TAU * mode.frequency_hz,
    );
    let omega = std::f64::consts::PI / contact_time_s;
    let tau = t_s.min(contact_time_s);
    let (sin, cos) = (libm::sin(omega * tau), libm::cos(omega * tau));
    // exp(λt)·Ω − exp(λ(t − τ))·(λ sin Ωτ + Ω cos Ωτ): both exponents fall, so nothing overflows.
    let free = scaled(exponential(lambda, t_s), omega);
    let forced = product(
        exponential(lambda, t_s - tau),
        (lambda.0 * sin + omega * cos, lambda.1 * sin),
    );
    let numerator = (free.0 - forced.0, free.1 - forced.1);
    let square = product(lambda, lambda);
    quotient(numerator, (square.0 + omega * omega, square.1)).1 / contact_time_s
}

fn exponential(lambda: Complex, t_s: f64) -> Complex {
    let size = libm::exp(lambda.0 * t_s);
    (
        size * libm::cos(lambda.1 * t_s),
        size * libm::sin(lambda.1 * t_s),
    )
}

fn scaled(a: Complex, by: f64) -> Complex {
    (a.0 * by, a.1 * by)
}

fn product(a: Complex, b: Complex) -> Complex {
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

    #[test]
    fn the_closed_form_is_the_integral() {
        let mode = Mode {
            frequency_hz: 900.0,
            decay_s: 4e-3,
            level: 1.0,
        };
        let contact = 1.3e-3;
        for t in [0.2e-3, 1.0e-3, 1.3e-3, 2.0e-3, 7.0e-3] {
            // The definition, summed by the midpoint rule.
            let steps = 20_000;
            let ds = f64::min(t, contact) / real(steps);
            let sum: f64 = (0..steps)
                .map(|k| {
                    let s = (real(k) + 0.5) * ds;
                    let ring = (-(t - s) / mode.decay_s).exp()
                        * (std::f64::consts::TAU * mode.frequency_hz * (t - s)).sin();
                    ring * (std::f64::consts::PI * s / contact).sin() * ds
                })
                .sum();
            let closed = response(&mode, contact, t);
            assert!(
                (closed - sum / contact).abs() < 1e-8,
                "{t}: {closed} {}",
                sum / contact
            );
        }
    }
}
