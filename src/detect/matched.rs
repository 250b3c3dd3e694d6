//! Candidates by the sound of this ball: what the energy no longer shows, because the last impact still rings or the
//! echo comes back, the shape of an impact does.
//!
//! The mean of the impacts found so far is learnt, ring and echo included. In the whitened recording its best match is
//! sought, taken out whole, and the next best match sought in what is left, until nothing stands out of the noise.

use super::Candidate;
use super::voice::Voice;
use crate::signal::correlate::{correlate, dot};
use crate::signal::interpolate::shifted;
use crate::signal::whiten::Whitener;
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
/// `impacts_s` are onset times below a sample, ascending; `region_s` is where to look. The strength of a match is its
/// size in standard deviations of the noise, which falls with the ball's speed as loudness does. None where too few
/// impacts stand alone long enough to learn from, or the region is cut by the end of the recording.
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
        .take_out(most, apart)
        .into_iter()
        .map(|(position, z)| Candidate {
            time_s: (real(start + voice.before) + position) / sample_rate_hz,
            jitter_s: (JITTER_S / z).max(LEAST_JITTER_S),
            strength: z,
        })
        .collect();
    found.sort_by(|a, b| a.time_s.total_cmp(&b.time_s));
    Some(found)
}

/// The match of a stretch of sound against the voice at every sample, as far as it is not explained yet.
///
/// Sounds are taken out of the match and not of the sound: taking `a·s` out at p changes the match at k by
/// `a·R(k − p)`, where R is the match of the voice with itself. All in standard deviations of the noise: an `f32` holds
/// the loudest impact to a hundredth of one.
struct Residue {
    products: Vec<f32>,
    /// 0 where a match may be taken out, −∞ where one was.
    free: Vec<f32>,
    /// The best free match of each block.
    best: Vec<f32>,
    own: OwnMatch,
}

/// Length of the blocks whose best match is remembered.
const BLOCK: usize = 128;

impl Residue {
    fn new(sound: &[f64], voice: &Voice) -> Option<Self> {
        let count = sound.len().checked_sub(voice.matched)?;
        let shape = &voice.shape[..voice.matched];
        let scale = 1.0 / dot(shape, shape).sqrt();
        let products = correlate(sound, shape)?;
        let mut residue = Self {
            products: products[..count]
                .iter()
                .map(|p| narrow(scale * p))
                .collect(),
            free: vec![0.0; count],
            best: vec![0.0; count.div_ceil(BLOCK)],
            own: OwnMatch::of(voice)?,
        };
        residue.look_again(0, count);
        Some(residue)
    }

    /// Finds the best match anew in the blocks that hold these samples.
    fn look_again(&mut self, from: usize, to: usize) {
        let blocks = from / BLOCK..to.div_ceil(BLOCK);
        let products = self.products.chunks(BLOCK).zip(self.free.chunks(BLOCK));
        let best = self.best.iter_mut().zip(products);
        for (best, (products, free)) in best.skip(blocks.start).take(blocks.len()) {
            *best = highest(products.iter().zip(free).map(|(p, f)| p + f));
        }
    }

    /// The best free match: its index and size.
    fn top(&self) -> Option<(usize, f32)> {
        let height = highest(self.best.iter().copied());
        let start = BLOCK * self.best.iter().position(|&b| b >= height)?;
        let block = self.products[start..].iter().zip(&self.free[start..]);
        let offset = block.take(BLOCK).position(|(p, f)| p + f >= height)?;
        Some((start + offset, height))
    }

    /// Takes out match after match, the best first; gives their positions and sizes in standard deviations.
    fn take_out(mut self, most: usize, apart: usize) -> Vec<(f64, f64)> {
        let mut found = Vec::new();
        for _ in 0..most {
            let Some((best, z)) = self.top().filter(|(_, z)| f64::from(*z) >= WEAKEST) else {
                break;
            };
            let beside = self.vertex(best);
            found.push((real(best) + beside, f64::from(z)));
            let end = (best + apart + 1).min(self.free.len());
            self.free[best.saturating_sub(apart)..end].fill(f32::NEG_INFINITY);
            let (from, to) = self.own.subtract(&mut self.products, best, beside, z);
            self.look_again(from, to);
        }
        found
    }

    /// Where the parabola through three products is highest, from the middle one.
    fn vertex(&self, k: usize) -> f64 {
        let at = |k: usize| self.products.get(k).copied().map(f64::from);
        let (Some(left), Some(middle), Some(right)) =
            (k.checked_sub(1).and_then(at), at(k), at(k + 1))
        else {
            return 0.0;
        };
        let curvature = left - 2.0 * middle + right;
        if curvature < 0.0 {
            (0.5 * (left - right) / curvature).clamp(-0.5, 0.5)
        } else {
            0.0
        }
    }
}

/// The highest of some values, in lanes for the machine's vectors; −∞ of none.
fn highest(values: impl ExactSizeIterator<Item = f32>) -> f32 {
    values.fold(f32::NEG_INFINITY, |a, b| if b > a { b } else { a })
}

/// The match of the voice with itself, R over R(0), between samples too.
struct OwnMatch {
    /// R from a little more than ½ a sample earlier to as much later, in [`STEPS`] to a sample; all from one lag on.
    phases: Vec<Vec<f32>>,
    /// The index of lag 0.
    centre: usize,
}

/// Steps between two samples at which R is known. Between them a parabola is laid through three, which is wrong by at
/// most (π/16)³/16 = 0.05 % where R changes as fast as it can: the vertex of the match is farther off.
const STEPS: usize = 16;

impl OwnMatch {
    fn of(voice: &Voice) -> Option<Self> {
        let own = voice.own_match()?;
        let scale = 1.0 / own.get(voice.matched - 1)?;
        let phase = |step: usize| {
            let later = (real(step) - 1.0) / real(STEPS) - 0.5;
            let moved = shifted(&own, -1.0 - later, own.len() + 2);
            moved.into_iter().map(|r| narrow(scale * r)).collect()
        };
        Some(Self {
            phases: (0..STEPS + 3).map(phase).collect(),
            // The first value of `own` belongs to a lag of 1 − matched, and one stands before it.
            centre: voice.matched,
        })
    }

    /// Takes `z·R` out at an index and `later` in (−½, ½) of a sample; gives the range that changed.
    fn subtract(&self, products: &mut [f32], at: usize, later: f64, z: f32) -> (usize, usize) {
        let place = (later + 0.5) * real(STEPS);
        let nearest = samples_in(place, 1.0).min(STEPS);
        let off = narrow(place - real(nearest));
        let weights = [
            0.5 * z * off * (off - 1.0),
            z * (1.0 - off * off),
            0.5 * z * off * (off + 1.0),
        ];
        let skip = self.centre.saturating_sub(at);
        let from = at.saturating_sub(self.centre);
        let [a, b, c] = [0, 1, 2].map(|beside| &self.phases[nearest + beside][skip..]);
        let end = (from + a.len()).min(products.len());
        for (((product, a), b), c) in products[from..end].iter_mut().zip(a).zip(b).zip(c) {
            *product -= weights[0] * a + weights[1] * b + weights[2] * c;
        }
        (from, end)
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "matches need no more than an f32"
)]
const fn narrow(x: f64) -> f32 {
    x as f32
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
        let mut known: Vec<(f64, f64)> = (0..6)
            .map(|i| (0.3 + 0.1 * real(i), 0.5 - 0.05 * real(i)))
            .collect();
        // Flights are known down to 30 ms: no ball goes from 100 to 9 at once.
        known.extend([(0.86, 0.24), (0.89, 0.23)]);
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
                .all(|c| c.strength < 0.03 * strongest[3].strength),
            "{echo:?}"
        );
    }

    #[test]
    fn three_impacts_too_near_each_other_teach_nothing() {
        let samples = recording(&[(0.5, 0.5), (0.505, 0.4), (0.509, 0.3)]);
        assert!(candidates(&samples, RATE, &[0.5, 0.505, 0.509], (0.5, 0.6)).is_none());
    }
}
