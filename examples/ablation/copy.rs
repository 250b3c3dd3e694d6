//! A copy of the package in which every listed constant can be changed from outside.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use super::constants::{Constant, Source};
use super::mask::places;
use super::uses::{path_before, uses};

/// What the copy asks for its constants.
const TUNED: &str = include_str!("tuned.rs");

/// Makes the copy, and leaves untouched what is already as it should be, so that it is compiled anew only where needed.
pub(crate) fn make(
    root: &Path,
    to: &Path,
    sources: &[Source],
    constants: &[Constant],
) -> io::Result<()> {
    let mut kept = BTreeSet::new();
    for path in files(root)? {
        let inside = path.strip_prefix(root).unwrap_or(&path);
        let source = inside.strip_prefix("src").ok().and_then(|inside| {
            let file = inside.iter().map(|part| part.to_string_lossy());
            let file = file.collect::<Vec<_>>().join("/");
            sources.iter().find(|source| source.file == file)
        });
        let bytes = match source {
            Some(source) => rewritten(source, sources, constants).into_bytes(),
            None => fs::read(&path)?,
        };
        put(&to.join(inside), &bytes)?;
        kept.insert(to.join(inside));
    }
    let tuned = to.join("src/ablation.rs");
    put(&tuned, TUNED.as_bytes())?;
    kept.insert(tuned);
    for path in files(to)? {
        if !kept.contains(&path) {
            fs::remove_file(path)?;
        }
    }
    Ok(())
}

/// Files of a package, but for what is built and what is hidden.
fn files(root: &Path) -> io::Result<Vec<PathBuf>> {
    let mut found = Vec::new();
    let mut folders = vec![root.to_path_buf()];
    while let Some(folder) = folders.pop() {
        if !folder.is_dir() {
            continue;
        }
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if name.starts_with('.') || name == "target" {
                continue;
            }
            if path.is_dir() {
                folders.push(path);
            } else {
                found.push(path);
            }
        }
    }
    Ok(found)
}

fn put(path: &Path, bytes: &[u8]) -> io::Result<()> {
    if fs::read(path).is_ok_and(|old| old == bytes) {
        return Ok(());
    }
    fs::create_dir_all(path.parent().unwrap_or(path))?;
    fs::write(path, bytes)
}

/// A source whose constants are functions that ask for their value.
fn rewritten(source: &Source, sources: &[Source], constants: &[Constant]) -> String {
    let mut edits = edits(source, sources, constants);
    edits.sort();
    let mut text = String::new();
    let mut done = 0;
    for (from, to, _, new) in edits {
        text += &source.text[done..from];
        text += &new;
        done = to;
    }
    text += &source.text[done..];
    // Messages name constants too, and are not code.
    for constant in constants.iter().filter(|c| c.file == source.file) {
        if let [number] = constant.numbers.as_slice() {
            text = text.replace(&format!("{{{}}}", constant.name), &number.value);
        }
    }
    if source.file == "lib.rs" {
        // What a linter says of the copy interests nobody.
        text = format!("#![allow(warnings)]\n{text}\nmod ablation;\n");
    }
    text
}

/// From, to and what comes in its place, in bytes of a source. Of those at one place the one of the lower rank comes first.
type Edit = (usize, usize, Rank, String);

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    First,
    Second,
}

fn edits(source: &Source, sources: &[Source], constants: &[Constant]) -> Vec<Edit> {
    let mut edits = Vec::new();
    for constant in constants.iter().filter(|c| !c.structural) {
        if source.file == constant.file {
            add_declaration(constant, &mut edits);
        }
        for at in uses(constant, source, sources) {
            let (start, end) = (path_start(&source.code, at), at + constant.name.len());
            edits.push((start, start, Rank::Second, "(*".to_owned()));
            edits.push((end, end, Rank::First, "())".to_owned()));
        }
    }
    if !edits.is_empty() {
        // What asks for a value is not constant.
        let constants = places(&source.code, "const").into_iter();
        let of_functions = constants.filter(|&at| source.code[at..].starts_with("const fn "));
        edits.extend(of_functions.map(|at| (at, at + "const ".len(), Rank::First, String::new())));
    }
    edits
}

fn add_declaration(constant: &Constant, edits: &mut Vec<Edit>) {
    let Constant {
        name,
        of,
        item,
        expression,
        ..
    } = constant;
    let lazy = "std::sync::LazyLock";
    let before =
        format!("fn {name}() -> &'static {of} {{ static VALUE: {lazy}<{of}> = {lazy}::new(|| ");
    edits.push((item.start, expression.start, Rank::First, before));
    for number in constant.numbers.iter().filter(|_| constant.is_listed()) {
        let key = format!("{}::{}", constant.file, number.name);
        let (start, end) = (number.place.start, number.place.end);
        let ask = format!("crate::ablation::tuned(\"{key}\", ");
        edits.push((start, start, Rank::First, ask));
        edits.push((end, end, Rank::Second, ")".to_owned()));
    }
    let after = "); &VALUE }".to_owned();
    edits.push((expression.end, item.end, Rank::First, after));
}

/// Where the path begins whose last name stands at a place.
fn path_start(code: &str, at: usize) -> usize {
    match path_before(code, at) {
        Some(before) => path_start(code, at - "::".len() - before.len()),
        None => at,
    }
}
