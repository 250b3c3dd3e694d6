//! What a detector gives a tracker.

/// A moment at which something may have struck.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Seconds from the start of the recording.
    pub time_s: f64,
    /// Standard deviation of the time in seconds: of a rise in energy an eighth of a millisecond for a click and a
    /// millisecond or two for a thud, of a match 0.05 ms or more.
    pub jitter_s: f64,
    /// Evidence that something struck, in nats: the log-likelihood ratio of a rise in energy, summed over bands, or of a
    /// match of z standard deviations, z²/2.
    pub strength: f64,
    /// How loud it is, as a natural logarithm: of the size of a match, which goes with the speed of an impact, or of the
    /// nats of a rise. It is comparable among events that were found in one way.
    pub loudness: f64,
    /// How its evidence is spread over the bands.
    pub profile: Profile,
}

/// Bands that a profile holds: the octaves from 40 Hz to half of a rate of 192 kHz, and one more.
const BANDS: usize = 12;

/// What a sound is like: how its evidence is spread over the octaves, as a vector of length one.
///
/// # Formula
/// `p_b = √(g_b / Σ g)` for the nats g of each band, the highest first. Two sounds are as unlike as `1 − p·q`, 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Profile {
    roots: [f32; BANDS],
}

impl Profile {
    /// The profile of a sound by the nats of each of its bands, the highest first.
    #[must_use]
    pub fn new(nats: impl Iterator<Item = f32>) -> Self {
        let mut roots = [0.0; BANDS];
        for (root, nats) in roots.iter_mut().zip(nats) {
            *root = nats.max(0.0).sqrt();
        }
        let length = roots.iter().map(|r| r * r).sum::<f32>().sqrt();
        if length > 0.0 {
            roots.iter_mut().for_each(|root| *root /= length);
        }
        Self { roots }
    }

    /// Whether anything is known of the sound.
    #[must_use]
    pub fn is_known(&self) -> bool {
        self.roots.iter().any(|r| *r > 0.0)
    }

    /// How unlike two sounds are, 0 to 1; 0 if nothing is known of one of them.
    #[must_use]
    pub fn unlikeness(&self, other: &Self) -> f64 {
        if !self.is_known() || !other.is_known() {
            return 0.0;
        }
        let cosine: f32 = self
            .roots
            .iter()
            .zip(&other.roots)
            .map(|(a, b)| a * b)
            .sum();
        f64::from((1.0 - cosine).max(0.0))
    }
}
