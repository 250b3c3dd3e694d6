//! The sound of one impact: damped modes driven by the force of the contact, in closed form.

use super::scene::Mode;
use super::{instant_s, sample_after};
use crate::units::{real, samples_in};

/// A mode is followed until it has fallen by this many times 1/e, 156 dB: 12 dB more than 24 bits hold.
const DECAYS: f64 = 18.0;
/// Modes above this share of the sample rate are left out, as a recorder's filter does.
const HIGHEST_OF_RATE: f64 = 0.45;

/// A complex number, as two reals.
type Complex = (f64, f64);

/// What an impact of a ball sounds like.
///
/// # Formula
/// The force is half a sine, `F(t) = sin(Ωt)` for 0 < t < ΔT with Ω = π/ΔT. A mode answers a knock with
/// `Im exp(λt)`, λ = −1/decay + i·2π·frequency, so it answers the force with
/// ```text
/// y(t) = Im z(t),   z(t) = ∫₀^τ exp(λ(t − s)) sin(Ωs) ds,   τ = min(t, ΔT)
///                        = [Ω exp(λt) − exp(λ(t − τ))·(λ sin Ωτ + Ω cos Ωτ)] / (λ² + Ω²)
/// dy/dt = Im (λz + F) = Im λz
/// ```
/// It is evaluated at each sample's own instant, so an impact may fall anywhere between two samples. After the contact
/// z turns and shrinks by the same factor `exp(λ/rate)` from sample to sample.
#[derive(Debug, Clone)]
pub struct Sound {
    modes: Vec<Mode>,
    contact_time_s: f64,
    longest_s: f64,
}

/// The samples of one sound.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct Rendered {
    /// Index in the recording of the first sample; it may lie before its start.
    pub first: i64,
    /// Pressure.
    pub pressure: Vec<f64>,
    /// Its derivative in time, per second.
    pub slope: Vec<f64>,
}

impl Sound {
    /// The sound of modes excited by a contact of this length in seconds.
    #[must_use]
    pub fn new(modes: &[Mode], contact_time_s: f64) -> Self {
        Self {
            modes: modes.to_vec(),
            contact_time_s,
            longest_s: f64::INFINITY,
        }
    }

    /// The same sound, followed for so many seconds at most: what nobody will hear costs time and memory too.
    #[must_use]
    pub const fn at_most(mut self, longest_s: f64) -> Self {
        self.longest_s = longest_s;
        self
    }

    /// The samples, at a rate, of an impact at `onset_s`, times `gain`.
    #[must_use]
    pub fn render(&self, rate: f64, onset_s: f64, gain: f64) -> Rendered {
        let first = sample_after(onset_s, rate);
        let audible = |m: &&Mode| m.frequency_hz < HIGHEST_OF_RATE * rate;
        let longest = self.modes.iter().filter(audible).map(|m| m.decay_s);
        let length_s = self.contact_time_s + DECAYS * longest.fold(0.0, f64::max);
        let count = samples_in(length_s.min(self.longest_s), rate);
        let mut rendered = Rendered {
            first: first.index,
            pressure: vec![0.0; count],
            slope: vec![0.0; count],
        };
        for mode in self.modes.iter().filter(audible) {
            self.add_mode(mode, rate, first.instant_s - onset_s, gain, &mut rendered);
        }
        rendered
    }

    /// The sound of each mode alone, as [`Sound::render`] gives their sum.
    #[must_use]
    pub fn modes(&self, rate: f64, onset_s: f64, gain: f64) -> Vec<Rendered> {
        let alone = |mode: &Mode| {
            Self::new(std::slice::from_ref(mode), self.contact_time_s).at_most(self.longest_s)
        };
        let modes = self.modes.iter();
        modes
            .map(|m| alone(m).render(rate, onset_s, gain))
            .collect()
    }

    /// Adds one mode, `start_s` being the time of the first sample after the touch.
    fn add_mode(&self, mode: &Mode, rate: f64, start_s: f64, gain: f64, to: &mut Rendered) {
        let force = HalfSine::new(mode, self.contact_time_s);
        let scale = gain * mode.level / self.contact_time_s;
        let length = samples_in(self.contact_time_s + DECAYS * mode.decay_s, rate);
        let step = exponential(force.lambda, 1.0 / rate);
        let mut free: Option<Complex> = None;
        let pairs = to.pressure.iter_mut().zip(&mut to.slope);
        for (i, (pressure, slope)) in pairs.enumerate().take(length) {
            let t_s = start_s + instant_s(i, rate);
            let z = match free {
                Some(z) => product(z, step),
                None => force.answer(t_s),
            };
            if t_s >= self.contact_time_s {
                free = Some(z);
            }
            *pressure += scale * z.1;
            *slope += scale * product(force.lambda, z).1;
        }
    }
}

impl Rendered {
    /// The greatest pressure.
    #[must_use]
    pub fn peak(&self) -> f64 {
        self.pressure.iter().fold(0.0, |m, x| x.abs().max(m))
    }

    /// Adds the pressure to samples, `later` samples later, times `gain`.
    pub(super) fn add_to(&self, samples: &mut [f64], later: usize, gain: f64) {
        add(&self.pressure, self.first, later, gain, samples);
    }

    /// Adds only its beginning, of this many samples.
    pub(super) fn add_start_to(&self, count: usize, samples: &mut [f64], later: usize, gain: f64) {
        let start = &self.pressure[..count.min(self.pressure.len())];
        add(start, self.first, later, gain, samples);
    }

    /// How many samples hold this share of its energy.
    pub(super) fn samples_holding(&self, share: f64) -> usize {
        let energy: f64 = self.pressure.iter().map(|x| x * x).sum();
        let mut sum = 0.0;
        let held = self.pressure.iter().position(|x| {
            sum += x * x;
            sum >= share * energy
        });
        held.map_or(self.pressure.len(), |last| last + 1)
    }

    /// Frequency of a tone that changes as fast as this sound does, in Hz: √(Σ(ds/dt)²/Σs²)/2π.
    pub(super) fn frequency_hz(&self) -> f64 {
        let sum = |xs: &[f64]| xs.iter().map(|x| x * x).sum::<f64>();
        let (energy, change) = (sum(&self.pressure), sum(&self.slope));
        if energy > 0.0 {
            libm::sqrt(change / energy) / std::f64::consts::TAU
        } else {
            0.0
        }
    }
}

fn add(sound: &[f64], first: i64, later: usize, gain: f64, samples: &mut [f64]) {
    let Ok(delay) = i64::try_from(later) else {
        return;
    };
    let at = first.saturating_add(delay);
    let skipped = usize::try_from(at.saturating_neg()).unwrap_or(0);
    let start = usize::try_from(at).unwrap_or(0).min(samples.len());
    for (x, s) in samples[start..].iter_mut().zip(sound.iter().skip(skipped)) {
        *x += gain * s;
    }
}

/// The answer of one mode to the force of a contact.
struct HalfSine {
    lambda: Complex,
    omega: f64,
    contact_time_s: f64,
    /// λ² + Ω².
    denominator: Complex,
}

impl HalfSine {
    fn new(mode: &Mode, contact_time_s: f64) -> Self {
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

    /// z(t) of [`Sound`]; 0 before the touch. Both exponents fall, so nothing overflows.
    fn answer(&self, t_s: f64) -> Complex {
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

/// Root mean square.
pub(super) fn rms(samples: &[f64]) -> f64 {
    libm::sqrt(samples.iter().map(|x| x * x).sum::<f64>() / real(samples.len().max(1)))
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn samples_are_the_closed_form_at_their_own_instants() {
        let (rate, onset, contact) = (48_000.0, 0.123_456_7, 0.7e-3);
        // Times ΔT, by which sounds are divided.
        let made = Sound::new(&[MODE], contact).render(rate, onset, contact);
        let half_sine = HalfSine::new(&MODE, contact);
        for (i, y) in made.pressure.iter().enumerate() {
            let t = real(5_926 + i) / rate - onset;
            assert!((y - half_sine.answer(t).1).abs() < 1e-16, "{i}: {y}");
        }
        assert_eq!(made.first, 5_926);
    }

    #[test]
    fn the_slope_is_the_change_of_pressure() {
        let (rate, step) = (48_000.0, 1e-9);
        let sound = Sound::new(&[MODE], 0.7e-3);
        let [early, made, late] =
            [step, 0.0, -step].map(|shift| sound.render(rate, 0.100_003 + shift, 1.0));
        for i in 0..1_000 {
            let change = (late.pressure[i] - early.pressure[i]) / (2.0 * step);
            assert!((change - made.slope[i]).abs() < 1e-4 * 2_500.0, "{i}");
        }
    }
}
