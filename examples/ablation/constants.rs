//! The constants of the source: named numbers that detection, sequence, timing and analysis rest on.

use std::fs;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::mask::{at_depth_0, code, is_of_name, places};
use super::uses::{is_compiled, uses};

/// Where the constants are that are listed, from the folder of the source on.
pub(crate) const LISTED: [&str; 6] = [
    "analysis/",
    "detect/",
    "physics/priors.rs",
    "sequence/",
    "signal/",
    "timing/",
];

/// A constant. One that is not listed is known where it is made of listed ones.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Constant {
    /// Its file, from the folder of the source on.
    pub(crate) file: String,
    /// Its line, from 1.
    pub(crate) line: usize,
    pub(crate) name: String,
    /// Its type.
    pub(crate) of: String,
    /// The first sentence of its comment.
    pub(crate) about: String,
    /// The numbers that can be changed, each for itself.
    pub(crate) numbers: Vec<Number>,
    /// Whether the compiler has to know it: the length of an array, or what such a length is made of.
    pub(crate) structural: bool,
    /// From `const` to the semicolon, in bytes of the file.
    pub(crate) item: Range<usize>,
    /// What stands between `=` and the semicolon.
    pub(crate) expression: Range<usize>,
}

/// A number of a constant: all of it, an element of a tuple or a field of a structure.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Number {
    /// The name of the constant, and that of the element or field after a dot.
    pub(crate) name: String,
    pub(crate) value: String,
    /// Where its value stands in the file.
    pub(crate) place: Range<usize>,
}

impl Constant {
    pub(crate) fn is_listed(&self) -> bool {
        !self.numbers.is_empty() && LISTED.iter().any(|place| self.file.starts_with(place))
    }
}

/// A file of the source with its code.
#[derive(Debug)]
pub(crate) struct Source {
    /// Its path from the folder of the source on, with slashes.
    pub(crate) file: String,
    pub(crate) text: String,
    pub(crate) code: String,
}

/// All files of the source but for those that hold nothing but tests, in order.
pub(crate) fn sources(src: &Path) -> io::Result<Vec<Source>> {
    let mut paths = Vec::new();
    add_paths(src, &mut paths)?;
    paths.sort();
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path)?;
        let inside = path.strip_prefix(src).unwrap_or(&path);
        let names = inside.iter().map(|part| part.to_string_lossy());
        let file = names.collect::<Vec<_>>().join("/");
        let code = code(&text);
        Ok(Source { file, text, code })
    };
    paths.into_iter().map(read).collect()
}

fn add_paths(folder: &Path, paths: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if path.is_dir() {
            add_paths(&path, paths)?;
        } else if name.ends_with(".rs") && !name.ends_with("tests.rs") {
            paths.push(path);
        }
    }
    Ok(())
}

/// The constants that are listed, in order of file and line, and after them those that are made of them.
pub(crate) fn constants(sources: &[Source]) -> Vec<Constant> {
    let all = sources.iter().flat_map(of_file);
    let (mut found, mut rest): (Vec<Constant>, Vec<Constant>) = all.partition(Constant::is_listed);
    let mut known = 0;
    while known < found.len() {
        known = found.len();
        let (new, others) = rest.into_iter().partition(|constant| {
            let names = found.iter().map(|c| &c.name);
            let source = sources.iter().find(|s| s.file == constant.file);
            let code = source.map_or("", |s| &s.code[constant.expression.clone()]);
            names.into_iter().any(|name| !places(code, name).is_empty())
        });
        found.extend::<Vec<Constant>>(new);
        rest = others;
    }
    mark_structural(&mut found, sources);
    found
}

/// What the compiler has to know, and what that is made of.
fn mark_structural(constants: &mut [Constant], sources: &[Source]) {
    let used: Vec<Vec<(usize, usize)>> = constants
        .iter()
        .map(|constant| {
            let places = sources.iter().enumerate().flat_map(|(i, source)| {
                let used = uses(constant, source, sources).into_iter();
                used.map(move |at| (i, at))
            });
            places.collect()
        })
        .collect();
    let mut marked = true;
    while marked {
        marked = false;
        for (i, used) in used.iter().enumerate() {
            let is_structural = used.iter().any(|&(source, at)| {
                let source = &sources[source];
                let in_structural = constants
                    .iter()
                    .any(|c| c.structural && c.file == source.file && c.item.contains(&at));
                in_structural || is_compiled(&source.code, at)
            });
            marked |= is_structural && !constants[i].structural;
            constants[i].structural |= is_structural;
        }
    }
}

fn of_file(source: &Source) -> Vec<Constant> {
    let starts = places(&source.code, "const").into_iter();
    starts.filter_map(|at| constant(source, at)).collect()
}

/// The constant whose `const` stands at a place; none where it is none.
fn constant(source: &Source, at: usize) -> Option<Constant> {
    let Source { file, text, code } = source;
    let from = at + "const".len();
    let colon = from + code[from..].find(|c: char| c != ' ' && !is_of_name(c as u8))?;
    let name = code[from..colon].trim();
    let is_name = !name.is_empty()
        && name
            .bytes()
            .all(|b| !b.is_ascii_lowercase() && is_of_name(b));
    if !is_name || code.as_bytes()[colon] != b':' {
        return None;
    }
    let equals = at_depth_0(code, colon, b"=;")?;
    let end = at_depth_0(code, equals, b";")?;
    let of = code[colon + 1..equals].trim();
    Some(Constant {
        file: file.clone(),
        line: text[..at].matches('\n').count() + 1,
        name: name.to_owned(),
        of: of.to_owned(),
        about: about(&text[..at]),
        numbers: numbers(source, name, of, equals + 1..end),
        structural: false,
        item: at..end + 1,
        expression: equals + 1..end,
    })
}

/// The numbers of an expression of a type; none where it is made of something else too.
fn numbers(source: &Source, name: &str, of: &str, expression: Range<usize>) -> Vec<Number> {
    let code = &source.code[expression.clone()];
    let number = |suffix: &str, place: Range<usize>| {
        let place = trimmed(&source.code, place);
        let value = source.text[place.clone()].split_whitespace();
        Number {
            name: format!("{name}{suffix}"),
            value: value.collect::<Vec<_>>().join(" "),
            place,
        }
    };
    if is_made_of_numbers(of) && !of.starts_with('(') {
        return vec![number("", expression)];
    }
    let (open, close) = if is_made_of_numbers(of) {
        ('(', ')')
    } else {
        ('{', '}')
    };
    let is_structure = of.bytes().all(|b| is_of_name(b) || b == b':') && of != "Self";
    let (Some(from), Some(to)) = (code.find(open), code.rfind(close)) else {
        return Vec::new();
    };
    if open == '{' && !(is_structure && code[..from].trim() == of) {
        return Vec::new();
    }
    let inside = expression.start + from + 1..expression.start + to;
    let mut found = Vec::new();
    for (i, element) in elements(&source.code, inside).into_iter().enumerate() {
        let text = &source.code[element.clone()];
        let (suffix, place) = match text.split_once(':') {
            Some((field, value)) if open == '{' => (
                format!(".{}", field.trim()),
                element.end - value.len()..element.end,
            ),
            _ => (format!(".{i}"), element),
        };
        // A field of another kind makes the whole no constant of numbers.
        if !source.code[place.clone()].contains(|c: char| c.is_ascii_digit()) {
            return Vec::new();
        }
        found.push(number(&suffix, place));
    }
    found
}

/// What stands between commas.
fn elements(code: &str, inside: Range<usize>) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut from = inside.start;
    while from < inside.end {
        let to = at_depth_0(code, from, b",").map_or(inside.end, |at| at.min(inside.end));
        if !code[from..to].trim().is_empty() {
            found.push(from..to);
        }
        from = to + 1;
    }
    found
}

fn trimmed(code: &str, range: Range<usize>) -> Range<usize> {
    let text = &code[range.clone()];
    let start = range.start + text.len() - text.trim_start().len();
    start..start + text.trim().len()
}

fn is_made_of_numbers(of: &str) -> bool {
    let mut words = of
        .split(|c: char| !is_of_name(c as u8))
        .filter(|w| !w.is_empty());
    let number = |w: &str| {
        matches!(w, "f32" | "f64" | "usize" | "u32" | "u64" | "i32") || w.parse::<u32>().is_ok()
    };
    let plain = of
        .chars()
        .all(|c| is_of_name(c as u8) || " ()[];,".contains(c));
    plain && words.all(number)
}

/// The first sentence of the comment that ends a text; that of the constants just before where this one has none.
fn about(text: &str) -> String {
    let lines = text.lines().rev().skip(usize::from(!text.ends_with('\n')));
    let is_constant = |l: &&str| l.trim_start().starts_with("const ") || l.contains(") const ");
    let lines = lines.skip_while(is_constant);
    let lines = lines.skip_while(|l| l.trim_start().starts_with("#["));
    let comment = lines.map_while(|l| l.trim_start().strip_prefix("///"));
    let mut comment: Vec<&str> = comment.map(str::trim).collect();
    comment.reverse();
    let whole = comment.join(" ");
    let end = whole.find(". ").map_or(whole.len(), |i| i + 1);
    whole[..end]
        .trim_end_matches(['.', ':', '…', ' '])
        .to_owned()
}
