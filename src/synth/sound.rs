//! The sound of one impact: damped modes driven by the force of the contact, in closed form.

use super::half_sine::{Complex, HalfSine, exponential, product};
use super::scene::Mode;
use super::{instant_s, sample_after};
use crate::units::{real, samples_in};

/// A mode is followed until it has fallen by this many times 1/e, 156 dB: 12 dB more than 24 bits hold.
const DECAYS: f64 = 18.0;
/// Modes above this share of the sample rate are left out, as a recorder's filter does.
const HIGHEST_OF_RATE: f64 = 0.45;

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
/// A mode that is heard with a phase φ, as from another place of ball and surface, is `y(t) = Im exp(iφ)z(t)`, with
/// `dy/dt = Im exp(iφ)(λz + F)`: it begins with t² where one without begins with t³.
/// It is evaluated at each sample's own instant, so an impact may fall anywhere between two samples. After the contact
/// z turns and shrinks by the same factor `exp(λ/rate)` from sample to sample.
#[derive(Debug, Clone)]
pub struct Sound {
    partials: Vec<Partial>,
    contact_time_s: f64,
    longest_s: f64,
}

/// A mode as it is heard.
#[derive(Debug, Clone, Copy)]
struct Partial {
    mode: Mode,
    /// exp(iφ).
    turn: Complex,
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
        Self::with_phases(modes.iter().map(|&mode| (mode, 0.0)), contact_time_s)
    }

    /// The same of modes that are heard with phases φ, in radians.
    #[must_use]
    pub fn with_phases(modes: impl IntoIterator<Item = (Mode, f64)>, contact_time_s: f64) -> Self {
        let partials = modes.into_iter().map(|(mode, phase)| Partial {
            mode,
            turn: turned(phase),
        });
        Self {
            partials: partials.collect(),
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

    /// The same with each mode at another level and phase: a factor, and radians that are added.
    pub(super) fn unlike(&self, mut by: impl FnMut() -> (f64, f64)) -> Self {
        let mut other = self.clone();
        for partial in &mut other.partials {
            let (factor, phase) = by();
            partial.mode.level *= factor;
            partial.turn = product(partial.turn, turned(phase));
        }
        other
    }

    /// The samples, at a rate, of an impact at `onset_s`, times `gain`.
    #[must_use]
    pub fn render(&self, rate: f64, onset_s: f64, gain: f64) -> Rendered {
        let first = sample_after(onset_s, rate);
        let audible = |p: &&Partial| p.mode.frequency_hz < HIGHEST_OF_RATE * rate;
        let longest = self.partials.iter().filter(audible);
        let longest = longest.map(|p| p.mode.decay_s);
        let length_s = self.contact_time_s + DECAYS * longest.fold(0.0, f64::max);
        let count = samples_in(length_s.min(self.longest_s), rate);
        let mut rendered = Rendered {
            first: first.index,
            pressure: vec![0.0; count],
            slope: vec![0.0; count],
        };
        for partial in self.partials.iter().filter(audible) {
            self.add_partial(
                partial,
                rate,
                first.instant_s - onset_s,
                gain,
                &mut rendered,
            );
        }
        rendered
    }

    /// The sound of each mode alone, as [`Sound::render`] gives their sum.
    #[must_use]
    pub fn modes(&self, rate: f64, onset_s: f64, gain: f64) -> Vec<Rendered> {
        let alone = |partial: &Partial| Self {
            partials: vec![*partial],
            ..*self
        };
        let partials = self.partials.iter();
        partials
            .map(|p| alone(p).render(rate, onset_s, gain))
            .collect()
    }

    /// Adds one mode, `start_s` being the time of the first sample after the touch.
    fn add_partial(
        &self,
        partial: &Partial,
        rate: f64,
        start_s: f64,
        gain: f64,
        to: &mut Rendered,
    ) {
        let Partial { mode, turn } = partial;
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
            let change = product(force.lambda, z);
            let change = (change.0 + force.force(t_s), change.1);
            *pressure += scale * product(*turn, z).1;
            *slope += scale * product(*turn, change).1;
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

/// exp(iφ).
fn turned(phase: f64) -> Complex {
    (libm::cos(phase), libm::sin(phase))
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
