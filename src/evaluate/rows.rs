//! Many recordings summed up in a row of numbers: one row for all, and one for each scene, so that an average hides
//! nothing.

use serde::Serialize;

use super::scores::{FileScore, Hit};
use super::statistics::{common_slope, root_mean_square, share};
use crate::statistics::{median, quantile};

/// The result of an evaluation. Numbers that do not exist are null.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Evaluation {
    /// Seconds of audio that can be read and squared in a second.
    pub limit_audio_s_per_s: Option<f64>,
    /// How many recordings were analyzed.
    pub files: usize,
    /// One row for each way of timing and model, over all recordings.
    pub rows: Vec<Row>,
    /// The same for each scene.
    pub scenes: Vec<Row>,
}

/// How well recordings were analyzed in one way.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct Row {
    /// How impacts were timed.
    pub timing: String,
    /// The model of the flights.
    pub model: String,
    /// The scene; null for all.
    pub scene: Option<String>,
    /// How many recordings.
    pub files: usize,
    /// How many audible impacts.
    pub audible: usize,
    /// Share of the audible impacts that were found.
    pub recall: Option<f64>,
    /// Share of what was found that is an impact.
    pub precision: Option<f64>,
    /// Drops found where none was.
    pub false_drops: usize,
    /// Drops that were not found.
    pub lost_drops: usize,
    /// Drops found in pieces.
    pub split_drops: usize,
    /// Median of |error| of the times of audible impacts, in seconds. What was not found counts as infinitely wrong, here
    /// and in the quantiles below: an analyzer does not get better by losing what is hard. Null where a quantile is such.
    pub timing_error_median_s: Option<f64>,
    /// Its 95th percentile.
    pub timing_error_p95_s: Option<f64>,
    /// Slope of the error against level, in seconds per dB.
    pub walk_s_per_db: Option<f64>,
    /// Standard error of that.
    pub walk_std_s_per_db: Option<f64>,
    /// √mean((error/limit)²), without cycle slips: 1 is the best that is possible.
    pub efficiency: Option<f64>,
    /// √mean((error/floor)²), without cycle slips: 1 is the best that a match with the mean sound reaches where impacts
    /// differ as these do.
    pub efficiency_of_match: Option<f64>,
    /// Median of |error|/limit.
    pub efficiency_median: Option<f64>,
    /// Share of the audible impacts found that are off by half a period of their sound or more.
    pub cycle_slips: Option<f64>,
    /// √mean((error/stated standard error)²), without cycle slips: 1 is honest, more is boastful.
    pub error_over_stated: Option<f64>,
    /// Median of |e − the generating e|.
    pub restitution_error_median: Option<f64>,
    /// Its 90th percentile.
    pub restitution_error_p90: Option<f64>,
    /// Median of |e − what happened|.
    pub realised_error_median: Option<f64>,
    /// Its 90th percentile.
    pub realised_error_p90: Option<f64>,
    /// How often the 95 % interval holds the generating e.
    pub coverage95: Option<f64>,
    /// Seconds of audio read and analyzed in a second.
    pub audio_s_per_s: Option<f64>,
    /// The same as a share of the limit.
    pub of_limit: Option<f64>,
}

/// The recordings of one way of analysis.
#[derive(Debug, Clone, PartialEq)]
pub struct Tier {
    /// How impacts were timed.
    pub timing: String,
    /// The model of the flights.
    pub model: String,
    /// One score for each recording.
    pub files: Vec<FileScore>,
}

impl Evaluation {
    /// Sums up. Scenes come in the order in which they first appear.
    #[must_use]
    pub fn of(tiers: &[Tier], limit_audio_s_per_s: Option<f64>) -> Self {
        let mut evaluation = Self {
            limit_audio_s_per_s,
            files: tiers.iter().map(|t| t.files.len()).max().unwrap_or(0),
            rows: Vec::new(),
            scenes: Vec::new(),
        };
        for tier in tiers {
            let all: Vec<&FileScore> = tier.files.iter().collect();
            evaluation
                .rows
                .push(row(tier, None, &all, limit_audio_s_per_s));
            let mut names: Vec<&str> = Vec::new();
            for file in &tier.files {
                if !names.contains(&file.scene.as_str()) {
                    names.push(&file.scene);
                }
            }
            for name in names {
                let some: Vec<&FileScore> =
                    all.iter().copied().filter(|f| f.scene == name).collect();
                evaluation
                    .scenes
                    .push(row(tier, Some(name), &some, limit_audio_s_per_s));
            }
        }
        evaluation
    }

    /// The document, ending with a line feed.
    ///
    /// # Errors
    /// If a number cannot be written as JSON, which no evaluation holds.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self).map(|s| s + "\n")
    }
}

fn row(tier: &Tier, scene: Option<&str>, files: &[&FileScore], limit: Option<f64>) -> Row {
    let sum = |of: fn(&FileScore) -> usize| files.iter().map(|f| of(f)).sum::<usize>();
    let (audible, found) = (sum(|f| f.audible), sum(|f| f.found));
    let elapsed_s: f64 = files.iter().map(|f| f.elapsed_s).sum();
    let audio_s: f64 = files.iter().map(|f| f.audio_s).sum();
    let speed = (elapsed_s > 0.0).then(|| audio_s / elapsed_s);
    let mut row = Row {
        timing: tier.timing.clone(),
        model: tier.model.clone(),
        scene: scene.map(str::to_owned),
        files: files.len(),
        audible,
        recall: share(sum(|f| f.recalled), audible),
        precision: share(found - sum(|f| f.spurious), found),
        false_drops: sum(|f| f.false_drops),
        lost_drops: sum(|f| f.lost_drops),
        split_drops: sum(|f| f.split_drops),
        audio_s_per_s: speed,
        of_limit: speed.zip(limit).map(|(speed, limit)| speed / limit),
        ..Row::default()
    };
    row.add_timing(files);
    row.add_restitution(files);
    row
}

impl Row {
    fn add_timing(&mut self, files: &[&FileScore]) {
        let hits: Vec<&Hit> = files.iter().flat_map(|f| &f.hits).collect();
        let sizes = with_lost(
            hits.iter().map(|h| h.error_s.abs()),
            self.audible - hits.len(),
        );
        let kept = hits.iter().filter(|h| !h.slipped);
        let ratios = |of: fn(&Hit) -> Option<f64>| -> Vec<f64> {
            let pairs = kept.clone().filter_map(|h| Some((h.error_s, of(h)?)));
            pairs
                .filter(|(_, s)| *s > 0.0)
                .map(|(e, s)| e / s)
                .collect()
        };
        let (to_limit, to_stated) = (ratios(|h| h.limit_s), ratios(|h| h.stated_s));
        let to_floor = ratios(|h| h.floor_s);
        let to_limit_sizes: Vec<f64> = to_limit.iter().map(|r| r.abs()).collect();
        let groups: Vec<Vec<(f64, f64)>> = files.iter().map(|f| levels_and_errors(f)).collect();
        let walk = common_slope(&groups);
        self.timing_error_median_s = finite(median(sizes.iter().copied()));
        self.timing_error_p95_s = finite(quantile(sizes, 0.95));
        self.walk_s_per_db = walk.map(|(slope, _)| slope);
        self.walk_std_s_per_db = walk.map(|(_, error)| error);
        self.efficiency = root_mean_square(&to_limit);
        self.efficiency_of_match = root_mean_square(&to_floor);
        self.efficiency_median = median(to_limit_sizes.iter().copied());
        self.cycle_slips = share(hits.iter().filter(|h| h.slipped).count(), hits.len());
        self.error_over_stated = root_mean_square(&to_stated);
    }

    fn add_restitution(&mut self, files: &[&FileScore]) {
        let drops = || files.iter().flat_map(|f| &f.drops);
        let errors = with_lost(drops().map(|d| d.error.abs()), self.lost_drops);
        let realised = drops().filter_map(|d| d.error_realised).map(f64::abs);
        let realised = with_lost(realised, self.lost_drops);
        self.restitution_error_median = finite(median(errors.iter().copied()));
        self.restitution_error_p90 = finite(quantile(errors, 0.9));
        self.realised_error_median = finite(median(realised.iter().copied()));
        self.realised_error_p90 = finite(quantile(realised, 0.9));
        let covered: Vec<bool> = drops().filter_map(|d| d.covered).collect();
        self.coverage95 = share(covered.iter().filter(|&&c| c).count(), covered.len());
    }
}

/// Sizes of errors, and infinity for each of those that are lost.
fn with_lost(sizes: impl Iterator<Item = f64>, lost: usize) -> Vec<f64> {
    sizes
        .chain(std::iter::repeat_n(f64::INFINITY, lost))
        .collect()
}

/// A quantile, if it lies among what was found.
fn finite(quantile: Option<f64>) -> Option<f64> {
    quantile.filter(|v| v.is_finite())
}

fn levels_and_errors(file: &FileScore) -> Vec<(f64, f64)> {
    let kept = file.hits.iter().filter(|h| !h.slipped);
    kept.filter_map(|h| Some((h.level_db?, h.error_s)))
        .collect()
}
