//! The findings, scene by scene, and the analysis that they add up to.

use super::Settings;
use super::candidate::Candidate;
use super::drop::{Extent, Measured};
use super::few;
use super::scene::{SceneResult, clearest, is_known};
use super::warnings::{self, Sounds};
use crate::Error;
use crate::order::sort_by_number;
use crate::report::{self, Analysis, Rejected};
use crate::sequence::NAMED;

/// Impacts that are kept, of the drops with the most evidence: an hour of one drop after another. With its document
/// each takes 1 KiB, so that these add 50 MiB to the memory of a scene.
const MOST_IMPACTS: usize = 50_000;

/// The findings in the scenes so far.
#[derive(Debug, Default)]
pub(super) struct Findings {
    drops: Vec<Measured>,
    impacts: usize,
    /// Two or three impacts, which count if there is no drop: the best of any scene, and what the next best is worth.
    few: Option<few::Heard>,
    /// The chain that comes nearest to a drop, likewise.
    candidate: Option<Candidate>,
    /// Drops that there was no room for.
    left_out: usize,
    /// Drops that were cut in two.
    split: usize,
    rejected: Vec<(f64, Rejected)>,
    weak: usize,
    sounds: Sounds,
    clarities: Vec<f64>,
    /// Times of the impacts of the last scene.
    reported_s: Vec<f64>,
}

impl Findings {
    pub(super) fn new(channels: usize) -> Self {
        Self {
            clarities: vec![0.0; channels],
            ..Self::default()
        }
    }

    /// Times of the impacts reported already from a time on, ascending.
    pub(super) fn reported_after(&self, time_s: f64) -> &[f64] {
        &self.reported_s[self.reported_s.partition_point(|&t| t < time_s)..]
    }

    /// Adds what was heard in the next scene.
    pub(super) fn add(&mut self, scene: SceneResult) {
        let impacts = scene.drops.iter().flat_map(|m| &m.impacts);
        self.reported_s = impacts.map(|i| i.time_s).collect();
        self.reported_s.sort_by(f64::total_cmp);
        self.impacts += self.reported_s.len();
        self.drops.extend(scene.drops);
        self.few = match (self.few.take(), scene.few) {
            (Some(before), Some(now)) => Some(before.or_better(now)),
            (before, now) => before.or(now),
        };
        self.candidate = nearer(self.candidate.take(), scene.candidate);
        self.keep_the_surest();
        self.rejected.extend(scene.rejected);
        self.weak += scene.weak;
        self.keep_the_strongest();
        self.split += scene.split;
        self.sounds.add(scene.sound, &scene.strengths);
        for (sum, clarity) in self.clarities.iter_mut().zip(scene.clarities) {
            *sum += clarity;
        }
    }

    fn keep_the_surest(&mut self) {
        while self.impacts > MOST_IMPACTS {
            let evidence = |i: &usize| self.drops[*i].evidence_nats;
            let weakest = (0..self.drops.len()).min_by(|a, b| evidence(a).total_cmp(&evidence(b)));
            let Some(weakest) = weakest else { return };
            self.impacts -= self.drops.remove(weakest).impacts.len();
            self.left_out += 1;
        }
    }

    fn keep_the_strongest(&mut self) {
        if self.rejected.len() > NAMED {
            sort_by_number(&mut self.rejected, |(strength, _)| -strength);
            self.weak += self.rejected.len() - NAMED;
            self.rejected.truncate(NAMED);
        }
    }

    /// The whole of it, and the index of the channel that most of it was heard on, in the recording.
    ///
    /// # Errors
    /// [`Error::Argument`] for a setting out of range.
    pub(super) fn analysis(
        mut self,
        extent: Extent,
        settings: &Settings,
    ) -> Result<(usize, Analysis), Error> {
        let channel = extent.first_channel + self.channel();
        sort_by_number(&mut self.rejected, |(_, rejected)| rejected.time_s);
        let mut warnings = Vec::new();
        let candidate = self.candidate();
        if self.drops.is_empty() {
            warnings.push(self.sounds.warning(candidate.as_ref()));
        }
        warnings.extend(warnings::of_memory(self.left_out, self.split));
        let drops = self.drops.into_iter().map(|m| m.within(extent, settings));
        let analysis = Analysis {
            drops: drops.collect::<Result<_, Error>>()?,
            candidate,
            rejected: self.rejected.into_iter().map(|(_, r)| r).collect(),
            rejected_weak: self.weak,
            warnings,
        };
        Ok((channel, analysis))
    }

    /// Where there is no drop, two or three impacts become one if they are enough; else what comes nearest to a drop.
    fn candidate(&mut self) -> Option<report::Candidate> {
        if !self.drops.is_empty() {
            return None;
        }
        let few = match self.few.take() {
            Some(few) if few.is_enough() => {
                let impacts = few.measured.impacts.iter().map(|i| i.time_s);
                let impacts_s: Vec<f64> = impacts.collect();
                // No chain had them, so they were put down as rejected.
                self.rejected
                    .retain(|(_, r)| !is_known(r.time_s, &impacts_s));
                self.drops.push(few.measured);
                return None;
            }
            few => few.map(Candidate::of_few),
        };
        nearer(self.candidate.take(), few)?.reported()
    }

    /// The channel of most drops; of several, or where there are none, the clearest.
    fn channel(&self) -> usize {
        let mut counts = vec![0_usize; self.clarities.len()];
        for m in &self.drops {
            counts[m.channel] += 1;
        }
        let most = counts.iter().copied().max().unwrap_or(0);
        let of_most = |(count, clarity): (&usize, &f64)| {
            if *count == most {
                *clarity
            } else {
                f64::NEG_INFINITY
            }
        };
        let clarities: Vec<f64> = counts.iter().zip(&self.clarities).map(of_most).collect();
        clearest(&clarities)
    }
}

fn nearer(a: Option<Candidate>, b: Option<Candidate>) -> Option<Candidate> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.or_nearer(b)),
        (a, b) => a.or(b),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::WarningCode;

    #[test]
    fn past_the_limit_the_drops_with_the_least_evidence_go_and_are_counted() {
        let mut findings = Findings::new(1);
        findings.impacts = MOST_IMPACTS + 1;
        for evidence in [30.0, 20.0, 40.0] {
            findings.drops.push(Measured::with_evidence(evidence));
        }
        findings.keep_the_surest();
        let extent = Extent {
            first_channel: 0,
            end_s: 20.0,
        };
        let (_, analysis) = findings.analysis(extent, &Settings::default()).unwrap();
        let left: Vec<f64> = analysis.drops.iter().map(|d| d.evidence_nats).collect();
        assert_eq!(left, [30.0, 40.0]);
        assert_eq!(analysis.warnings[0].code, WarningCode::LeftOut);
    }
}
