//! A cheap look for stretches in which nothing happens: most of a long recording.

use crate::units::{real, samples_in};

/// Length of the frames whose energies are compared, in seconds: about that of an impact.
const FRAME_S: f64 = 1e-3;
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

/// Whether no frame rises out of those before it: neither in the sound itself, nor in its treble (the difference of
/// neighbouring samples), nor in its bass (the mean of sixteen).
#[must_use]
pub fn is_quiet(samples: &[f32], sample_rate_hz: f64) -> bool {
    let frame = samples_in(FRAME_S, sample_rate_hz).max(2 * LOW);
    let [mut all, mut high, mut low] = [Past::default(), Past::default(), Past::default()];
    samples.chunks(frame * LOW_FRAMES).all(|frames| {
        let mut sharp = frames.chunks_exact(frame);
        sharp.all(|f| all.goes_on_with(energy(f)) && high.goes_on_with(treble(f)))
            && low.goes_on_with(bass(frames))
    })
}

/// The energies of the last frames.
#[derive(Debug, Default)]
struct Past {
    energies: [f32; USUAL],
    count: usize,
}

impl Past {
    /// Whether a frame is like those before; it then is one of them.
    fn goes_on_with(&mut self, energy: f32) -> bool {
        let usual = self.energies.iter().sum::<f32>() / narrow(USUAL);
        let known = self.count >= USUAL;
        self.energies[self.count % USUAL] = energy;
        self.count += 1;
        !known || energy <= RISE * usual.max(SILENCE)
    }
}

/// Lanes that are summed side by side, so that the compiler can use the machine's vectors.
const LANES: usize = 8;

fn energy(frame: &[f32]) -> f32 {
    sum_of_squares(frame.as_chunks::<LANES>().0.iter().copied()) / narrow(frame.len())
}

fn treble(frame: &[f32]) -> f32 {
    let pairs = frame[1..]
        .as_chunks::<LANES>()
        .0
        .iter()
        .zip(frame.as_chunks::<LANES>().0);
    let differences = pairs.map(|(a, b)| std::array::from_fn(|i| a[i] - b[i]));
    sum_of_squares(differences) / narrow(frame.len())
}

fn bass(frame: &[f32]) -> f32 {
    let means = frame
        .as_chunks::<LOW>()
        .0
        .iter()
        .map(|c| c.iter().sum::<f32>() / narrow(LOW));
    means.map(|m| m * m).sum::<f32>() / narrow((frame.len() / LOW).max(1))
}

fn sum_of_squares(chunks: impl Iterator<Item = [f32; LANES]>) -> f32 {
    let mut sums = [0.0; LANES];
    for chunk in chunks {
        for (sum, x) in sums.iter_mut().zip(chunk) {
            *sum += x * x;
        }
    }
    sums.iter().sum()
}

#[expect(clippy::cast_possible_truncation, reason = "counts of a few samples")]
fn narrow(count: usize) -> f32 {
    real(count) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    fn noise_with(click: f32) -> Vec<f32> {
        let mut rng = SplitMix64::new(9);
        #[expect(clippy::cast_possible_truncation, reason = "test noise")]
        let mut noise: Vec<f32> = (0..480_000).map(|_| (0.01 * rng.normal()) as f32).collect();
        for (i, x) in noise[240_000..240_096].iter_mut().enumerate() {
            *x += if i % 2 == 0 { click } else { -click };
        }
        noise
    }

    #[test]
    fn noise_is_quiet_and_a_click_in_it_is_not() {
        assert!(is_quiet(&noise_with(0.0), 48_000.0));
        assert!(!is_quiet(&noise_with(0.04), 48_000.0));
    }

    #[test]
    fn a_thud_under_hiss_is_not_quiet() {
        let mut sound = noise_with(0.0);
        for (i, x) in sound[240_000..240_480].iter_mut().enumerate() {
            *x += 0.012 * (std::f32::consts::PI * narrow(i) / 120.0).sin();
        }
        assert!(!is_quiet(&sound, 48_000.0));
    }

    #[test]
    fn silence_is_quiet() {
        assert!(is_quiet(&vec![0.0; 48_000], 48_000.0));
    }
}
