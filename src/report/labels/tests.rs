//! Labels are read back as they were written, and changes by a person are noticed.

use super::*;
use crate::report::{Bounce, Impact, Status};

const FORMS: [Form; 3] = [Form::Audacity, Form::Instants, Form::TextGrid];
const BY_HAND_S: f64 = 1e-3;

fn impact(time_s: f64, status: Status) -> Impact {
    let heard = status != Status::Inferred;
    Impact {
        time_s,
        time_std_s: heard.then_some(1.0 / 3.0 * 1e-7),
        level_db: heard.then_some(-3.456),
        interval_s: None,
        ratio: None,
        rebound_height_m: None,
        rebound_height_std_m: None,
        bounce: Bounce::default(),
        status,
    }
}

fn two_drops() -> [[Impact; 3]; 2] {
    let drop = |from_s: f64| {
        [
            impact(from_s + 1.0 / 3.0, Status::Heard),
            impact(from_s + 0.7, Status::Inferred),
            impact(from_s + 0.1_f64.sqrt() + 0.6, Status::Doubtful),
        ]
    };
    [drop(1.0), drop(11.0)]
}

fn labels(drops: &[[Impact; 3]], form: Form) -> String {
    let drops: Vec<&[Impact]> = drops.iter().map(<[Impact; 3]>::as_slice).collect();
    to_labels(&drops, 20.0, form)
}

fn marked(text: &str, form: Form) -> Vec<Vec<Marked>> {
    drops(&read(text.as_bytes(), form).unwrap(), form, BY_HAND_S).unwrap()
}

#[test]
fn what_is_written_is_read_back_to_the_last_digit() {
    let written = two_drops();
    for form in FORMS {
        let back = marked(&labels(&written, form), form);
        assert_eq!(back.len(), 2, "{form:?}");
        for (drop, back) in written.iter().zip(&back) {
            assert_eq!(drop.len(), back.len());
            for (impact, back) in drop.iter().zip(back) {
                assert_eq!(impact.time_s, back.time_s, "{form:?}");
                assert_eq!(impact.time_std_s.unwrap_or(0.0), back.std_s);
                assert_eq!((impact.status, false), (back.status, back.by_hand));
            }
        }
    }
}

#[test]
fn a_label_that_a_tool_rounded_is_not_moved_and_one_that_was_is() {
    let text = "17 heard -3.4 dB at 1.1564341234567 ±1.3e-8 s";
    let at = |time: &str| marked(&format!("{time}\t{time}\t{text}\n"), Form::Audacity)[0][0];
    let rounded = at("1.156434");
    assert_eq!(
        (rounded.time_s, rounded.std_s),
        (1.156_434_123_456_7, 1.3e-8)
    );
    let moved = at("1.156437");
    assert_eq!((moved.time_s, moved.std_s), (1.156_437, BY_HAND_S));
    assert!(moved.by_hand && !rounded.by_hand);
    // An inferred impact that was moved to where it is seen counts as heard.
    let set = "2\t2\t5 inferred at 1.9 s\n";
    assert_eq!(marked(set, Form::Audacity)[0][0].status, Status::Heard);
}

#[test]
fn a_person_may_write_what_they_like() {
    let text = "0.5\t0.5\n1,0\t1,0\tsecond ±2e-4\n\\\t100\t200\n1.4\t1.5\tinferred\n1.7\t1.7\t\n";
    let drop = &marked(text, Form::Audacity)[0];
    let times: Vec<f64> = drop.iter().map(|m| m.time_s).collect();
    assert_eq!(times, [0.5, 1.0, 1.4, 1.7]);
    let stds: Vec<f64> = drop.iter().map(|m| m.std_s).collect();
    assert_eq!(stds, [BY_HAND_S, 2e-4, 0.0, BY_HAND_S]);
    assert_eq!(drop[2].status, Status::Inferred);
    assert!(drop.iter().all(|m| m.by_hand));
    let table = "TIME,LABEL\n0.5,\"a \"\"quote\"\"\"\n1.25,\n";
    assert_eq!(marked(table, Form::Instants)[0].len(), 2);
}

#[test]
fn a_label_without_a_drop_is_of_the_nearest() {
    let text = "1\t1\t1:1\n1.4\t1.4\t1:2\n1.6\t1.6\tnew\n9\t9\tnew\n10\t10\t2:1\n10.5\t10.5\t2:2\n";
    let drops = marked(text, Form::Audacity);
    let times = |d: usize| drops[d].iter().map(|m| m.time_s).collect::<Vec<_>>();
    assert_eq!(times(0), [1.0, 1.4, 1.6]);
    assert_eq!(times(1), [9.0, 10.0, 10.5]);
}

#[test]
fn errors_name_the_line() {
    for (text, form, line, words) in [
        ("1\t1\ta\none\ttwo\n", Form::Audacity, 2, "'one' is no time"),
        ("\n-1\t-1\ta\n", Form::Audacity, 2, "before the recording"),
        ("inf\t1\ta\n", Form::Audacity, 1, "'inf' is no time"),
        ("1\t1\ta ±oops\n", Form::Audacity, 1, "'±oops'"),
        ("1\t1\ta ±0\n", Form::Audacity, 1, "'±0'"),
        (
            "2\t2\ta\n1\t1\tb\n2\t2\tc\n",
            Form::Audacity,
            3,
            "already, in line 1",
        ),
        ("1,a\nb,1\n", Form::Instants, 2, "'b' is no time"),
        ("nothing", Form::TextGrid, 1, "TextGrid"),
        (
            "\"TextTier\"\nnumber = x\n",
            Form::TextGrid,
            2,
            "'x' is no time",
        ),
    ] {
        let result = read(text.as_bytes(), form).and_then(|labels| drops(&labels, form, BY_HAND_S));
        let error = result.unwrap_err().to_string();
        assert!(
            error.starts_with(&format!("line {line}: ")) && error.contains(words),
            "{error}"
        );
    }
}

#[test]
fn a_text_grid_has_the_lines_that_praat_reads() {
    let grid = labels(&two_drops(), Form::TextGrid);
    for line in [
        "File type = \"ooTextFile\"",
        "Object class = \"TextGrid\"",
        "        class = \"TextTier\"",
        "        points: size = 6",
        "        points [6]:",
        "            mark = \"2:2 inferred at 11.7 s\"",
    ] {
        assert!(grid.lines().any(|l| l == line), "{line} in\n{grid}");
    }
}

#[test]
fn praat_may_save_in_utf_16() {
    let grid = labels(&two_drops(), Form::TextGrid);
    let units: Vec<u16> = std::iter::once(0xfeff).chain(grid.encode_utf16()).collect();
    let big: Vec<u8> = units.iter().flat_map(|u| u.to_be_bytes()).collect();
    let little: Vec<u8> = units.iter().flat_map(|u| u.to_le_bytes()).collect();
    let plain = read(grid.as_bytes(), Form::TextGrid).unwrap();
    for bytes in [big, little, format!("{}{grid}", '\u{feff}').into_bytes()] {
        assert_eq!(read(&bytes, Form::TextGrid).unwrap(), plain);
    }
    let error = read(&[0x31, 0xff], Form::Audacity).unwrap_err().to_string();
    assert!(error.contains("UTF-8"), "{error}");
}
