//! Leading edges: the beginnings of the sounds, which are the same however long the contact lasts.

use super::alternate::Joint;
use super::normal_equations::NormalEquations;
use crate::signal::interpolate::{KERNEL, shifted, slope};
use crate::signal::template::aligned::{Cut, mean};
use crate::units::{real, samples_in};

/// The greatest value is sought this long after the onset, in seconds.
const PEAK_WITHIN_S: f64 = 2e-3;
/// An edge starts this long before the onset, in seconds.
const LEAD_S: f64 = 0.5e-3;
/// Edges rest once none that is clear moves by more than this share of its standard error, against the others (convention).
const REST: f64 = 0.1;
/// Rounds at most: most drops have faint edges that go to and fro by a sample until then.
const LIMIT: usize = 100;

/// Samples of an edge before the onset.
fn lead(joint: &Joint<'_>) -> usize {
    samples_in(LEAD_S, joint.started.rate).min(joint.template.before)
}

/// Samples of an edge that ends at a share of the greatest value.
pub(super) fn edge_length(joint: &Joint<'_>, share: f64) -> Option<usize> {
    let onset = joint.template.before;
    let within = samples_in(PEAK_WITHIN_S, joint.started.rate);
    let mean = joint.template.mean();
    let near = mean.iter().take(onset + within);
    let peak = near.fold(0.0, |m: f64, s| m.max(s.abs()));
    let end = mean.iter().position(|s| s.abs() >= share * peak)? + 1;
    (end + lead(joint)).checked_sub(onset).filter(|&l| l > 3)
}

/// The leading edges of all impacts, each matched with their mean.
pub(super) struct LeadingEdges {
    /// Each impact's sound, the others taken out, with a margin on both sides.
    sounds: Vec<Vec<f64>>,
    /// Position of each edge in its sound, and its amplitude.
    positions: Vec<f64>,
    amplitudes: Vec<f64>,
    /// Position at first, in its sound and in the stretch.
    first: f64,
    origins: Vec<f64>,
    /// Samples of an edge, before the onset and in all.
    lead: usize,
    pub length: usize,
    /// Standard deviations of the noise by which an edge has to stand out.
    clear: f64,
    /// Whether an edge is still where its sound begins. One unlike the others would move on for ever, and the mean with it.
    begins: Vec<bool>,
}

impl LeadingEdges {
    pub(super) fn of(joint: &Joint<'_>, share: f64, clear: f64) -> Option<Self> {
        let lead = lead(joint);
        let length = edge_length(joint, share)?;
        let margin = samples_in(LEAD_S, joint.started.rate) + KERNEL;
        let first = real(lead + margin);
        let sounds = joint.surroundings(lead + margin, length + 2 * margin + KERNEL);
        Some(Self {
            positions: vec![first; sounds.len()],
            amplitudes: joint.places.iter().map(|i| i.amplitude).collect(),
            begins: vec![true; sounds.len()],
            origins: joint.places.iter().map(|i| i.position).collect(),
            sounds,
            first,
            lead,
            length,
            clear,
        })
    }

    /// Positions in the stretch and their standard errors, in samples, of those that are clear.
    pub(super) fn aligned(&mut self) -> Vec<Option<(f64, f64)>> {
        let mut stds = vec![f64::INFINITY; self.sounds.len()];
        for _ in 0..LIMIT {
            let moves = self.moves(&mut stds);
            let weighted = moves.iter().zip(&stds).map(|(m, std)| (m, std.powi(-2)));
            let (sum, weight) = weighted.fold((0.0, 0.0), |(s, w), (m, by)| (s + m * by, w + by));
            // Matching with their own mean leaves a shift that is common to all unmeasured.
            let common = if weight > 0.0 { sum / weight } else { 0.0 };
            for ((p, begins), m) in self.positions.iter_mut().zip(&mut self.begins).zip(&moves) {
                *p += m - common;
                *begins &= (*p - self.first).abs() <= real(self.lead);
            }
            let mut each = moves.iter().zip(&stds);
            if each.all(|(m, std)| (m - common).abs() <= REST * std) {
                break;
            }
        }
        let moved = self.positions.iter().map(|p| p - self.first);
        let places = self.origins.iter().zip(moved).map(|(o, m)| o + m);
        let clear = |(place, std): (f64, f64)| std.is_finite().then_some((place, std));
        places.zip(stds).map(clear).collect()
    }

    /// One step of all edges towards their mean, in samples; their standard errors, infinite where an edge is not clear.
    fn moves(&mut self, stds: &mut [f64]) -> Vec<f64> {
        let noise = vec![1.0; self.length];
        let cuts = self.cuts();
        let beginning = cuts.iter().zip(&self.begins).filter(|(_, begins)| **begins);
        let shape = mean(&beginning.map(|(cut, _)| cut.clone()).collect::<Vec<Cut>>());
        let slopes = slope(&shape);
        let mut moves = Vec::with_capacity(cuts.len());
        for (i, cut) in cuts.iter().enumerate() {
            let normal = NormalEquations::of(&cut.sound, &noise, &shape, &slopes);
            let (amplitude, moved, std) = normal.solve(self.amplitudes[i]);
            self.amplitudes[i] = amplitude.max(0.3 * self.amplitudes[i]);
            let is_clear = self.begins[i] && normal.clearness(amplitude) >= self.clear;
            stds[i] = if is_clear { std } else { f64::INFINITY };
            moves.push(moved.clamp(-1.0, 1.0));
        }
        moves
    }

    /// The edges at their positions.
    fn cuts(&self) -> Vec<Cut> {
        let places = self.sounds.iter().zip(&self.positions);
        let cuts = places
            .zip(&self.amplitudes)
            .map(|((s, p), &amplitude)| Cut {
                amplitude,
                sound: shifted(s, p - real(self.lead), self.length + KERNEL),
            });
        cuts.collect()
    }
}
