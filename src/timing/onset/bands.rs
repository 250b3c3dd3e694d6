//! The energies of octave bands around each impact, as running sums.

use crate::timing::joint::Prior;
use crate::units::{real, samples_in, whole};

/// Lower edges of the bands, in Hz; the last is what lies above (convention: octaves of what impacts sound in).
const EDGES_HZ: [f64; 6] = [250.0, 700.0, 1_400.0, 2_800.0, 5_600.0, 11_200.0];
/// Highest lower edge of a band, and highest upper edge that is filtered, as shares of the sample rate.
const HIGHEST: (f64, f64) = (0.4, 0.45);
/// Sound before the foot that the level is measured in, foot of the rise, and sound after the onset, in seconds; …
const BEFORE_S: f64 = 3e-3;
pub(super) const FOOT_S: f64 = 0.3e-3;
pub(super) const AFTER_S: f64 = 2.5e-3;
/// … farthest search, in seconds; …
const REACH_S: f64 = 1.2e-3;
/// … and as shares of the flight on that side at most, the search of the shorter one.
const BEFORE_SHARE: f64 = 0.3;
const AFTER_SHARE: f64 = 0.5;
const REACH_SHARE: f64 = 0.15;
/// Step of the grid, in seconds: less than the errors of onsets.
const STEP_S: f64 = 40e-6;
/// Sound that the filters settle in, in seconds.
const SETTLE_S: f64 = 6e-3;

/// One impact's window: samples before the grid, the grid, samples after it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window {
    /// The sample at which the grid is centred.
    pub centre: f64,
    /// Samples of the sound before the foot of an onset at the first place of the grid, …
    pub before: usize,
    /// … to the farthest place of its own on either side, in steps, …
    pub reach: usize,
    /// … and after an onset at the last.
    pub after: usize,
    /// The prior, from the centre, in samples.
    pub prior: Prior,
}

/// The windows of all impacts.
#[derive(Debug)]
pub(super) struct Windows {
    /// Samples between places of the grid.
    pub step: usize,
    /// Samples of the foot.
    pub foot: usize,
    pub of: Vec<Window>,
    pub bands: Vec<Band>,
}

/// One band: for each impact the sums of its energy from the window's first sample on.
#[derive(Debug)]
pub(super) struct Band {
    /// Variance of the noise.
    pub noise: f64,
    /// κ, the share of independent values among its samples: a band of width B holds 2·B of them a second (Nyquist).
    pub kappa: f64,
    pub sums: Vec<Vec<f64>>,
}

impl Windows {
    /// The windows around where impacts were found last, with their priors, in samples of the sound.
    pub(super) fn of(sound: &[f64], rate: f64, priors: &[Prior], found: &[Prior]) -> Self {
        let mut windows = Self {
            step: samples_in(STEP_S, rate).max(1),
            foot: samples_in(FOOT_S, rate),
            of: Vec::new(),
            bands: Vec::new(),
        };
        let flights = found.windows(2).map(|w| w[1].position - w[0].position);
        let flights: Vec<f64> = flights.collect();
        let flight = |i: Option<usize>| i.and_then(|i| flights.get(i)).copied();
        let around = |i: usize| {
            let sides = [flight(i.checked_sub(1)), flight(Some(i))];
            sides.map(|side| side.unwrap_or(f64::INFINITY))
        };
        let each = priors.iter().zip(found).enumerate();
        let of = each.map(|(i, (prior, found))| {
            let centre = found.position.round();
            Window::around(centre, prior.from(centre), around(i), rate, windows.step)
        });
        windows.of = of.collect();
        windows.bands = edges(rate)
            .map(|edges| windows.band(sound, rate, edges))
            .collect();
        windows
    }

    /// The sums of one band.
    fn band(&self, sound: &[f64], rate: f64, edges: (f64, Option<f64>)) -> Band {
        let settle = samples_in(SETTLE_S, rate);
        let sums = self.of.iter().map(|window| {
            let first = window.centre - real(window.onset(window.reach, self) + settle);
            let length = window.onset(2 * window.reach, self) + window.after;
            let banded = filtered(&cut(sound, first, settle + length), edges);
            running_sums(banded[settle..].iter().map(|x| x * x))
        });
        let mut impulse = vec![0.0; settle];
        impulse[0] = 1.0;
        Band {
            kappa: 2.0 * (edges.1.unwrap_or(0.5) - edges.0),
            noise: filtered(&impulse, edges).iter().map(|h| h * h).sum(),
            sums: sums.collect(),
        }
    }

    /// Places of the widest grid.
    pub(super) fn places(&self) -> usize {
        2 * self.of.iter().map(|w| w.reach).max().unwrap_or(0) + 1
    }
}

/// The sums of no value, of the first, of the first two, and so on.
fn running_sums(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut sum = 0.0;
    let sums = values.map(|x| {
        sum += x;
        sum
    });
    std::iter::once(0.0).chain(sums).collect()
}

impl Window {
    /// The window of an impact between the flights before and after it, in samples.
    fn around(centre: f64, prior: Prior, [back, on]: [f64; 2], rate: f64, step: usize) -> Self {
        let reach = (REACH_S * rate).min(REACH_SHARE * back.min(on));
        Self {
            centre,
            before: whole((BEFORE_S * rate).min(BEFORE_SHARE * back)).max(2),
            reach: whole(reach / real(step)).max(1),
            after: whole((AFTER_S * rate).min(AFTER_SHARE * on)).max(2),
            prior,
        }
    }

    /// Index in the sums of an onset at a place of its grid, from 0 to twice its reach.
    pub(super) const fn onset(&self, place: usize, windows: &Windows) -> usize {
        self.before + windows.foot + place * windows.step
    }

    /// Distance of a place from the centre, in samples.
    pub(super) fn offset(&self, place: usize, step: usize) -> f64 {
        (real(place) - real(self.reach)) * real(step)
    }
}

/// Lower and upper edge of each band that the rate holds.
fn edges(rate: f64) -> impl Iterator<Item = (f64, Option<f64>)> {
    let held = EDGES_HZ
        .into_iter()
        .filter(move |low| *low < HIGHEST.0 * rate);
    let held: Vec<f64> = held.map(|low| low / rate).collect();
    (0..held.len()).map(move |k| {
        let high = held.get(k + 1).copied().filter(|high| *high < HIGHEST.1);
        (held[k], high)
    })
}

/// Samples from an index on, 0 where there are none.
fn cut(sound: &[f64], first: f64, length: usize) -> Vec<f64> {
    let skip = whole(-first).min(length);
    let from = whole(first).min(sound.len());
    let mut cut = vec![0.0; length];
    for (y, x) in cut[skip..].iter_mut().zip(&sound[from..]) {
        *y = *x;
    }
    cut
}

/// Butterworth's filters of second order above one frequency and below another, in cycles per sample.
fn filtered(samples: &[f64], (low, high): (f64, Option<f64>)) -> Vec<f64> {
    let above = second_order(samples, low, true);
    high.map_or_else(|| above.clone(), |high| second_order(&above, high, false))
}

/// One such filter, above a frequency or below it, by the bilinear transform.
fn second_order(samples: &[f64], frequency: f64, above: bool) -> Vec<f64> {
    let k = (std::f64::consts::PI * frequency).tan();
    let norm = 1.0 / (1.0 + std::f64::consts::SQRT_2 * k + k * k);
    let (b, middle) = if above {
        (norm, -2.0 * norm)
    } else {
        (k * k * norm, 2.0 * k * k * norm)
    };
    let (a1, a2) = (
        2.0 * (k * k - 1.0) * norm,
        (1.0 - std::f64::consts::SQRT_2 * k + k * k) * norm,
    );
    let (mut first, mut second) = (0.0, 0.0);
    samples
        .iter()
        .map(|x| {
            let y = b * x + first;
            first = middle * x - a1 * y + second;
            second = b * x - a2 * y;
            y
        })
        .collect()
}
