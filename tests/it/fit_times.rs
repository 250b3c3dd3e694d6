//! `bounce-audio fit`: impact times typed in, from the list to the answer.

use std::fs;
use std::path::Path;

use serde_json::Value;

use crate::common::{empty_folder, json, only_drop, piped, run, text};

fn listed(folder: &Path, name: &str, content: &str) -> String {
    let path = folder.join(name);
    fs::write(&path, content).unwrap();
    path.display().to_string()
}

fn e(drop: &Value) -> (f64, f64) {
    let of = &drop["restitution"];
    (
        of["value"].as_f64().unwrap(),
        of["std_error"].as_f64().unwrap(),
    )
}

fn codes(of: &Value) -> Vec<&str> {
    let warnings = of["warnings"].as_array().unwrap();
    warnings
        .iter()
        .map(|w| w["code"].as_str().unwrap())
        .collect()
}

/// Erickson's ping-pong ball (2020): impacts read by hand on a grid of 1 ms. The published ratio of its flights is 0.9451.
const ERICKSON_MS: [u32; 30] = [
    129, 315, 492, 658, 815, 963, 1104, 1234, 1358, 1475, 1586, 1693, 1791, 1886, 1975, 2060, 2138,
    2212, 2282, 2349, 2412, 2472, 2527, 2581, 2631, 2680, 2727, 2771, 2810, 2849,
];

#[test]
fn a_published_list_read_by_hand_gives_its_published_ratio() {
    let folder = empty_folder("fit_times", "erickson");
    let lines: Vec<String> = ERICKSON_MS.iter().map(u32::to_string).collect();
    let path = listed(&folder, "erickson.csv", &lines.join("\n"));
    let document = json(&["fit", &path]);
    let drop = only_drop(&document);
    let ratio = drop["estimates"]["flight_ratio"]["value"].as_f64().unwrap();
    assert!((ratio - 0.9451).abs() < 0.001, "{ratio}");
    let (e, std) = e(drop);
    assert!((e - 0.9451).abs() < 2.0 * std && std < 0.003, "{e} ± {std}");
    assert_eq!(document["recording"]["encoding"], "typed times in ms");
    assert!(codes(drop).contains(&"impacts_given"));
}

/// The paper's ping-pong ball: 30.5 cm, 70 bounces in 7.5 s, which by its Figure 4 is e = 0.93. Its flights and contacts, as
/// equation (25) has them, are typed in.
#[test]
fn the_ball_of_the_paper_typed_in_has_its_e_and_total_time() {
    let folder = empty_folder("fit_times", "paper");
    let solved = json(&[
        "solve",
        "--bounces",
        "70",
        "--total-time",
        "7.5s",
        "--height",
        "30.5cm",
    ]);
    let of = |name: &str| solved["eq25"][name].as_f64().unwrap();
    let (e25, contact_s) = (of("restitution"), of("contact_time_s"));
    assert!((e25 - 0.93).abs() < 0.005, "{e25}");
    let fall_s = (2.0_f64 * 0.305 / 9.81).sqrt();
    let mut at_s = fall_s;
    let mut lines = vec!["t [s]".to_owned()];
    for n in 1..=70 {
        lines.push(format!("{at_s:.4}").replace('.', ","));
        at_s += 2.0 * fall_s * e25.powi(n) + contact_s;
    }
    let path = listed(&folder, "paper.csv", &lines.join("\n"));
    let document = json(&["fit", &path, "--height", "30.5cm", "--time-error", "0.05ms"]);
    let drop = only_drop(&document);
    let (e, std) = e(drop);
    assert!((e - e25).abs() < 0.003 && std < 0.003, "{e} ± {std}");
    let eq25 = drop["estimates"]["eq25"]["value"].as_f64().unwrap();
    assert!((eq25 - e25).abs() < 0.002, "{eq25}");
    let total_s = drop["total_time_s"].as_f64().unwrap();
    assert!((total_s - 7.5).abs() < 0.05, "{total_s}");
}

/// Gravity in m/s² for a ball of which nothing is known, which displaces 0.6 % of its mass: `g·(1 − β)/(1 + β/2)`.
const IN_AIR: f64 = 9.81 * 0.994 / 1.003;

/// Times of a published acoustic stopwatch: 0.7 m, first impacts 0.248, 0.955 and 1.617 s.
#[test]
fn three_times_with_a_height_give_e_of_the_first_impact() {
    let folder = empty_folder("fit_times", "three");
    let path = listed(&folder, "three.csv", "time_s\n0.248\n0.955\n1.617\n");
    let document = json(&["fit", &path, "--height", "0.7m"]);
    let drop = only_drop(&document);
    assert_eq!(drop["restitution"]["method"], "first_rebound");
    // √(g·T₁²/8h), and the ratio of the flights.
    let (first, ratio) = (0.707 * (IN_AIR / 5.6).sqrt(), 0.662 / 0.707);
    let (e, std) = e(drop);
    assert!(
        (e - first).abs() < 1e-6 && (e - ratio).abs() < 2.0 * std,
        "{e} ± {std}"
    );
}

#[test]
fn what_a_recording_gives_its_times_typed_in_give_again() {
    let folder = empty_folder("fit_times", "again");
    let wav = format!("{}/examples/drop.wav", env!("CARGO_MANIFEST_DIR"));
    let heard = json(&["analyze", &wav, "--height", "30.5cm"]);
    let times = heard["drops"][0]["impacts"].as_array().unwrap();
    let lines: Vec<String> = times.iter().map(|i| i["time_s"].to_string()).collect();
    let path = listed(&folder, "again.txt", &lines.join("\n"));
    let fitted = json(&["fit", &path, "--height", "30.5cm", "--time-error", "0.5us"]);
    let ((heard, std), (typed, _)) = (e(&heard["drops"][0]), e(only_drop(&fitted)));
    assert!((heard - typed).abs() < std, "{heard} ± {std}, {typed}");
}

#[test]
fn several_drops_come_from_standard_input_with_decimal_commas() {
    let list = b"drop;flight [ms]\nred;812,5\nred;731\nblue;650,2\nblue;520\n";
    let folder = empty_folder("fit_times", "piped");
    let mut arguments = vec!["fit", "-", "--height", "1m"];
    let said = piped(&folder, &arguments, list);
    let said = text(&said.stdout);
    assert!(
        said.starts_with("-: 2 drops") && said.contains("1 is red, 2 is blue"),
        "{said}"
    );
    arguments.extend(["--format", "json"]);
    let document: Value = serde_json::from_slice(&piped(&folder, &arguments, list).stdout).unwrap();
    let encoding = &document["recording"]["encoding"];
    assert_eq!(encoding, "typed intervals in ms, with decimal commas");
    let first = 0.8125 * (IN_AIR / 8.0).sqrt();
    assert!((e(&document["drops"][0]).0 - first).abs() < 1e-9);
}

#[test]
fn the_error_of_a_time_is_that_of_its_rounding_if_that_is_more() {
    let folder = empty_folder("fit_times", "rounding");
    let path = listed(&folder, "coarse.txt", "0.0\n0.8\n1.5\n2.1\n2.6\n");
    let std = |extra: &[&str]| {
        let document = json(&[&["fit", path.as_str()], extra].concat());
        document["drops"][0]["impacts"][0]["time_std_s"]
            .as_f64()
            .unwrap()
    };
    assert!((std(&[]) - 0.1 / 12.0_f64.sqrt()).abs() < 1e-12);
    assert!((std(&["--time-error", "5ms"]) - 5e-3).abs() < 1e-12);
    let fine = listed(&folder, "fine.txt", "0.00000\n0.80000\n1.50000\n");
    let document = json(&["fit", &fine]);
    assert_eq!(document["drops"][0]["impacts"][0]["time_std_s"], 1e-3);
}

#[test]
fn what_cannot_be_fitted_is_said_in_a_sentence_with_its_line() {
    let folder = empty_folder("fit_times", "refused");
    for (content, said) in [
        ("", "line 1: there are no times in it"),
        ("0\n0.5\n0.4\n0.9\n", "line 3: times grow from line to line"),
        ("0,523\n0,418\n", "line 1: '0,523' may be one number"),
        ("time\n0.5\n", "line 2: one time bounds no flight"),
    ] {
        let path = listed(&folder, "wrong.csv", content);
        let output = run(&["fit", &path]);
        let error = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{error}");
        assert!(
            error.contains("wrong.csv: ") && error.contains(said),
            "{error}"
        );
        assert_eq!(error.lines().count(), 1, "{error}");
    }
    let missing = run(&["fit", "nowhere.csv"]);
    assert_eq!(missing.status.code(), Some(2));
    assert!(text(&missing.stderr).contains("nowhere.csv"));
    let path = listed(&folder, "comma.csv", "0,523\n0,418\n0,334\n");
    assert!(run(&["fit", &path, "--decimal", "comma"]).status.success());
}

#[test]
fn a_rule_has_the_exit_status_of_its_verdict() {
    let folder = empty_folder("fit_times", "rule");
    // Flights of a tennis ball from 254 cm whose rebounds are 142, 120 and 136.5 cm.
    for (flight, status) in [("1.0760", 0), ("0.9892", 3)] {
        let path = listed(&folder, "rule.txt", flight);
        let arguments = [
            "fit",
            &path,
            "--height",
            "254cm",
            "--contact-time",
            "5ms",
            "--rule",
            "itf-tennis",
            "--time-error",
            "0.1ms",
        ];
        let output = run(&arguments);
        assert_eq!(
            output.status.code(),
            Some(status),
            "{}",
            text(&output.stdout)
        );
    }
}

#[test]
fn a_clock_that_runs_at_another_rate_is_scaled_and_one_of_unknown_rate_is_in_the_error() {
    let folder = empty_folder("fit_times", "clock");
    let slow = listed(&folder, "slow.txt", "6.56\n5.28\n4.24\n3.36\n");
    let fast = listed(&folder, "fast.txt", "0.82\n0.66\n0.53\n0.42\n");
    let fit = |path: &str, more: &[&str]| {
        let document =
            json(&[&["fit", path, "--height", "1m", "--as", "intervals"], more].concat());
        document["drops"][0].clone()
    };
    let scaled = fit(&slow, &["--time-scale", "8", "--time-error", "8ms"]);
    let plain = fit(&fast, &["--time-error", "1ms"]);
    let near = |a: &Value, b: &Value| (a.as_f64().unwrap() - b.as_f64().unwrap()).abs() < 1e-9;
    for field in ["value", "std_error"] {
        assert!(
            near(&scaled["restitution"][field], &plain["restitution"][field]),
            "{field}"
        );
    }
    let std = |drop: &Value| {
        drop["first_rebound"]["resilience"]["std_error"]
            .as_f64()
            .unwrap()
    };
    let doubted = fit(&fast, &["--time-error", "1ms", "--clock-error", "1%"]);
    let share = plain["first_rebound"]["resilience"]["value"]
        .as_f64()
        .unwrap();
    assert!((std(&doubted) / std(&plain).hypot(0.02 * share) - 1.0).abs() < 1e-3);
    let too_long = fit(&slow, &[]);
    let warnings = too_long["warnings"].to_string();
    assert!(
        warnings.contains("the clock runs wrong, as that of a slowed recording does"),
        "{warnings}"
    );
}

#[test]
fn a_recording_in_slow_motion_gives_what_it_gave_at_its_own_speed() {
    let folder = empty_folder("fit_times", "slow");
    let scene = "name = 'slow'\nsample_rate_hz = 32000\nduration_s = 4.0\nnoise.white_db = -60.0\n[[drops]]\n\
                 height_m = 0.5\nmass_kg = 0.03\ndiameter_m = 0.02\nfirst_impact_s = 0.5\n\
                 bounce.constant = { restitution = 0.8, contact_time_s = 5e-4 }\n\
                 modes = [{ frequency_hz = 2000.0, decay_s = 4e-3, level = 1.0 }]\n";
    let wav = crate::common::synthesized(&folder, "own", scene);
    let mut bytes = fs::read(&wav).unwrap();
    // The same samples at an eighth of the rate: samples and bytes a second, in the format chunk.
    for place in [24, 28] {
        let rate = u32::from_le_bytes(bytes[place..place + 4].try_into().unwrap());
        bytes[place..place + 4].copy_from_slice(&(rate / 8).to_le_bytes());
    }
    let slow = folder.join("slow.wav").display().to_string();
    fs::write(&slow, bytes).unwrap();
    let own = json(&["analyze", &wav, "--height", "50cm", "--start", "0.1"]);
    let scaled = json(&[
        "analyze",
        &slow,
        "--height",
        "50cm",
        "--start",
        "0.8",
        "--time-scale",
        "8",
    ]);
    assert_eq!(own["drops"], scaled["drops"]);
    assert_eq!(
        own["recording"]["duration_s"],
        scaled["recording"]["duration_s"]
    );
    let picture = folder.join("slow.svg").display().to_string();
    let drawn = run(&["analyze", &slow, "--time-scale", "8", "--plot", &picture]);
    assert_eq!(drawn.status.code(), Some(0), "{}", text(&drawn.stderr));
    let labelled = run(&["analyze", &slow, "--time-scale", "8", "--labels", "x.txt"]);
    assert_eq!(
        labelled.status.code(),
        Some(2),
        "{}",
        text(&labelled.stderr)
    );
}
