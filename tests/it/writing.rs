//! Results are whole, or what was there before stays: the rest of what `faults` tries one by one.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::common::{PROGRAM, WRITERS, empty_folder, names};

/// A folder of its own for each test, with a recording `drop.wav` in it and the thresholds that it reaches.
fn folder(name: &str) -> PathBuf {
    let folder = empty_folder("writing", name);
    let made = run(&folder, "synth --preset dead -o drop.wav");
    assert!(made.status.success(), "{}", errors(&made));
    folder
}

fn command(folder: &Path, line: &str) -> Command {
    let mut command = Command::new(PROGRAM);
    command.current_dir(folder).args(line.split_whitespace());
    command
}

fn run(folder: &Path, line: &str) -> Output {
    command(folder, line).output().unwrap()
}

fn errors(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// One sentence that names the file, status 2, and nothing else.
fn assert_refused(output: &Output, line: &str, why: &str) {
    let said = errors(output);
    let sentence = said.lines().last().unwrap_or_default();
    assert_eq!(output.status.code(), Some(2), "{line}: {said}");
    assert!(output.stdout.is_empty(), "{line}");
    assert!(sentence.starts_with("bounce-audio: "), "{line}: {said}");
    assert!(sentence.contains(why), "{line}: {said}");
    assert!(!said.contains("panicked"), "{line}: {said}");
}

#[test]
fn a_file_that_is_there_is_replaced_whole_except_rows_and_labels() {
    let folder = folder("replaced");
    for (writer, ending) in WRITERS {
        let path = folder.join(format!("out.{ending}"));
        let line = format!("{writer} out.{ending}");
        let fresh = run(&folder, &line);
        let whole = fs::read(&path).unwrap_or_else(|e| panic!("{line}: {e}: {}", errors(&fresh)));
        // It begins as what comes, and is longer, so that a rest of it would show.
        let older = match ending {
            "toml" => [b"# older\n".repeat(10_000), whole.clone()].concat(),
            _ => [&whole[..4], &b"older ".repeat(1_000_000)].concat(),
        };
        fs::write(&path, &older).unwrap();
        let again = run(&folder, &line);
        if matches!(ending, "csv" | "txt") {
            assert_refused(&again, &line, "--force");
            assert!(fs::read(&path).unwrap() == older, "{line}");
            let forced = run(&folder, &format!("{line} --force"));
            assert!(forced.status.success(), "{line}: {}", errors(&forced));
            assert!(fs::read(&path).unwrap() == whole, "{line}");
        } else if ending == "toml" {
            // What is reached depends on the recordings made meanwhile, but a threshold is never left out.
            let kept = fs::read_to_string(&path).unwrap();
            assert!(
                kept.len() < older.len() && !kept.contains("# older\n# older"),
                "{kept}"
            );
        } else if writer.starts_with("evaluate") {
            // The speeds of this picture are never the same twice.
            let text = fs::read_to_string(&path).unwrap();
            assert!(text.starts_with("<svg") && text.ends_with("</svg>\n"));
        } else {
            assert!(again.status.success(), "{line}: {}", errors(&again));
            assert!(fs::read(&path).unwrap() == whole, "{line}");
        }
        fs::remove_file(&path).unwrap();
    }
}

/// A disk that takes 8 KiB more of any file, as a limit of the system that the shell sets.
#[cfg(target_os = "linux")]
fn run_on_a_full_disk(folder: &Path, line: &str) -> Output {
    let limited = "trap '' XFSZ; ulimit -f 16; exec \"$0\" \"$@\"";
    Command::new("sh")
        .current_dir(folder)
        .args(["-c", limited, PROGRAM])
        .args(line.split_whitespace())
        .output()
        .unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn a_disk_that_fills_up_leaves_what_was_there() {
    let folder = folder("full");
    for (writer, name) in [
        ("synth --preset dead --seed 2 -o", "drop.wav"),
        ("analyze drop.wav --plot", "out.svg"),
        ("analyze drop.wav --plot", "out.png"),
    ] {
        let line = format!("{writer} {name}");
        let path = folder.join(name);
        if !path.exists() {
            assert!(run(&folder, &line).status.success());
        }
        let (before, there) = (fs::read(&path).unwrap(), names(&folder));
        assert!(before.len() > 8192, "{name} is too small to fill a disk");
        assert_refused(&run_on_a_full_disk(&folder, &line), &line, name);
        assert!(fs::read(&path).unwrap() == before, "{line}");
        assert_eq!(names(&folder), there, "{line}");
    }
    // The truth is still that of the recording which is still there.
    let truth = fs::read_to_string(folder.join("drop.truth.json")).unwrap();
    assert!(
        run(&folder, "synth --preset dead -o again.wav")
            .status
            .success()
    );
    assert_eq!(
        fs::read_to_string(folder.join("again.truth.json")).unwrap(),
        truth
    );
    let line = "synth --suite suite --seeds 1";
    assert_refused(&run_on_a_full_disk(&folder, line), line, "suite");
    assert_eq!(names(&folder.join("suite")), Vec::<String>::new());
}

#[cfg(unix)]
#[test]
fn a_recording_does_not_go_into_a_pipe() {
    let folder = folder("pipe");
    let line = "synth --preset dead -o /dev/stdout";
    assert_refused(&run(&folder, line), line, "to a file and not to a pipe");
}

/// An error that nobody can read is an error all the same, and no panic.
#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_error_leaves_the_status() {
    let folder = folder("stderr");
    let full = fs::OpenOptions::new().write(true).open("/dev/full");
    let mut command = command(&folder, "analyze missing.wav");
    let status = command.stderr(full.unwrap()).status().unwrap();
    assert_eq!(status.code(), Some(2));
}
