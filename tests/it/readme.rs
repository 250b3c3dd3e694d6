//! The README and what it leads to: every link leads somewhere, every command runs as printed and says what is printed.

use std::fs;
use std::path::{Path, PathBuf};

use crate::common::{empty_folder, run_in, text};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn readme() -> String {
    fs::read_to_string(root().join("README.md")).unwrap()
}

/// The files and folders that `.ci/release` packs as they stand.
fn packed() -> Vec<PathBuf> {
    let script = fs::read_to_string(root().join(".ci/release")).unwrap();
    let (_, behind) = script.split_once("\npacked=(\n").unwrap();
    let (names, _) = behind.split_once("\n)\n").unwrap();
    names.split_whitespace().map(|n| root().join(n)).collect()
}

/// All documents that a reader of the archive may open.
fn documents() -> Vec<PathBuf> {
    let docs = fs::read_dir(root().join("docs")).unwrap();
    let docs = docs.map(|entry| entry.unwrap().path());
    let all = packed().into_iter().chain(docs);
    all.filter(|path| path.extension().is_some_and(|e| e == "md"))
        .collect()
}

/// What the links and pictures of a document lead to.
fn links(document: &str) -> Vec<&str> {
    let of = |before: &'static str, after: char| {
        let parts = document.split(before).skip(1);
        parts.filter_map(move |part| part.split(after).next())
    };
    let links = of("](", ')').chain(of("src=\"", '"'));
    // What leads to an item of the source is for rustdoc.
    links.filter(|link| !link.contains("::")).collect()
}

/// The blocks of a language.
fn blocks<'a>(document: &'a str, language: &str) -> Vec<&'a str> {
    let open = format!("```{language}\n");
    let behind = document.split(open.as_str()).skip(1);
    behind
        .map(|rest| rest.split("```").next().unwrap())
        .collect()
}

#[test]
fn every_link_leads_to_a_file_that_is_there_and_in_the_archive() {
    let mut checked = 0;
    let packed = packed().into_iter().map(|path| path.canonicalize());
    let packed: Vec<PathBuf> = packed.map(Result::unwrap).collect();
    for path in documents() {
        let document = fs::read_to_string(&path).unwrap();
        for link in links(&document) {
            if link.starts_with("https://") {
                continue;
            }
            let from = path.parent().unwrap();
            let target = match link.split('#').next().unwrap() {
                "" => path.clone(),
                target => from.join(target),
            };
            let there = target.canonicalize();
            let there = there.is_ok_and(|t| packed.iter().any(|p| t.starts_with(p)));
            assert!(there, "{}: {link}", path.display());
            checked += 1;
        }
    }
    assert!(checked > 30, "{checked} links only");
}

#[test]
fn every_document_can_be_reached_from_the_readme() {
    let mut reached = vec![root().join("README.md")];
    let mut next = 0;
    while let Some(path) = reached.get(next).cloned() {
        next += 1;
        let document = fs::read_to_string(&path).unwrap();
        for link in links(&document) {
            let target = path.parent().unwrap().join(link);
            let is_new = target.extension().is_some_and(|e| e == "md")
                && target.exists()
                && !reached
                    .iter()
                    .any(|r| r.canonicalize().unwrap() == target.canonicalize().unwrap());
            if is_new {
                reached.push(target);
            }
        }
    }
    for document in documents() {
        let found = reached
            .iter()
            .any(|r| r.canonicalize().unwrap() == document);
        assert!(found, "{} is linked from nowhere", document.display());
    }
}

#[test]
fn the_readme_is_short() {
    let lines = readme().lines().count();
    assert!((110..=150).contains(&lines), "{lines} lines");
}

/// A folder in which the commands of the README can be typed.
fn desk() -> PathBuf {
    let folder = empty_folder("readme", "desk");
    for name in ["examples", "recordings"] {
        fs::create_dir(folder.join(name)).unwrap();
        let recording = root().join("examples/drop.wav");
        fs::copy(recording, folder.join(name).join("drop.wav")).unwrap();
    }
    folder
}

#[test]
fn every_command_of_the_readme_runs_as_printed() {
    let (folder, document) = (desk(), readme());
    let lines = blocks(&document, "sh").into_iter().flat_map(str::lines);
    let (ours, others): (Vec<&str>, Vec<&str>) =
        lines.partition(|l| l.starts_with("bounce-audio "));
    assert_eq!(others, ["cargo install --path ."]);
    assert!(ours.len() >= 9, "{ours:?}");
    for line in ours {
        let arguments: Vec<&str> = line.split_whitespace().skip(1).collect();
        let output = run_in(&folder, &arguments);
        assert_eq!(
            output.status.code(),
            Some(0),
            "{line}: {}",
            text(&output.stderr)
        );
    }
    for made in ["drop.svg", "drops.csv", "labels.txt"] {
        assert!(folder.join(made).metadata().unwrap().len() > 500, "{made}");
    }
}

#[test]
fn the_answer_of_the_readme_is_what_is_printed() {
    let document = readme();
    let output = run_in(root(), &["analyze", "examples/drop.wav"]);
    let printed = text(&output.stdout);
    assert_eq!(blocks(&document, "text"), [printed.as_str()]);
    let console = blocks(&document, "console")[0];
    let first = printed.lines().next().unwrap();
    assert_eq!(
        console,
        format!("$ bounce-audio analyze examples/drop.wav\n{first}\n")
    );
}

#[test]
fn the_recording_of_the_readme_is_made_from_its_scene() {
    let folder = empty_folder("readme", "made");
    let scene = root().join("examples/drop.toml").display().to_string();
    let made = run_in(&folder, &["synth", &scene, "-o", "drop.wav"]);
    assert_eq!(made.status.code(), Some(0), "{}", text(&made.stderr));
    let kept = fs::read(root().join("examples/drop.wav")).unwrap();
    assert!(
        fs::read(folder.join("drop.wav")).unwrap() == kept,
        "other bytes"
    );
}
