//! What is heard besides impacts: steady noises here, bursts of all kinds in [`super::bursts`].

use serde::{Deserialize, Serialize};

use super::babble::Words;
use super::bursts::{Knocks, Steps};
use super::half_sine::{exponential, product};
use super::scene::within;
use super::sound::rms;
use super::taps::Taps;
use super::{babble, bursts, decibels};
use crate::Error;
use crate::random::SplitMix64;
use crate::units::real;

/// What is heard besides impacts. Levels in dB of full scale at the recorder's input; minus infinity is none.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Noise {
    /// White noise, rms. Each channel has its own. Default −70.
    pub white_db: f64,
    /// Pink noise (−3 dB per octave), rms: rumble, wind, traffic. Each channel has its own.
    pub pink_db: f64,
    /// A steady tone, rms.
    pub tone_db: f64,
    /// Its frequency in Hz.
    pub tone_hz: f64,
    /// Mains hum with its harmonics, rms.
    pub hum_db: f64,
    /// Its fundamental in Hz.
    pub hum_hz: f64,
    /// Speech-like bursts, rms of a syllable.
    pub babble_db: f64,
    /// Knocks at random times.
    pub knocks: Option<Knocks>,
    /// Steps or ticks at regular times.
    pub steps: Option<Steps>,
    /// Words whose syllables quicken and fade as the impacts of a ball do.
    pub words: Option<Words>,
    /// Rows of like sounds: taps, claps, keys, a game.
    pub taps: Vec<Taps>,
}

impl Default for Noise {
    fn default() -> Self {
        Self {
            white_db: -70.0,
            pink_db: f64::NEG_INFINITY,
            tone_db: f64::NEG_INFINITY,
            tone_hz: 1_000.0,
            hum_db: f64::NEG_INFINITY,
            hum_hz: 50.0,
            babble_db: f64::NEG_INFINITY,
            knocks: None,
            steps: None,
            words: None,
            taps: Vec::new(),
        }
    }
}

/// Noise as it is in one channel, in two parts: the first is alike at all times, the second is not.
#[derive(Debug, Clone)]
pub(super) struct Ambience {
    pub(super) steady: Vec<f64>,
    pub(super) bursts: Vec<f64>,
}

/// Harmonics of hum, the fundamental included.
const HARMONICS: u32 = 12;

impl Noise {
    pub(super) fn check(&self) -> Result<(), Error> {
        let levels = [
            ("white_db", self.white_db),
            ("pink_db", self.pink_db),
            ("tone_db", self.tone_db),
            ("hum_db", self.hum_db),
            ("babble_db", self.babble_db),
        ];
        for (name, level) in levels {
            within(
                name,
                level,
                f64::NEG_INFINITY..=20.0,
                "20 dB or less (-inf for none)",
            )?;
        }
        within("tone_hz", self.tone_hz, 1.0..=1e6, "1 Hz or more")?;
        within("hum_hz", self.hum_hz, 1.0..=1e6, "1 Hz or more")?;
        self.knocks.map_or(Ok(()), |knocks| knocks.check())?;
        self.steps.map_or(Ok(()), |steps| steps.check())?;
        self.words.map_or(Ok(()), Words::check)?;
        self.taps.iter().try_for_each(Taps::check)
    }

    /// Noise of one channel. `own` differs from channel to channel, `shared` is the same in all: hum, voices and knocks
    /// come from one place.
    pub(super) fn render(
        &self,
        count: usize,
        rate: f64,
        mut own: SplitMix64,
        mut shared: SplitMix64,
    ) -> Ambience {
        let mut steady = vec![0.0; count];
        add_white(decibels(self.white_db), &mut own, &mut steady);
        add_pink(decibels(self.pink_db), &mut own, &mut steady);
        let tone = decibels(self.tone_db) * std::f64::consts::SQRT_2;
        add_tone(tone, self.tone_hz, 0.0, rate, &mut steady);
        self.add_hum(rate, &mut shared, &mut steady);
        let mut bursts = vec![0.0; count];
        if self.babble_db > f64::NEG_INFINITY {
            babble::add(decibels(self.babble_db), rate, &mut shared, &mut bursts);
        }
        if let Some(knocks) = self.knocks {
            bursts::add_knocks(knocks, rate, &mut shared, &mut bursts);
        }
        if let Some(steps) = self.steps {
            bursts::add_steps(steps, rate, &mut shared, &mut bursts);
        }
        if let Some(words) = self.words {
            babble::add_words(words, rate, &mut shared, &mut bursts);
        }
        for taps in &self.taps {
            taps.add(rate, &mut shared, &mut bursts);
        }
        Ambience { steady, bursts }
    }

    /// Harmonics k with amplitudes 1/k and random phases.
    fn add_hum(&self, rate: f64, rng: &mut SplitMix64, samples: &mut [f64]) {
        let level = decibels(self.hum_db);
        let harmonics = (1..=HARMONICS).map(f64::from);
        let power: f64 = harmonics.clone().map(|k| 0.5 / (k * k)).sum();
        for k in harmonics {
            let phase = std::f64::consts::TAU * rng.uniform();
            let amplitude = level / libm::sqrt(power) / k;
            add_tone(amplitude, k * self.hum_hz, phase, rate, samples);
        }
    }
}

fn add_white(level: f64, rng: &mut SplitMix64, samples: &mut [f64]) {
    if level > 0.0 {
        for x in samples {
            *x += level * rng.normal();
        }
    }
}

/// White noise through three one-pole filters, the sum of which falls by 3 dB an octave within 0.5 dB over the audible
/// range (Kellet's economy filter), scaled to its rms.
fn add_pink(level: f64, rng: &mut SplitMix64, samples: &mut [f64]) {
    if level <= 0.0 {
        return;
    }
    let mut poles = [0.0; 3];
    let pink: Vec<f64> = samples
        .iter()
        .map(|_| {
            let white = rng.normal();
            for (y, (pole, gain)) in poles.iter_mut().zip([
                (0.997_65, 0.099_046_0),
                (0.963_00, 0.296_516_4),
                (0.570_00, 1.052_691_3),
            ]) {
                *y = pole * *y + gain * white;
            }
            poles.iter().sum::<f64>() + 0.184_8 * white
        })
        .collect();
    let gain = level / rms(&pink).max(f64::MIN_POSITIVE);
    for (x, y) in samples.iter_mut().zip(&pink) {
        *x += gain * y;
    }
}

/// A sine, turned on from sample to sample: exact to rounding, and the same everywhere. Above Nyquist there is none.
fn add_tone(amplitude: f64, frequency_hz: f64, phase: f64, rate: f64, samples: &mut [f64]) {
    if amplitude <= 0.0 || frequency_hz >= 0.5 * rate {
        return;
    }
    let step = exponential((0.0, std::f64::consts::TAU * frequency_hz), 1.0 / rate);
    let mut z = (libm::cos(phase), libm::sin(phase));
    for x in samples {
        *x += amplitude * z.1;
        z = product(z, step);
    }
}

/// Mean of x(t)·x(t + k) for k from 0 up.
pub(super) fn autocorrelation<const LAGS: usize>(samples: &[f64]) -> [f64; LAGS] {
    std::array::from_fn(|lag| {
        let pairs = samples.iter().zip(samples.iter().skip(lag));
        pairs.map(|(a, b)| a * b).sum::<f64>() / real(samples.len().max(1))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn only(change: impl Fn(&mut Noise)) -> Vec<f64> {
        let mut noise = Noise {
            white_db: f64::NEG_INFINITY,
            ..Noise::default()
        };
        change(&mut noise);
        let [own, shared] = [1, 2].map(SplitMix64::new);
        noise.render(200_000, 44_100.0, own, shared).steady
    }

    #[test]
    fn every_steady_noise_has_its_level() {
        for samples in [
            only(|n| n.white_db = -40.0),
            only(|n| n.pink_db = -40.0),
            only(|n| n.tone_db = -40.0),
            only(|n| n.hum_db = -40.0),
        ] {
            let level = 20.0 * rms(&samples).log10();
            assert!((level + 40.0).abs() < 0.1, "{level}");
        }
        assert!(only(|_| ()).iter().all(|&x| x == 0.0));
    }

    #[test]
    fn pink_noise_falls_by_3_db_an_octave() {
        let samples = only(|n| n.pink_db = -20.0);
        // Power in octave bands is equal: measured by sums over sines of random frequencies in the band.
        let power_at = |hz: f64| -> f64 {
            let step = std::f64::consts::TAU * hz / 44_100.0;
            let blocks = samples.chunks_exact(4_000);
            blocks
                .map(|b| {
                    let sum = b.iter().enumerate().fold((0.0, 0.0), |(c, s), (i, x)| {
                        let phase = step * real(i);
                        (c + x * phase.cos(), s + x * phase.sin())
                    });
                    sum.0 * sum.0 + sum.1 * sum.1
                })
                .sum()
        };
        let band = |hz: f64| {
            (0..8)
                .map(|k| power_at(hz * (1.0 + 0.05 * f64::from(k))))
                .sum::<f64>()
        };
        let slope = 10.0 * (band(4_000.0) / band(500.0)).log10() / 3.0;
        assert!((slope + 3.0).abs() < 0.5, "{slope} dB an octave");
    }
}
