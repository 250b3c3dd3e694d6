//! `--pattern 'ball-{height}-{n}.wav'`: what the names of the files say.

use std::path::Path;

use super::{Given, NAMES};
use crate::Error;
use crate::cli::listen::name;

/// A name with places in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::cli::batch) struct Pattern {
    text: String,
    parts: Vec<Part>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Part {
    /// These very characters.
    Literal(String),
    /// One of [`NAMES`]: a number with its unit, or a word.
    Named(&'static str),
    /// Anything, of one character or more.
    Any,
}

impl std::str::FromStr for Pattern {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut parts = Vec::new();
        let mut rest = text;
        while let Some((literal, after)) = rest.split_once('{') {
            let (place, after) = after.split_once('}').ok_or("a { has no }")?;
            if !literal.is_empty() {
                parts.push(Part::Literal(literal.to_owned()));
            }
            let named = NAMES.into_iter().find(|name| *name == place);
            parts.push(named.map_or(Part::Any, Part::Named));
            rest = after;
        }
        if !rest.is_empty() {
            parts.push(Part::Literal(rest.to_owned()));
        }
        check(&parts)?;
        let text = text.to_owned();
        Ok(Self { text, parts })
    }
}

/// Whether there is one way only to read a name.
fn check(parts: &[Part]) -> Result<(), String> {
    let named: Vec<&Part> = parts
        .iter()
        .filter(|p| matches!(p, Part::Named(_)))
        .collect();
    if named.is_empty() {
        return Err("it has none of {height}, {mass}, {diameter}, {ball} and {group}".to_owned());
    }
    if (1..named.len()).any(|i| named[..i].contains(&named[i])) {
        return Err(
            "it has one of {height}, {mass}, {diameter}, {ball} and {group} twice".to_owned(),
        );
    }
    for pair in parts.windows(2) {
        match pair {
            [
                Part::Named(name @ ("height" | "mass" | "diameter")),
                Part::Literal(next),
            ] if next.starts_with(char::is_alphabetic) => {
                return Err(format!(
                    "{{{name}}} stands for the number with its unit: {next} must not follow it"
                ));
            }
            [Part::Named(_) | Part::Any, Part::Named(_) | Part::Any] => {
                return Err("something must stand between two places".to_owned());
            }
            _ => {}
        }
    }
    Ok(())
}

impl Pattern {
    /// What the name of a file says, its folder left out.
    pub(in crate::cli::batch) fn of(&self, path: &Path) -> Result<Given, Error> {
        let file = name(path.file_name().map_or(path, Path::new));
        let mut given = Given::default();
        if matched(&self.parts, &file, &mut given) {
            return Ok(given);
        }
        Err(Error::Argument {
            argument: "the name",
            got: format!("not of the pattern '{}'", self.text),
            expected: "one with what stands for each of its places, a quantity as 30cm or 2.5g (a bare number is in m or kg)",
        })
    }
}

/// Whether all of a text is these parts, each place as short as can be.
fn matched(parts: &[Part], text: &str, given: &mut Given) -> bool {
    let Some((part, rest)) = parts.split_first() else {
        return text.is_empty();
    };
    if let Part::Literal(literal) = part {
        let after = text.strip_prefix(literal.as_str());
        return after.is_some_and(|after| matched(rest, after, given));
    }
    let ends = text.char_indices().map(|(i, c)| i + c.len_utf8());
    ends.into_iter().any(|end| {
        let (place, after) = text.split_at(end);
        let read = match part {
            Part::Named(name) => given.set(name, place).is_ok(),
            _ => true,
        };
        read && matched(rest, after, given)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn given(pattern: &str, file: &str) -> Option<(Option<f64>, Option<f64>)> {
        let pattern: Pattern = pattern.parse().unwrap();
        let given = pattern.of(Path::new(file)).ok()?;
        Some((given.height_m, given.mass_kg))
    }

    #[test]
    fn quantities_are_read_where_their_places_are() {
        let height = Some((Some(0.3), None));
        assert_eq!(given("ball-{height}-{n}.wav", "d/ball-30cm-03.wav"), height);
        assert_eq!(given("{n}-{height}.wav", "a-b-30cm.wav"), height);
        assert_eq!(given("{height}.wav", "0.3.wav"), height);
        assert_eq!(
            given("{a}_{mass}_{height}.wav", "_x_2g_1m.wav"),
            Some((Some(1.0), Some(0.002)))
        );
        for file in [
            "ball-30cm.wav",
            "ball-30kg-1.wav",
            "ball-0cm-1.wav",
            "ball-30cm-.wav",
            "ball-30cm-1.wav2",
        ] {
            assert_eq!(given("ball-{height}-{n}.wav", file), None, "{file}");
        }
    }

    #[test]
    fn a_pattern_that_can_be_read_in_two_ways_is_refused() {
        for (pattern, reason) in [
            ("ball-{n}.wav", "none of"),
            ("{height}-{height}.wav", "twice"),
            ("{height}cm.wav", "with its unit"),
            ("{height}{n}.wav", "between"),
            ("{height.wav", "no }"),
        ] {
            let refused = pattern.parse::<Pattern>().unwrap_err();
            assert!(refused.contains(reason), "{pattern}: {refused}");
        }
    }
}
