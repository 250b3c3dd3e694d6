//! The constants of the source: named numbers that detection, sequence, timing and analysis rest on.

use std::fs;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::mask::{at_depth_0, code, is_of_name, places};

/// The folders of the source whose constants are listed.
pub(crate) const FOLDERS: [&str; 5] = ["detect", "signal", "sequence", "timing", "analysis"];

/// A constant made of numbers: one, a tuple or an array.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Constant {
    /// Its file, from the folder of the source on.
    pub file: String,
    /// Its line, from 1.
    pub line: usize,
    pub name: String,
    pub of: String,
    pub value: String,
    /// The first sentence of its comment.
    pub about: String,
    /// Whether the compiler has to know it: the length of an array, or what such a length is made of.
    pub(crate) structural: bool,
    /// From `const` to the semicolon, in bytes of the file.
    pub item: Range<usize>,
    /// What stands between `=` and the semicolon.
    pub expression: Range<usize>,
}

impl Constant {
    /// The name that no other constant has.
    pub(crate) fn key(&self) -> String {
        format!("{}::{}", self.file, self.name)
    }

    /// The numbers that are changed one at a time: those of a tuple, else the whole.
    pub(crate) fn numbers(&self) -> Vec<(String, String)> {
        let inner = self
            .value
            .strip_prefix('(')
            .filter(|_| self.of.starts_with('('));
        let Some(inner) = inner.and_then(|v| v.strip_suffix(')')) else {
            return vec![(self.name.clone(), self.value.clone())];
        };
        let elements = inner.split(',').map(str::trim).filter(|e| !e.is_empty());
        let numbered = elements.enumerate();
        numbered
            .map(|(i, value)| (format!("{}.{i}", self.name), value.to_owned()))
            .collect()
    }
}

/// A file of the source with its code.
#[derive(Debug)]
pub(crate) struct Source {
    /// Its path from the folder of the source on, with slashes.
    pub file: String,
    pub text: String,
    pub code: String,
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

/// The constants of the folders that are listed, in order of file and line.
pub(crate) fn constants(sources: &[Source]) -> Vec<Constant> {
    let listed = sources.iter().filter(|source| {
        let folder = source.file.split('/').next().unwrap_or_default();
        FOLDERS.contains(&folder)
    });
    let mut found: Vec<Constant> = listed.flat_map(of_file).collect();
    let mut known = 0;
    // What a structural constant is made of is structural too.
    loop {
        for i in 0..found.len() {
            found[i].structural |= is_structural(&found[i], sources, &found);
        }
        let structural = found.iter().filter(|c| c.structural).count();
        if structural == known {
            return found;
        }
        known = structural;
    }
}

fn of_file(source: &Source) -> Vec<Constant> {
    let starts = places(&source.code, "const");
    starts
        .into_iter()
        .filter_map(|at| constant(source, at))
        .collect()
}

/// The constant whose `const` stands at a place; none where it is none, or not made of numbers.
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
    (is_made_of_numbers(of)).then(|| Constant {
        file: file.clone(),
        line: text[..at].matches('\n').count() + 1,
        name: name.to_owned(),
        of: of.to_owned(),
        value: text[equals + 1..end]
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" "),
        about: about(&text[..at]),
        structural: false,
        item: at..end + 1,
        expression: equals + 1..end,
    })
}

fn is_made_of_numbers(of: &str) -> bool {
    let words = of
        .split(|c: char| !is_of_name(c as u8))
        .filter(|w| !w.is_empty());
    let number = |w: &str| {
        matches!(w, "f32" | "f64" | "usize" | "u32" | "u64" | "i32") || w.parse::<u32>().is_ok()
    };
    let brackets = of
        .chars()
        .all(|c| is_of_name(c as u8) || " ()[];,".contains(c));
    brackets && words.into_iter().all(number)
}

/// The first sentence of the comment that ends a text; that of the constant before where this one has none of its own.
fn about(text: &str) -> String {
    let lines = text.lines().rev().skip(usize::from(!text.ends_with('\n')));
    let lines =
        lines.skip_while(|l| l.trim_start().starts_with("const ") || l.contains(") const "));
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

fn is_structural(constant: &Constant, sources: &[Source], all: &[Constant]) -> bool {
    sources.iter().any(|source| {
        uses(constant, source).into_iter().any(|at| {
            let own = source.file == constant.file && constant.item.contains(&at);
            !own && (is_compiled(&source.code, at) || is_in_structural(source, at, all))
        })
    })
}

/// Where a constant is used in a file: by its name in its own file or where it is imported, elsewhere by a path.
pub(crate) fn uses(constant: &Constant, source: &Source) -> Vec<usize> {
    let own = source.file == constant.file;
    let module = module(&constant.file);
    let imports = imports(&source.code);
    let import = |at: usize| imports.iter().find(|range| range.contains(&at));
    let at = places(&source.code, &constant.name);
    let is_parent = constant.file == parent(&source.file);
    let imported = at.iter().any(|&at| {
        import(at).is_some_and(|range| {
            let path = &source.code[range.start..at];
            path.contains(&format!("{module}::")) || (is_parent && path.contains("super::"))
        })
    });
    let used = at.into_iter().filter(|&at| import(at).is_none());
    used.filter(|&at| match path_before(&source.code, at) {
        Some(before) => before == module || (own && before == "Self"),
        None => own || imported,
    })
    .collect()
}

/// The name of the module of a file.
fn module(file: &str) -> &str {
    let stem = file
        .strip_suffix("/mod.rs")
        .or_else(|| file.strip_suffix(".rs"))
        .unwrap_or(file);
    stem.rsplit('/').next().unwrap_or(stem)
}

/// The file of the module above that of a file.
fn parent(file: &str) -> String {
    let inside = file.strip_suffix("/mod.rs").unwrap_or(file);
    let folder = inside.rsplit_once('/').map_or("", |(folder, _)| folder);
    format!("{folder}/mod.rs")
}

/// Where the path begins whose last name stands at a place.
pub(crate) fn path_start(code: &str, at: usize) -> usize {
    match path_before(code, at) {
        Some(before) => path_start(code, at - "::".len() - before.len()),
        None => at,
    }
}

/// The last name before `::` before a place.
fn path_before(code: &str, at: usize) -> Option<&str> {
    let path = code[..at].strip_suffix("::")?;
    let from = path
        .rfind(|c: char| !is_of_name(c as u8))
        .map_or(0, |i| i + 1);
    Some(&path[from..])
}

/// From `use` to the semicolon.
fn imports(code: &str) -> Vec<Range<usize>> {
    let starts = places(code, "use").into_iter();
    starts
        .filter_map(|at| Some(at..at + code[at..].find(';')?))
        .collect()
}

/// Whether the compiler has to know what stands at a place: the length of an array, or a parameter of a type.
fn is_compiled(code: &str, at: usize) -> bool {
    let before = code[..at].trim_end();
    if before.ends_with("::<") {
        return true;
    }
    let Some(open) = enclosing(code, at) else {
        return false;
    };
    let outside = code[..open].trim_end();
    match code.as_bytes()[open] {
        b'[' => code[open..at].contains(';') && !outside.ends_with('!'),
        b'{' => outside.ends_with('<'),
        b'(' => is_compiled(code, open),
        _ => false,
    }
}

/// The bracket that encloses a place.
fn enclosing(code: &str, at: usize) -> Option<usize> {
    let mut depth = 0_i32;
    for (i, byte) in code.as_bytes()[..at].iter().enumerate().rev() {
        match byte {
            b'}' | b')' | b']' => depth += 1,
            b'{' | b'(' | b'[' if depth == 0 => return Some(i),
            b'{' | b'(' | b'[' => depth -= 1,
            _ => {}
        }
    }
    None
}

fn is_in_structural(source: &Source, at: usize, all: &[Constant]) -> bool {
    all.iter()
        .any(|c| c.structural && c.file == source.file && c.item.contains(&at))
}
