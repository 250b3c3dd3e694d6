//! What was found in one recording, held against its truth.

use super::matching::{Matching, Pair, pair};
use super::reference::{Reference, ReferenceDrop};
use crate::report::{Analysis, Drop, Impact, Status};
use crate::statistics::median;
use crate::units::real;

/// How one recording was analyzed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct FileScore {
    /// Its scene.
    pub scene: String,
    /// Impacts that can be heard.
    pub audible: usize,
    /// How many of them were found.
    pub recalled: usize,
    /// Impacts found, heard or doubtful; what was only inferred does not count.
    pub found: usize,
    /// How many of them are none. An inaudible impact that is found is no error.
    pub spurious: usize,
    /// Drops found where none was.
    pub false_drops: usize,
    /// Drops of which none was found, though three impacts or more are audible.
    pub lost_drops: usize,
    /// Drops found more than once, in pieces.
    pub split_drops: usize,
    /// The audible impacts that were found.
    pub hits: Vec<Hit>,
    /// The drops that were found, and have an e.
    pub drops: Vec<DropScore>,
    /// Length of the recording in seconds.
    pub audio_s: f64,
    /// Time that reading and analysis took, in seconds.
    pub elapsed_s: f64,
}

/// An audible impact that was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Found minus true, after the recording's common offset, in seconds.
    pub error_s: f64,
    /// The least standard error that was possible, in seconds.
    pub limit_s: Option<f64>,
    /// The standard error that a match with the mean sound reaches at best, in seconds.
    pub floor_s: Option<f64>,
    /// The standard error that was stated, in seconds.
    pub stated_s: Option<f64>,
    /// Its level in dB.
    pub level_db: Option<f64>,
    /// Whether it is off by half a period of its sound or more: a cycle slip.
    pub slipped: bool,
}

/// The e of one drop that was found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DropScore {
    /// e found minus the generating one, at the speed that was stated.
    pub error: f64,
    /// e found minus the geometric mean of what happened, over the impacts found.
    pub error_realised: Option<f64>,
    /// Whether the 95 % interval holds the generating e; null where no interval is stated.
    pub covered: Option<bool>,
}

/// A true drop needs this many audible impacts to count as lost: fewer bound no two flights.
const FEWEST_AUDIBLE: usize = 3;

/// Scores an analysis.
#[must_use]
pub fn score(
    analysis: &Analysis,
    reference: &Reference,
    audio_s: f64,
    elapsed_s: f64,
) -> FileScore {
    let found = found_impacts(analysis);
    let truth = true_impacts(reference);
    let found_s: Vec<f64> = found.iter().map(|(_, i)| i.time_s).collect();
    let truth_s: Vec<f64> = truth.iter().map(|t| t.onset_s).collect();
    let matching = pair(&found_s, &truth_s);
    let errors_s = errors_s(analysis, reference, &found, &truth, &matching);
    let pairs = matching.pairs.iter().zip(errors_s);
    let hits: Vec<Hit> = pairs
        .filter(|(p, _)| truth[p.truth].audible)
        .map(|(p, error_s)| hit(error_s, found[p.found].1, &truth[p.truth]))
        .collect();
    let mut score = FileScore {
        scene: reference.scene.clone(),
        audible: truth.iter().filter(|t| t.audible).count(),
        recalled: hits.len(),
        found: found.len(),
        spurious: found.len() - matching.pairs.len(),
        hits,
        audio_s,
        elapsed_s,
        ..FileScore::default()
    };
    score.judge_drops(analysis, reference, &found, &truth, &matching);
    score
}

/// A true impact and the drop it belongs to.
struct TrueImpact {
    drop: usize,
    index: usize,
    onset_s: f64,
    audible: bool,
    limit_s: Option<f64>,
    floor_s: Option<f64>,
    period_s: Option<f64>,
}

fn true_impacts(reference: &Reference) -> Vec<TrueImpact> {
    let mut impacts: Vec<TrueImpact> = Vec::new();
    for (drop, d) in reference.drops.iter().enumerate() {
        let pairs = d.onsets_s.iter().zip(&d.audible);
        impacts.extend(
            pairs
                .enumerate()
                .map(|(index, (&onset_s, &audible))| TrueImpact {
                    drop,
                    index,
                    onset_s,
                    audible,
                    limit_s: d.timing_limit_s.get(index).copied().flatten(),
                    floor_s: d.timing_floor_s.get(index).copied().flatten(),
                    period_s: d.period_s,
                }),
        );
    }
    impacts.sort_by(|a, b| a.onset_s.total_cmp(&b.onset_s));
    impacts
}

/// The error of each pair by the onset in the channel that its drop was heard on, after one common offset.
fn errors_s(
    analysis: &Analysis,
    reference: &Reference,
    found: &[(usize, &Impact)],
    truth: &[TrueImpact],
    matching: &Matching,
) -> Vec<f64> {
    let own = |p: &Pair| {
        let (channel, truth) = (analysis.drops[found[p.found].0].channel, &truth[p.truth]);
        p.error_s - reference.drops[truth.drop].later_s(truth.index, channel)
    };
    let errors_s: Vec<f64> = matching.pairs.iter().map(own).collect();
    let common_s = median(errors_s.iter().copied()).unwrap_or(0.0);
    errors_s.iter().map(|e| e - common_s).collect()
}

/// Impacts that were heard, with the index of their drop, in order of time.
fn found_impacts(analysis: &Analysis) -> Vec<(usize, &Impact)> {
    let drops = analysis.drops.iter().enumerate();
    let mut found: Vec<(usize, &Impact)> = drops
        .flat_map(|(j, d)| d.impacts.iter().map(move |i| (j, i)))
        .filter(|(_, i)| i.status != Status::Inferred)
        .collect();
    found.sort_by(|a, b| a.1.time_s.total_cmp(&b.1.time_s));
    found
}

fn hit(error_s: f64, found: &Impact, truth: &TrueImpact) -> Hit {
    Hit {
        error_s,
        limit_s: truth.limit_s,
        floor_s: truth.floor_s,
        stated_s: found.time_std_s,
        level_db: found.level_db,
        slipped: truth
            .period_s
            .is_some_and(|period| error_s.abs() >= 0.5 * period),
    }
}

impl FileScore {
    /// Which true drop each found one is: the one that most of its impacts belong to, if those are half of them.
    fn judge_drops(
        &mut self,
        analysis: &Analysis,
        reference: &Reference,
        found: &[(usize, &Impact)],
        truth: &[TrueImpact],
        matching: &Matching,
    ) {
        let mut common = vec![vec![0_usize; reference.drops.len()]; analysis.drops.len()];
        let mut sizes = vec![0_usize; analysis.drops.len()];
        for (j, _) in found {
            sizes[*j] += 1;
        }
        for p in &matching.pairs {
            common[found[p.found].0][truth[p.truth].drop] += 1;
        }
        let mut claims: Vec<Vec<(usize, usize)>> = vec![Vec::new(); reference.drops.len()];
        for (j, counts) in common.iter().enumerate() {
            let most = counts.iter().enumerate().max_by_key(|(_, count)| **count);
            match most {
                Some((d, &count)) if count > 0 && 2 * count >= sizes[j] => {
                    claims[d].push((count, j));
                }
                _ => self.false_drops += 1,
            }
        }
        for (d, claims) in claims.iter().enumerate() {
            let drop = &reference.drops[d];
            let audible = drop.audible.iter().filter(|&&a| a).count();
            let Some(&(_, j)) = claims.iter().max() else {
                self.lost_drops += usize::from(audible >= FEWEST_AUDIBLE);
                continue;
            };
            self.split_drops += claims.len() - 1;
            let own = |p: &&Pair| found[p.found].0 == j && truth[p.truth].drop == d;
            let heard: Vec<usize> = matching
                .pairs
                .iter()
                .filter(own)
                .map(|p| truth[p.truth].index)
                .collect();
            self.drops
                .extend(drop_score(&analysis.drops[j], drop, &heard));
        }
    }
}

/// None where there is no e, stated or true.
fn drop_score(found: &Drop, truth: &ReferenceDrop, heard: &[usize]) -> Option<DropScore> {
    let stated = found.restitution.as_ref()?;
    let speeds: Vec<f64> = heard
        .iter()
        .filter_map(|&i| truth.speeds_m_per_s.get(i).copied())
        .collect();
    let speed = stated
        .at_speed_m_per_s
        .or_else(|| geometric_mean(&speeds))?;
    let generating = truth.restitution_at(speed)?;
    // The last impact bounds no flight that was heard: its own e is not in the answer.
    let happened: Vec<f64> = heard
        .iter()
        .take(heard.len().saturating_sub(1))
        .filter_map(|&i| truth.restitution_each.get(i).copied())
        .filter(|e| *e > 0.0)
        .collect();
    let value = stated.estimate.value;
    Some(DropScore {
        error: value - generating,
        error_realised: geometric_mean(&happened).map(|e| value - e),
        covered: stated
            .estimate
            .interval95
            .map(|[low, high]| (low..=high).contains(&generating)),
    })
}

fn geometric_mean(values: &[f64]) -> Option<f64> {
    let sum: f64 = values.iter().map(|v| v.ln()).sum();
    (!values.is_empty()).then(|| (sum / real(values.len())).exp())
}
