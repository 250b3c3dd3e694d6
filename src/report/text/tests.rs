//! What the text of a report holds at each level of detail.

use super::*;
use crate::fit::Estimate;
use crate::report::{Analysis, Method, RecordingInfo, Restitution, Settings};

fn drop_of(value: f64, std: f64, bounces: usize) -> Drop {
    let estimate = Estimate {
        value,
        std_error: Some(std),
        interval95: Some([value - 2.0 * std, value + 2.0 * std]),
    };
    Drop {
        bounces,
        observed_time_s: 5.81,
        evidence_nats: 6.0,
        restitution: Some(Restitution {
            estimate,
            at_speed_m_per_s: Some(0.186),
            method: Method::LeastSquares,
        }),
        ..Drop::empty()
    }
}

fn report(drops: Vec<Drop>) -> Report {
    let analysis = Analysis {
        drops,
        candidate: None,
        rejected: Vec::new(),
        rejected_weak: 0,
        warnings: Vec::new(),
    };
    let recording = RecordingInfo::new(44_100.0, 8.0, "made here");
    Report::new(
        "my drop.wav".to_owned(),
        recording,
        Settings::default(),
        analysis,
        None,
    )
}

#[test]
fn the_first_line_is_the_answer() {
    let said = to_text(&report(vec![drop_of(0.929_42, 0.000_7, 67)]), Detail::Usual);
    let mut lines = said.lines();
    assert_eq!(
        lines.next().unwrap(),
        "my drop.wav: e = 0.9294 ± 0.0007 (67 bounces in 5.8 s)"
    );
    let rest: Vec<&str> = lines.collect();
    assert_eq!(
        rest,
        [
            "  range    0.9280 to 0.9308 with 95 % confidence, for impacts at 0.19 m/s",
            "  odds     400 to 1 that this is a drop and not chance",
        ]
    );
}

#[test]
fn a_shell_reads_a_line_per_drop() {
    let mut late = drop_of(0.9, 0.012, 5);
    late.warnings = vec![
        Warning::new(WarningCode::LateStart, "…"),
        Warning::new(WarningCode::FewImpacts, "…"),
    ];
    let bare = Drop {
        bounces: 2,
        ..Drop::empty()
    };
    let said = to_text(&report(vec![late, bare]), Detail::Answer);
    assert_eq!(
        said,
        "0.900 0.012 5 5.8100 late_start,few_impacts my drop.wav\n- - 2 0.0000 - my drop.wav\n"
    );
    assert_eq!(to_text(&report(Vec::new()), Detail::Answer), "");
}

#[test]
fn several_drops_have_a_line_each_then_their_mean() {
    let said = to_text(
        &report(vec![
            drop_of(0.929_42, 0.000_7, 67),
            drop_of(0.95, 0.014, 1),
        ]),
        Detail::Usual,
    );
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines[0], "my drop.wav: 2 drops");
    assert_eq!(
        lines[1],
        "    1  e = 0.9294 ± 0.0007  67 bounces in 5.8 s, from 0.0 s"
    );
    assert_eq!(
        lines[2],
        "    2  e = 0.950 ± 0.014    1 bounce in 5.8 s, from 0.0 s"
    );
    let words = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        words.contains("mean e 0.9") && words.contains("for 1 degree of freedom"),
        "{said}"
    );
}

#[test]
fn a_warning_is_said_once_with_its_drops_and_what_to_do() {
    let warned = |message: &str| Drop {
        warnings: vec![Warning::new(WarningCode::ModelsAlike, message)],
        ..drop_of(0.9, 0.01, 9)
    };
    let report = report(vec![
        warned("alike"),
        warned("other"),
        warned("alike"),
        warned("alike"),
    ]);
    let advice = |code| (code == WarningCode::ModelsAlike).then_some("--mass");
    let said = to_text_with(&report, Detail::Usual, &advice);
    assert!(
        said.contains("\nWarning: drops 1, 3 and 4: alike (--mass)\n"),
        "{said}"
    );
    assert!(
        said.ends_with("\nWarning: drop 2: other (--mass)\n"),
        "{said}"
    );
}

#[test]
fn what_was_rejected_is_told_like_by_like_with_every_time() {
    let rejected = |time_s: f64, detail: &str| Rejected {
        time_s,
        detail: detail.to_owned(),
        reason: crate::report::RejectReason::Echo,
    };
    let mut report = report(Vec::new());
    report.rejected = vec![
        rejected(0.5, "a knock"),
        rejected(1.0, "an echo"),
        rejected(2.0, "an echo"),
    ];
    let said = to_text(&report, Detail::Everything);
    assert!(
        said.ends_with(
            "\nRejected in the recording: 3\n  an echo: 1.0000, 2.0000 s\n  a knock: 0.5000 s\n"
        ),
        "{said}"
    );
    assert!(!to_text(&report, Detail::Usual).contains("Rejected"));
}
