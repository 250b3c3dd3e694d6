//! `bounce-audio solve` as a user runs it: the paper's ball, errors, and every wrong argument.

use serde_json::Value;

use crate::common::{run, text};

const PAPER: [&str; 9] = [
    "solve",
    "--bounces",
    "70",
    "--total-time",
    "7.5s",
    "--height",
    "30.5cm",
    "--mass",
    "2.5g",
];

fn spoken(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(output.stderr.is_empty());
    text(&output.stdout)
}

fn json(arguments: &[&str]) -> Value {
    let document = spoken(&[arguments, &["--format", "json"]].concat());
    serde_json::from_str(&document).unwrap_or_else(|e| panic!("{e}: {document}"))
}

fn number(document: &Value, path: &str) -> f64 {
    let found = document.pointer(path);
    found
        .and_then(Value::as_f64)
        .unwrap_or_else(|| panic!("{path} is {found:?}"))
}

fn codes(document: &Value) -> Vec<&str> {
    let warnings = document["warnings"].as_array().unwrap();
    assert!(
        warnings
            .iter()
            .all(|w| w["message"].as_str().unwrap().len() > 20)
    );
    warnings
        .iter()
        .map(|w| w["code"].as_str().unwrap())
        .collect()
}

/// Fails unless the number at `path` rounds to `printed`, whose last digit is worth `unit`.
fn rounds_to(document: &Value, path: &str, printed: f64, unit: f64) {
    let value = number(document, path);
    assert!(
        (value - printed).abs() <= 0.5 * unit,
        "{path}: {value} is not {printed}"
    );
}

#[test]
fn the_papers_drop_gives_the_papers_ball() {
    let document = json(&PAPER);
    for (path, printed, unit) in [
        ("/eq25/restitution", 0.93347, 1e-5),
        ("/eq30/restitution", 0.93564, 1e-5),
        ("/eq25/contact_time_s", 4.474e-3, 1e-6),
        ("/conditioning/restitution_rounded", 0.93, 1e-9),
        ("/conditioning/contact_time_rounded_s", 3.447e-3, 1e-6),
        ("/conditioning/contact_time_per_restitution", 70.0, 0.1),
        ("/inputs/height_m", 0.305, 1e-9),
    ] {
        rounds_to(&document, path, printed, unit);
    }
    assert_eq!(document["eq25"]["release_rule"], "zero_displacement");
    assert_eq!(document["eq25"]["rest"]["impacts_by_eq19"], 70);
    for null in ["/with_contact_time", "/eq25/std_error", "/eq30/std_error"] {
        assert!(document.pointer(null).unwrap().is_null(), "{null}");
    }
    for code in [
        "contact_time_ill_conditioned",
        "bounces_are_a_lower_bound",
        "rest_is_assumed",
        "release_rule",
    ] {
        assert!(codes(&document).contains(&code), "{code}");
    }
}

#[test]
fn the_papers_contact_gives_the_papers_ball() {
    for (contact, expected) in [
        (
            "3.4ms",
            [
                ("stiffness_per_mass_per_s2", 8.542e5, 1e2),
                ("stiffness_n_per_m", 2.136e3, 1.0),
                ("damping_per_mass_per_s", 42.69, 1e-2),
                ("damping_n_s_per_m", 0.1067, 1e-4),
                ("natural_frequency_rad_per_s", 924.2, 0.1),
                ("natural_frequency_hz", 147.1, 0.1),
                ("damping_ratio", 0.02309, 1e-5),
            ],
        ),
        (
            "1ms",
            [
                ("stiffness_per_mass_per_s2", 9.875e6, 1e3),
                ("stiffness_n_per_m", 24.69e3, 10.0),
                ("damping_per_mass_per_s", 145.1, 0.1),
                ("damping_n_s_per_m", 0.3629, 1e-4),
                ("natural_frequency_rad_per_s", 3142.0, 1.0),
                ("natural_frequency_hz", 500.1, 0.1),
                ("damping_ratio", 0.02309, 1e-5),
            ],
        ),
    ] {
        let document = json(&[
            "solve",
            "--restitution",
            "0.93",
            "--contact-time",
            contact,
            "--mass",
            "2.5g",
        ]);
        for (field, printed, unit) in expected {
            rounds_to(&document, &format!("/ball/{field}"), printed, unit);
        }
        assert!(document["ball"]["rest"].is_null());
    }
}

#[test]
fn a_contact_time_beside_the_drop_counts_the_bounces_that_were_not_heard() {
    let document = json(&[&PAPER[..], &["--contact-time", "1ms"]].concat());
    let rest = &document["conditioning"]["rest_at_given_contact_time"];
    assert_eq!(
        (&rest["impacts_by_eq19"], &rest["impacts_exact"]),
        (&92.into(), &86.into())
    );
    rounds_to(&document, "/with_contact_time/contact_time_s", 1e-3, 1e-12);
    rounds_to(&document, "/with_contact_time/restitution", 0.93567, 1e-5);
    assert!(codes(&document).contains(&"contact_times_disagree"));

    let too_long = json(&[&PAPER[..], &["--contact-time", "2s"]].concat());
    assert!(too_long["with_contact_time"].is_null());
    assert!(codes(&too_long).contains(&"contact_time_does_not_fit"));
}

#[test]
fn the_text_answers_first_and_then_says_how_safe_it_is() {
    let page = spoken(&PAPER);
    let lines: Vec<&str> = page.lines().collect();
    assert!(
        lines[0].contains("0.305 m") && lines[0].contains("70 bounces"),
        "{page}"
    );
    assert!(
        lines[3].contains("restitution") && lines[3].contains("0.93347"),
        "{page}"
    );
    for part in [
        "4.474",
        "N/mm",
        "N·s/m",
        "rad/s",
        "70 by (19), 64 exact",
        "3.447 ms",
        "70-fold",
        "lower bound",
        "x = 0",
    ] {
        assert!(page.contains(part), "{part} is missing:\n{page}");
    }
    let longest = page.lines().map(|line| line.chars().count()).max();
    assert!(longest <= Some(102), "{longest:?}");
    let bare = spoken(&PAPER[..7]);
    assert!(bare.contains("--mass") && !bare.contains("N/mm"), "{bare}");
}

#[test]
fn without_a_mass_stiffness_and_damping_are_null() {
    let document = json(&PAPER[..7]);
    assert!(document["eq25"]["stiffness_n_per_m"].is_null());
    assert!(document["eq25"]["damping_n_s_per_m"].is_null());
    assert!(number(&document, "/eq25/stiffness_per_mass_per_s2") > 0.0);
}

#[test]
fn what_underflows_is_null() {
    let many = [
        "solve",
        "--bounces",
        "1000000000",
        "--total-time",
        "7.5",
        "--height",
        "0.305",
    ];
    let document = json(&many);
    assert!(document["eq25"]["contact_time_s"].is_null());
    assert!(document["eq25"]["natural_frequency_rad_per_s"].is_null());
    assert!(document["eq25"]["rest"].is_null());
    rounds_to(&document, "/eq25/damping_ratio", 0.02117, 1e-5);
}

const FIELDS: [&str; 9] = [
    "restitution",
    "contact_time_s",
    "stiffness_n_per_m",
    "damping_n_s_per_m",
    "stiffness_per_mass_per_s2",
    "damping_per_mass_per_s",
    "natural_frequency_rad_per_s",
    "natural_frequency_hz",
    "damping_ratio",
];

/// Arguments with one value moved by `steps` of a small step.
fn moved(arguments: &[(&str, f64, f64)], which: usize, steps: f64) -> Vec<String> {
    let mut words = vec!["solve".to_owned()];
    for (i, (name, value, error)) in arguments.iter().enumerate() {
        let shift = if i == which {
            steps * 1e-3 * error
        } else {
            0.0
        };
        words.extend([(*name).to_owned(), (value + shift).to_string()]);
    }
    words
}

/// Each error against the central differences of the values, added in squares.
fn errors_are_those_of_differences(fixed: &[&str], arguments: &[(&str, f64, f64)], block: &str) {
    let solve = |which: usize, steps: f64| {
        let words = moved(arguments, which, steps);
        json(
            &[
                words.iter().map(String::as_str).collect::<Vec<_>>(),
                fixed.to_vec(),
            ]
            .concat(),
        )
    };
    let mut words = moved(arguments, 0, 0.0);
    for (name, _, error) in arguments {
        words.extend([format!("{name}-error"), error.to_string()]);
    }
    let with_errors = json(
        &[
            words.iter().map(String::as_str).collect::<Vec<_>>(),
            fixed.to_vec(),
        ]
        .concat(),
    );
    for field in FIELDS {
        let path = format!("/{block}/{field}");
        let expected = (0..arguments.len())
            .map(|i| number(&solve(i, 1.0), &path) - number(&solve(i, -1.0), &path))
            .fold(0.0, |sum: f64, difference| sum.hypot(difference / 2e-3));
        let got = number(&with_errors, &format!("/{block}/std_error/{field}"));
        assert!(
            (got - expected).abs() <= 1e-5 * expected.max(1e-12),
            "{path}: {got}, by differences {expected}"
        );
    }
}

#[test]
fn errors_of_the_drop_are_propagated() {
    let drop = [
        ("--total-time", 7.5, 0.05),
        ("--height", 0.305, 0.001),
        ("--gravity", 9.81, 0.02),
        ("--mass", 0.0025, 0.000_01),
    ];
    for block in ["eq25", "eq30"] {
        errors_are_those_of_differences(&["--bounces", "70"], &drop, block);
    }
    let with_contact = [&drop[..], &[("--contact-time", 0.001, 0.0002)]].concat();
    errors_are_those_of_differences(&["--bounces", "70"], &with_contact, "with_contact_time");
}

#[test]
fn errors_of_the_contact_are_propagated() {
    let contact = [
        ("--restitution", 0.93, 0.01),
        ("--contact-time", 0.001, 0.000_05),
        ("--mass", 0.0025, 0.000_01),
    ];
    errors_are_those_of_differences(&[], &contact, "ball");
}

#[test]
fn a_large_error_of_the_contact_time_is_said() {
    let rough = json(&[&PAPER[..], &["--total-time-error", "0.7s"]].concat());
    assert!(codes(&rough).contains(&"contact_time_uncertain"));
    let fine = json(&[&PAPER[..], &["--total-time-error", "10ms"]].concat());
    assert!(!codes(&fine).contains(&"contact_time_uncertain"));
}

#[test]
fn no_root_is_one_line_with_what_can_be_reached() {
    for total in ["0.2s", "80s"] {
        let arguments = [
            "solve",
            "--bounces",
            "70",
            "--total-time",
            total,
            "--height",
            "30.5cm",
        ];
        let output = run(&arguments);
        let error = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{error}");
        assert!(output.stdout.is_empty());
        assert_eq!(error.lines().count(), 1, "{error}");
        assert!(
            error.contains("0.24936") && error.contains("73.437"),
            "{error}"
        );
    }
}

#[test]
fn wrong_arguments_name_themselves() {
    let contact = ["--restitution", "0.9", "--contact-time", "1ms"];
    let drop = &PAPER[1..];
    for (arguments, expected) in [
        (vec![], "--bounces"),
        (vec!["--bounces", "70"], "--total-time"),
        (vec!["--bounces", "70", "--total-time", "7.5"], "--height"),
        (vec!["--total-time", "7.5"], "--bounces"),
        (vec!["--restitution", "0.9"], "--contact-time"),
        (vec!["--contact-time", "1ms"], "--restitution"),
        ([drop, &contact[..2]].concat(), "--restitution"),
        (
            [&contact[..], &["--total-time", "7"]].concat(),
            "--total-time",
        ),
        (
            [&contact[..], &["--height-error", "1mm"]].concat(),
            "--height-error",
        ),
        (
            [&contact[..], &["--gravity-error", "1"]].concat(),
            "--gravity-error",
        ),
        ([&contact[..], &["--mass-error", "1g"]].concat(), "--mass"),
        (
            [drop, &["--restitution-error", "0.1"]].concat(),
            "--restitution",
        ),
        (
            [drop, &["--contact-time-error", "1ms"]].concat(),
            "--contact-time",
        ),
        (
            [drop, &["--contact-time", "-1ms"]].concat(),
            "--contact-time is -0.001",
        ),
        ([drop, &["--gravity", "0"]].concat(), "--gravity is 0"),
        (
            [drop, &["--total-time-error", "-1"]].concat(),
            "--total-time-error is -1",
        ),
        (
            [drop, &["--mass-error", "-1g"]].concat(),
            "--mass-error is -0.001",
        ),
        ([&contact[..], &["--mass", "0"]].concat(), "--mass is 0"),
        (
            [&contact[..], &["--height", "-1cm"]].concat(),
            "--height is -0.01",
        ),
        (
            [&contact[..], &["--contact-time-error", "-1"]].concat(),
            "--contact-time-error is -1",
        ),
        (
            [&contact[..], &["--restitution-error", "-1"]].concat(),
            "--restitution-error is -1",
        ),
        ([&contact[..], &["--format", "csv"]].concat(), "json"),
        (
            vec!["--restitution", "1", "--contact-time", "1ms"],
            "--restitution is 1",
        ),
        (
            vec!["--restitution", "nan", "--contact-time", "1ms"],
            "restitution is 'nan', expected a share such as 0.93",
        ),
        (vec!["--restitution", "0.9", "--contact-time", "1g"], "1ms"),
        (
            vec!["--bounces", "0", "--total-time", "1", "--height", "1"],
            "--bounces is 0",
        ),
        (
            vec!["--bounces", "2.5", "--total-time", "1", "--height", "1"],
            "--bounces",
        ),
        (
            vec!["--bounces", "2", "--total-time", "1", "--height", "1kg"],
            "30.5cm",
        ),
    ] {
        let output = run(&[&["solve"], &arguments[..]].concat());
        let error = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
        assert!(error.contains(expected), "{arguments:?}: {error}");
    }
}

#[test]
fn help_shows_both_ways() {
    let help = spoken(&["solve", "--help"]);
    assert!(help.contains("--bounces 70 --total-time 7.5s") && help.contains("--restitution 0.93"));
}
