//! Names of many files for a picture: short, and still told apart.

use std::collections::HashSet;

/// A name is cut to this many characters, in its middle.
const LONGEST: usize = 30;

/// Files by names that tell them apart, and what those leave out.
pub(super) struct Names {
    /// A name for each file.
    pub own: Vec<String>,
    /// What all their names begin and end with; nothing of fewer than two different files.
    pub shared: (String, String),
}

impl Names {
    /// By the last parts of the paths if those tell the files apart, else by the whole paths.
    pub(super) fn of(files: &[&str]) -> Self {
        let last = |file: &'_ str| file.rfind(['/', '\\']).map_or(0, |i| i + 1);
        let lasts: Vec<&str> = files.iter().map(|file| &file[last(file)..]).collect();
        let different = |names: &[&str]| names.iter().collect::<HashSet<_>>().len();
        let names = if different(&lasts) == different(files) {
            lasts.as_slice()
        } else {
            files
        };
        let (head, tail) = match different(names) {
            0 | 1 => ("", ""),
            _ => in_common(names),
        };
        let own = names
            .iter()
            .map(|name| &name[head.len()..name.len() - tail.len()]);
        Self {
            own: own.map(short).collect(),
            shared: (head.to_owned(), tail.to_owned()),
        }
    }
}

/// What names begin and end with, up to a mark that separates words. Something is left of each.
fn in_common<'a>(names: &[&'a str]) -> (&'a str, &'a str) {
    let first = names[0];
    let ends = first.char_indices().map(|(i, c)| i + c.len_utf8());
    let heads = ends.map(|end| &first[..end]);
    let heads = heads.filter(|head| head.ends_with(separates));
    let starts = |head: &&str| {
        names
            .iter()
            .all(|n| n.starts_with(head) && n.len() > head.len())
    };
    let head = heads.take_while(|head| names.iter().all(|n| n.starts_with(head)));
    let head = head.filter(starts).last().unwrap_or("");
    let tails = first[head.len()..].char_indices();
    let tails = tails.map(|(i, _)| &first[head.len() + i..]);
    let ended = |tail: &&str| {
        let longer = |name: &&str| name.len() > head.len() + tail.len();
        tail.starts_with(separates) && names.iter().all(|n| n.ends_with(tail) && longer(n))
    };
    (head, tails.clone().find(ended).unwrap_or(""))
}

fn separates(c: char) -> bool {
    !c.is_alphanumeric() && c.is_ascii()
}

/// A name without its middle where it is long: numbers stand at the end.
fn short(name: &str) -> String {
    let characters: Vec<char> = name.chars().collect();
    if characters.len() <= LONGEST {
        return name.to_owned();
    }
    let kept = LONGEST / 2;
    let (head, tail) = (&characters[..kept], &characters[characters.len() - kept..]);
    [head, &['…'], tail].concat().into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lose_what_all_have_in_common_and_stay_told_apart() {
        for (files, own) in [
            (&["a/ball-01.wav", "a/ball-02.wav"][..], &["01", "02"][..]),
            (&["a/ball.wav", "a/ball-2.wav"], &["ball", "ball-2"]),
            (&["a/x.wav", "b/x.wav"], &["a", "b"]),
            (&["a/x.wav", "b/y.wav"], &["x", "y"]),
            (&["in/x.wav", "in/x.flac"], &["wav", "flac"]),
            (&["in/größe-é.wav", "in/größe-è.wav"], &["é", "è"]),
            (&["a/x.wav", "a/x.wav", "a/y.wav"], &["x", "x", "y"]),
            (&["a/x.wav", "a/x.wav"], &["x.wav", "x.wav"]),
            (&["a/one.wav"], &["one.wav"]),
            (&["-.wav", "-a.wav"], &[".wav", "a.wav"]),
            (&["ball-", "ball-1"], &["ball-", "ball-1"]),
            (&[], &[]),
        ] {
            assert_eq!(Names::of(files).own, own, "{files:?}");
        }
        let shared = Names::of(&["a/b-1.wav", "a/b-2.wav"]).shared;
        assert_eq!(shared, ("b-".to_owned(), ".wav".to_owned()));
        let long = "x".repeat(40);
        let own = Names::of(&[&long]).own;
        assert_eq!(own[0].chars().count(), LONGEST + 1);
    }
}
