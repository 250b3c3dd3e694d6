//! A document is read back to the report that it was written from.

use super::json::to_json;
use super::labels::Marked;
use super::*;
use crate::analysis::{analyze_clearest, analyze_labelled};
use crate::rules::{judge, rule};
use crate::synth::presets::preset;
use crate::synth::{Synthetic, render};

fn made(name: &str) -> Synthetic {
    render(&preset(name).unwrap(), 1).unwrap()
}

fn report(made: &Synthetic, settings: Settings, analysis: Analysis) -> Report {
    let sample_rate_hz = f64::from(made.truth.sample_rate_hz);
    let recording = RecordingInfo::new(sample_rate_hz, made.truth.duration_s, "made here");
    Report::new("made.wav".to_owned(), recording, settings, analysis, None)
}

fn heard(name: &str, settings: Settings) -> Report {
    let made = made(name);
    let rate = f64::from(made.truth.sample_rate_hz);
    let (_, analysis) = analyze_clearest(&[&made.samples], rate, &settings).unwrap();
    report(&made, settings, analysis)
}

/// Document to report to the same document.
fn assert_read_back(report: &Report) -> Report {
    let document = to_json(report).unwrap();
    let back: Report = serde_json::from_str(&document).unwrap();
    assert_eq!(to_json(&back).unwrap(), document);
    assert_eq!(&back, report);
    back
}

#[test]
fn documents_with_a_drop_a_rule_and_without_a_drop_are_read_back() {
    let mut settings = Settings::default();
    (settings.height_m, settings.mass_kg) = (Some(0.305), Some(2.7e-3));
    settings.diameter_m = Some(0.04);
    let pingpong = heard("pingpong", settings);
    let ittf = rule("ittf-ball").unwrap();
    let judged = judge(&ittf, &pingpong.drops, ittf.ball(None, None), 9.81).unwrap();
    let back = assert_read_back(&Report {
        rule: Some(judged),
        ..pingpong
    });
    assert!(!back.drops.is_empty() && back.rule.is_some());
    assert_eq!(back.drops[0].model.given, [Given::Drag]);
    // The ball that the document stands for has its e at its speed.
    let e = back.drops[0].restitution.as_ref().unwrap();
    let ball = back.drops[0].ball_model(9.81).unwrap();
    let there = ball.restitution(e.at_speed_m_per_s.unwrap()).unwrap();
    assert!((there.value() - e.estimate.value).abs() < 1e-12);

    let none = assert_read_back(&heard("metronome", Settings::default()));
    assert!(none.drops.is_empty() && !none.warnings.is_empty());
}

#[test]
fn a_document_of_labels_is_read_back_with_its_infinite_evidence() {
    let made = made("basketball");
    let marked = |(i, &time_s): (usize, &f64)| Marked {
        time_s,
        std_s: 1e-4,
        status: Status::Heard,
        by_hand: true,
        line: i + 1,
    };
    let onsets = &made.truth.drops[0].onsets_s;
    let drops = [onsets.iter().take(8).enumerate().map(marked).collect()];
    let (rate, settings) = (f64::from(made.truth.sample_rate_hz), Settings::default());
    let (_, analysis) = analyze_labelled(&[&made.samples], 0, rate, &drops, &settings).unwrap();
    let back = assert_read_back(&report(&made, settings, analysis));
    assert!(back.drops[0].evidence_nats.is_infinite());
    let codes: Vec<WarningCode> = back.drops[0].warnings.iter().map(|w| w.code).collect();
    assert!(codes.contains(&WarningCode::ImpactsGiven), "{codes:?}");
}

#[test]
fn settings_are_those_of_a_document_and_their_absence_is_the_default() {
    let mut settings = Settings::default();
    (settings.model, settings.start_s) = (crate::fit::model_selection::Choice::Linear, Some(1.5));
    let json = serde_json::to_string(&settings).unwrap();
    assert_eq!(serde_json::from_str::<Settings>(&json).unwrap(), settings);
    assert_eq!(
        serde_json::from_str::<Settings>("{}").unwrap(),
        Settings::default()
    );
    let unknown = serde_json::from_str::<Settings>(r#"{"hieght_m": 1.0}"#);
    assert!(unknown.unwrap_err().to_string().contains("hieght_m"));
}
