//! An activity gate: a cheap test of short-time energy that passes on the units in which something rises. Most of a long
//! recording is background noise.

use crate::units::{narrow, real, samples_in};

/// Length of the frames whose energies are compared, in seconds: about that of an impact.
const FRAME_S: f64 = 1e-3;
/// Length of the units that are judged as a whole, in seconds: short against a drop, so that little silence is kept
/// with it, and long against a frame.
const UNIT_S: f64 = 0.25;
/// Frames before a frame whose mean is its usual energy.
const USUAL: usize = 8;
/// A frame opens the gate with this many times the usual energy. Derived: of the 24 independent values that a frame
/// of white noise at 48 kHz has at least, one in 10⁹ sums to that; of the 16 at the lowest rates, one in 10⁷.
const RISE: f32 = 4.0;
/// Samples that are averaged for the low band.
const LOW: usize = 16;
/// Frames that its energy is taken over: fewer would hold too few independent values.
const LOW_FRAMES: usize = 10;
/// Levels below this mean square are digital silence.
const SILENCE: f32 = 1e-14;

/// A gate that opens for frames that rise out of those before them: in the sound itself, in its treble (the differences
/// of pairs), or in its bass (the means of sixteen).
///
/// The past before the first sample counts as silence, so the first sound of a recording always rises.
#[derive(Debug, Clone)]
pub struct ActivityGate {
    frame: usize,
    unit: usize,
    all: Past,
    high: Past,
    low: Past,
}

impl ActivityGate {
    /// A gate over samples at this rate.
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

    /// Whether anything rises in the next unit; the last one of a recording may be shorter.
    pub fn rises(&mut self, unit: &[f32]) -> bool {
        self.measure(unit);
        let scale = 1.0 / narrow(real(self.frame));
        // The sums of sixteen, not their means, and for each group of sixteen one.
        let bass_scale = 1.0 / narrow(real(self.frame * LOW_FRAMES * LOW));
        // Each of the three takes in the unit, whatever the others say.
        let rises = [
            self.all.rises(scale),
            self.high.rises(scale),
            self.low.rises(bass_scale),
        ];
        rises.contains(&true)
    }

    /// Adds the energies of all whole frames.
    fn measure(&mut self, unit: &[f32]) {
        for frames in unit.chunks(self.frame * LOW_FRAMES) {
            let mut bass = 0.0;
            for frame in frames.chunks_exact(self.frame) {
                let sums = Sums::over(frame);
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
        let usual_scale = RISE / narrow(real(USUAL));
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
    /// Σ (difference of two)², over pairs that do not overlap.
    high: f32,
    /// Σ (sum of sixteen)².
    bass: f32,
}

impl Sums {
    /// # Formula
    /// `a² + b² = ½·[(a + b)² + (b − a)²]`: sums and differences of pairs give all three energies.
    fn over(frame: &[f32]) -> Self {
        let (mut sums, mut differences, mut bass) = ([0.0; LANES], [0.0; LANES], 0.0);
        for group in frame.as_chunks::<LOW>().0 {
            let mut sixteen = [0.0; LANES];
            for pairs in group.as_chunks::<{ 2 * LANES }>().0 {
                for i in 0..LANES {
                    let (a, b) = (pairs[2 * i], pairs[2 * i + 1]);
                    let (sum, difference) = (a + b, b - a);
                    sums[i] += sum * sum;
                    differences[i] += difference * difference;
                    sixteen[i] += sum;
                }
            }
            bass += total(sixteen) * total(sixteen);
        }
        let (sums, high) = (total(sums), total(differences));
        Self {
            all: 0.5 * (sums + high),
            high,
            bass,
        }
    }
}

/// The sum of the lanes, by halves.
fn total(lanes: [f32; LANES]) -> f32 {
    (lanes[0] + lanes[2]) + (lanes[1] + lanes[3])
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
        let mut gate = ActivityGate::new(RATE_HZ);
        let unit = gate.unit();
        let starts = (0..samples.len()).step_by(unit);
        let restless = starts.filter(|&i| gate.rises(&samples[i..samples.len().min(i + unit)]));
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
        let border = ActivityGate::new(RATE_HZ).unit();
        sound[8 * border] = 0.3;
        assert_eq!(restless_s(&sound), [0.0, real(8 * border) / RATE_HZ]);
    }

    #[test]
    fn a_thud_under_hiss_rises() {
        let mut sound = noise_with(0.0);
        for (i, x) in sound[240_000..240_480].iter_mut().enumerate() {
            *x += 0.012 * (std::f32::consts::PI * narrow(real(i)) / 120.0).sin();
        }
        assert_eq!(restless_s(&sound).len(), 2);
    }

    #[test]
    fn silence_is_quiet() {
        assert!(restless_s(&vec![0.0; 48_000]).is_empty());
    }
}
