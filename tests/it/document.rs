//! `--report OUT.html`: the page of a recording, of times and of a batch.

use std::fs;
use std::path::Path;

use crate::common::{empty_folder, run, run_in, text};

fn drop_wav() -> String {
    format!("{}/examples/drop.wav", env!("CARGO_MANIFEST_DIR"))
}

/// The page that a command writes, and that it is one file.
fn page(arguments: &[&str], path: &Path) -> String {
    let name = path.display().to_string();
    let said = run(&[
        arguments,
        &["--report", name.as_str(), "--note", "ball <7> & granite"],
    ]
    .concat());
    assert_eq!(said.status.code(), Some(0), "{}", text(&said.stderr));
    let html = fs::read_to_string(path).unwrap();
    for outside in ["<script", "<link", "<img", "src=", "href=", "url("] {
        assert!(!html.contains(outside), "{outside}");
    }
    assert!(html.contains("ball &lt;7&gt; &amp; granite") && html.contains("size:A4"));
    assert!(html.contains(concat!("bounce-audio ", env!("CARGO_PKG_VERSION"))));
    html
}

/// By another program: `sha256sum examples/drop.wav`.
fn sha256_of_the_example() -> String {
    let sums = std::process::Command::new("sha256sum")
        .arg(drop_wav())
        .output();
    sums.map_or_else(|_| String::new(), |out| text(&out.stdout)[..64].to_owned())
}

#[test]
fn a_recording_has_a_page_with_the_answer_first_and_its_hash() {
    let folder = empty_folder("document", "recording");
    let html = page(
        &["analyze", &drop_wav(), "--height", "30.5cm"],
        &folder.join("a.html"),
    );
    let order = [
        "class=\"answer\">",
        "ball &lt;7",
        "What it means",
        "<svg",
        "In full",
        "Settings",
        "SHA-256 ",
    ];
    let places: Vec<usize> = order.iter().map(|part| html.find(part).unwrap()).collect();
    assert!(places.is_sorted(), "{places:?}");
    assert!(html.contains(&sha256_of_the_example()));
    assert!(html.contains("<th>height m</th><td>0.305</td>") && html.contains("resilience"));
    assert!(html.contains("drop.wav: e = 0.9"));
}

#[test]
fn times_and_batches_have_pages_too() {
    let folder = empty_folder("document", "others");
    let list = folder.join("t.csv");
    fs::write(
        &list,
        "0.8,a\n0.7,a\n0.61,a\n0.53,a\n0.82,b\n0.72,b\n0.62,b\n",
    )
    .unwrap();
    let html = page(
        &["fit", &list.display().to_string()],
        &folder.join("t.html"),
    );
    assert_eq!(html.matches("<svg").count(), 2, "a sheet for each drop");
    let wav = drop_wav();
    let html = page(
        &["batch", &wav, "--height", "30.5cm"],
        &folder.join("b.html"),
    );
    assert!(
        html.contains("All drops")
            && html.contains("Each drop")
            && html.matches("<svg").count() == 1
    );
    assert!(html.contains(&sha256_of_the_example()));
    let drawn = run(&[
        "fit",
        &list.display().to_string(),
        "--plot",
        &folder.join("t.svg").display().to_string(),
    ]);
    assert_eq!(drawn.status.code(), Some(0), "{}", text(&drawn.stderr));
    assert!(folder.join("t-1.svg").is_file() && folder.join("t-2.svg").is_file());
}

#[test]
fn what_is_no_page_is_not_replaced_and_a_pipe_has_none() {
    let folder = empty_folder("document", "refused");
    fs::write(folder.join("letter.html"), "Dear Ms Miller").unwrap();
    let wav = drop_wav();
    for (arguments, said) in [
        (
            vec!["analyze", &wav, "--report", "letter.html"],
            "letter.html: it is there",
        ),
        (vec!["analyze", &wav, "--report", "a.pdf"], "ends in .html"),
        (vec!["analyze", "-", "--report", "a.html"], "for a pipe"),
        (vec!["fit", "-", "--report", "a.html"], "for a pipe"),
        (
            vec!["batch", &wav, "--report", "same.html", "-o", "same.html"],
            "two results",
        ),
        (vec!["analyze", &wav, "--note", "x"], "--report"),
    ] {
        let output = run_in(&folder, &arguments);
        let error = text(&output.stderr);
        assert!(
            output.status.code() == Some(2) && error.contains(said),
            "{arguments:?}: {error}"
        );
    }
    assert_eq!(
        fs::read_to_string(folder.join("letter.html")).unwrap(),
        "Dear Ms Miller"
    );
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
}

#[test]
fn text_page_and_batch_say_what_of_the_ball_is_the_rules() {
    let folder = empty_folder("document", "ball-of-the-rule");
    let told = |arguments: &[&str]| {
        let path = folder.join("a.html");
        let page = ["--report", path.to_str().unwrap(), "--rule", "ittf-ball"];
        let output = run(&[arguments, &page].concat());
        let html = fs::read_to_string(&path).unwrap();
        fs::remove_file(&path).unwrap();
        [[output.stdout, output.stderr].concat(), html.into()].map(|bytes| text(&bytes))
    };
    let all = "for the drag in e too";
    let (mass, diameter) = (["--mass", "2.7g"], ["--diameter", "40mm"]);
    for (given, sentence) in [
        (&[][..], "Mass and diameter are the rule's, for the drag"),
        (&mass, "The diameter is the rule's, for the drag"),
        (&diameter, "The mass is the rule's, for the drag"),
        (&[mass, diameter].concat(), ""),
    ] {
        for command in ["analyze", "batch"] {
            for said in told(&[&[command, &drop_wav()], given].concat()) {
                let expected = usize::from(!sentence.is_empty());
                assert!(said.contains(sentence), "{command} {given:?}: {said}");
                assert_eq!(said.matches(all).count(), expected, "{command} {given:?}");
            }
        }
    }
    let [one, other] = ["one.wav", "other.wav"].map(|name| folder.join(name));
    fs::copy(drop_wav(), &one).unwrap();
    fs::copy(drop_wav(), &other).unwrap();
    let table = folder.join("balls.csv");
    fs::write(&table, "file,mass\none.wav,2.7g\nother.wav,\n").unwrap();
    let [folder, table] = [&folder, &table].map(|path| path.to_str().unwrap());
    for said in told(&["batch", folder, "--options", table]) {
        let sentence = "Mass and diameter are the rule's where none is given, for the drag";
        assert!(said.contains(sentence), "{said}");
    }
}
