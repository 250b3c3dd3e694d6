//! Signals in the middle of the work: what is left is whole, or named `.partial`, and can be gone on with.

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use bounce_audio::audio;

use super::writing::{PROGRAM, content, folder, run, status};

/// Signals and how a person sends them.
const SIGNALS: [(&str, &str); 3] = [
    ("INT", "Ctrl-C (SIGINT)"),
    ("TERM", "`kill` (SIGTERM)"),
    ("KILL", "`kill -9` (SIGKILL)"),
];

pub(super) const INTRODUCTION: &str = "
## Interrupts

The program dies of the signal, as the system has it: a shell says 130 after Ctrl-C, 143 after `kill`.

| sent | to | status | in the folder |
|---|---|---|---|
";

pub(super) fn add_rows(table: &mut String) {
    for (signal, sent) in SIGNALS {
        for (what, interrupted) in [
            ("`synth --suite`", suite as fn(&str) -> [String; 2]),
            ("`batch -o`", batch),
            ("`batch --plots`", plots),
            ("`evaluate --plot`", evaluate),
        ] {
            let [status, left] = interrupted(signal);
            writeln!(table, "| {sent} | {what} | {status} | {left} |").unwrap();
        }
    }
}

/// Starts a command that can be interrupted even where this test runs in the background, and cannot.
fn start(folder: &Path, line: &str) -> Child {
    Command::new("env")
        .current_dir(folder)
        .args(["--default-signal=INT", PROGRAM])
        .args(line.split_whitespace())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

/// Sends a signal as soon as something is there; gives how it ended.
fn interrupt(mut child: Child, signal: &str, seen: impl Fn() -> bool) -> String {
    let begun = Instant::now();
    while !seen() {
        assert!(child.try_wait().unwrap().is_none(), "it ended before");
        assert!(begun.elapsed() < Duration::from_secs(60), "nothing comes");
        std::thread::sleep(Duration::from_millis(1));
    }
    let sent = Command::new("kill")
        .args(["-s", signal, &child.id().to_string()])
        .status();
    assert!(sent.unwrap().success());
    status(&child.wait_with_output().unwrap())
}

fn many_drops(name: &str) -> std::path::PathBuf {
    let folder = folder(name);
    for number in 0..40 {
        let copy = folder.join(format!("{number}.wav"));
        fs::copy(folder.join("drop.wav"), &copy).unwrap();
        fs::copy(
            folder.join("drop.truth.json"),
            copy.with_extension("truth.json"),
        )
        .unwrap();
    }
    folder
}

/// Every file is whole or named `.partial`.
fn judged(folder: &Path) -> String {
    for (name, bytes) in content(folder) {
        let whole = match name.rsplit('.').next().unwrap_or_default() {
            "partial" => true,
            "wav" => audio::read(&bytes[..]).is_ok_and(|r| r.warnings.is_empty()),
            "json" => {
                // A truth never stands beside another recording, or alone.
                let recording = name.replace(".truth.json", ".wav");
                serde_json::from_slice::<serde_json::Value>(&bytes).is_ok()
                    && folder.join(recording).exists()
            }
            "svg" => bytes.ends_with(b"</svg>\n"),
            _ => bytes.is_empty(),
        };
        if !whole {
            return format!("**{name} is broken**");
        }
    }
    "whole files, and `NAME.PID.partial`".to_owned()
}

fn suite(signal: &str) -> [String; 2] {
    let folder = folder("interrupted-suite");
    let suite = folder.join("suite");
    let child = start(&folder, "synth --suite suite --seeds 50");
    let status = interrupt(child, signal, || {
        fs::read_dir(&suite).is_ok_and(|files| files.count() > 4)
    });
    let judged = judged(&suite);
    // What an interruption left is in nobody's way.
    let again = run(&folder, "", "synth --suite suite --seeds 1");
    assert!(again.status.success(), "{again:?}");
    [status, judged + "; the same command makes all"]
}

fn batch(signal: &str) -> [String; 2] {
    let folder = many_drops("interrupted-batch");
    let whole = run(&folder, "", "batch . -o whole.csv");
    assert_eq!(whole.status.code(), Some(0));
    let partial = folder.join("out.csv.partial");
    let child = start(&folder, "batch . -o out.csv");
    let status = interrupt(child, signal, || {
        fs::read_to_string(&partial).is_ok_and(|rows| rows.lines().count() > 2)
    });
    assert!(!folder.join("out.csv").exists());
    assert!(partial.exists());
    let resumed = run(&folder, "", "batch . -o out.csv --resume");
    assert_eq!(resumed.status.code(), Some(0));
    let read = |name: &str| fs::read(folder.join(name)).unwrap();
    assert_eq!(read("out.csv"), read("whole.csv"));
    let left = "`OUT.partial`; `--resume` makes of it what an uninterrupted run gives";
    [status, left.to_owned()]
}

fn plots(signal: &str) -> [String; 2] {
    let folder = many_drops("interrupted-plots");
    let sheets = folder.join("sheets");
    let child = start(&folder, "batch . --plots sheets");
    let status = interrupt(child, signal, || {
        fs::read_dir(&sheets).is_ok_and(|files| files.count() > 2)
    });
    [status, judged(&sheets)]
}

fn evaluate(signal: &str) -> [String; 2] {
    let folder = many_drops("interrupted-evaluate");
    let before = content(&folder);
    let begun = Instant::now();
    let child = start(&folder, "evaluate . --plot out.svg --tighten out.toml");
    let status = interrupt(child, signal, || {
        begun.elapsed() > Duration::from_millis(50)
    });
    assert_eq!(content(&folder), before);
    [status, "as before: it writes at the end".to_owned()]
}
