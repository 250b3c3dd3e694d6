//! The command that was probably meant where the one given is none.

use std::ffi::OsString;
use std::path::Path;

use clap::CommandFactory;

use crate::audio;
use crate::units::Quantity;

/// What to say of arguments that cannot be parsed, if it is clear what their user wants.
pub(super) fn meant(arguments: &[OsString]) -> Option<String> {
    let given: Vec<String> = arguments
        .iter()
        .skip(1)
        .map(|a| a.to_string_lossy().into_owned())
        .collect();
    let recordings: Vec<&String> = given.iter().filter(|a| is_recording(a)).collect();
    let first = given.first()?;
    let command = super::Arguments::command();
    let is_option = first.starts_with('-');
    let known = first == "help" || command.get_subcommands().any(|c| c.get_name() == first);
    match (known, recordings.as_slice()) {
        (false, []) => None,
        // A command that was misspelt is clap's to mend.
        (false, _) if !is_option && !is_recording(first) => None,
        (false, [one]) if Path::new(one.as_str()).is_dir() => Some(format!(
            "a command is missing. To listen to all recordings in a folder: bounce-audio batch {}",
            quoted(&given)
        )),
        (false, [_]) => Some(format!(
            "a command is missing. To listen to a recording: bounce-audio analyze {}",
            quoted(&given)
        )),
        (false, _) => Some(format!(
            "a command is missing. To listen to several recordings: bounce-audio batch {}",
            quoted(&given)
        )),
        _ if apart(&given).is_some() => apart(&given),
        (true, [_, _, ..]) if first == "analyze" => {
            let recordings: Vec<String> = recordings.into_iter().cloned().collect();
            Some(format!(
                "analyze takes one recording. To listen to several: bounce-audio batch {}",
                quoted(&recordings)
            ))
        }
        (true, _) => None,
    }
}

/// A unit that stands apart from its number, which a shell makes two arguments of: `--height 30,5 cm`.
fn apart(given: &[String]) -> Option<String> {
    given.windows(3).find_map(|three| {
        let [option, number, unit] = three else {
            return None;
        };
        let is_number = number.starts_with(|c: char| c.is_ascii_digit())
            && number
                .chars()
                .all(|c| c.is_ascii_digit() || ".,".contains(c));
        let is_unit = is_unit(unit) && !Path::new(unit).exists();
        (option.starts_with("--") && is_number && is_unit).then(|| {
            let number = number.replace(',', ".");
            format!("a number and its unit are one word: {option} {number}{unit}")
        })
    })
}

/// Whether this can stand behind a number.
fn is_unit(text: &str) -> bool {
    use Quantity::{Acceleration, Length, Mass, Share, Time};
    let with_number = format!("1{text}");
    let reads = |quantity: &Quantity| quantity.parse("", &with_number).is_ok();
    !text.starts_with(|c: char| c.is_ascii_digit() || ":.eE".contains(c))
        && [Length, Mass, Time, Acceleration, Share].iter().any(reads)
}

/// A file or folder that is there, or a name that ends as those of recordings do.
fn is_recording(argument: &str) -> bool {
    let path = Path::new(argument);
    !argument.starts_with('-') && (path.exists() || audio::has_ending(path))
}

/// Arguments as a shell takes them.
pub(super) fn quoted(arguments: &[String]) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./=%,:@+".contains(c);
    let one = |argument: &String| {
        if !argument.is_empty() && argument.chars().all(plain) {
            argument.clone()
        } else {
            format!("'{}'", argument.replace('\'', r"'\''"))
        }
    };
    arguments.iter().map(one).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(line: &[&str]) -> Option<String> {
        let line = ["bounce-audio"].iter().chain(line);
        meant(&line.map(OsString::from).collect::<Vec<_>>())
    }

    #[test]
    fn the_command_that_was_meant_is_offered_as_it_can_be_typed() {
        for (line, offered) in [
            (&["drop.wav"][..], "bounce-audio analyze drop.wav"),
            (
                &["--height", "30cm", "my drop.m4a"],
                "bounce-audio analyze --height 30cm 'my drop.m4a'",
            ),
            (&["a.wav", "b.flac"], "bounce-audio batch a.wav b.flac"),
            (&["src"], "bounce-audio batch src"),
            (
                &["analyze", "a.wav", "it's.wav", "-q"],
                r"bounce-audio batch a.wav 'it'\''s.wav'",
            ),
        ] {
            let said = said(line).unwrap();
            assert!(said.ends_with(offered), "{said}");
        }
    }

    #[test]
    fn nothing_is_offered_where_nothing_is_clear() {
        for line in [
            &[][..],
            &["anlyze"],
            &["analyse", "a.wav"],
            &["analyze"],
            &["analyze", "a.wav", "--hieght", "1"],
            &["solve", "a.wav", "b.wav"],
        ] {
            assert_eq!(said(line), None, "{line:?}");
        }
    }

    #[test]
    fn a_unit_apart_from_its_number_is_joined_to_it() {
        let told = said(&["analyze", "a.wav", "--height", "30,5", "cm", "-q"]).unwrap();
        assert!(told.ends_with("one word: --height 30.5cm"), "{told}");
        assert_eq!(
            said(&["analyze", "a.wav", "--height", "30,5cm", "-q"]),
            None
        );
    }
}
