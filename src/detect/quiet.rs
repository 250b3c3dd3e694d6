//! A cheap watch over everything: most of a long recording is nothing but its own noise.

use crate::units::{real, samples_in};

/// Length of the frames whose energies are compared, in seconds: about that of an impact.
const FRAME_S: f64 = 1e-3;
/// Length of the units that are judged as a whole, in seconds: short against a drop, so that little silence is kept
/// with it, and long against a frame.
const UNIT_S: f64 = 0.25;
/// Frames that say what is usual.
const USUAL: usize = 8;
/// A frame with this many times the usual energy is a reason to look closer. Of the 30 or more independent values of a
/// frame of white noise, one in 10⁹ sums to that.
const RISE: f32 = 4.0;
/// Samples that are averaged for the low band.
const LOW: usize = 16;
/// Frames that its energy is taken over: fewer would hold too few independent values.
const LOW_FRAMES: usize = 10;
/// Levels below this mean square are digital silence.
const SILENCE: f32 = 1e-14;

/// Listens for frames that rise out of those before them: in the sound itself, in its treble (the differences of
/// neighbours), or in its bass (the means of sixteen).
///
/// Before the first sample there is silence, so the first sound of a recording always rises.
#[derive(Debug, Clone)]
pub struct Watch {
    frame: usize,
    unit: usize,
    all: Past,
    high: Past,
    low: Past,
}

impl Watch {
    /// A watch over samples at this rate.
    #[must_use]
    pub fn new(sample_rate_hz: f64) -> Self {
        let frame = samples_in(FRAME_S, sample_rate_hz)
            .next_multiple_of(LOW)
            .max(2 * LOW);
        let unit = samples_in(UNIT_S, sample_rate_hz).next_multiple_of(frame * LOW_FRAMES);
        Self {
            frame,
            unit,
            all: Past::default(),
            high: Past::default(),
            low: Past::default(),
        }
    }

    /// Samples of one unit.
    #[must_use]
    pub const fn unit(&self) -> usize {
        self.unit
    }

    /// Whether anything rises in the next unit, which is what `samples` holds from an index on; the last unit of a
    /// recording may be shorter.
    pub fn rises(&mut self, samples: &[f32], from: usize) -> bool {
        let unit = &samples[from..];
        match from.checked_sub(1) {
            Some(before) => self.measure(unit, &samples[before..]),
            // Of the very first sample there is none before.
            None => self.measure(unit, &[&unit[..unit.len().min(1)], unit].concat()),
        }
        let scale = 1.0 / narrow(self.frame);
        // The sums of sixteen, not their means, and for each group of sixteen one.
        let bass_scale = 1.0 / narrow(self.frame * LOW_FRAMES * LOW);
        // All three have to be told what was heard, whatever the others say.
        let rises = [
            self.all.rises(scale),
            self.high.rises(scale),
            self.low.rises(bass_scale),
        ];
        rises.contains(&true)
    }

    /// Adds the energies of all whole frames; `earlier` begins one sample before `unit`.
    fn measure(&mut self, unit: &[f32], earlier: &[f32]) {
        let length = self.frame * LOW_FRAMES;
        for (unit, earlier) in unit.chunks(length).zip(earlier.chunks(length)) {
            let frames = unit.chunks_exact(self.frame);
            let mut bass = 0.0;
            for (frame, earlier) in frames.zip(earlier.chunks_exact(self.frame)) {
                let sums = Sums::over(frame, earlier);
                self.all.energies.push(sums.all);
                self.high.energies.push(sums.high);
                bass += sums.bass;
            }
            self.low.energies.push(bass);
        }
    }
}

/// The energies of the last frames, and after them those of the frames to be judged.
#[derive(Debug, Clone)]
struct Past {
    energies: Vec<f32>,
}

impl Default for Past {
    fn default() -> Self {
        Self {
            energies: vec![0.0; USUAL],
        }
    }
}

impl Past {
    /// Whether any frame exceeds the mean of those before it; they then all are past. `scale` makes mean squares of
    /// the energies.
    fn rises(&mut self, scale: f32) -> bool {
        let usual_scale = RISE / narrow(USUAL);
        let least = RISE * SILENCE / scale;
        let frames = &self.energies[USUAL..];
        // One window after the other, but without a way out of the loop: so the machine's vectors can be used.
        let mut highest = f32::NEG_INFINITY;
        for (energy, before) in frames.iter().zip(self.energies.windows(USUAL)) {
            let sum = (before[0] + before[1] + before[2] + before[3])
                + (before[4] + before[5] + before[6] + before[7]);
            highest = highest.max(energy - (usual_scale * sum).max(least));
        }
        let known = self.energies.len() - USUAL;
        self.energies.drain(..known);
        highest > 0.0
    }
}

/// Lanes that are summed side by side, so that the compiler can use the machine's vectors.
const LANES: usize = 4;

/// The energies of one frame, in one go over its samples.
#[derive(Debug, Clone, Copy)]
struct Sums {
    /// Σ x².
    all: f32,
    /// Σ (x − the sample before)².
    high: f32,
    /// Σ (sum of sixteen)².
    bass: f32,
}

impl Sums {
    /// Sums over a frame; `earlier` begins one sample before it.
    fn over(frame: &[f32], earlier: &[f32]) -> Self {
        let (mut all, mut high, mut bass) = ([0.0; LANES], [0.0; LANES], 0.0);
        let groups = frame.as_chunks::<LOW>().0.iter();
        for (group, earlier) in groups.zip(earlier.as_chunks::<LOW>().0) {
            let mut sixteen = [0.0; LANES];
            let quads = group.as_chunks::<LANES>().0.iter();
            for (x, before) in quads.zip(earlier.as_chunks::<LANES>().0) {
                for i in 0..LANES {
                    let step = x[i] - before[i];
                    all[i] += x[i] * x[i];
                    high[i] += step * step;
                    sixteen[i] += x[i];
                }
            }
            bass += total(sixteen) * total(sixteen);
        }
        Self {
            all: total(all),
            high: total(high),
            bass,
        }
    }
}

/// The sum of the lanes, by halves.
fn total(lanes: [f32; LANES]) -> f32 {
    (lanes[0] + lanes[2]) + (lanes[1] + lanes[3])
}

#[expect(clippy::cast_possible_truncation, reason = "counts of a few samples")]
fn narrow(count: usize) -> f32 {
    real(count) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    const RATE_HZ: f64 = 48_000.0;

    fn noise_with(click: f32) -> Vec<f32> {
        let mut rng = SplitMix64::new(9);
        #[expect(clippy::cast_possible_truncation, reason = "test noise")]
        let mut noise: Vec<f32> = (0..480_000).map(|_| (0.01 * rng.normal()) as f32).collect();
        for (i, x) in noise[240_000..240_096].iter_mut().enumerate() {
            *x += if i % 2 == 0 { click } else { -click };
        }
        noise
    }

    /// The units, by the second they begin in, in which something rises.
    fn restless_s(samples: &[f32]) -> Vec<f64> {
        let mut watch = Watch::new(RATE_HZ);
        let unit = watch.unit();
        let starts = (0..samples.len()).step_by(unit);
        let restless = starts.filter(|&i| watch.rises(&samples[..samples.len().min(i + unit)], i));
        restless.map(|i| real(i) / RATE_HZ).collect()
    }

    #[test]
    fn only_the_beginning_of_noise_and_a_click_in_it_rise() {
        assert_eq!(restless_s(&noise_with(0.0)), [0.0]);
        let found = restless_s(&noise_with(0.04));
        assert_eq!(found.len(), 2, "{found:?}");
        assert!((4.7..=5.0).contains(&found[1]), "{found:?}");
    }

    #[test]
    fn a_click_at_the_very_start_of_a_unit_rises_out_of_the_unit_before() {
        let mut sound = noise_with(0.0);
        let border = Watch::new(RATE_HZ).unit();
        sound[8 * border] = 0.3;
        assert_eq!(restless_s(&sound), [0.0, real(8 * border) / RATE_HZ]);
    }

    #[test]
    fn a_thud_under_hiss_rises() {
        let mut sound = noise_with(0.0);
        for (i, x) in sound[240_000..240_480].iter_mut().enumerate() {
            *x += 0.012 * (std::f32::consts::PI * narrow(i) / 120.0).sin();
        }
        assert_eq!(restless_s(&sound).len(), 2);
    }

    #[test]
    fn silence_is_quiet() {
        assert!(restless_s(&vec![0.0; 48_000]).is_empty());
    }
}
