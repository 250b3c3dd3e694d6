//! Every crate that is built in has a licence that `docs/dependencies.md` allows, and comes from the registry. No network is
//! needed: `cargo tree` reads what was fetched to build this test.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

/// A crate as `cargo tree` names it.
struct Crate {
    name: String,
    version: String,
    /// What stands behind the version: where it comes from, if that is not the registry.
    source: String,
    licence: String,
}

/// All crates of this platform, those that are used while compiling too, without this one.
fn crates() -> Vec<Crate> {
    let output = Command::new(env!("CARGO"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["tree", "--offline", "--locked", "--edges", "normal,build"])
        .args(["--prefix", "none", "--no-dedupe", "--format", "{p}|{l}"])
        .output()
        .unwrap();
    let error = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{error}");
    let text = String::from_utf8(output.stdout).unwrap();
    let mut lines: Vec<&str> = text.lines().collect();
    lines.sort_unstable();
    lines.dedup();
    let of_line = |line: &str| {
        let (package, licence) = line.split_once('|').unwrap();
        let mut words = package.splitn(3, ' ').map(str::to_owned);
        Crate {
            name: words.next().unwrap(),
            version: words.next().unwrap(),
            source: words.next().unwrap_or_default(),
            licence: licence.to_owned(),
        }
    };
    let all = lines.into_iter().map(of_line);
    all.filter(|c| c.name != env!("CARGO_PKG_NAME")).collect()
}

fn document() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/dependencies.md");
    fs::read_to_string(path).unwrap()
}

/// The licences that the document allows, and the crates that each is allowed to; `all` is every crate.
fn allowed() -> BTreeMap<String, Vec<String>> {
    let document = document();
    let table = document.split("| licence | allowed to |").nth(1).unwrap();
    let rows = table.lines().skip(2).take_while(|l| l.starts_with('|'));
    let row = |line: &str| {
        let mut cells = line.trim_matches('|').split('|').map(str::trim);
        let licence = cells.next().unwrap().to_owned();
        let to = cells.next().unwrap().split(", ");
        let to = to.map(|name| name.trim_matches('`').to_owned());
        (licence, to.collect())
    };
    rows.map(row).collect()
}

/// Whether one may use a crate: of alternatives any, of what stands together all.
fn may_use(name: &str, licence: &str, allowed: &BTreeMap<String, Vec<String>>) -> bool {
    let is_allowed = |one: &str| {
        let one = one.trim_matches(|c: char| c == '(' || c == ')' || c == ' ');
        let to = allowed.get(one);
        to.is_some_and(|to| to.iter().any(|to| to == "all" || to == name))
    };
    let together = licence.split(" AND ");
    let mut met = together.map(|part| {
        part.split(" OR ")
            .flat_map(|p| p.split('/'))
            .any(is_allowed)
    });
    !licence.is_empty() && met.all(|met| met)
}

#[test]
fn alternatives_and_conditions_are_told_apart() {
    let all = vec!["all".to_owned()];
    let allowed = BTreeMap::from([
        ("MIT".to_owned(), all),
        ("Unicode-3.0".to_owned(), vec!["tables".to_owned()]),
    ]);
    for (name, licence, may) in [
        ("a", "MIT", true),
        ("a", "GPL-3.0 OR MIT", true),
        ("a", "Unlicense/MIT", true),
        ("a", "GPL-3.0", false),
        ("a", "", false),
        ("a", "MIT AND GPL-3.0", false),
        ("tables", "(MIT OR Apache-2.0) AND Unicode-3.0", true),
        ("a", "(MIT OR Apache-2.0) AND Unicode-3.0", false),
    ] {
        assert_eq!(may_use(name, licence, &allowed), may, "{name}: {licence}");
    }
}

#[test]
fn every_crate_may_be_used_and_comes_from_the_registry() {
    let (crates, allowed) = (crates(), allowed());
    assert!(crates.len() > 20 && allowed.contains_key("MIT"));
    for Crate {
        name,
        version,
        source,
        licence,
    } in &crates
    {
        assert!(
            may_use(name, licence, &allowed),
            "{name} {version} is under '{licence}', which docs/dependencies.md does not allow"
        );
        assert!(
            source.is_empty() || source == "(proc-macro)",
            "{name} {version} comes from {source}"
        );
    }
    // What is allowed to some crates is used by them, or the line is out of date.
    let named = allowed.values().flatten().filter(|name| *name != "all");
    for name in named {
        assert!(crates.iter().any(|c| c.name == *name), "{name} is not used");
    }
}

#[test]
fn what_is_named_in_the_manifest_is_built_once() {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.toml");
    let manifest: toml::Table = fs::read_to_string(manifest).unwrap().parse().unwrap();
    let crates = crates();
    for name in manifest["dependencies"].as_table().unwrap().keys() {
        let versions: Vec<&str> = crates
            .iter()
            .filter(|c| c.name == *name)
            .map(|c| c.version.as_str())
            .collect();
        assert_eq!(versions.len(), 1, "{name}: {versions:?}");
    }
}

/// Other systems need a few more or less.
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
#[test]
fn the_document_counts_the_crates() {
    let count = crates().len();
    assert!(
        document().contains(&format!("they are {count} crates on Linux")),
        "they are {count}"
    );
}
