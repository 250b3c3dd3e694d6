//! Results that cannot be written, or not where they should go: what is said, and what is in the folder afterwards.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use super::interrupts;

pub(super) const PROGRAM: &str = env!("CARGO_BIN_EXE_bounce-audio");

#[path = "../common/writers.rs"]
mod writers;
use writers::WRITERS;

/// Something in the way of a file `OUT`.
struct Fault {
    what: &'static str,
    /// Where the file should go.
    out: &'static str,
    /// Puts it in the way.
    prepare: fn(&Path),
    /// What the shell does before the command.
    shell: &'static str,
}

const NOTHING: Fault = Fault {
    what: "",
    out: "out",
    prepare: |_| (),
    shell: "",
};

const FAULTS: [Fault; 13] = [
    Fault {
        what: "nothing is in the way",
        ..NOTHING
    },
    Fault {
        what: "the folder is missing",
        out: "missing/out",
        ..NOTHING
    },
    // A folder in which nothing can be made, whoever asks: to root no folder is read-only.
    Fault {
        what: "the folder is a file",
        out: "drop.wav/out",
        ..NOTHING
    },
    Fault {
        what: "the folder takes no files (`/proc`)",
        out: "/proc/out",
        ..NOTHING
    },
    Fault {
        what: "a folder has the name",
        prepare: |out| fs::create_dir(out).unwrap(),
        ..NOTHING
    },
    Fault {
        what: "a recording has the name",
        prepare: |out| {
            fs::copy(out.with_file_name("drop.wav"), out).unwrap();
        },
        ..NOTHING
    },
    Fault {
        what: "a letter has the name",
        prepare: |out| fs::write(out, "Dear diary, today I bounced a ball.\n").unwrap(),
        ..NOTHING
    },
    Fault {
        what: "the name is a link to a file that is not there",
        prepare: |out| symlink("elsewhere", out).unwrap(),
        ..NOTHING
    },
    Fault {
        what: "the name is a link to a recording",
        prepare: |out| {
            fs::copy(out.with_file_name("drop.wav"), out.with_file_name("mine")).unwrap();
            symlink("mine", out).unwrap();
        },
        ..NOTHING
    },
    Fault {
        what: "the file is protected",
        prepare: |out| {
            fs::write(out, "").unwrap();
            let mut permissions = fs::metadata(out).unwrap().permissions();
            permissions.set_readonly(true);
            fs::set_permissions(out, permissions).unwrap();
        },
        ..NOTHING
    },
    Fault {
        what: "the name is a link to a full device",
        prepare: |out| symlink("/dev/full", out).unwrap(),
        ..NOTHING
    },
    Fault {
        what: "the disk takes no more (as by `ulimit -f 0`)",
        shell: "trap '' XFSZ; ulimit -f 0; ",
        ..NOTHING
    },
    Fault {
        what: "the system kills whoever writes (`ulimit -f 0`, SIGXFSZ)",
        shell: "ulimit -f 0; ",
        ..NOTHING
    },
];

/// What would write over something that is read, or two results into one place.
const CLASHES: [&str; 12] = [
    "analyze copy.svg --plot copy.svg",
    "analyze copy.txt --labels copy.txt",
    "analyze copy.txt --labels copy.txt --force",
    "analyze drop.wav --labels moved.txt",
    "analyze drop.wav --impacts moved.txt --labels moved.txt",
    "batch drop.wav -o drop.wav --force",
    "batch drop.wav --options balls.csv -o balls.csv --force",
    "batch drop.wav --plot copy.svg",
    "batch drop.wav -o new.svg --plot new.svg",
    "batch drop.wav --plots sheets --plot sheets/drop.wav.svg",
    "synth scene.toml -o scene.toml",
    "synth scene.toml -o drop",
];

/// What goes to standard output, and the status if all of it is read.
const PRINTERS: [&str; 9] = [
    "analyze drop.wav",
    "analyze drop.wav --format json",
    "analyze drop.wav --format csv",
    "batch drop.wav",
    "batch drop.wav --format ndjson",
    "solve --restitution 0.93 --contact-time 1ms",
    "synth --list",
    "evaluate .",
    "completions bash",
];

/// A folder of its own, with a recording and its truth, and other things that a person made.
pub(super) fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("faults-{name}"));
    // There is none on the first run.
    drop(fs::remove_dir_all(&folder));
    fs::create_dir_all(&folder).unwrap();
    let made = run(&folder, "", "synth --preset dead -o drop.wav");
    assert!(made.status.success());
    folder
}

pub(super) fn run(folder: &Path, shell: &str, line: &str) -> Output {
    let script = format!("{shell}exec \"$0\" \"$@\"");
    Command::new("sh")
        .current_dir(folder)
        .args(["-c", &script, PROGRAM])
        .args(line.split_whitespace())
        .output()
        .unwrap()
}

/// Every file below a folder, with what is in it; of a link, where it leads.
pub(super) fn content(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_symlink() {
            let to = fs::read_link(&path).unwrap();
            found.insert(name, to.into_os_string().into_encoded_bytes());
        } else if path.is_dir() {
            found.insert(format!("{name}/"), Vec::new());
            let below = content(&path).into_iter();
            found.extend(below.map(|(below, bytes)| (format!("{name}/{below}"), bytes)));
        } else {
            found.insert(name, fs::read(&path).unwrap());
        }
    }
    found
}

/// How the status reads in the table.
pub(super) fn status(output: &Output) -> String {
    use std::os::unix::process::ExitStatusExt;
    match (output.status.code(), output.status.signal()) {
        (Some(code), _) => code.to_string(),
        (None, signal) => format!("signal {}", signal.unwrap_or(0)),
    }
}

/// The sentence on standard error, if that is an error; no document may be beside it.
fn said(output: &Output) -> String {
    let error = String::from_utf8(output.stderr.clone()).unwrap();
    assert!(!error.contains("panicked"), "{error}");
    if output.status.code() != Some(2) {
        return "-".to_owned();
    }
    // Notes and the summary of a batch come before it.
    let mut lines = error.lines();
    let sentence = lines.find(|line| line.starts_with("bounce-audio: "));
    sentence
        .unwrap_or_else(|| panic!("{error}"))
        .replace('|', "\\|")
}

/// What a command changed in its folder.
fn change(before: &BTreeMap<String, Vec<u8>>, after: &BTreeMap<String, Vec<u8>>) -> String {
    let mut told = Vec::new();
    for (name, bytes) in before {
        match after.get(name) {
            None => told.push(format!("**{name} is gone**")),
            Some(now) if now != bytes => told.push(format!("**{name} is another**")),
            Some(_) => {}
        }
    }
    let new = after.keys().filter(|name| !before.contains_key(*name));
    told.extend(new.map(|name| format!("{} is new", without_number(name))));
    match told.len() {
        0 => "as before".to_owned(),
        _ => told.join(", "),
    }
}

/// The number of the process taken out of a name.
fn without_number(name: &str) -> String {
    let part = |part: &str| match part.parse::<u64>() {
        Ok(_) => "PID".to_owned(),
        Err(_) => part.to_owned(),
    };
    name.split('.').map(part).collect::<Vec<_>>().join(".")
}

/// A row for each way in which commands take a fault.
fn of_fault(table: &mut String, fault: &Fault) {
    let mut rows: Vec<([String; 3], Vec<String>)> = Vec::new();
    for (writer, ending) in WRITERS {
        let folder = folder("writing");
        let out = format!("{}.{ending}", fault.out);
        (fault.prepare)(&folder.join(&out));
        let before = content(&folder);
        let output = run(&folder, fault.shell, &format!("{writer} {out}"));
        let change = change(&before, &content(&folder));
        // A recording and its truth are one result, and what a link leads to is the file of its name.
        let change = change.replace("out.truth.json is new, out.wav", "out.wav with its truth");
        let row = [status(&output), said(&output), change].map(|cell| {
            let cell = cell.replace(&format!("out.{ending}"), "OUT");
            cell.replace(
                &format!("{}/", fault.out.trim_end_matches("/out")),
                "FOLDER/",
            )
        });
        let command = format!("`{} {}`", shorter(writer), ending);
        match rows.iter_mut().find(|(other, _)| *other == row) {
            Some((_, commands)) => commands.push(command),
            None => rows.push((row, vec![command])),
        }
    }
    for ([status, said, change], commands) in rows {
        let commands = match commands.len() {
            n if n == WRITERS.len() => "all".to_owned(),
            _ => commands.join(", "),
        };
        writeln!(
            table,
            "| {} | {commands} | {status} | {said} | {change} |",
            fault.what
        )
        .unwrap();
    }
}

/// The command and the option that takes the file.
fn shorter(writer: &str) -> String {
    let words: Vec<&str> = writer.split(' ').collect();
    format!("{} {}", words[0], words[words.len() - 1])
}

fn of_clash(table: &mut String, line: &str) {
    let folder = folder("clash");
    for copy in ["copy.svg", "copy.txt"] {
        fs::copy(folder.join("drop.wav"), folder.join(copy)).unwrap();
    }
    let labels = run(&folder, "", "analyze drop.wav --labels moved.txt");
    assert!(labels.status.success());
    let moved = fs::read_to_string(folder.join("moved.txt")).unwrap();
    let (first, rest) = moved.split_once('\n').unwrap();
    let first = first.split('\t').nth(2).unwrap();
    fs::write(
        folder.join("moved.txt"),
        format!("0.1234\t0.1234\t{first}\n{rest}"),
    )
    .unwrap();
    fs::write(folder.join("balls.csv"), "file,height\ndrop.wav,1m\n").unwrap();
    fs::write(
        folder.join("scene.toml"),
        "name = \"mine\"\nduration_s = 1.0\n",
    )
    .unwrap();
    let before = content(&folder);
    let output = run(&folder, "", line);
    let change = change(&before, &content(&folder));
    let (status, said) = (status(&output), said(&output));
    writeln!(table, "| `{line}` | {status} | {said} | {change} |").unwrap();
}

/// What comes of a result when nobody reads it, and when it goes to a full disk.
fn of_printer(table: &mut String, folder: &Path, line: &str) {
    let words = || line.split_whitespace();
    let mut closed = Command::new(PROGRAM)
        .current_dir(folder)
        .args(words())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(closed.stdout.take());
    let closed = closed.wait_with_output().unwrap();
    let said_of_pipe = String::from_utf8(closed.stderr.clone()).unwrap();
    assert!(!said_of_pipe.contains("pipe"), "{line}: {said_of_pipe}");
    let full = fs::OpenOptions::new().write(true).open("/dev/full");
    let full = Command::new(PROGRAM)
        .current_dir(folder)
        .args(words())
        .stdout(full.unwrap())
        .output()
        .unwrap();
    writeln!(
        table,
        "| `{line}` | {} | {} | {}: {} |",
        status(&run(folder, "", line)),
        status(&closed),
        status(&full),
        said(&full)
    )
    .unwrap();
}

fn table() -> String {
    let mut table = INTRODUCTION.to_owned();
    for fault in &FAULTS {
        of_fault(&mut table, fault);
    }
    table += CLASHES_INTRODUCTION;
    for line in CLASHES {
        of_clash(&mut table, line);
    }
    table += PRINTERS_INTRODUCTION;
    let folder = folder("printing");
    for line in PRINTERS {
        of_printer(&mut table, &folder, line);
    }
    table += interrupts::INTRODUCTION;
    interrupts::add_rows(&mut table);
    table
}

const INTRODUCTION: &str = "# What comes of results that cannot be written

Each row is tried by `tests/faults/writing.rs` on Linux, which fails where this table is not what came of it. Status 2: it
could not be done, and one sentence on standard error says why. A name in bold would be something that was lost.

## Files

| in the way | command | status | said | in the folder |
|---|---|---|---|---|
";

const CLASHES_INTRODUCTION: &str = "
## What is read, and results in one place

`copy.svg` and `copy.txt` are recordings, `moved.txt` are labels of which one was moved by hand, `balls.csv` is a table
and `scene.toml` a scene.

| command | status | said | in the folder |
|---|---|---|---|
";

const PRINTERS_INTRODUCTION: &str = "
## Standard output

The status when all is read, when the pipe is closed before (`| head`: nothing is said of it), and when it goes to a full
disk.

| command | read | closed | full |
|---|---|---|---|
";

#[test]
fn every_fault_of_writing_gives_what_the_table_says() {
    let made = table();
    super::compare("docs/faults-of-writing.md", &made);
    assert!(!made.contains("**"), "something was lost: {made}");
}
