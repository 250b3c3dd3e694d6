//! What cannot matter: changes of a recording that leave every flight as it is.

use std::fmt;
use std::ops::Range;

use bounce_audio::units::narrow;

use super::recording::Recording;

/// A cut stays so far away from the first impact and from the last, in seconds: flights of lively balls end within it.
const BEFORE_S: f64 = 0.3;
const AFTER_S: f64 = 0.5;
/// The pause before a second drop, in seconds.
const PAUSE_S: f64 = 2.0;
/// Rounding does not matter whose error is so many times below the noise: 20 dB.
const BELOW_NOISE: f64 = 10.0;

/// A change that cannot matter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Change {
    /// So many zeros in front.
    Zeros(usize),
    /// So many samples in front of the quiet of the recording itself.
    Quiet(usize),
    /// Gain in dB, in floating point.
    Gain(f64),
    /// The other sign.
    Inverted,
    /// So many samples less in front, where nothing sounds there.
    CutFront(usize),
    /// So many samples less at the end, where nothing sounds there.
    CutEnd(usize),
    /// Gain in dB, then rounding to so many bits, where that is far below the noise.
    Rounded(f64, u16),
    /// Every channel twice.
    Doubled,
    /// The recording once more, after a pause of its own quiet.
    Followed,
    /// Zeros in front, gain in dB and the other sign.
    Together(usize, f64),
}

/// The changes that are tried.
pub(crate) const CHANGES: [Change; 40] = [
    Change::Zeros(1),
    Change::Zeros(3),
    Change::Zeros(8),
    Change::Zeros(17),
    Change::Zeros(64),
    Change::Zeros(100),
    Change::Zeros(333),
    Change::Zeros(512),
    Change::Zeros(1_001),
    Change::Zeros(1_024),
    Change::Zeros(3_001),
    Change::Zeros(10_007),
    Change::Quiet(1_001),
    Change::Quiet(4_417),
    Change::Quiet(22_051),
    Change::Gain(-1.0),
    Change::Gain(-3.0),
    Change::Gain(-6.0),
    Change::Gain(-9.0),
    Change::Gain(-20.0),
    Change::Gain(3.0),
    Change::Inverted,
    Change::CutFront(1),
    Change::CutFront(100),
    Change::CutFront(1_024),
    Change::CutFront(5_003),
    Change::CutFront(10_007),
    Change::CutEnd(100),
    Change::CutEnd(1_024),
    Change::CutEnd(5_003),
    Change::CutEnd(10_007),
    Change::Rounded(0.0, 16),
    Change::Rounded(-1.0, 16),
    Change::Rounded(-1.0, 24),
    Change::Doubled,
    Change::Followed,
    Change::Together(8, -1.0),
    Change::Together(333, -3.0),
    Change::Together(1_024, -6.0),
    Change::Together(3_001, -9.0),
];

/// A recording that was changed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Variant {
    pub(crate) recording: Recording,
    /// Samples by which its impacts are later than those of the original.
    pub(crate) shift: isize,
    /// Drops that begin after this sample are not compared.
    pub(crate) until: usize,
}

/// Where a recording sounds and where it does not.
#[derive(Debug, Clone)]
pub(crate) struct Pauses {
    /// Samples from the first impact to the last, none without a drop.
    pub(crate) drops: Option<Range<usize>>,
    /// The quietest stretch.
    pub(crate) quiet: Option<Range<usize>>,
}

impl Change {
    /// The recording with this change; none where the recording has no room for it, or where nothing changes.
    pub(crate) fn of(self, original: &Recording, pauses: &Pauses) -> Option<Variant> {
        let (recording, shift) = match self {
            Self::Zeros(count) => (
                original.map(|c| [&vec![0.0; count], c].concat()),
                count.cast_signed(),
            ),
            Self::Quiet(count) => {
                let quiet = pauses.quiet.clone()?;
                let before = |c: &[f32]| [&tiled(&c[quiet.clone()], count), c].concat();
                (original.map(before), count.cast_signed())
            }
            Self::Gain(db) => (original.map(|c| scaled(c, factor(db))), 0),
            Self::Inverted => (original.map(|c| scaled(c, -1.0)), 0),
            Self::CutFront(count) => (self.cut(original, 0..count, pauses)?, -count.cast_signed()),
            Self::CutEnd(count) => {
                let end = original.len();
                (self.cut(original, end.checked_sub(count)?..end, pauses)?, 0)
            }
            Self::Rounded(db, bits) => (rounded(original, db, bits, pauses)?, 0),
            Self::Doubled => {
                let channels = [&original.channels[..], &original.channels].concat();
                let rate = original.rate;
                (Recording { channels, rate }, 0)
            }
            Self::Followed => (followed(original, pauses)?, 0),
            Self::Together(count, db) => {
                let turned = original.map(|c| scaled(c, -factor(db)));
                return Self::Zeros(count).of(&turned, pauses);
            }
        };
        (recording != *original).then(|| Variant {
            until: original.len().saturating_add_signed(shift),
            recording,
            shift,
        })
    }

    /// The recording without a stretch at one of its ends, if nothing sounds there.
    fn cut(
        self,
        original: &Recording,
        stretch: Range<usize>,
        pauses: &Pauses,
    ) -> Option<Recording> {
        let (drops, quiet) = (pauses.drops.clone()?, pauses.quiet.clone()?);
        let apart = match self {
            Self::CutFront(_) => stretch.end + original.samples_in(BEFORE_S) <= drops.start,
            _ => drops.end + original.samples_in(AFTER_S) <= stretch.start,
        };
        let kept = match self {
            Self::CutFront(_) => stretch.end..original.len(),
            _ => 0..stretch.start,
        };
        let rms = original.rms(quiet);
        (apart && original.is_quiet(stretch, rms)).then(|| original.map(|c| c[kept.clone()].into()))
    }
}

/// Rounded to whole steps after a gain, if the error of that, a step's `1/√12`, is far below the noise.
fn rounded(original: &Recording, db: f64, bits: u16, pauses: &Pauses) -> Option<Recording> {
    let steps = f64::from(bits - 1).exp2();
    let noise = factor(db) * original.rms(pauses.quiet.clone()?);
    let is_below = BELOW_NOISE / (12.0_f64.sqrt() * steps) <= noise;
    let round = |x: &f32| narrow((f64::from(*x) * factor(db) * steps).round() / steps);
    is_below.then(|| original.map(|c| c.iter().map(round).collect()))
}

/// The recording, a pause of its own quiet, and the recording again.
fn followed(original: &Recording, pauses: &Pauses) -> Option<Recording> {
    let (quiet, _) = (pauses.quiet.clone()?, pauses.drops.clone()?);
    let pause = original.samples_in(PAUSE_S);
    Some(original.map(|c| [c, &tiled(&c[quiet.clone()], pause), c].concat()))
}

/// So many samples of a stretch of noise, forth and back without a step.
fn tiled(noise: &[f32], count: usize) -> Vec<f32> {
    let there_and_back = noise.iter().chain(noise.iter().rev());
    there_and_back.copied().cycle().take(count).collect()
}

fn scaled(samples: &[f32], factor: f64) -> Vec<f32> {
    let scale = |x: &f32| narrow(f64::from(*x) * factor);
    samples.iter().map(scale).collect()
}

/// `10^(x/20)`.
fn factor(db: f64) -> f64 {
    10.0_f64.powf(db / 20.0)
}

impl fmt::Display for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Zeros(count) => write!(f, "{count} zeros"),
            Self::Quiet(count) => write!(f, "{count} of quiet"),
            Self::Gain(db) => write!(f, "{db:+} dB"),
            Self::Inverted => write!(f, "inverted"),
            Self::CutFront(count) => write!(f, "first {count} cut"),
            Self::CutEnd(count) => write!(f, "last {count} cut"),
            Self::Rounded(db, bits) => write!(f, "{db:+} dB, {bits} bits"),
            Self::Doubled => write!(f, "channels twice"),
            Self::Followed => write!(f, "second drop"),
            Self::Together(count, db) => write!(f, "{count} zeros, {db:+} dB, inverted"),
        }
    }
}
