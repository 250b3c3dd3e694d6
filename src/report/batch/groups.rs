//! Groups of drops compared, in words.

use super::super::numbers::{digits_for, plus_minus};
use super::super::wrap::wrapped;
use super::{DropDigest, visible};
use crate::fit::Estimate;
use crate::fit::groups::{Difference, Groups, Member};

/// Compares groups of drops by e, at one speed.
///
/// # Errors
/// A sentence where that cannot be.
pub fn compared(names: &[String], drops: &[(usize, DropDigest)]) -> Result<Groups, String> {
    let members: Vec<Member> = drops
        .iter()
        .filter_map(|(g, drop)| member(*g, drop))
        .collect();
    let held = |g: usize| members.iter().filter(|m| m.group == g).count();
    if let [] | [_] = names {
        let there = if names.is_empty() { "none" } else { "one only" };
        return Err(format!("Groups: there is {there}, and nothing to compare"));
    }
    if let Some(few) = (0..names.len()).find(|g| held(*g) < 2) {
        return Err(format!(
            "Groups: {} has {} with an e and its error. Each group needs two at least, better five, to show by how much its drops differ",
            visible(&names[few]),
            super::counted(held(few), "drop")
        ));
    }
    Groups::of(&members, names.len()).ok_or_else(|| "Groups: they cannot be compared".to_owned())
}

/// A drop as one measurement.
pub(super) fn member(group: usize, drop: &DropDigest) -> Option<Member> {
    let (value, std) = super::measurement(drop)?;
    Some(Member {
        group,
        value,
        std,
        ln_speed: drop.at_speed_m_per_s.filter(|v| *v > 0.0).map(f64::ln),
    })
}

/// What a comparison says; a sentence where there is none.
#[must_use]
pub fn told(names: &[String], groups: &Result<Groups, String>) -> String {
    match groups {
        Ok(groups) => in_words(names, groups),
        Err(why) => wrapped(why, 2) + "\n",
    }
}

fn in_words(names: &[String], groups: &Groups) -> String {
    let names: Vec<String> = names.iter().map(|name| visible(name)).collect();
    let at = groups.at_speed_m_per_s.map_or_else(String::new, |v| {
        let how = match &groups.slope {
            Some(slope) => format!(
                "e changes by {} for a speed greater by a factor of 2.7",
                plus_minus(slope.value, slope.std_error.unwrap_or(0.0))
            ),
            None => "how e changes with the speed is not told by them and stands in the errors"
                .to_owned(),
        };
        format!(", all at {v:.2} m/s ({how})")
    });
    let mut lines = vec![format!("Groups compared by e{at}")];
    for (name, mean) in names.iter().zip(&groups.means) {
        let spread = mean
            .spread
            .map_or_else(String::new, |s| format!(", spread {s:.*}", digits_for(s)));
        lines.push(format!(
            "  {name}: {}, {}{spread}",
            value(&mean.mean),
            super::counted(mean.count, "drop")
        ));
    }
    let Groups {
        within,
        between_drops,
        between_groups,
        ..
    } = groups;
    let least = [within, between_drops, between_groups]
        .into_iter()
        .copied()
        .filter(|s| *s > 0.0);
    let digits = digits_for(least.fold(0.1, f64::min));
    lines.push(format!(
        "  scatter  {within:.digits$} within a drop, {between_drops:.digits$} more between drops of a group, \
         {between_groups:.digits$} more between groups, one standard deviation"
    ));
    lines.extend(
        groups
            .differences
            .iter()
            .map(|d| difference(&names, d, groups.differences.len())),
    );
    lines.iter().map(|line| wrapped(line, 11) + "\n").collect()
}

/// `0.812 ± 0.004 (95 %: 0.803 to 0.821)`.
fn value(estimate: &Estimate) -> String {
    let std = estimate.std_error.unwrap_or(0.0);
    let digits = digits_for(std);
    let ends = estimate.interval95.map_or_else(String::new, |[low, high]| {
        format!(" (95 %: {low:.digits$} to {high:.digits$})")
    });
    plus_minus(estimate.value, std) + &ends
}

fn difference(names: &[String], difference: &Difference, count: usize) -> String {
    let [first, second] = difference.groups.map(|g| &names[g]);
    let judged = if difference.is_real() {
        "the difference is real"
    } else {
        "may be chance"
    };
    let chance = match difference.corrected {
        rare if rare < 0.001 => "below 0.001".to_owned(),
        chance => format!("{chance:.3}"),
    };
    let of_many = if count > 1 {
        format!(", corrected for {count} differences by Holm")
    } else {
        String::new()
    };
    format!(
        "  {second} less {first}: {}: {judged} (chance {chance}{of_many})",
        value(&difference.difference)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drops(of: &[(usize, f64)]) -> Vec<(usize, DropDigest)> {
        let drop = |&(group, value): &(usize, f64)| {
            let restitution = Some(Estimate {
                value,
                std_error: Some(0.001),
                interval95: None,
            });
            let digest = DropDigest {
                restitution,
                ..DropDigest::default()
            };
            (group, digest)
        };
        of.iter().map(drop).collect()
    }

    fn said_of(names: &[String], drops: &[(usize, DropDigest)]) -> String {
        told(names, &compared(names, drops))
    }

    fn names(of: &[&str]) -> Vec<String> {
        of.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn two_groups_are_told_with_their_difference() {
        let of = [
            (0, 0.80),
            (0, 0.81),
            (0, 0.805),
            (1, 0.85),
            (1, 0.86),
            (1, 0.855),
        ];
        let said = said_of(&names(&["cold", "warm\n"]), &drops(&of));
        assert!(said.contains("  cold: 0.8050 ± 0.0029 (95 %: "), "{said}");
        assert!(
            said.contains("warm\\n less cold: 0.0500 ± 0.0041 (95 %: "),
            "{said}"
        );
        let in_line = said.replace("\n          ", "");
        assert!(
            in_line.contains("the difference is real (chance below 0.001)"),
            "{said}"
        );
        assert!(
            said.lines().all(|line| line.chars().count() <= 80),
            "{said}"
        );
        let alike = [(0, 0.80), (0, 0.81), (1, 0.801), (1, 0.811)];
        let said = said_of(&names(&["a", "b"]), &drops(&alike));
        assert!(said.contains("may be chance"), "{said}");
    }

    #[test]
    fn many_groups_say_that_they_are_corrected() {
        let of = [
            (0, 0.80),
            (0, 0.81),
            (1, 0.80),
            (1, 0.81),
            (2, 0.80),
            (2, 0.81),
        ];
        let said = said_of(&names(&["a", "b", "c"]), &drops(&of)).replace("\n          ", "");
        assert_eq!(
            said.matches("corrected for 3 differences by Holm").count(),
            3,
            "{said}"
        );
    }

    #[test]
    fn a_group_of_one_and_a_group_alone_have_a_sentence() {
        let said = said_of(
            &names(&["a", "b"]),
            &drops(&[(0, 0.8), (0, 0.81), (1, 0.9)]),
        );
        assert!(said.contains("b has 1 drop with an e"), "{said}");
        assert!(
            said_of(&names(&["a"]), &drops(&[(0, 0.8), (0, 0.81)])).contains("there is one only")
        );
        assert!(said_of(&[], &[]).contains("there is none"));
    }
}
