//! Labels written, edited as a person would, and read back: the fit uses exactly what stands in the file.

use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use crate::common::{empty_folder, json, run, text};

/// A recording of a preset in a folder of its own.
fn recording(folder: &str, preset: &str) -> (PathBuf, String) {
    let folder = empty_folder("labels", folder);
    let path = folder.join("drop.wav").display().to_string();
    let made = run(&["synth", "--preset", preset, "-o", &path]);
    assert!(made.status.success(), "{}", text(&made.stderr));
    (folder, path)
}

/// A label file for a recording, as written and with its lines.
fn written(folder: &Path, wav: &str, name: &str) -> (String, String) {
    let path = folder.join(name).display().to_string();
    let output = run(&["analyze", wav, "--labels", &path]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let content = fs::read_to_string(&path).unwrap();
    (path, content)
}

/// What the fit makes of the times; that it rests on labels is not part of it.
fn fitted(document: &Value) -> Vec<Value> {
    let drops = document["drops"].as_array().unwrap();
    let fields = [
        "impacts",
        "restitution",
        "estimates",
        "scatter",
        "model",
        "ball",
        "budget",
    ];
    drops
        .iter()
        .map(|drop| fields.iter().map(|f| drop[f].clone()).collect())
        .collect()
}

#[test]
fn labels_read_back_give_the_same_answer_to_the_last_digit() {
    for (preset, height) in [("pingpong", "30.5cm"), ("three-drops", "20cm")] {
        let (folder, wav) = recording(&format!("same-{preset}"), preset);
        let before = json(&["analyze", &wav, "--height", height]);
        for name in ["drop.txt", "drop.csv", "drop.TextGrid"] {
            let (labels, _) = written(&folder, &wav, name);
            let after = json(&["analyze", &wav, "--height", height, "--impacts", &labels]);
            assert_eq!(fitted(&before), fitted(&after), "{preset} {name}");
            let note = &after["drops"][0]["warnings"];
            let note = note
                .as_array()
                .unwrap()
                .iter()
                .find(|w| w["code"] == "impacts_given");
            assert!(
                note.unwrap()["message"]
                    .as_str()
                    .unwrap()
                    .contains(": 0 of ")
            );
        }
    }
}

#[test]
fn times_rounded_by_audacity_are_no_edit() {
    let (folder, wav) = recording("rounded", "steel");
    let (labels, content) = written(&folder, &wav, "drop.txt");
    let rounded: String = content
        .lines()
        .map(|line| {
            let fields: Vec<&str> = line.split('\t').collect();
            let time: f64 = fields[0].parse().unwrap();
            format!("{time:.6}\t{time:.6}\t{}\n", fields[2])
        })
        .collect();
    assert_ne!(rounded, content);
    fs::write(&labels, rounded).unwrap();
    let after = json(&["analyze", &wav, "--impacts", &labels]);
    assert_eq!(fitted(&json(&["analyze", &wav])), fitted(&after));
}

#[test]
fn edited_labels_change_the_answer() {
    let (folder, wav) = recording("edited", "steel");
    let (labels, content) = written(&folder, &wav, "drop.txt");
    let before = json(&["analyze", &wav])["drops"][0].clone();
    let mut lines: Vec<String> = content.lines().map(str::to_owned).collect();
    // The last impact removed, the third moved by 2 ms.
    lines.pop();
    let fields: Vec<String> = lines[2].split('\t').map(str::to_owned).collect();
    let moved = fields[0].parse::<f64>().unwrap() + 2e-3;
    lines[2] = format!("{moved}\t{moved}\t{}", fields[2]);
    fs::write(&labels, lines.join("\n")).unwrap();
    let after = json(&[
        "analyze",
        &wav,
        "--impacts",
        &labels,
        "--label-error",
        "0.5ms",
    ])["drops"][0]
        .clone();
    let count = before["impacts"].as_array().unwrap().len();
    assert_eq!(after["impacts"].as_array().unwrap().len(), count - 1);
    assert_eq!(after["impacts"][2]["time_s"], moved);
    assert_eq!(after["impacts"][2]["time_std_s"], 0.5e-3);
    assert_eq!(
        after["impacts"][1]["time_std_s"],
        before["impacts"][1]["time_std_s"]
    );
    assert_ne!(
        after["restitution"]["value"],
        before["restitution"]["value"]
    );
}

#[test]
fn labels_set_by_hand_alone_are_enough() {
    let (folder, wav) = recording("by-hand", "steel");
    let labels = folder.join("hand.txt");
    // A ball of e = 0.8 whatever the recording holds.
    let times = [0.5, 1.0, 1.4, 1.72, 1.976, 2.1808];
    let lines: String = times.iter().map(|t| format!("{t}\t{t}\t\n")).collect();
    fs::write(&labels, lines).unwrap();
    let labels = labels.display().to_string();
    let drop =
        json(&["analyze", &wav, "--impacts", &labels, "--model", "constant"])["drops"][0].clone();
    let e = drop["restitution"]["value"].as_f64().unwrap();
    assert!((e - 0.8).abs() < 1e-3, "{e}");
    assert_eq!(drop["impacts"][0]["time_std_s"], 1e-3);
    assert!(drop["evidence_nats"].is_null());
}

#[test]
fn what_cannot_be_used_is_said_in_one_line() {
    let (folder, wav) = recording("wrong", "steel");
    let file = |name: &str, content: &str| {
        let path = folder.join(name);
        fs::write(&path, content).unwrap();
        path.display().to_string()
    };
    let cases = [
        (
            file("word.txt", "1\t1\ta\none\t1\tb\n"),
            "word.txt: line 2: 'one' is no time",
        ),
        (
            file("late.txt", "1\t1\ta\n1.5\t1.5\tb\n99\t99\tc\n"),
            "line 3: 99 s is after the recording ends",
        ),
        (
            file("few.txt", "1\t1\ta\n2\t2\tinferred\n"),
            "line 1: the drop that begins here has 1 impact heard, a flight needs 2",
        ),
        (file("empty.txt", "\n"), "there are no labels"),
        (
            file("what.json", "{}"),
            "expected a name that ends in .txt (Audacity)",
        ),
        (folder.join("gone.txt").display().to_string(), "gone.txt: "),
    ];
    for (labels, words) in cases {
        let output = run(&["analyze", &wav, "--impacts", &labels]);
        assert_eq!(output.status.code(), Some(2), "{labels}");
        let said = text(&output.stderr);
        assert!(said.contains(words) && said.lines().count() == 1, "{said}");
    }
    let output = run(&["analyze", &wav, "--labels", "drop.xyz"]);
    assert_eq!(output.status.code(), Some(2));
    let nowhere = folder
        .join("no-folder")
        .join("drop.txt")
        .display()
        .to_string();
    let output = run(&["analyze", &wav, "--labels", &nowhere]);
    assert!(text(&output.stderr).contains("no-folder") && output.status.code() == Some(2));
}

#[test]
fn a_label_file_is_replaced_whole_and_nothing_stays_beside_it() {
    let (folder, wav) = recording("whole", "steel");
    let (_, first) = written(&folder, &wav, "drop.txt");
    let (_, second) = written(&folder, &wav, "drop.txt");
    assert_eq!(first, second);
    let names: Vec<_> = fs::read_dir(&folder)
        .unwrap()
        .map(|e| e.unwrap().file_name())
        .collect();
    assert!(
        names
            .iter()
            .all(|n| !n.to_string_lossy().contains("partial")),
        "{names:?}"
    );
}
