//! What a person meets first: help with examples, completions, quiet and verbose, no colours in a pipe.

use std::fs;
use std::path::Path;

use crate::common::{empty_folder, run};

fn said(arguments: &[&str]) -> String {
    String::from_utf8(run(arguments).stdout).unwrap()
}

/// A recording of a preset in a folder of its own.
fn recording(name: &str, preset: &str) -> String {
    let folder = empty_folder("first-minute", name);
    let path = folder.join("drop.wav").display().to_string();
    assert!(
        run(&["synth", "--preset", preset, "-o", &path])
            .status
            .success()
    );
    path
}

#[test]
fn every_command_has_examples_in_its_help() {
    let all = said(&["--help"]);
    assert!(all.contains("Examples:\n") && all.contains("bounce-audio analyze drop.wav"));
    let commands = all.lines().skip_while(|l| *l != "Commands:").skip(1);
    let commands: Vec<&str> = commands
        .map_while(|l| l.strip_prefix("  ")?.split_whitespace().next())
        .filter(|c| *c != "help")
        .collect();
    assert!(commands.contains(&"analyze") && commands.contains(&"completions"));
    for command in commands {
        let help = said(&[command, "--help"]);
        let examples = help.split("Example").nth(1).unwrap_or_default();
        assert!(
            examples.contains(&format!("bounce-audio {command} ")),
            "{help}"
        );
    }
}

#[test]
fn help_names_the_rules_and_where_they_stand() {
    let help = said(&["analyze", "--help"]);
    // Lines end where the page does.
    let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
    for words in [
        "ittf-ball:",
        "240 to 265 mm from 305 mm",
        "ITF Rules of Tennis, Appendix I",
    ] {
        assert!(help.contains(words), "{words}");
    }
}

#[test]
fn shells_get_their_completions() {
    for (shell, words) in [
        ("bash", "complete -F"),
        ("zsh", "#compdef bounce-audio"),
        ("fish", "complete -c bounce-audio"),
        ("powershell", "Register-ArgumentCompleter"),
    ] {
        let script = said(&["completions", shell]);
        assert!(
            script.contains(words) && script.contains("contact-time"),
            "{shell}"
        );
    }
    assert_eq!(run(&["completions", "sh"]).status.code(), Some(2));
}

#[test]
fn the_answer_comes_first_and_the_table_is_for_who_asks() {
    let file = recording("detail", "pingpong");
    let (quiet, usual, verbose, table) = (
        said(&["analyze", &file, "-q", "--height", "30.5cm"]),
        said(&["analyze", &file, "--height", "30.5cm"]),
        said(&["analyze", &file, "-v", "--height", "30.5cm"]),
        said(&["analyze", &file, "--table", "--height", "30.5cm"]),
    );
    assert_eq!(verbose, table);
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    for line in lines(&usual) {
        assert!(lines(&verbose).contains(&line), "{line}");
    }
    for (words, in_usual) in [
        (": e = 0.9", true),
        ("  odds     over a billion to 1", true),
        ("m/s", true),
        ("s from release to rest", true),
        ("\nWarning: ", true),
        ("flight ratios", false),
        ("[ms]", false),
        ("Rejected between the impacts", false),
        ("Models compared", false),
    ] {
        assert_eq!(usual.contains(words), in_usual, "{words} in {usual}");
        assert!(verbose.contains(words), "{words} in {verbose}");
    }
    let of_answer = lines(&usual).iter().take_while(|l| !l.is_empty()).count();
    assert!(of_answer <= 11, "{usual}");
    // A shell reads e, its error, bounces, seconds, warnings and the file, whatever its name.
    assert_eq!(lines(&quiet).len(), 1);
    let cells: Vec<&str> = quiet.trim_end().splitn(6, ' ').collect();
    let [e, error, bounces, seconds, warnings, named] = cells[..] else {
        panic!("{quiet}");
    };
    assert!((e.parse::<f64>().unwrap() - 0.93).abs() < 0.002, "{quiet}");
    assert!(error.parse::<f64>().unwrap() < 0.002, "{quiet}");
    assert!(bounces.parse::<u32>().unwrap() > 60 && seconds.parse::<f64>().unwrap() > 5.0);
    assert_eq!((warnings, named), ("air_drag", file.as_str()));
    assert_eq!(run(&["analyze", &file, "-q", "-v"]).status.code(), Some(2));
}

#[test]
fn the_command_that_was_meant_is_offered() {
    let file = recording("meant", "dead");
    for (arguments, offered) in [
        (&[file.as_str()][..], "bounce-audio analyze "),
        (&[&file, &file], "bounce-audio batch "),
        (&["analyze", &file, &file], "bounce-audio batch "),
        (&["analyze", "src"], "bounce-audio batch src"),
    ] {
        let output = run(arguments);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
        assert!(
            said.contains(offered) && said.lines().count() == 1,
            "{said}"
        );
    }
}

#[test]
fn the_version_tells_what_is_built_in() {
    let version = said(&["--version"]);
    assert!(version.starts_with(concat!("bounce-audio ", env!("CARGO_PKG_VERSION"), "\n")));
    assert!(version.contains("FLAC") && version.contains("features  audio, opus, plots, lab, cli"));
    assert_eq!(said(&["-V"]).lines().count(), 1);
}

#[test]
fn help_is_no_wider_than_a_page() {
    for command in [
        "analyze",
        "batch",
        "solve",
        "synth",
        "evaluate",
        "completions",
    ] {
        for line in said(&[command, "--help"]).lines() {
            assert!(line.chars().count() <= 100, "{command}: {line}");
        }
    }
}

#[test]
fn where_nothing_was_found_the_text_says_what_to_try() {
    let output = run(&["analyze", &recording("nothing", "rapping")]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(
        text.contains("sharp sounds") && text.contains("--start"),
        "{text}"
    );
}

#[test]
fn a_pipe_gets_no_colours() {
    for arguments in [&["--help"][..], &["analyze"], &["analyze", "no.wav"]] {
        let output = run(arguments);
        let bytes = [output.stdout, output.stderr].concat();
        assert!(!bytes.contains(&0x1b), "{arguments:?}");
    }
}

#[test]
fn a_rule_is_judged_in_text_and_json() {
    let file = recording("colours", "steel");
    let text = said(&["analyze", &file, "--rule", "ittf-ball"]);
    assert!(
        text.contains("  rule     ittf-ball: ") && text.contains("rebound predicted "),
        "{text}"
    );
    let of_rule = "\nMass and diameter are the rule's, for the drag in e too";
    assert!(text.contains(of_rule), "{text}");
    for more in [&["--mass", "2.7g", "--diameter", "40mm"][..], &["-q"]] {
        let text = said(&[&["analyze", &file, "--rule", "ittf-ball"], more].concat());
        assert!(!text.contains(of_rule), "{text}");
    }
    let json = said(&["analyze", &file, "--rule", "ittf-ball", "--format", "json"]);
    let json: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(json["settings"]["mass_kg"], 2.7e-3);
    let judged = &json["rule"]["drops"][0];
    let [low, high] = [0, 1].map(|i| judged["rebound_m"]["interval95"][i].as_f64().unwrap());
    let outcome = if low >= 0.240 && high <= 0.265 {
        "pass"
    } else if high < 0.240 || low > 0.265 {
        "fail"
    } else {
        "undecided"
    };
    assert_eq!(judged["outcome"], outcome);
    let none = said(&["analyze", &file, "--format", "json"]);
    let none: serde_json::Value = serde_json::from_str(&none).unwrap();
    assert!(none["rule"].is_null() && none.get("rule").is_some());
    let wrong = run(&["analyze", &file, "--rule", "cricket"]);
    assert!(
        wrong.status.code() == Some(2)
            && String::from_utf8(wrong.stderr)
                .unwrap()
                .contains("ittf-table")
    );
}

/// The names of all fields of a document.
fn names(value: &serde_json::Value, found: &mut Vec<String>) {
    if let Some(fields) = value.as_object() {
        for (name, value) in fields {
            found.push(name.clone());
            names(value, found);
        }
    }
    for value in value.as_array().into_iter().flatten() {
        names(value, found);
    }
}

#[test]
fn a_document_names_every_field_of_json() {
    let named = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/json.md");
    let named = fs::read_to_string(named).unwrap();
    let file = recording("fields", "pingpong");
    let json = said(&[
        "analyze",
        &file,
        "--height",
        "30.5cm",
        "--mass",
        "2.7g",
        "--rule",
        "ittf-ball",
        "--format",
        "json",
    ]);
    let mut found = Vec::new();
    names(&serde_json::from_str(&json).unwrap(), &mut found);
    assert!(found.len() > 100);
    for name in found {
        let told = [
            format!("`{name}`"),
            format!("[].{name}`"),
            format!("[].{name}[]`"),
        ];
        assert!(told.iter().any(|t| named.contains(t)), "{name}");
    }
}
