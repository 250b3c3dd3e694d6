//! `bounce-audio batch` as a user runs it: odd inputs, order, interruption, options by file.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use bounce_audio::random::SplitMix64;
use serde_json::Value;

use crate::common::{empty_folder, run_in as run, text};

fn folder(name: &str) -> PathBuf {
    empty_folder("batch", name)
}

/// A recording of a preset at a path of any kind.
fn synth(path: impl AsRef<Path>, preset: &str, seed: u64) {
    let path = path.as_ref();
    let made = path.with_file_name("made.wav");
    let output = run(
        path.parent().unwrap(),
        &[
            "synth",
            "--preset",
            preset,
            "--seed",
            &seed.to_string(),
            "-o",
            "made.wav",
        ],
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
    fs::remove_file(made.with_extension("truth.json")).unwrap();
    fs::rename(made, path).unwrap();
}

/// The rows of a table, without its heading, as fields.
fn rows(table: &[u8]) -> Vec<csv::StringRecord> {
    csv::Reader::from_reader(table)
        .records()
        .map(|row| row.unwrap())
        .collect()
}

/// One column of a table.
fn column(table: &[u8], name: &str) -> Vec<String> {
    let headers = csv::Reader::from_reader(table).headers().unwrap().clone();
    let at = headers.iter().position(|h| h == name).unwrap();
    rows(table).iter().map(|row| row[at].to_owned()).collect()
}

#[test]
fn rows_come_in_the_order_of_the_inputs_whatever_the_threads_do() {
    let folder = folder("order");
    fs::create_dir(folder.join("b")).unwrap();
    synth(folder.join("b/2.wav"), "dead", 1);
    synth(folder.join("b/1.wav"), "three-drops", 1);
    synth(folder.join("a.wav"), "dead", 2);
    synth(folder.join("c.wav"), "steel", 2);
    let of = |jobs: &str| run(&folder, &["batch", "c.wav", "b", "a.wav", "--jobs", jobs]);
    let one = of("1");
    assert_eq!(one.status.code(), Some(0), "{}", text(&one.stderr));
    let files = ["c.wav", "b/1.wav", "b/1.wav", "b/1.wav", "b/2.wav", "a.wav"];
    assert_eq!(column(&one.stdout, "file"), files);
    assert_eq!(column(&one.stdout, "drop"), ["1", "1", "2", "3", "1", "1"]);
    assert_eq!(column(&one.stdout, "drops"), ["1", "3", "3", "3", "1", "1"]);
    for jobs in ["2", "7"] {
        let many = of(jobs);
        assert_eq!(
            (many.stdout, many.stderr),
            (one.stdout.clone(), one.stderr.clone())
        );
    }
    // A pipe gets the summary and no bar.
    let said = text(&one.stderr);
    assert!(said.contains("b/1.wav drop 2: e 0.") && said.contains("4 recordings, 6 drops"));
    assert!(
        said.contains("  mean e   0.") && said.contains("Birge"),
        "{said}"
    );
    assert!(!said.contains('\r') && !said.contains('\u{1b}'), "{said}");
}

#[test]
fn a_line_is_the_document_of_analyze() {
    let folder = folder("ndjson");
    synth(folder.join("a.wav"), "steel", 1);
    synth(folder.join("n.wav"), "silence", 1);
    fs::write(folder.join("empty.wav"), "").unwrap();
    let options = ["--height", "15cm", "--model", "constant"];
    let all = ["batch", "a.wav", "empty.wav", "n.wav", "--format", "ndjson"];
    let output = run(&folder, &[&all[..], &options].concat());
    assert_eq!(output.status.code(), Some(1));
    let lines: Vec<Value> = text(&output.stdout)
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    for (line, file) in [(0, "a.wav"), (2, "n.wav")] {
        let one = [&["analyze", file, "--format", "json"][..], &options].concat();
        let document: Value = serde_json::from_slice(&run(&folder, &one).stdout).unwrap();
        assert_eq!(lines[line], document, "{file}");
    }
    assert_eq!(lines[1]["file"], "empty.wav");
    assert_eq!(lines[1]["error"], "not a readable recording: it is empty");
}

#[test]
fn a_bad_file_costs_one_row_with_its_reason() {
    let folder = folder("bad");
    synth(folder.join("c.wav"), "dead", 1);
    synth(folder.join("none.wav"), "silence", 1);
    fs::write(folder.join("a.wav"), "").unwrap();
    fs::write(folder.join("b.wav"), b"RIFF\x24\0\0\0WAVEfmt ").unwrap();
    let output = run(&folder, &["batch", "missing.wav", "."]);
    assert_eq!(output.status.code(), Some(1));
    let status = ["error", "error", "error", "drop", "none"];
    assert_eq!(column(&output.stdout, "status"), status);
    let reasons = column(&output.stdout, "reason");
    for (reason, expected) in reasons.iter().zip([
        "there is no such file or folder",
        "is empty",
        "ends before its samples",
        "",
        "silent",
    ]) {
        assert!(reason.contains(expected), "{reasons:?}");
    }
    let said = text(&output.stderr);
    assert!(said.contains("without a drop: 1; failed: 3"), "{said}");
    assert!(
        said.contains("./a.wav: failed: not a readable recording: it is empty"),
        "{said}"
    );
}

#[test]
fn a_recording_is_known_by_its_content() {
    let folder = folder("content");
    synth(folder.join("take 1"), "dead", 1);
    synth(folder.join("b.mp3"), "dead", 2);
    fs::write(folder.join("notes.txt"), "RIFF is what a WAV begins with").unwrap();
    fs::write(folder.join("._b.wav"), "what macOS leaves").unwrap();
    let output = run(&folder, &["batch", "."]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert_eq!(column(&output.stdout, "file"), ["./b.mp3", "./take 1"]);
}

#[test]
fn a_folder_without_recordings_is_an_error_and_beside_others_a_row() {
    let folder = folder("empty");
    fs::create_dir_all(folder.join("e/deep")).unwrap();
    let output = run(&folder, &["batch", "e", "-o", "out.csv"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty() && !folder.join("out.csv.partial").exists());
    let said = text(&output.stderr);
    assert_eq!(said.lines().count(), 1);
    assert!(said.contains("e: the folder holds no recording"), "{said}");
    synth(folder.join("a.wav"), "dead", 1);
    let output = run(&folder, &["batch", "e", "a.wav"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(column(&output.stdout, "status"), ["error", "drop"]);
}

#[test]
fn what_cannot_be_meant_is_refused_at_once() {
    let folder = folder("refused");
    synth(folder.join("a.wav"), "dead", 1);
    for (arguments, expected) in [
        (&["-"][..], "analyze - reads a pipe"),
        (&["a.wav", "--height", "-1"], "height is -1"),
        (&["a.wav", "--jobs", "0"], "1..=65535"),
        (&["a.wav", "--resume"], "--output"),
        (&["a.wav", "--pattern", "{height}cm.wav"], "with its unit"),
        (&["a.wav", "--options", "no.csv"], "no.csv"),
        (
            &["a.wav", "-o", "no/such/out.csv"],
            "no/such/out.csv: there is no folder no/such\n",
        ),
        (
            &["a.wav", "-o", "no/such/out.csv", "--resume"],
            "no/such/out.csv: there is no folder no/such\n",
        ),
        (
            &["a.wav", "-o", "a.wav/out.csv"],
            "a.wav/out.csv: a.wav is a file, not a folder\n",
        ),
    ] {
        let output = run(&folder, &[&["batch"], arguments].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(
            text(&output.stderr).contains(expected),
            "{}",
            text(&output.stderr)
        );
        assert!(output.stdout.is_empty());
    }
}

#[cfg(unix)]
#[test]
fn links_end_and_odd_names_stay_apart() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    use std::os::unix::fs::symlink;

    let folder = folder("names");
    let names: [&[u8]; 5] = [
        b"a b.wav",
        b"c,\"d\".wav",
        b"e\nf.wav",
        b"g\xE8.wav",
        b"g\xE9.wav",
    ];
    for (seed, name) in (1..).zip(names) {
        synth(folder.join(OsStr::from_bytes(name)), "dead", seed);
    }
    fs::create_dir(folder.join("sub")).unwrap();
    symlink("..", folder.join("sub/up")).unwrap();
    symlink(".", folder.join("here")).unwrap();
    symlink("a b.wav", folder.join("z.wav")).unwrap();
    symlink("nowhere", folder.join("y.wav")).unwrap();
    let all = ["batch", ".", "a b.wav", "-o", "out.csv"];
    let output = run(&folder, &all);
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
    let table = fs::read(folder.join("out.csv")).unwrap();
    let shown = [
        "./a b.wav",
        "./c,\"d\".wav",
        "./e\nf.wav",
        "./g\\xE8.wav",
        "./g\\xE9.wav",
        "./y.wav",
    ];
    assert_eq!(column(&table, "file"), shown);
    assert!(text(&output.stderr).contains("./e\\nf.wav: e 0."));
    // The five seeds are five drops.
    let mut values = column(&table, "restitution");
    values.truncate(5);
    values.sort();
    values.dedup();
    assert_eq!(values.len(), 5);
    // From anywhere in the middle of these names, too, it goes on to the same bytes.
    for cut in [table.len() / 2, table.len() * 2 / 3] {
        fs::rename(folder.join("out.csv"), folder.join("whole.csv")).unwrap();
        fs::write(folder.join("out.csv.partial"), &table[..cut]).unwrap();
        run(&folder, &[&all[..], &["--resume"]].concat());
        assert_eq!(fs::read(folder.join("out.csv")).unwrap(), table);
    }
}

#[test]
fn nothing_is_overwritten_unless_asked() {
    let folder = folder("overwrite");
    synth(folder.join("a.wav"), "dead", 1);
    let recording = fs::read(folder.join("a.wav")).unwrap();
    let (out, partial) = (folder.join("out.csv"), folder.join("out.csv.partial"));
    let batch = |more: &[&str]| {
        let output = run(
            &folder,
            &[&["batch", "a.wav", "-o", "out.csv"], more].concat(),
        );
        (output.status.code(), text(&output.stderr))
    };
    fs::write(&out, "mine").unwrap();
    let (status, said) = batch(&[]);
    assert!(
        status == Some(2) && said.contains("out.csv: it is there already"),
        "{said}"
    );
    let (status, said) = batch(&["--resume"]);
    assert!(status == Some(2) && said.contains("--format"), "{said}");
    assert_eq!(fs::read(&out).unwrap(), b"mine");
    assert!(!partial.exists());
    assert_eq!(batch(&["--force"]).0, Some(0));
    let table = fs::read(&out).unwrap();
    assert_eq!(column(&table, "status"), ["drop"]);
    // It is finished: there is nothing to go on with, but the answer is the same.
    let (status, said) = batch(&["--resume"]);
    assert!(
        status == Some(0) && said.contains("1 recording, 1 drop"),
        "{said}"
    );
    fs::remove_file(&out).unwrap();
    fs::write(&partial, "theirs").unwrap();
    for more in [&[][..], &["--resume"]] {
        let (status, said) = batch(more);
        assert!(status == Some(2) && said.contains("--resume"), "{said}");
        assert_eq!(fs::read(&partial).unwrap(), b"theirs");
    }
    assert_eq!(batch(&["--force"]).0, Some(0));
    assert!(!partial.exists() && fs::read(&out).unwrap() == table);
    let output = run(&folder, &["batch", ".", "-o", "a.wav", "--force"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("one of the recordings"));
    assert_eq!(fs::read(folder.join("a.wav")).unwrap(), recording);
}

/// Six short recordings with drops, without and broken, and the arguments of a batch of them.
fn to_interrupt(name: &str) -> PathBuf {
    let folder = folder(name);
    for seed in 1..=4 {
        synth(folder.join(format!("{seed}.wav")), "dead", seed);
    }
    synth(folder.join("2-three.wav"), "three-drops", 1);
    synth(folder.join("3-none.wav"), "silence", 1);
    fs::write(folder.join("broken.wav"), "").unwrap();
    folder
}

#[test]
fn a_killed_run_is_resumed_to_the_same_bytes() {
    let folder = to_interrupt("kill");
    let mut rng = SplitMix64::new(7);
    for format in ["csv", "ndjson"] {
        let all = ["batch", ".", "--format", format, "--jobs", "2", "-o"];
        run(&folder, &[&all[..], &["whole", "--force"]].concat());
        let whole = fs::read(folder.join("whole")).unwrap();
        let partial = folder.join("out.partial");
        for _ in 0..5 {
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a place in a file"
            )]
            let moment = (rng.uniform() * bounce_audio::units::real(whole.len())) as u64;
            let mut child = Command::new(env!("CARGO_BIN_EXE_bounce-audio"))
                .current_dir(&folder)
                .args([&all[..], &["out"]].concat())
                .stderr(Stdio::null())
                .spawn()
                .unwrap();
            // It may get to its end first: then there is nothing to go on with, which is as good.
            while child.try_wait().unwrap().is_none() {
                if fs::metadata(&partial).is_ok_and(|m| m.len() >= moment) {
                    child.kill().unwrap();
                }
            }
            let resumed = run(&folder, &[&all[..], &["out", "--resume"]].concat());
            assert_eq!(resumed.status.code(), Some(1), "{}", text(&resumed.stderr));
            assert!(
                text(&resumed.stderr)
                    .contains("7 recordings, 7 drops; without a drop: 1; failed: 1")
            );
            assert!(
                fs::read(folder.join("out")).unwrap() == whole,
                "{format} killed at {moment}"
            );
            assert!(!partial.exists());
            fs::remove_file(folder.join("out")).unwrap();
        }
    }
}

#[test]
fn a_torn_row_is_done_again() {
    let folder = to_interrupt("torn");
    let all = ["batch", ".", "-o"];
    let first = run(&folder, &[&all[..], &["whole"]].concat());
    let whole = fs::read(folder.join("whole")).unwrap();
    let second_of_three = text(&whole).find("2-three.wav,2,3").unwrap();
    for cut in [0, 100, second_of_three + 40, whole.len() - 1, whole.len()] {
        fs::write(folder.join("out.partial"), &whole[..cut]).unwrap();
        let resumed = run(&folder, &[&all[..], &["out", "--resume"]].concat());
        assert_eq!(fs::read(folder.join("out")).unwrap(), whole, "cut at {cut}");
        assert_eq!(resumed.stderr, first.stderr, "cut at {cut}");
        fs::remove_file(folder.join("out")).unwrap();
    }
}

#[test]
fn other_inputs_or_options_are_not_gone_on_with() {
    let folder = to_interrupt("other");
    run(&folder, &["batch", ".", "-o", "whole"]);
    let whole = fs::read(folder.join("whole")).unwrap();
    let half = &whole[..whole.len() * 2 / 3];
    fs::write(folder.join("out.partial"), half).unwrap();
    for (arguments, expected) in [
        (&["."][..], None),
        (
            &["3.wav", "4.wav"],
            Some("where the inputs now have \"3.wav\""),
        ),
        (&[".", "--height", "20cm"], Some("other options")),
        (&[".", "--format", "ndjson"], Some("--format")),
    ]
    .into_iter()
    .rev()
    {
        let resumed = run(
            &folder,
            &[&["batch", "-o", "out", "--resume"], arguments].concat(),
        );
        let said = text(&resumed.stderr);
        match expected {
            Some(expected) => {
                assert_eq!(resumed.status.code(), Some(2));
                assert!(
                    said.contains("out.partial: ") && said.contains(expected),
                    "{said}"
                );
                assert_eq!(fs::read(folder.join("out.partial")).unwrap(), half);
            }
            None => assert_eq!(fs::read(folder.join("out")).unwrap(), whole),
        }
    }
}

#[test]
fn options_differ_from_file_to_file() {
    let folder = folder("options");
    synth(folder.join("ball-20cm-01.wav"), "dead", 1);
    synth(folder.join("ball-30cm-01.wav"), "dead", 2);
    let heights = |more: &[&str]| {
        let output = run(&folder, &[&["batch", "."], more].concat());
        (
            column(&output.stdout, "height_m"),
            column(&output.stdout, "mass_kg"),
            output,
        )
    };
    let pattern = ["--pattern", "ball-{height}-{n}.wav", "--mass", "2g"];
    let (height, mass, output) = heights(&pattern);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert_eq!(
        (height, mass),
        (
            vec!["0.2".to_owned(), "0.3".to_owned()],
            vec!["0.002".to_owned(); 2]
        )
    );
    let table = "file,height,mass\nball-20cm-01.wav,25cm,\nball-40cm-01.wav,40cm,1g\n";
    fs::write(folder.join("t.csv"), table).unwrap();
    let (height, mass, output) =
        heights(&["--options", "t.csv", "--height", "50cm", "--mass", "2g"]);
    assert_eq!(
        (height, mass),
        (
            vec!["0.25".to_owned(), "0.5".to_owned()],
            vec!["0.002".to_owned(); 2]
        )
    );
    let said = text(&output.stderr);
    assert!(
        said.contains("t.csv: no row for \"./ball-30cm-01.wav\""),
        "{said}"
    );
    assert!(
        said.contains("t.csv, line 3: no input is named \"ball-40cm-01.wav\""),
        "{said}"
    );
    synth(folder.join("ball.wav"), "dead", 3);
    let (_, _, output) = heights(&pattern);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(column(&output.stdout, "status"), ["drop", "drop", "error"]);
    assert!(column(&output.stdout, "reason")[2].contains("not of the pattern"));
}

#[test]
fn a_reader_that_has_read_enough_ends_the_run() {
    let folder = folder("head");
    synth(folder.join("a.wav"), "dead", 1);
    let mut child = Command::new(env!("CARGO_BIN_EXE_bounce-audio"))
        .current_dir(&folder)
        .args(["batch", "."])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
}

#[test]
fn a_batch_draws_its_drops_and_a_sheet_of_each_recording() {
    let folder = folder("plots");
    fs::create_dir(folder.join("in")).unwrap();
    synth(folder.join("in/steel.wav"), "steel", 1);
    synth(folder.join("in/dead.wav"), "dead", 1);
    let output = run(
        &folder,
        &["batch", "in", "--plot", "all.svg", "--plots", "sheets"],
    );
    assert!(output.status.success(), "{}", text(&output.stderr));
    let all = fs::read_to_string(folder.join("all.svg")).unwrap();
    for part in [
        "mean e = ",
        ">\n2 drops in 2 recordings\n",
        ">\nsteel\n",
        ">\ndead\n",
    ] {
        assert!(all.contains(part), "{part}");
    }
    for name in ["steel.wav.svg", "dead.wav.svg"] {
        let sheet = fs::read_to_string(folder.join("sheets").join(name)).unwrap();
        assert!(sheet.contains("Level of channel"), "{name}");
    }
    // What has no drop has a row too, and e sorts the rows.
    synth(folder.join("in/clock.wav"), "metronome", 1);
    let sorted = ["batch", "in", "--plot", "e.svg", "--plot-order", "e"];
    assert_eq!(run(&folder, &sorted).status.code(), Some(1));
    let by_e = fs::read_to_string(folder.join("e.svg")).unwrap();
    let place = |name: &str| by_e.find(&format!(">\n{name}\n")).unwrap();
    assert!(by_e.contains("no drop") && place("steel") < place("dead"));
    let wrong = run(&folder, &["batch", "in", "--plot-order", "size"]);
    assert_eq!(wrong.status.code(), Some(2));
    assert!(text(&wrong.stderr).contains("[possible values: file, e]"));
}

#[test]
fn two_recordings_never_share_a_picture() {
    let folder = folder("one-picture");
    for side in ["a", "b"] {
        fs::create_dir(folder.join(side)).unwrap();
        synth(folder.join(side).join("steel.wav"), "steel", 1);
    }
    let output = run(&folder, &["batch", "a", "b", "--plots", "sheets"]);
    assert_eq!(output.status.code(), Some(2));
    let said = text(&output.stderr);
    assert!(said.contains("a/steel.wav and b/steel.wav"), "{said}");
    assert!(!folder.join("sheets").exists());
    let output = run(&folder, &["batch", "a", "--plot", "all.jpg"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains(".svg or .png"));
}

/// A list of two drops of a ball of this e from 1 m.
fn list(e: f64) -> String {
    let mut lines = "time [s];drop\n".to_owned();
    for (drop, e) in [("first", e), ("second", e + 0.004)] {
        let mut time = 1.0;
        for n in 0..9 {
            lines += &format!("{time:.5};{drop}\n");
            time += 2.0 * (2.0_f64 / 9.81).sqrt() * e.powi(n + 1);
        }
    }
    lines
}

#[test]
fn lists_of_times_are_judged_and_grouped_as_recordings_are() {
    let folder = folder("lists");
    for (group, e) in [("cold", 0.70), ("warm", 0.80)] {
        fs::create_dir(folder.join(group)).unwrap();
        fs::write(folder.join(group).join("times.csv"), list(e)).unwrap();
    }
    let lists = ["cold/times.csv", "warm/times.csv"];
    let known = ["--height", "1m", "--time-error", "0.1ms"];
    let compared = run(&folder, &[&["compare"], &lists[..], &known[..]].concat());
    assert_eq!(
        compared.status.code(),
        Some(0),
        "{}",
        text(&compared.stderr)
    );
    let said = text(&compared.stdout);
    assert!(
        said.contains("cold: 0.70") && said.contains("warm: 0.80"),
        "{said}"
    );
    assert!(
        said.contains("2 drops") && said.contains("the difference is real"),
        "{said}"
    );
    let rule = ["--rule", "resilience=45..55%@1m,100g,20mm"];
    let judged = run(
        &folder,
        &[&["batch"], &lists[..], &known[..], &rule[..]].concat(),
    );
    let rows = text(&judged.stdout);
    assert_eq!(judged.status.code(), Some(3), "{}", text(&judged.stderr));
    assert_eq!(rows.lines().count(), 5, "{rows}");
    assert!(rows.contains("cold/times.csv,2,2,drop"), "{rows}");
    let drawn = run(&folder, &["batch", lists[0], "--plots", "sheets"]);
    assert_eq!(drawn.status.code(), Some(0), "{}", text(&drawn.stderr));
    assert!(folder.join("sheets/times.csv-2.svg").exists());
    // A list that is none costs its row, and a folder is searched for recordings alone.
    fs::write(folder.join("cold/notes.txt"), "no times at all\n").unwrap();
    let spoilt = run(&folder, &["batch", "cold/notes.txt", "warm/times.csv"]);
    assert_eq!(spoilt.status.code(), Some(1));
    assert!(
        text(&spoilt.stdout).contains("cold/notes.txt,,0,error,"),
        "{}",
        text(&spoilt.stdout)
    );
    let searched = run(&folder, &["batch", "cold"]);
    assert_eq!(searched.status.code(), Some(2));
    assert!(text(&searched.stderr).contains("no recording"));
}
