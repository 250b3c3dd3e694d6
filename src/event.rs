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
    is_known: bool,
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
        let is_known = length > 0.0;
        if is_known {
            roots.iter_mut().for_each(|root| *root /= length);
        }
        Self { roots, is_known }
    }

    /// Whether anything is known of the sound.
    #[must_use]
    pub const fn is_known(&self) -> bool {
        self.is_known
    }

    /// How unlike two sounds are, 0 to 1; 0 if nothing is known of one of them.
    #[must_use]
    pub fn unlikeness(&self, other: &Self) -> f64 {
        if !self.is_known() || !other.is_known() {
            return 0.0;
        }
        // Four sums side by side, which a processor forms at once: a drop asks this of some hundred thousand pairs.
        let mut cosines = [0.0_f32; 4];
        let (these, _) = self.roots.as_chunks::<4>();
        let (those, _) = other.roots.as_chunks::<4>();
        for (a, b) in these.iter().zip(those) {
            for (cosine, (a, b)) in cosines.iter_mut().zip(a.iter().zip(b)) {
                *cosine += a * b;
            }
        }
        f64::from((1.0 - cosines.iter().sum::<f32>()).max(0.0))
    }
}
