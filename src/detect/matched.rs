//! Candidates by the sound of this ball: what the energy no longer shows, because the last impact still rings or the
//! echo comes back, the shape of an impact does.
//!
//! The mean of the impacts found so far is learnt, ring and echo included. In the whitened recording its best match is
//! sought, taken out whole, and the next best match sought in what is left, until nothing stands out of the noise.

use super::Candidate;
use super::refine::interpolate::shifted;
use super::refine::whiten::Whitener;
use super::voice::{Voice, correlate, dot};
use crate::units::{real, samples_in};

/// Weakest match, in standard deviations of the noise.
const WEAKEST: f64 = 3.5;
/// Two matches are at least this far apart, in seconds: what is left of a sound that is taken out is no other.
const APART_S: f64 = 0.5e-3;
/// Matches taken out for each second of the region: far more than a ball has impacts.
const PER_SECOND: f64 = 300.0;
/// A match of one standard deviation is this uncertain in time, in seconds; a better one less, down to what
/// neighbours that overlap pull.
const JITTER_S: f64 = 0.2e-3;
const LEAST_JITTER_S: f64 = 0.05e-3;

/// Matches with the mean of the impacts known so far, in a region of the recording, in order of time.
///
/// `impacts_s` are onset times below a sample, ascending; `region_s` is where to look. The strength of a match of z
/// standard deviations is its log-likelihood ratio z²/2. None where too few impacts stand alone long enough to learn
/// from, or the region is cut by the end of the recording.
#[must_use]
pub fn candidates(
    samples: &[f32],
    sample_rate_hz: f64,
    impacts_s: &[f64],
    region_s: (f64, f64),
) -> Option<Vec<Candidate>> {
    let whitener = Whitener::learn(samples, sample_rate_hz, impacts_s);
    let voice = Voice::learn(samples, sample_rate_hz, impacts_s, &whitener)?;
    let start = samples_in(region_s.0, sample_rate_hz);
    let end = samples_in(region_s.1, sample_rate_hz).min(samples.len());
    let sound = whitener.apply(samples, start, end)?;
    let most = samples_in(PER_SECOND, region_s.1 - region_s.0);
    let apart = samples_in(APART_S, sample_rate_hz).max(1);
    let mut found: Vec<Candidate> = Residue::new(&sound, &voice)?
        .take_out(&voice, most, apart)
        .into_iter()
        .map(|(position, z)| Candidate {
            time_s: (real(start + voice.before) + position) / sample_rate_hz,
            jitter_s: (JITTER_S / z).max(LEAST_JITTER_S),
            strength: 0.5 * z * z,
        })
        .collect();
    found.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    Some(found)
}

/// The match of a stretch of sound against the voice at every sample, as far as it is not explained yet.
///
/// Sounds are taken out of the match and not of the sound: taking `a·s` out at p changes the match at k by
/// `a·R(k − p)`, where R is the match of the voice with itself.
struct Residue {
    products: Vec<f64>,
    /// Where a match was taken out already.
    taken: Vec<bool>,
    /// The best match of each block that is still free.
    best: Vec<(usize, f64)>,
    /// R, from the lag `1 − matched` on.
    own: Vec<f64>,
}

/// Length of the blocks whose best match is remembered.
const BLOCK: usize = 128;

impl Residue {
    fn new(sound: &[f64], voice: &Voice) -> Option<Self> {
        let count = sound.len().checked_sub(voice.matched)?;
        let shape = &voice.shape[..voice.matched];
        let mut residue = Self {
            products: correlate(sound, shape)?[..count].to_vec(),
            taken: vec![false; count],
            best: vec![(0, 0.0); count.div_ceil(BLOCK)],
            own: voice.own_match()?,
        };
        residue.look_again(0, count);
        Some(residue)
    }

    /// Finds the best match anew in the blocks that hold these samples.
    fn look_again(&mut self, from: usize, to: usize) {
        for block in from / BLOCK..to.min(self.products.len()).div_ceil(BLOCK) {
            let start = block * BLOCK;
            let end = (start + BLOCK).min(self.products.len());
            let free = (start..end).filter(|&k| !self.taken[k]);
            let best = free.max_by(|&a, &b| self.products[a].total_cmp(&self.products[b]));
            self.best[block] = best.map_or((start, f64::NEG_INFINITY), |k| (k, self.products[k]));
        }
    }

    /// Takes out match after match, the best first; gives their positions and sizes in standard deviations.
    fn take_out(mut self, voice: &Voice, most: usize, apart: usize) -> Vec<(f64, f64)> {
        let shape = &voice.shape[..voice.matched];
        let energy = dot(shape, shape);
        let mut found = Vec::new();
        for _ in 0..most {
            let Some(&(best, product)) = self.best.iter().max_by(|a, b| a.1.total_cmp(&b.1)) else {
                break;
            };
            let z = product / energy.sqrt();
            if z < WEAKEST {
                break;
            }
            let position = real(best) + self.vertex(best);
            found.push((position, z));
            let (from, to) = (
                best.saturating_sub(apart),
                (best + apart + 1).min(self.taken.len()),
            );
            self.taken[from..to].fill(true);
            self.subtract(position, product / energy, voice.matched);
        }
        found
    }

    fn vertex(&self, k: usize) -> f64 {
        let at = |k: usize| self.products.get(k).copied();
        let (Some(left), Some(right)) = (k.checked_sub(1).and_then(at), at(k + 1)) else {
            return 0.0;
        };
        let curvature = left - 2.0 * self.products[k] + right;
        if curvature < 0.0 {
            (0.5 * (left - right) / curvature).clamp(-0.5, 0.5)
        } else {
            0.0
        }
    }

    fn subtract(&mut self, position: f64, amplitude: f64, matched: usize) {
        let whole = position.floor();
        let moved = shifted(&self.own, whole - position, self.own.len() + 1);
        // The first value of `own` belongs to a lag of 1 − matched.
        let first = samples_in(whole, 1.0);
        let skip = (matched - 1).saturating_sub(first);
        let from = (first + 1).saturating_sub(matched);
        let end = (from + moved.len() - skip).min(self.products.len());
        for (product, r) in self.products[from..end].iter_mut().zip(&moved[skip..]) {
            *product -= amplitude * r;
        }
        self.look_again(from, end);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::SplitMix64;

    const RATE: f64 = 44_100.0;

    /// Rings of 8 ms at 900 Hz with an echo, at these times with these amplitudes, in noise.
    fn recording(impacts: &[(f64, f64)]) -> Vec<f32> {
        let mut rng = SplitMix64::new(12);
        let ring = |t: f64| {
            if t > 0.0 {
                (-t / 8e-3).exp()
                    * (1.0 - (-t / 2e-4).exp())
                    * (std::f64::consts::TAU * 900.0 * t).sin()
            } else {
                0.0
            }
        };
        #[expect(clippy::cast_possible_truncation, reason = "test samples")]
        (0..88_200)
            .map(|i| {
                let t = real(i) / RATE;
                let sound: f64 = impacts
                    .iter()
                    .map(|&(at, a)| a * (ring(t - at) + 0.4 * ring(t - at - 11e-3)))
                    .sum();
                (sound + 1e-3 * rng.normal()) as f32
            })
            .collect()
    }

    #[test]
    fn impacts_under_the_ring_and_the_echo_of_others_are_found() {
        let known: Vec<(f64, f64)> = (0..6)
            .map(|i| (0.3 + 0.1 * real(i), 0.5 - 0.05 * real(i)))
            .collect();
        let late = [(1.000, 0.2), (1.009, 0.15), (1.0171, 0.12), (1.0243, 0.1)];
        let samples = recording(&[&known[..], &late].concat());
        let onsets: Vec<f64> = known.iter().map(|k| k.0).collect();
        let found = candidates(&samples, RATE, &onsets, (0.95, 1.1)).unwrap();
        let mut strongest = found.clone();
        strongest.sort_by(|a, b| b.strength.total_cmp(&a.strength));
        let mut times: Vec<f64> = strongest[..4].iter().map(|c| c.time_s).collect();
        times.sort_by(f64::total_cmp);
        for (time, (true_time, _)) in times.iter().zip(late) {
            // What overlaps pulls its neighbour by some hundredths of a millisecond.
            assert!((time - true_time).abs() < 1e-4, "{times:?}");
        }
        // The echoes were taken out with their impacts: of the last one nothing is left.
        let echo = found.iter().filter(|c| (c.time_s - 1.0353).abs() < 3e-3);
        assert!(
            echo.clone()
                .all(|c| c.strength < 1e-3 * strongest[3].strength),
            "{echo:?}"
        );
    }

    #[test]
    fn three_impacts_too_near_each_other_teach_nothing() {
        let samples = recording(&[(0.5, 0.5), (0.505, 0.4), (0.509, 0.3)]);
        assert!(candidates(&samples, RATE, &[0.5, 0.505, 0.509], (0.5, 0.6)).is_none());
    }
}
