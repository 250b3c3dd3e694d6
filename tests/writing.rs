//! What becomes of files that are written when something is in the way: they are whole, or not there.
#![allow(
    clippy::unwrap_used,
    clippy::panic,
    reason = "a failing test should panic"
)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use bounce_audio::audio;

const PROGRAM: &str = env!("CARGO_BIN_EXE_bounce-audio");

/// A folder of its own for each test, with a recording `drop.wav` in it and the thresholds that it reaches.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("writing-{name}"));
    // There is none on the first run.
    drop(fs::remove_dir_all(&folder));
    fs::create_dir_all(&folder).unwrap();
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

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

/// Every command that writes a file, up to the file's name, and an ending that it takes.
const WRITERS: [(&str, &str); 8] = [
    ("synth --preset dead -o", "wav"),
    ("analyze drop.wav --labels", "txt"),
    ("analyze drop.wav --plot", "svg"),
    ("analyze drop.wav --plot", "png"),
    (
        "solve --bounces 70 --total-time 7.5s --height 30.5cm --plot",
        "svg",
    ),
    ("evaluate . --plot", "svg"),
    ("evaluate . --tighten", "toml"),
    ("batch drop.wav -o", "csv"),
];

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
fn a_place_that_cannot_be_written_to_is_named_and_nothing_is_left() {
    let folder = folder("nowhere");
    fs::create_dir(folder.join("empty")).unwrap();
    let before = names(&folder);
    for (writer, ending) in WRITERS {
        let line = format!("{writer} missing/out.{ending}");
        let output = run(&folder, &line);
        assert_refused(&output, &line, &format!("missing/out.{ending}"));
        // Nothing can be made below what is a file: the same as in a folder that may not be written to.
        let line = format!("{writer} drop.wav/out.{ending}");
        let output = run(&folder, &line);
        assert_refused(&output, &line, &format!("drop.wav/out.{ending}"));
        let taken = format!("taken.{ending}");
        fs::create_dir(folder.join(&taken)).unwrap();
        let line = format!("{writer} {taken}");
        assert_refused(&run(&folder, &line), &line, &taken);
        fs::remove_dir(folder.join(&taken)).unwrap();
        assert_eq!(names(&folder), before, "{writer}");
    }
    for line in [
        "synth --suite drop.wav/suite --seeds 1",
        "batch drop.wav --plots drop.wav/plots",
    ] {
        assert_refused(&run(&folder, line), line, "drop.wav/");
    }
    assert_eq!(names(&folder), before);
}

#[test]
fn a_file_that_is_there_is_replaced_whole_except_by_a_batch() {
    let folder = folder("replaced");
    for (writer, ending) in WRITERS {
        let path = folder.join(format!("out.{ending}"));
        let line = format!("{writer} out.{ending}");
        let fresh = run(&folder, &line);
        let whole = fs::read(&path).unwrap_or_else(|e| panic!("{line}: {e}: {}", errors(&fresh)));
        // Longer than what comes, so that a rest of it would show; thresholds are read before they are made stricter.
        let older = if ending == "toml" {
            [b"# older\n".repeat(10_000), whole.clone()].concat()
        } else {
            b"older ".repeat(1_000_000)
        };
        fs::write(&path, &older).unwrap();
        let again = run(&folder, &line);
        if writer.starts_with("batch") {
            assert_refused(&again, &line, "--force");
            assert_eq!(fs::read(&path).unwrap(), older);
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

#[test]
fn a_file_that_is_protected_stays() {
    let folder = folder("protected");
    let path = folder.join("out.txt");
    fs::write(&path, "mine").unwrap();
    let mut permissions = fs::metadata(&path).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(&path, permissions).unwrap();
    let line = "analyze drop.wav --labels out.txt";
    assert_refused(&run(&folder, line), line, "out.txt: permission denied");
    assert_eq!(fs::read(&path).unwrap(), b"mine");
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

#[cfg(target_os = "linux")]
#[test]
fn a_full_device_is_told_and_stays_a_device() {
    use std::os::unix::fs::{FileTypeExt, symlink};

    let folder = folder("device");
    for (writer, ending) in WRITERS {
        let link = folder.join(format!("full.{ending}"));
        symlink("/dev/full", &link).unwrap();
        let before = names(&folder);
        let line = format!("{writer} full.{ending}");
        let why = if writer.starts_with("batch") {
            "it is not a file"
        } else {
            "No space left on device"
        };
        assert_refused(&run(&folder, &line), &line, why);
        assert_eq!(names(&folder), before, "{line}");
        fs::remove_file(&link).unwrap();
    }
    for line in [
        "synth --preset dead -o /dev/full",
        "batch drop.wav -o /dev/full --force",
    ] {
        assert_refused(&run(&folder, line), line, "/dev/full");
    }
    assert!(
        fs::metadata("/dev/full")
            .unwrap()
            .file_type()
            .is_char_device()
    );
    assert!(
        !Path::new("/dev/full.truth.json").exists() && !Path::new("/dev/full.partial").exists()
    );
    let full = || {
        fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .unwrap()
    };
    for line in ["analyze drop.wav", "batch drop.wav", "synth --list"] {
        let output = command(&folder, line).stdout(full()).output().unwrap();
        assert_refused(&output, line, "No space left on device");
    }
}

#[cfg(unix)]
#[test]
fn a_recording_does_not_go_into_a_pipe() {
    let folder = folder("pipe");
    let line = "synth --preset dead -o /dev/stdout";
    assert_refused(&run(&folder, line), line, "to a file and not to a pipe");
}

/// Whoever closes a pipe has read enough: the status is that of what was found.
#[test]
fn a_closed_pipe_is_no_error() {
    let folder = folder("closed");
    assert!(
        run(&folder, "synth --preset silence -o silence.wav")
            .status
            .success()
    );
    for (line, status) in [
        ("analyze drop.wav", 0),
        ("analyze drop.wav --format json", 0),
        ("analyze silence.wav --quiet", 1),
        ("synth --list", 0),
        ("completions bash", 0),
        ("batch drop.wav", 0),
        ("evaluate .", 0),
    ] {
        let mut command = command(&folder, line);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        assert_eq!(
            output.status.code(),
            Some(status),
            "{line}: {}",
            errors(&output)
        );
        let said = errors(&output);
        assert!(
            !said.contains("pipe") && !said.contains("panicked"),
            "{line}: {said}"
        );
    }
}

/// Waits until a file has been put in its place, and kills.
fn kill_after(folder: &Path, line: &str, seen: impl Fn() -> bool) {
    let mut child = command(folder, line).stderr(Stdio::null()).spawn().unwrap();
    while !seen() && child.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn a_killed_suite_leaves_whole_recordings() {
    let folder = folder("killed");
    for wanted in [1, 2, 5] {
        let suite = folder.join(format!("suite-{wanted}"));
        let made = || {
            let entries = fs::read_dir(&suite).into_iter().flatten();
            entries
                .filter(|e| {
                    e.as_ref()
                        .is_ok_and(|e| e.path().extension().is_some_and(|e| e == "wav"))
                })
                .count()
        };
        kill_after(
            &folder,
            &format!("synth --suite {} --seeds 2", suite.display()),
            || made() >= wanted,
        );
        for name in names(&suite) {
            let path = suite.join(&name);
            if name.ends_with(".wav") {
                assert!(
                    audio::read_file(&path).unwrap().warnings.is_empty(),
                    "{name}"
                );
            } else if name.ends_with(".json") {
                serde_json::from_slice::<serde_json::Value>(&fs::read(&path).unwrap()).unwrap();
                assert!(
                    path.with_extension("").with_extension("wav").exists(),
                    "{name}"
                );
            } else {
                assert!(name.ends_with(".partial"), "{name}");
            }
        }
    }
}

#[test]
fn a_killed_batch_leaves_what_can_be_told_from_a_whole_table() {
    let folder = folder("killed-batch");
    for number in 0..40 {
        fs::copy(
            folder.join("drop.wav"),
            folder.join(format!("{number}.wav")),
        )
        .unwrap();
    }
    let partial = folder.join("out.csv.partial");
    kill_after(&folder, "batch . -o out.csv", || {
        fs::read_to_string(&partial).is_ok_and(|rows| rows.lines().count() > 2)
    });
    assert!(partial.exists() != folder.join("out.csv").exists());
}
