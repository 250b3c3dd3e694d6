//! `--plot` as a user meets it: which files are there afterwards, and what is said where none can be.

use std::fs;
use std::path::PathBuf;

use crate::common::{empty_folder, names, run_in};

/// An empty folder of its own for each test, with the recording of a preset.
fn folder(name: &str, preset: &str) -> PathBuf {
    let folder = empty_folder("pictures", name);
    let made = run_in(&folder, &["synth", "--preset", preset, "-o", "in.wav"]);
    assert!(made.status.success());
    fs::remove_file(folder.join("in.truth.json")).unwrap();
    folder
}

#[test]
fn a_drop_is_one_sheet_and_the_output_stays_what_it_is() {
    let folder = folder("plot-one", "steel");
    let plain = run_in(&folder, &["analyze", "in.wav"]);
    for (name, start) in [("a.svg", &b"<svg "[..]), ("b.PNG", b"\x89PNG")] {
        let plotted = run_in(&folder, &["analyze", "in.wav", "--plot", name]);
        assert_eq!(plotted.status.code(), Some(0));
        assert_eq!(plotted.stdout, plain.stdout);
        assert!(fs::read(folder.join(name)).unwrap().starts_with(start));
    }
    assert_eq!(names(&folder), ["a.svg", "b.PNG", "in.wav"]);
    let svg = fs::read_to_string(folder.join("a.svg")).unwrap();
    assert!(svg.contains("in.wav") && svg.contains("Impact 1: ") && svg.contains("less the model"));
}

#[test]
fn several_drops_are_several_sheets() {
    let folder = folder("plot-several", "three-drops");
    let plotted = run_in(&folder, &["analyze", "in.wav", "--plot", "my.sheet.svg"]);
    assert_eq!(plotted.status.code(), Some(0));
    assert_eq!(
        names(&folder),
        [
            "in.wav",
            "my.sheet-1.svg",
            "my.sheet-2.svg",
            "my.sheet-3.svg"
        ]
    );
    let third = fs::read_to_string(folder.join("my.sheet-3.svg")).unwrap();
    assert!(third.contains("in.wav, drop 3 of 3"));
}

#[test]
fn without_a_drop_there_is_a_sheet_that_shows_it() {
    let folder = folder("plot-none", "metronome");
    let plotted = run_in(&folder, &["analyze", "in.wav", "--plot", "no.svg"]);
    assert_eq!(plotted.status.code(), Some(1));
    let svg = fs::read_to_string(folder.join("no.svg")).unwrap();
    assert!(svg.contains("in.wav") && svg.contains("no drop found") && svg.contains("rejected"));
}

#[test]
fn what_cannot_be_drawn_is_one_line_and_leaves_no_file() {
    let folder = folder("plot-errors", "steel");
    for (arguments, part) in [
        (["analyze", "in.wav", "--plot", "a.jpg"], ".svg or .png"),
        (["analyze", "in.wav", "--plot", "svg"], ".svg or .png"),
        (["analyze", "-", "--plot", "a.svg"], "a second time"),
        (["analyze", "/dev/null", "--plot", "a.svg"], "a second time"),
        (["analyze", "gone.wav", "--plot", "a.svg"], "gone.wav"),
        (["analyze", "in.wav", "--plot", "no/a.svg"], "no/a.svg"),
    ] {
        let failed = run_in(&folder, &arguments);
        let said = String::from_utf8(failed.stderr).unwrap();
        assert_eq!(failed.status.code(), Some(2), "{arguments:?}");
        assert_eq!(said.lines().count(), 1, "{said}");
        assert!(said.contains(part) && failed.stdout.is_empty(), "{said}");
    }
    assert_eq!(names(&folder), ["in.wav"]);
}

#[test]
fn solve_draws_its_drop_among_the_curves() {
    let folder = folder("plot-solve", "steel");
    let whole = [
        "--bounces",
        "70",
        "--total-time",
        "7.5s",
        "--height",
        "30.5cm",
    ];
    let drawn = run_in(
        &folder,
        &[&["solve"], &whole[..], &["--plot", "s.svg"]].concat(),
    );
    assert_eq!(drawn.status.code(), Some(0));
    let svg = fs::read_to_string(folder.join("s.svg")).unwrap();
    for part in ["n = 70, 7.5 s", "e = 0.9335", "e = 0.95", "h₀ = 30.5 cm"] {
        assert!(svg.contains(part), "{part}");
    }
    // One bounce has no place in it.
    let one = ["solve", "--restitution", "0.9", "--contact-time", "1ms"];
    let refused = run_in(&folder, &[&one[..], &["--plot", "t.svg"]].concat());
    assert_eq!(refused.status.code(), Some(2));
    assert_eq!(names(&folder), ["in.wav", "s.svg"]);
}
