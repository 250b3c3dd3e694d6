//! What is asked of all drops together: the verdict of a rule on balls and lot, and groups compared.

use std::path::Path;

use clap::ValueEnum;
use serde_json::Value;

use super::job::Job;
use crate::cli::known::Known;
use crate::cli::listen::name;
use crate::cli::rule::{ball_of_rule, status};
use crate::fit::groups::Groups;
use crate::report::batch::{Digest, DropDigest, Found, compared, summary_json, told, verdict};
use crate::report::rule::LotJudged;
use crate::rules::{Rule, judge_lot};

/// What makes a group.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum GroupBy {
    /// The folder that a file is in
    Folder,
    /// What --pattern or --options say
    Group,
}

/// What is said behind the summary, and the exit status of the verdict.
#[derive(Debug, Default)]
pub(super) struct Together {
    pub said: String,
    pub status: u8,
    lot: Option<LotJudged>,
    groups: Option<(Vec<String>, Groups)>,
}

/// How drops of one ball in several recordings are told to be so.
const NAMING: &str =
    "{ball} in --pattern, or a column ball in --options, says which are of one ball";

/// A drop with the path of its file.
type OfFile<'a> = (&'a Path, &'a str, DropDigest);

impl Together {
    pub(super) fn of(job: &Job<'_>, group: Option<GroupBy>, digests: &[Digest]) -> Self {
        let mut together = Self::default();
        let drops = drops(job, digests);
        if let Some(rule) = &job.rule {
            together.judge(job, rule, &drops);
        }
        if let Some(by) = group {
            together.compare(job, by, &drops);
        }
        together
    }

    /// Whether groups were compared.
    pub(super) const fn is_compared(&self) -> bool {
        self.groups.is_some()
    }

    /// The summary as JSON.
    pub(super) fn json(&self, digests: &[Digest]) -> Value {
        let groups = self
            .groups
            .as_ref()
            .map(|(names, groups)| (names.as_slice(), groups));
        summary_json(digests, self.lot.as_ref(), groups)
    }

    /// Each ball is that of the table or the name, else a file.
    fn judge(&mut self, job: &Job<'_>, rule: &Rule, drops: &[OfFile<'_>]) {
        let named = |path: &Path| job.given(path).ok().and_then(|given| given.ball);
        let of = |(path, file, drop): &OfFile<'_>| {
            let rebound = drop.judged.and_then(|judged| judged.rebound_m);
            let ball = named(path).unwrap_or_else(|| (*file).to_owned());
            (ball, rebound)
        };
        let lot = judge_lot(rule, &drops.iter().map(of).collect::<Vec<_>>());
        let any_named = drops.iter().any(|(path, ..)| named(path).is_some());
        let known = |path: &Path| Some(job.given(path).ok()?.over(job.listening).known);
        let known: Vec<Known> = drops.iter().filter_map(|(path, ..)| known(path)).collect();
        self.said = "\n".to_owned() + &verdict(&lot, (!any_named).then_some(NAMING));
        self.said += &ball_of_rule(&known);
        self.status = status(lot.outcome);
        self.lot = Some(lot);
    }

    fn compare(&mut self, job: &Job<'_>, by: GroupBy, drops: &[OfFile<'_>]) {
        let Grouped {
            names,
            members,
            without,
        } = groups(job, by, drops);
        let groups = compared(&names, &members);
        self.said += &("\n".to_owned() + &told(&names, &groups));
        self.said += &match without {
            0 => String::new(),
            1 => "1 drop is of no group and left out\n".to_owned(),
            several => format!("{several} drops are of no group and left out\n"),
        };
        self.groups = groups.ok().map(|groups| (names, groups));
    }
}

fn drops<'a>(job: &'a Job<'_>, digests: &'a [Digest]) -> Vec<OfFile<'a>> {
    let mut drops = Vec::new();
    for (input, digest) in job.inputs.iter().zip(digests) {
        if let Found::Drops(found) = &digest.found {
            let of_file = found
                .iter()
                .map(|drop| (input.path(), digest.file.as_str(), *drop));
            drops.extend(of_file);
        }
    }
    drops
}

/// Drops by their group.
#[derive(Debug, Default)]
struct Grouped {
    /// In the order in which they first appear.
    names: Vec<String>,
    members: Vec<(usize, DropDigest)>,
    /// Drops of no group.
    without: usize,
}

fn groups(job: &Job<'_>, by: GroupBy, drops: &[OfFile<'_>]) -> Grouped {
    let of = |path: &Path| match by {
        GroupBy::Folder => Some(path.parent().map_or_else(String::new, name)),
        GroupBy::Group => job.given(path).ok().and_then(|given| given.group),
    };
    let mut grouped = Grouped::default();
    for (path, _, drop) in drops {
        let Some(group) = of(path) else {
            grouped.without += 1;
            continue;
        };
        let known = grouped.names.iter().position(|n| *n == group);
        let index = known.unwrap_or_else(|| {
            grouped.names.push(group);
            grouped.names.len() - 1
        });
        grouped.members.push((index, *drop));
    }
    grouped
}
