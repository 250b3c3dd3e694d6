//! Where a constant is used.

use std::ops::Range;

use super::constants::{Constant, Source};
use super::mask::{is_of_name, places};

/// Where a constant is used in a file: by its name in its own file or where it is imported, elsewhere by a path.
pub(crate) fn uses(constant: &Constant, source: &Source, sources: &[Source]) -> Vec<usize> {
    let at = places(&source.code, &constant.name);
    if at.is_empty() {
        return at;
    }
    let own = source.file == constant.file;
    let modules = modules(constant, sources);
    let imports = imports(&source.code);
    let import = |at: usize| imports.iter().find(|range| range.contains(&at));
    let is_parent = constant.file == parent(&source.file);
    let imported = at.iter().any(|&at| {
        import(at).is_some_and(|range| {
            let path = &source.code[range.start..at];
            let through = modules.iter().any(|m| path.contains(&format!("{m}::")));
            through || (is_parent && path.contains("super::"))
        })
    });
    let used = at.into_iter().filter(|&at| import(at).is_none());
    let declared = constant.item.start..constant.expression.start;
    used.filter(|at| !(own && declared.contains(at)))
        .filter(|&at| match path_before(&source.code, at) {
            Some("Self") => own,
            Some("super") => is_parent,
            Some(before) => modules.contains(&before),
            None => own || imported,
        })
        .collect()
}

/// The names of the module of a constant, and of those above it that pass the constant on.
fn modules<'a>(constant: &'a Constant, sources: &[Source]) -> Vec<&'a str> {
    let own = module(&constant.file);
    let mut modules = vec![own];
    let mut folder = constant.file.as_str();
    while let Some((above, _)) = folder.rsplit_once('/') {
        folder = above;
        let file = format!("{folder}/mod.rs");
        let passes_on = sources.iter().filter(|s| s.file == file).any(|source| {
            let imports = imports(&source.code);
            let mut at = places(&source.code, &constant.name).into_iter();
            at.any(|at| imports.iter().any(|range| range.contains(&at)))
        });
        if passes_on {
            modules.push(folder.rsplit('/').next().unwrap_or(folder));
        }
    }
    modules
}

/// The name of the module of a file.
fn module(file: &str) -> &str {
    let inside = file.strip_suffix("/mod.rs");
    let stem = inside.or_else(|| file.strip_suffix(".rs")).unwrap_or(file);
    stem.rsplit('/').next().unwrap_or(stem)
}

/// The file of the module above that of a file.
fn parent(file: &str) -> String {
    let inside = file.strip_suffix("/mod.rs").unwrap_or(file);
    let folder = inside.rsplit_once('/').map_or("", |(folder, _)| folder);
    format!("{folder}/mod.rs")
}

/// The last name before `::` before a place.
pub(crate) fn path_before(code: &str, at: usize) -> Option<&str> {
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
pub(crate) fn is_compiled(code: &str, at: usize) -> bool {
    if code[..at].trim_end().ends_with("::<") {
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
