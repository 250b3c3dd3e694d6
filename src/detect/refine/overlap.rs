//! Times of impacts whose sounds overlap: each is matched with the mean impact in what all the others leave.

use super::Timed;
use super::interpolate::{KERNEL, interpolated, maximum, shifted};
use super::whiten::Whitener;
use crate::detect::voice::{Voice, dot};
use crate::units::{real, samples_in};

/// A match may lie this far from the first time, in seconds.
const SEARCH_S: f64 = 0.3e-3;
/// Rounds in which the times and amplitudes settle.
const ROUNDS: usize = 6;

/// One impact: its sound around it and where its match with the mean impact stands.
struct Local {
    /// Whitened samples from `start` on.
    sound: Vec<f64>,
    start: usize,
    /// Match with the voice at each lag within reach of the first time, the first at sample `start`.
    products: Vec<f64>,
    /// Onset in samples of the recording, and amplitude in units of the voice.
    onset: f64,
    amplitude: f64,
}

/// Times of those impacts that begin before the sound of the one before has ended; none for the others.
///
/// # Formula
/// In whitened sound x the best position and amplitude of impact i, given the others, are
/// ```text
/// max over p of Q(p),  Q(p) = ⟨x, s(· − p)⟩ − Σ_{j≠i} a_j·R(p − p_j),  a_i = Q/⟨s, s⟩
/// σ_t = σ / (a·√Σ(ds/dt)²)
/// ```
/// with s the matched part of the voice, R its match with the whole voice, σ what all together leave unexplained.
pub(super) fn times(
    samples: &[f32],
    rate: f64,
    onsets_s: &[f64],
    whitener: &Whitener,
) -> Option<Vec<Option<Timed>>> {
    let voice = Voice::learn(samples, rate, onsets_s, whitener)?;
    let length_s = real(voice.shape.len()) / rate;
    let overlapped: Vec<bool> = (0..onsets_s.len())
        .map(|i| i > 0 && onsets_s[i] - onsets_s[i - 1] < length_s)
        .collect();
    let first = overlapped.iter().position(|&o| o)?;
    // Whatever still sounds when the first of them begins belongs to the scene.
    let from = onsets_s.partition_point(|&t| t < onsets_s[first] - length_s);
    let own = voice.own_match()?;
    let reach = samples_in(SEARCH_S, rate) + KERNEL + 1;
    let scene: Option<Vec<Local>> = onsets_s[from..]
        .iter()
        .map(|&t| Local::new(samples, t * rate, reach, &voice, whitener))
        .collect();
    let mut scene = scene?;
    for _ in 0..ROUNDS {
        for i in 0..scene.len() {
            settle(&mut scene, i, &voice, &own, overlapped[from + i]);
        }
    }
    let mut timed = vec![None; onsets_s.len()];
    for i in (0..scene.len()).filter(|i| overlapped[from + i]) {
        timed[from + i] = scene[i].timed(&scene, i, &voice, rate);
    }
    Some(timed)
}

impl Local {
    fn new(
        samples: &[f32],
        onset: f64,
        reach: usize,
        voice: &Voice,
        whitener: &Whitener,
    ) -> Option<Self> {
        let start = samples_in(onset, 1.0).checked_sub(voice.before + reach)?;
        let sound = whitener.apply(samples, start, start + voice.matched + 2 * reach)?;
        let shape = &voice.shape[..voice.matched];
        let products = sound
            .windows(voice.matched)
            .map(|w| dot(w, shape))
            .collect();
        Some(Self {
            sound,
            start,
            products,
            onset,
            amplitude: 0.0,
        })
    }

    /// The time with its error by what the whole scene leaves unexplained here.
    fn timed(&self, scene: &[Self], own: usize, voice: &Voice, rate: f64) -> Option<Timed> {
        if self.amplitude <= 0.0 {
            return None;
        }
        let begin = self.onset - real(voice.before) - real(self.start);
        let mut left = shifted(&self.sound, begin, voice.matched);
        for (j, other) in scene.iter().enumerate() {
            // Sample k of what is left stands k + (onset − before) in the recording.
            let offset = self.onset - other.onset;
            if j == own || offset.abs() < real(voice.shape.len()) {
                let sounding = shifted(&voice.shape, offset, voice.matched);
                for (x, s) in left.iter_mut().zip(sounding) {
                    *x -= other.amplitude * s;
                }
            }
        }
        let noise = (dot(&left, &left) / real(voice.matched)).max(1.0).sqrt();
        let slopes: f64 = voice.shape[..voice.matched]
            .windows(2)
            .map(|w| (w[1] - w[0]).powi(2))
            .sum();
        Some(Timed {
            time_s: self.onset / rate,
            std_s: noise / (self.amplitude * slopes.sqrt()) / rate,
        })
    }
}

/// Sets amplitude, and position if it may move, of one impact, given all others.
fn settle(scene: &mut [Local], i: usize, voice: &Voice, own: &[f64], may_move: bool) {
    let local = &scene[i];
    let mut left = local.products.clone();
    let origin = real(local.start + voice.before);
    for other in scene
        .iter()
        .enumerate()
        .filter(|&(j, _)| j != i)
        .map(|(_, other)| other)
    {
        // The first value of `own` belongs to a lag of 1 − matched.
        let lag = origin - other.onset + real(voice.matched) - 1.0;
        if other.amplitude > 0.0 && lag < real(own.len()) && lag + real(left.len()) > 0.0 {
            for (q, r) in left.iter_mut().zip(shifted(own, lag, local.products.len())) {
                *q -= other.amplitude * r;
            }
        }
    }
    let shape = &voice.shape[..voice.matched];
    let energy = dot(shape, shape);
    let inside = KERNEL..left.len() - KERNEL;
    let top = inside
        .max_by(|&a, &b| left[a].total_cmp(&left[b]))
        .unwrap_or(KERNEL);
    let (offset, height) = if may_move {
        maximum(&left, top)
    } else {
        let here = local.onset - origin;
        (here, interpolated(&left, here))
    };
    scene[i].onset = origin + offset;
    scene[i].amplitude = (height / energy).max(0.0);
}
