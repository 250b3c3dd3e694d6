//! One rebound from a known height, judged by a rule and compared between groups: from recordings to the answer.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::{empty_folder, json, only_drop, run, synthesized, text};

/// A tennis ball of this e from 254 cm in air, caught after two impacts, at 22.05 kHz.
fn tennis(folder: &Path, name: &str, e: f64) -> String {
    let scene = format!(
        "name = 'tennis'\nsample_rate_hz = 22050\nduration_s = 3.2\npeak_db = -3.0\nnoise.white_db = -62.0\n\
         [[drops]]\nheight_m = 2.54\nmass_kg = 0.0577\ndiameter_m = 0.067\ndrag = true\nfirst_impact_s = 1.2\n\
         bounce.constant = {{ restitution = {e}, contact_time_s = 5e-3 }}\nmost_impacts = 2\n\
         modes = [{{ frequency_hz = 900.0, decay_s = 4e-3, level = 1.0 }}]\n"
    );
    synthesized(folder, name, &scene)
}

const RULE: [&str; 6] = [
    "--height",
    "254cm",
    "--contact-time",
    "5ms",
    "--rule",
    "itf-tennis",
];

#[test]
fn two_impacts_from_the_rules_height_pass_fail_or_stay_open() {
    let folder = empty_folder("rebound", "rule");
    for (e, status, outcome) in [
        (0.775, 0, "pass"),
        (0.70, 3, "fail"),
        (0.7527, 4, "undecided"),
    ] {
        let wav = tennis(&folder, &format!("e{e}"), e);
        let arguments = [&["analyze", wav.as_str()], &RULE[..]].concat();
        let said = run(&arguments);
        let shown = text(&said.stdout);
        assert_eq!(said.status.code(), Some(status), "{shown}");
        assert!(
            shown.contains("itf-tennis: ") && shown.contains("its own first rebound"),
            "{shown}"
        );
        let document = json(&arguments);
        let judged = &document["rule"]["drops"][0];
        assert_eq!(
            (&judged["outcome"], &judged["evidence"]),
            (&outcome.into(), &"first_rebound".into())
        );
        // ± 0.6 cm, where e of a later bounce could only say ± 4 cm.
        assert!(
            judged["rebound_m"]["std_error"].as_f64().unwrap() < 6e-3,
            "{judged}"
        );
        let first = &only_drop(&document)["first_rebound"];
        let off = (first["restitution"]["value"].as_f64().unwrap() - e).abs();
        assert!(
            off < 2.0 * first["restitution"]["std_error"].as_f64().unwrap(),
            "{first}"
        );
    }
}

#[test]
fn a_lot_is_judged_ball_by_ball_and_read_back_to_the_same() {
    let folder = empty_folder("rebound", "lot");
    for (name, e) in [
        ("a-1", 0.775),
        ("a-2", 0.777),
        ("b-1", 0.775),
        ("b-2", 0.773),
        ("c-1", 0.70),
        ("c-2", 0.70),
    ] {
        tennis(&folder, name, e);
    }
    let recordings = folder.display().to_string();
    let rows = folder.join("rows.csv").display().to_string();
    let batch = |more: &[&str]| {
        let said = run(&[
            &["batch", recordings.as_str(), "--pattern", "{ball}-{n}.wav"],
            &RULE[..],
            more,
        ]
        .concat());
        (said.status.code(), text(&said.stderr))
    };
    let (status, said) = batch(&["-o", &rows]);
    assert_eq!(status, Some(3), "{said}");
    assert!(
        said.contains("Rule itf-tennis: 135 to 147 cm from 254 cm"),
        "{said}"
    );
    assert!(
        said.contains("  lot      fail\n  balls    3 balls: 2 pass and 1 fail\n  fails    c: "),
        "{said}"
    );
    let verdict = |said: &str| {
        said.split_once("Rule itf-tennis")
            .map(|(_, verdict)| verdict.to_owned())
    };
    let (again, read_back) = batch(&["-o", &rows, "--resume"]);
    assert_eq!((again, verdict(&read_back)), (status, verdict(&said)));
    let table = fs::read_to_string(&rows).unwrap();
    assert!(
        table.starts_with("file,") && table.contains(",fail,1.") && table.contains(",pass,1."),
        "{table}"
    );
    for name in ["c-1.wav", "c-2.wav"] {
        fs::remove_file(folder.join(name)).unwrap();
    }
    let (status, said) = batch(&[]);
    assert_eq!(status, Some(0), "{said}");
    // Nobody says which of the recordings are of one ball.
    let said = run(&[&["batch", recordings.as_str()], &RULE[..]].concat());
    let said = text(&said.stderr);
    assert!(
        said.contains("  balls    4 recordings, a ball each: 4 pass ({ball} in --pattern, "),
        "{said}"
    );
}

#[test]
fn groups_are_compared_by_folder_and_by_name() {
    let folder = empty_folder("rebound", "groups");
    for (group, es) in [
        ("cold", [0.70, 0.706, 0.703]),
        ("warm", [0.75, 0.745, 0.748]),
    ] {
        fs::create_dir(folder.join(group)).unwrap();
        for (i, e) in es.into_iter().enumerate() {
            tennis(&folder.join(group), &format!("{group}-{i}"), e);
        }
    }
    let (cold, warm) = (folder.join("cold"), folder.join("warm"));
    let paths = [cold.display().to_string(), warm.display().to_string()];
    let batch = |more: &[&str]| {
        let paths = paths.iter().map(String::as_str);
        let arguments: Vec<&str> = ["batch"]
            .into_iter()
            .chain(paths)
            .chain(["--height", "254cm"])
            .collect();
        let said = run(&[&arguments, more].concat());
        assert_eq!(said.status.code(), Some(0));
        text(&said.stderr)
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
    };
    let by_folder = batch(&["--group", "folder"]);
    assert!(by_folder.contains("Groups compared by e"), "{by_folder}");
    assert!(
        by_folder.contains("warm less ") && by_folder.contains("the difference is real"),
        "{by_folder}"
    );
    let summary = folder.join("summary.json").display().to_string();
    let by_name = batch(&[
        "--group",
        "group",
        "--pattern",
        "{group}-{n}.wav",
        "--summary",
        &summary,
    ]);
    let summary: Value = serde_json::from_str(&fs::read_to_string(&summary).unwrap()).unwrap();
    let difference = &summary["groups"]["differences"][0];
    assert_eq!(
        (&difference["second"], &difference["real"]),
        (&"warm".into(), &true.into())
    );
    assert!((difference["second_less_first"]["value"].as_f64().unwrap() - 0.045).abs() < 0.005);
    assert_eq!(
        (&summary["drops"], &summary["resilience"]["count"]),
        (&6.into(), &6.into())
    );
    assert!(summary["rule"].is_null());
    assert!(by_name.contains("warm less cold: 0.04"), "{by_name}");
    fs::remove_file(warm.join("warm-0.wav")).unwrap();
    fs::remove_file(warm.join("warm-1.wav")).unwrap();
    let few = batch(&["--group", "group", "--pattern", "{group}-{n}.wav"]);
    assert!(
        few.contains("Groups: warm has 1 drop with an e and its error"),
        "{few}"
    );
}

/// A ball of e = 1 − 0.1·v^0.2 without drag from a height, at 22.05 kHz.
fn viscoelastic(folder: &Path, name: &str, height_m: f64) {
    let scene = format!(
        "name = 'sphere'\nsample_rate_hz = 22050\nduration_s = 5.0\npeak_db = -3.0\nnoise.white_db = -70.0\n\
         [[drops]]\nheight_m = {height_m}\nmass_kg = 0.05\ndiameter_m = 0.03\ndrag = false\nfirst_impact_s = 1.0\n\
         bounce.constant = {{ restitution = {}, contact_time_s = 1e-4 }}\nmost_impacts = 8\n\
         modes = [{{ frequency_hz = 1500.0, decay_s = 3e-3, level = 1.0 }}]\n",
        1.0 - 0.1 * (2.0 * 9.81 * height_m).powf(0.1)
    );
    synthesized(folder, name, &scene);
}

#[test]
fn a_curve_over_all_drops_is_told_drawn_and_written() {
    let folder = empty_folder("rebound", "curve");
    let recordings = folder.join("in");
    fs::create_dir(&recordings).unwrap();
    for (i, height_m) in [0.2, 0.4, 0.8, 1.2].into_iter().enumerate() {
        viscoelastic(&recordings, &format!("{i}"), height_m);
    }
    let recordings = recordings.display().to_string();
    let table = folder.join("curve.csv").display().to_string();
    let base = [
        "batch",
        recordings.as_str(),
        "--contact-time",
        "0.1ms",
        "--at-speed",
        "2,30",
    ];
    let said = run(&[&base[..], &["--curve", table.as_str()]].concat());
    let told = text(&said.stderr);
    assert_eq!(said.status.code(), Some(0), "{told}");
    assert!(
        told.contains("e against speed: ") && told.contains(" of 4 drops, "),
        "{told}"
    );
    assert!(
        told.contains("  at 2.00 m/s: e 0.8") && told.contains("beyond the speeds heard"),
        "{told}"
    );
    let rows = fs::read_to_string(&table).unwrap();
    assert!(
        rows.starts_with("speed_m_per_s,restitution,") && rows.lines().count() == 102,
        "{rows}"
    );
    for row in rows.lines().skip(1) {
        let numbers: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        let [_, e, std, low, high] = numbers[..] else {
            panic!("{row}")
        };
        assert!(
            low < e && e < high && std > 0.0 && (0.8..0.95).contains(&e),
            "{row}"
        );
    }
    let picture = folder.join("curve.svg");
    let drawn = run(&[&base[..], &["--curve", &picture.display().to_string()]].concat());
    assert_eq!(drawn.status.code(), Some(0), "{}", text(&drawn.stderr));
    let svg = fs::read_to_string(&picture).unwrap();
    assert!(svg.contains("impact speed (m/s)") && svg.contains("all drops"));
    for (wrong, reason) in [
        (vec!["--at-speed", "0"], "expected a speed above 0"),
        (vec!["--curve", "curve.txt"], "ends in .svg, .png or .csv"),
        (
            vec!["--at-speed", "1", "-o", table.as_str(), "--resume"],
            "cannot be used with",
        ),
    ] {
        let said = run(&[&base[..4], &wrong[..]].concat());
        let told = text(&said.stderr);
        assert!(
            said.status.code() == Some(2) && told.contains(reason),
            "{told}"
        );
    }
    for name in ["2.wav", "3.wav"] {
        fs::remove_file(Path::new(&recordings).join(name)).unwrap();
    }
    let few = run(&base);
    assert!(
        text(&few.stderr).contains("takes three drops"),
        "{}",
        text(&few.stderr)
    );
}

#[test]
fn rows_with_decimal_commas_have_semicolons_between_them() {
    let wav = format!("{}/examples/drop.wav", env!("CARGO_MANIFEST_DIR"));
    let rows = |more: &[&str]| {
        let said = run(&[&["batch", wav.as_str(), "--format", "csv"], more].concat());
        assert_eq!(said.status.code(), Some(0), "{}", text(&said.stderr));
        text(&said.stdout)
    };
    let (points, commas) = (rows(&[]), rows(&["--decimal", "comma"]));
    let cells = |table: &str, mark: char| -> Vec<String> {
        let all = table.lines().flat_map(|line| line.split(mark));
        all.map(|cell| cell.replace(',', ".")).collect()
    };
    assert_eq!(cells(&points, ','), cells(&commas, ';'));
    assert!(
        commas.contains(";0,9") && !commas.contains(";0."),
        "{commas}"
    );
    let impacts = run(&["analyze", &wav, "--format", "csv", "--decimal", "comma"]);
    assert!(
        text(&impacts.stdout).contains(";1;1;0,7002"),
        "{}",
        text(&impacts.stdout)
    );
    let resumed = run(&[
        "batch",
        &wav,
        "--decimal",
        "comma",
        "-o",
        "x.csv",
        "--resume",
    ]);
    assert_eq!(resumed.status.code(), Some(2));
}

#[test]
fn later_bounces_and_the_height_that_reaches_one_are_predicted() {
    let folder = empty_folder("rebound", "predict");
    let path = folder.join("times.csv");
    // e = 0.8 from 1 m, without air.
    let mut time = 0.0;
    let times = (0..9).map(|n| {
        time += 2.0 * (2.0 * 0.64_f64.powi(n) / 9.81).sqrt();
        format!("{time:.6}")
    });
    fs::write(&path, times.collect::<Vec<_>>().join("\n")).unwrap();
    let list = path.display().to_string();
    let asked = [
        "fit",
        &list,
        "--contact-time",
        "1us",
        "--predict",
        "1m",
        "--reach",
        "1m",
    ];
    let document = json(&asked);
    let prediction = &only_drop(&document)["prediction"];
    let second = &prediction["rebounds"]["heights_m"][1];
    assert!(
        (second["value"].as_f64().unwrap() - 0.4096).abs() < 0.01,
        "{second}"
    );
    let from = &prediction["reach"]["drop_height_m"];
    assert!(
        (from["value"].as_f64().unwrap() - 2.441).abs() < 0.05,
        "{from}"
    );
    assert_eq!(prediction["reach"]["bounce"], 2);
    let said = text(&run(&asked).stdout);
    assert!(said.contains("predict  from 100 cm back to 64."), "{said}");
    assert!(
        said.contains("for bounce 2 to reach 100 cm it must fall from 24"),
        "{said}"
    );
    // What is not asked is left out, and what cannot be asked is one sentence.
    assert!(
        only_drop(&json(&["fit", &list]))
            .get("prediction")
            .is_none()
    );
    for (wrong, part) in [
        (&["--predict", "0"][..], "height"),
        (&["--predict", "30.5"], "cm"),
        (&["--reach-bounce", "3"], "--reach"),
        (&["--reach", "1m", "--reach-bounce", "11"], "1..=10"),
    ] {
        let refused = run(&[&["fit", &list], wrong].concat());
        assert_eq!(refused.status.code(), Some(2), "{wrong:?}");
        assert!(
            text(&refused.stderr).contains(part),
            "{}",
            text(&refused.stderr)
        );
    }
}

#[test]
fn compare_says_on_standard_output_what_batch_says_of_its_groups() {
    let folder = empty_folder("rebound", "compare");
    for (group, e) in [("cold", 0.70), ("warm", 0.78)] {
        fs::create_dir(folder.join(group)).unwrap();
        for (i, off) in [-0.004, 0.0, 0.004].into_iter().enumerate() {
            tennis(&folder.join(group), &format!("{i}"), e + off);
        }
    }
    let [cold, warm] = ["cold", "warm"].map(|group| folder.join(group).display().to_string());
    let known = ["--height", "254cm", "--contact-time", "5ms"];
    let compared = run(&[&["compare", &cold, &warm], &known[..]].concat());
    let said = text(&compared.stdout);
    assert_eq!(
        compared.status.code(),
        Some(0),
        "{}",
        text(&compared.stderr)
    );
    assert!(said.starts_with("Groups compared by e"), "{said}");
    assert!(
        said.contains("the difference is") && !said.contains("file,drop"),
        "{said}"
    );
    let batch = run(&[&["batch", &cold, &warm, "--group", "folder"], &known[..]].concat());
    assert!(text(&batch.stderr).ends_with(&said), "{said}");
    // One group is nothing to compare, and rows have no place but a file.
    let one = run(&[&["compare", &cold], &known[..]].concat());
    assert_eq!(one.status.code(), Some(1));
    assert!(text(&one.stdout).contains("there is one only"));
    let rows = run(&["compare", &cold, &warm, "--format", "csv"]);
    assert_eq!(rows.status.code(), Some(2));
    assert!(text(&rows.stderr).contains("-o"), "{}", text(&rows.stderr));
}

#[test]
fn limits_of_ones_own_judge_as_a_rule_does() {
    let folder = empty_folder("rebound", "own");
    let wav = tennis(&folder, "ball", 0.77);
    let judged = |rule: &str| {
        let known = ["--height", "254cm", "--contact-time", "5ms", "--rule", rule];
        run(&[&["analyze", wav.as_str()], &known[..]].concat())
    };
    for (rule, status, said) in [
        ("e=0.75..0.79@254cm,57.7g,67mm", 0, "own: pass; from 254 cm"),
        ("e=0.80..0.85@254cm,57.7g,67mm", 3, "own: fail; from 254 cm"),
        (
            "rebound=135..147cm@254cm,57.7g,67mm",
            0,
            "135 to 147 cm are allowed",
        ),
    ] {
        let output = judged(rule);
        assert_eq!(
            output.status.code(),
            Some(status),
            "{rule} {}",
            text(&output.stderr)
        );
        assert!(
            text(&output.stdout).contains(said),
            "{}",
            text(&output.stdout)
        );
    }
    for (rule, part) in [
        ("e=0.75..0.79@254cm", "mass and diameter"),
        ("itf-golf", "There are ittf-ball, "),
        (
            "tabletennis",
            "Do you mean ittf-ball or ittf-ball-celluloid or ittf-table?",
        ),
    ] {
        let output = judged(rule);
        assert_eq!(output.status.code(), Some(2));
        assert!(
            text(&output.stderr).contains(part),
            "{}",
            text(&output.stderr)
        );
    }
}
