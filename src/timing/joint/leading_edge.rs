//! Leading edges: the beginnings of the sounds, which depend least on how long the contact lasts.

use super::alternate::Joint;
use super::curve::Value;
use super::time_walk::TimeWalk;
use crate::linalg::{Cholesky, dot};
use crate::signal::interpolate::{KERNEL, interpolated, shifted, slope};
use crate::signal::template::aligned::{Cut, mean};
use crate::units::{real, samples_in};

/// The greatest value is sought this long after the onset, in seconds.
const PEAK_WITHIN_S: f64 = 2e-3;
/// An edge starts this long before the onset, in seconds.
const LEAD_S: f64 = 0.5e-3;
/// Least scatter of the edges of single impacts, in seconds: modes do not begin quite alike.
const SCATTER_S: f64 = 3e-6;

/// An edge ends at this share of the greatest value: the crest beyond knows little of the time, and may be clipped.
const END: f64 = 0.8;
/// Where an edge begins is where the straight line through its places at two shares of the greatest value reaches nothing.
const RISE: [f64; 2] = [0.1, 0.2];

/// How edges go with the contact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Course {
    /// How much later than its match each begins.
    pub walk: TimeWalk,
    /// Relative change of the time that an edge takes, over that of the contact: 0 where all edges are alike, 1 where they are
    /// as slow as the contact is long.
    pub slowing: f64,
}

/// The leading edges of all impacts.
pub(super) struct LeadingEdges<'a> {
    joint: &'a Joint<'a>,
    /// Samples of an edge, before the onset and in all.
    lead: usize,
    length: usize,
    /// Where an edge begins, in samples of it, and its standard error: from there on one is slower than another.
    beginning: f64,
    beginning_std: f64,
    /// The sound about each impact.
    alone: Vec<Alone>,
}

/// What a step of least squares says of the edges.
pub(super) struct Step {
    /// How far each lies from its impact's match, in samples, if it is as slow as was taken.
    pub times: Vec<Value>,
    /// Time that each takes over that of the mean, less 1, wherever it lies.
    pub slowness: Vec<Value>,
    /// Samples by which an edge is placed too late for each unit of slowness that it was taken to have too little.
    pub late: f64,
    /// Standard error of where edges begin for each unit of contact, in samples.
    pub late_std: f64,
}

impl<'a> LeadingEdges<'a> {
    /// Edges as long as that of the template; none if it is too short to be matched.
    pub(super) fn of(joint: &'a Joint<'a>) -> Option<Self> {
        let rate = joint.started.rate;
        let onset = joint.template.before;
        let lead = samples_in(LEAD_S, rate).min(onset);
        let template = joint.template.mean();
        let near = template
            .iter()
            .take(onset + samples_in(PEAK_WITHIN_S, rate));
        let peak = near.fold(0.0, |m: f64, s| m.max(s.abs()));
        let end = template.iter().position(|s| s.abs() >= END * peak)? + 1;
        let length = (end + lead).checked_sub(onset).filter(|&l| l > 3)?;
        let [low, high] = RISE.map(|share| crossing(template, share * peak));
        let (low, high) = (low?, high?);
        let ahead = RISE[0] / (RISE[1] - RISE[0]) * (high - low);
        Some(Self {
            joint,
            lead,
            length,
            beginning: low - ahead - real(onset - lead),
            beginning_std: ahead,
            alone: vec![Alone::default(); joint.places.len()],
        })
    }

    /// A step of least squares from where a course has all edges towards their mean; none where that has no slope.
    ///
    /// Edges move together and none by itself: a faint one has many crests of noise to rest on, and those near where it began
    /// would be found too often.
    pub(super) fn step(&mut self, course: &Course) -> Option<Step> {
        let cuts = self.cuts(course);
        let mean = MeanEdge::of(&cuts, self.length, self.beginning)?;
        let started = self.joint.started;
        let (mut times, mut slowness) = (Vec::new(), Vec::new());
        let heard = cuts.iter().zip(&started.contact_stretches);
        for (cut, &contact_stretch) in heard.filter(|(cut, _)| cut.amplitude > 0.0) {
            let (later, slower) = mean.off(cut);
            let taken = self.slowness(contact_stretch, course);
            let std = taken * mean.time_std / cut.amplitude;
            times.push(Value {
                contact_stretch,
                value: course.walk.shift(contact_stretch) + taken * later,
                std: std.hypot(SCATTER_S * started.rate),
            });
            slowness.push(Value {
                contact_stretch,
                value: taken * (1.0 + slower) - 1.0,
                std: taken * mean.slow_std / cut.amplitude,
            });
        }
        Some(Step {
            times,
            slowness,
            late: mean.late,
            late_std: course.slowing * self.beginning_std,
        })
    }

    /// Time that an edge takes over that of the mean.
    fn slowness(&self, contact_stretch: f64, course: &Course) -> f64 {
        1.0 + course.slowing * contact_stretch / self.joint.started.mean_contact()
    }

    /// The edges where a course has them, each as fast as the mean, with a margin on both sides.
    fn cuts(&mut self, course: &Course) -> Vec<Cut> {
        let length = self.length + 2 * KERNEL;
        let cuts = (0..self.joint.places.len()).map(|i| {
            let contact_stretch = self.joint.started.contact_stretches[i];
            let place = self.joint.places[i];
            let begin = place.position + course.walk.shift(contact_stretch) - real(self.lead);
            let slowness = self.slowness(contact_stretch, course);
            let beginning = self.beginning;
            let at = |k: usize| begin + beginning + slowness * (real(k) - real(KERNEL) - beginning);
            let alone = self.alone(i, at(0), at(length));
            let sound = (0..length).map(|k| interpolated(&alone.sound, at(k) - alone.first));
            Cut {
                amplitude: place.amplitude,
                sound: sound.collect(),
            }
        });
        cuts.collect()
    }

    /// The sound about an impact, the other impacts taken out, from one place to another at least. It is cut anew only where
    /// a course leads beyond what was cut before.
    fn alone(&mut self, i: usize, from: f64, to: f64) -> &Alone {
        let (from, to) = (from.floor() - real(KERNEL), to.ceil() + real(KERNEL));
        if !self.alone[i].holds(from, to) {
            let first = from - real(ROOM);
            let length = samples_in(1.0, to - from) + 2 * ROOM;
            let mut sound = shifted(&self.joint.started.sound, first, length);
            self.joint.take_out_others(i, first, &mut sound);
            self.alone[i] = Alone { first, sound };
        }
        &self.alone[i]
    }
}

/// Samples that are cut on either side beyond those needed: courses seldom lead farther.
const ROOM: usize = 8;

/// The sound about one impact without the others, at the samples of the recording.
#[derive(Debug, Clone, Default)]
struct Alone {
    /// Place of its first sample in the stretch.
    first: f64,
    sound: Vec<f64>,
}

impl Alone {
    fn holds(&self, from: f64, to: f64) -> bool {
        self.first <= from && to <= self.first + real(self.sound.len())
    }
}

/// The mean of edges that are as fast as each other, and what an edge a little later or slower differs from it by:
/// `x = a·s − a·δ·ds/dt − a·σ·(t − t₀)·ds/dt` for an edge that begins at t₀, is late by δ and takes 1 + σ times as long.
struct MeanEdge {
    /// `s`, `ds/dt` and `(t − t₀)·ds/dt`.
    parts: [Vec<f64>; 3],
    /// Factors of their products: of the first two, for an edge as slow as it was taken to be, and of all.
    placed: Cholesky<3>,
    all: Cholesky<3>,
    /// Standard errors of δ and σ, for an amplitude of 1.
    time_std: f64,
    slow_std: f64,
    /// Least squares are linear in δ only as far as this, in samples.
    linear: f64,
    /// See [`Step::late`].
    late: f64,
}

impl MeanEdge {
    /// Of edges that have a margin on both sides, or the slope would be wrong at the ends.
    fn of(cuts: &[Cut], length: usize, beginning: f64) -> Option<Self> {
        let around = mean(cuts);
        let inside = KERNEL..KERNEL + length;
        let slopes = slope(&around)[inside.clone()].to_vec();
        let spread = slopes.iter().enumerate();
        let spread = spread.map(|(k, d)| (real(k) - beginning) * d).collect();
        let parts = [around[inside].to_vec(), slopes, spread];
        let products = parts
            .each_ref()
            .map(|a| parts.each_ref().map(|b| dot(a, b)));
        let (placed, all) = (Cholesky::of(&products, 2)?, Cholesky::of(&products, 3)?);
        Some(Self {
            parts,
            time_std: placed.inverse()[1][1].sqrt(),
            slow_std: all.inverse()[2][2].sqrt(),
            linear: (products[0][0] / products[1][1]).sqrt(),
            late: placed.solve(&products[2])[1],
            placed,
            all,
        })
    }

    /// How much later than the mean an edge begins, in samples, and how much slower it is, wherever it begins.
    fn off(&self, cut: &Cut) -> (f64, f64) {
        let sound = &cut.sound[KERNEL..KERNEL + self.parts[0].len()];
        let found = self
            .parts
            .each_ref()
            .map(|part| dot(part, sound) / cut.amplitude);
        let later = -self.placed.solve(&found)[1];
        (
            later.clamp(-self.linear, self.linear),
            -self.all.solve(&found)[2],
        )
    }
}

/// Where a sound first reaches a size, between its samples.
fn crossing(sound: &[f64], size: f64) -> Option<f64> {
    let after = sound.iter().position(|s| s.abs() >= size)?;
    let reached = sound[after].abs();
    let before = after.checked_sub(1).map_or(0.0, |k| sound[k].abs());
    Some(real(after) - (reached - size) / (reached - before))
}
