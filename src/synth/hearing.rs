//! Which impacts can be heard, and how exactly the best of methods could time them.
//!
//! # Formula
//! An impact is a known pulse s(t) in noise of spectrum N(f): the steady noise, what still rings of earlier impacts,
//! their echoes, knocks and voices in the same window, and the recorder's steps. The best filter for it lifts it to
//! ```text
//! energy to noise = ∫ |S|²/N df        standard error of its time: σ_t⁻² = ∫ (2πf)² |S|²/N df
//! ```
//! Here N is an autoregressive spectrum from the autocorrelation of everything but the impact. Filtered with the
//! coefficients of that model the noise is white with variance σ², so both integrals are sums over samples:
//! ```text
//! energy to noise = Σ (a∗s)²/σ²        σ_t⁻² = Σ (a∗ds/dt)²/σ²
//! ```
//! Impacts differ: each mode's level scatters by a share σ. A match with the mean sound takes that for a shift, so that
//! its error has a floor, however it is done, unless the modes are told apart:
//! ```text
//! floor² = σ_t² + Σ_modes (σ·⟨m, ds/dt⟩/⟨ds/dt, ds/dt⟩)²,   ⟨x, y⟩ = ∫ X·Y*/N df, m the mode's own sound
//! ```
//! In white noise the limit is `σ_t = σ/√(Σ(ds/dt)²)`. Samples at full scale tell nothing and are left out.

use super::ambience::autocorrelation;
use super::sound::Rendered;

/// Autocorrelations that the model of the noise rests on: order 24.
pub(super) const LAGS: usize = 25;
/// An impact is judged by the stretch that holds this share of its energy.
const SHARE: f64 = 0.99;
/// Energy over noise from which an impact can be heard, in dB.
const AUDIBLE_DB: f64 = 15.0;
/// Two impacts nearer than this are one sound, in seconds.
const NEAREST_S: f64 = 4e-3;
/// White noise in each model of noise, relative to its power: keeps the recursion stable.
const RIDGE: f64 = 1e-9;

/// One impact as it can be heard in one channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Heard {
    pub(super) energy_to_noise_db: f64,
    pub(super) timing_limit_s: f64,
    /// What a match with the mean sound reaches at best, impacts being as different as they are.
    pub(super) timing_floor_s: f64,
    /// Whether something else had driven the recorder to full scale for half of its energy.
    pub(super) lost: bool,
}

impl Heard {
    /// An impact of which no sample is in the recording.
    pub(super) const NOTHING: Self = Self {
        energy_to_noise_db: f64::NEG_INFINITY,
        timing_limit_s: f64::INFINITY,
        timing_floor_s: f64::INFINITY,
        lost: true,
    };

    /// The better of two channels.
    pub(super) fn or(self, other: Self) -> Self {
        if (other.lost, -other.energy_to_noise_db) < (self.lost, -self.energy_to_noise_db) {
            other
        } else {
            self
        }
    }

    /// Whether it can be heard, `since_s` after the one before with contacts of this length.
    pub(super) fn is_audible(&self, since_s: f64, contact_time_s: f64) -> bool {
        !self.lost
            && self.energy_to_noise_db >= AUDIBLE_DB
            && since_s >= NEAREST_S.max(contact_time_s)
    }
}

/// What an impact is heard against.
#[derive(Debug, Clone, Copy)]
pub(super) struct Background<'a> {
    /// Everything that is in the recording without this impact, from its first sample to the next impact.
    pub(super) all: &'a [f64],
    /// The part of it that is not steady.
    pub(super) passing: &'a [f64],
    /// Autocorrelation of the steady part, the recorder's steps included.
    pub(super) steady: &'a [f64; LAGS],
    /// Pressure at which the recorder is at full scale.
    pub(super) full_scale: f64,
}

/// How an impact differs from the others.
#[derive(Debug, Clone, Copy)]
pub(super) struct Variety<'a> {
    /// The sound of each mode alone.
    pub(super) modes: &'a [Rendered],
    /// Standard deviation of ln level of each.
    pub(super) level_scatter: f64,
}

/// How an impact is heard whose sound begins with the first sample of the background.
pub(super) fn hear(direct: &Rendered, variety: Variety<'_>, background: Background<'_>) -> Heard {
    let count = direct.samples_holding(SHARE).min(background.all.len());
    let (pressure, slope) = (&direct.pressure[..count], &direct.slope[..count]);
    let local: [f64; LAGS] = autocorrelation(&background.passing[..count]);
    let model = Model::of(&std::array::from_fn(|k| background.steady[k] + local[k]));
    let all = &background.all[..count];
    let open: Vec<bool> = (0..count)
        .map(|i| (all[i] + pressure[i]).abs() < background.full_scale)
        .collect();
    let slope = model.whitened(slope, &open);
    let information = product(&slope, &slope);
    let shift = |mode: &Rendered| {
        let own = model.whitened(&mode.pressure[..count.min(mode.pressure.len())], &open);
        variety.level_scatter * product(&own, &slope) / information
    };
    let shifts: f64 = variety.modes.iter().map(|m| shift(m) * shift(m)).sum();
    let sound = model.whitened(pressure, &open);
    Heard {
        energy_to_noise_db: 10.0 * libm::log10(product(&sound, &sound)),
        timing_limit_s: 1.0 / libm::sqrt(information),
        timing_floor_s: libm::sqrt(1.0 / information + shifts),
        lost: is_lost(pressure, all, background.full_scale),
    }
}

/// Whether all else alone is at full scale where half of the impact's energy is.
fn is_lost(pressure: &[f64], all: &[f64], full_scale: f64) -> bool {
    let (mut covered, mut total) = (0.0, 0.0);
    for (s, x) in pressure.iter().zip(all) {
        total += s * s;
        covered += if x.abs() >= full_scale { s * s } else { 0.0 };
    }
    covered >= 0.5 * total
}

/// Noise as white noise of some variance through 1/A: x(t) = −a₁x(t−1) − … + ε(t).
#[derive(Debug)]
struct Model {
    coefficients: Vec<f64>,
    variance: f64,
}

impl Model {
    /// The recursion of Levinson and Durbin.
    fn of(correlation: &[f64; LAGS]) -> Self {
        let mut variance = correlation[0] * (1.0 + RIDGE) + f64::MIN_POSITIVE;
        let mut a = vec![1.0];
        for order in 1..LAGS {
            let ahead: f64 = (0..order).map(|k| a[k] * correlation[order - k]).sum();
            let reflection = -ahead / variance;
            a.push(0.0);
            let before = a.clone();
            for k in 1..=order {
                a[k] += reflection * before[order - k];
            }
            let left = variance * (1.0 - reflection * reflection);
            if left <= RIDGE * RIDGE * correlation[0] {
                break;
            }
            variance = left;
        }
        Self {
            coefficients: a,
            variance,
        }
    }

    /// (a∗x)/σ at the open samples, x being 0 before its start.
    fn whitened(&self, samples: &[f64], open: &[bool]) -> Vec<f64> {
        let scale = 1.0 / libm::sqrt(self.variance);
        let pairs = open.iter().enumerate().take(samples.len());
        let at = |i: usize| {
            let past = samples[..=i].iter().rev();
            scale
                * self
                    .coefficients
                    .iter()
                    .zip(past)
                    .map(|(a, x)| a * x)
                    .sum::<f64>()
        };
        pairs
            .map(|(i, &open)| if open { at(i) } else { 0.0 })
            .collect()
    }
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;
    use crate::synth::scene::Mode;
    use crate::synth::sound::Sound;

    fn click() -> Rendered {
        let mode = Mode {
            frequency_hz: 5_000.0,
            decay_s: 3e-3,
            level: 1.0,
        };
        Sound::new(&[mode], 0.1e-3).render(44_100.0, 0.1, 1.0)
    }

    fn against(noise: &[f64], full_scale: f64) -> Heard {
        let steady = autocorrelation(noise);
        let background = Background {
            all: noise,
            passing: &vec![0.0; noise.len()],
            steady: &steady,
            full_scale,
        };
        let direct = click();
        let variety = Variety {
            modes: std::slice::from_ref(&direct),
            level_scatter: 0.1,
        };
        hear(&direct, variety, background)
    }

    fn white(level: f64) -> Vec<f64> {
        let mut rng = SplitMix64::new(5);
        (0..100_000).map(|_| level * rng.normal()).collect()
    }

    #[test]
    fn in_white_noise_the_limit_is_that_of_the_textbook() {
        let made = click();
        let held = made.samples_holding(SHARE);
        let sum = |xs: &[f64]| xs[..held].iter().map(|x| x * x).sum::<f64>();
        let heard = against(&white(0.01), 1e9);
        let limit = 0.01 / sum(&made.slope).sqrt();
        assert!((heard.timing_limit_s / limit - 1.0).abs() < 0.02);
        // A mode that grows as a whole is not moved by it, but for where its sound begins.
        let moved = 0.1
            * made.pressure[..held]
                .iter()
                .zip(&made.slope)
                .map(|(p, s)| p * s)
                .sum::<f64>();
        let floor = limit.hypot(moved / sum(&made.slope));
        assert!((heard.timing_floor_s / floor - 1.0).abs() < 0.02);
        let ratio_db = 10.0 * (sum(&made.pressure) / 1e-4).log10();
        assert!((heard.energy_to_noise_db - ratio_db).abs() < 0.2);
    }

    #[test]
    fn a_low_tone_hardly_harms_a_high_click() {
        let mut noise = white(1e-3);
        let quiet = against(&noise, 1e9);
        for (i, x) in noise.iter_mut().enumerate() {
            *x += 0.1 * (0.01 * crate::units::real(i)).sin();
        }
        let hummed = against(&noise, 1e9);
        let lost_db = quiet.energy_to_noise_db - hummed.energy_to_noise_db;
        assert!(lost_db > -0.5 && lost_db < 3.0, "{lost_db} dB");
    }

    #[test]
    fn what_is_under_a_full_scale_knock_is_lost() {
        let mut noise = white(1e-3);
        assert!(!against(&noise, 1.0).lost);
        noise[..600].fill(2.0);
        assert!(against(&noise, 1.0).lost);
    }
}
