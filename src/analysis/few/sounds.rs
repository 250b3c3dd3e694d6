//! Sounds that stand out by themselves: when each begins, how loud it is, what it is like and whether it is short.

use crate::detect::Detector;
use crate::event::{Event, Profile};
use crate::order::sort_by_number;
use crate::sequence::few::ClearSound;
use crate::signal::filterbank::Band;
use crate::signal::sound::Sound;
use crate::units::{narrow, real, samples_in, whole};

/// Least strength of an event that may begin a clear sound, in nats: white noise offers one in hours.
const LEAST_STRENGTH: f64 = 18.0;
/// What follows a louder onset within this time, in seconds, is its echo or its ring: 17 m to a wall.
const OWN_S: f64 = 0.1;
/// A sound is as loud as it is within this time after its onset, in seconds: the first half-wave of a thud of 40 Hz.
const LOUDEST_WITHIN_S: f64 = 0.012;
/// The body of a sound, in seconds from its onset on: its profile is that of an impact with its ring, and not of its first edge
/// alone, which depends on where exactly the onset was put.
const BODY_S: f64 = 0.03;
/// A sound is short if half of its energy is over by this time after its onset, in seconds. Measured: 40 of 46 impacts of eight
/// recordings, one in three other sounds of them.
const SHORT_S: f64 = 0.03;
/// The usual level before an onset is learnt from this stretch, in seconds before it.
const BEFORE_S: (f64, f64) = (0.03, 2e-3);
/// A sound is new if more than this share of it was not there before. Derived: what is less changes another sound.
const NEW_SHARE: f64 = 0.5;
/// The course of a sound is followed in steps of so many seconds.
const STEP_S: f64 = 2e-3;

/// The clear sounds among events, in order of time.
pub(super) fn clear_sounds(
    sound: &Sound<'_>,
    detector: &Detector,
    events: &[Event],
) -> Vec<ClearSound> {
    let strong: Vec<&Event> = events
        .iter()
        .filter(|e| e.strength >= LEAST_STRENGTH)
        .collect();
    if strong.len() < 2 {
        return Vec::new();
    }
    let spectrum = Spectrum {
        bands: detector.bank().split(sound.samples),
        hop_s: detector.bank().hop_s(),
        start_s: sound.start_s,
    };
    let mut heard: Vec<ClearSound> = strong
        .into_iter()
        .filter_map(|e| spectrum.sound(e))
        .collect();
    sort_by_number(&mut heard, |sound: &ClearSound| -sound.level);
    let mut clear: Vec<ClearSound> = Vec::new();
    for sound in heard {
        let near = |louder: &ClearSound| (0.0..OWN_S).contains(&(sound.time_s - louder.time_s));
        if !clear.iter().any(near) {
            clear.push(sound);
        }
    }
    sort_by_number(&mut clear, |sound| sound.time_s);
    clear
}

/// The energy of each octave on a grid of hops.
#[derive(Debug)]
struct Spectrum {
    bands: Vec<Band>,
    hop_s: f64,
    start_s: f64,
}

impl Spectrum {
    /// Mean energy of a band between two times; 0 outside the recording.
    fn mean(&self, band: &Band, from_s: f64, to_s: f64) -> f64 {
        let at = |time_s: f64| samples_in(time_s - self.start_s, 1.0 / self.hop_s);
        let end = at(to_s).min(band.energies.len());
        let energies = &band.energies[at(from_s).min(end)..end];
        let sum: f64 = energies.iter().map(|e| f64::from(*e)).sum();
        sum / real(energies.len().max(1))
    }

    /// Energy of each band between two times after an onset, as far as it exceeds that before.
    fn above(&self, onset_s: f64, from_s: f64, to_s: f64) -> impl Iterator<Item = f64> {
        self.bands.iter().map(move |band| {
            let after = self.mean(band, onset_s + from_s, onset_s + to_s);
            (after - self.before(band, onset_s)).max(0.0)
        })
    }

    /// Mean energy of a band before an onset.
    fn before(&self, band: &Band, onset_s: f64) -> f64 {
        self.mean(band, onset_s - BEFORE_S.0, onset_s - BEFORE_S.1)
    }

    /// The share of the energy after an onset that was not there before.
    ///
    /// # Formula
    /// `Σ a²/(a + b) / Σ a` over bands, a the energy that exceeds the b before: each band counts by what came in it, so that noise in
    /// others says nothing.
    fn new_share(&self, onset_s: f64) -> f64 {
        let above: Vec<f64> = self.above(onset_s, 0.0, LOUDEST_WITHIN_S).collect();
        let own = self.bands.iter().zip(&above).map(|(band, above)| {
            let before = self.before(band, onset_s);
            above * above / (above + before).max(f64::MIN_POSITIVE)
        });
        own.sum::<f64>() / above.iter().sum::<f64>().max(f64::MIN_POSITIVE)
    }

    /// The sound that an event begins; none where nothing exceeds the level before.
    fn sound(&self, event: &Event) -> Option<ClearSound> {
        let step = |i: usize| {
            let from_s = STEP_S * (real(i) - 0.5);
            self.above(event.time_s, from_s, from_s + STEP_S)
                .sum::<f64>()
        };
        let course: Vec<f64> = (0..whole(OWN_S / STEP_S)).map(step).collect();
        let energy = |until_s: f64| course[..whole(until_s / STEP_S)].iter();
        let loudest = energy(LOUDEST_WITHIN_S).copied().fold(0.0, f64::max);
        let body = self.above(event.time_s, 0.0, BODY_S);
        (loudest > 0.0).then(|| ClearSound {
            time_s: event.time_s,
            jitter_s: event.jitter_s,
            level: 0.5 * loudest.ln(),
            is_short: 2.0 * energy(SHORT_S).sum::<f64>() > energy(OWN_S).sum::<f64>(),
            is_new: self.new_share(event.time_s) > NEW_SHARE,
            profile: Profile::new(body.map(narrow)),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// A vowel of 0.4 s whose level rises twice in its midst, behind noise; or the same three sounds, each over at once.
    fn heard(is_vowel: bool) -> Vec<bool> {
        let rate = 16_000.0;
        let (onsets_s, levels) = ([0.5, 0.66, 0.78], [0.5, 0.4, 0.35]);
        let level = |time_s: f64| {
            let begun = onsets_s.iter().zip(levels).rev();
            let mut begun = begun.filter(|(onset_s, _)| time_s >= **onset_s);
            let (onset_s, level) = begun.next()?;
            let decay_s = if is_vowel { 0.6 } else { 0.008 };
            Some(level * (-(time_s - onset_s) / decay_s).exp())
        };
        let mut random = crate::random::SplitMix64::new(1);
        let sample = |i: usize| {
            let time_s = real(i) / rate;
            let tone = (TAU * 900.0 * time_s).sin() + 0.5 * (TAU * 2_600.0 * time_s).sin();
            narrow(level(time_s).unwrap_or(0.0) * tone + 1e-3 * random.normal())
        };
        let samples: Vec<f32> = (0..16_000).map(sample).collect();
        let sound = Sound {
            samples: &samples,
            sample_rate_hz: rate,
            start_s: 0.0,
        };
        let detector = Detector::new(rate).unwrap();
        let event = |&time_s: &f64| Event {
            time_s,
            jitter_s: 1e-4,
            strength: 30.0,
            loudness: 3.4,
            profile: Profile::default(),
        };
        let events: Vec<Event> = onsets_s.iter().map(event).collect();
        let clear = clear_sounds(&sound, &detector, &events);
        clear.iter().map(|sound| sound.is_new).collect()
    }

    #[test]
    fn a_rise_within_a_vowel_is_no_new_sound() {
        assert_eq!(heard(true), [true, false, false]);
        assert_eq!(heard(false), [true, true, true]);
    }
}
