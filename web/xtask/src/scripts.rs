//! Modules of the page to one script: each file's lines in the order in which they need each other.
//!
//! The page's modules use two forms only, which this takes away: `import { a, b } from "./c.js";` on one line, and `export`
//! before a declaration. One script has one scope, so that a name may be declared at the top of one module alone.

use std::error::Error;
use std::fs;
use std::path::Path;

/// The script of a module and all that it imports.
pub(crate) fn script(folder: &Path, module: &str) -> Result<String, Box<dyn Error>> {
    let mut done = Vec::new();
    let mut out = String::new();
    add(folder, module, &mut done, &mut out)?;
    Ok(format!("(() => {{\n\"use strict\";\n{out}}})();\n"))
}

fn add(
    folder: &Path,
    module: &str,
    done: &mut Vec<String>,
    out: &mut String,
) -> Result<(), Box<dyn Error>> {
    if done.iter().any(|name| name == module) {
        return Ok(());
    }
    done.push(module.to_owned());
    let path = folder.join(module);
    let text = fs::read_to_string(&path).map_err(|e| format!("{}: {e}", path.display()))?;
    for needed in text.lines().filter_map(imported) {
        add(folder, needed, done, out)?;
    }
    for line in text.lines().filter(|line| imported(line).is_none()) {
        if line.starts_with("import ") {
            return Err(format!("{module}: not an import of this form: {line}").into());
        }
        out.push_str(line.strip_prefix("export ").unwrap_or(line));
        out.push('\n');
    }
    Ok(())
}

/// The module that a line imports from.
fn imported(line: &str) -> Option<&str> {
    let (names, from) = line.strip_prefix("import { ")?.split_once(" } from \"./")?;
    names
        .split(", ")
        .all(|name| !name.contains(' '))
        .then_some(from)?
        .strip_suffix("\";")
}

#[cfg(test)]
mod tests {
    use super::imported;

    #[test]
    fn only_plain_imports_are_taken() {
        assert_eq!(imported("import { a, b } from \"./c.js\";"), Some("c.js"));
        assert_eq!(imported("import { a as b } from \"./c.js\";"), None);
        assert_eq!(imported("import * as c from \"./c.js\";"), None);
    }
}
