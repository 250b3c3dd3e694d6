use super::*;

fn typed(text: &str) -> Typed {
    read(text.as_bytes(), Reading::default()).unwrap_or_else(|e| panic!("{text:?}: {e}"))
}

fn refused(text: &str, reading: Reading) -> String {
    read(text.as_bytes(), reading).unwrap_err().to_string()
}

fn assert_near(found: &[f64], expected: &[f64]) {
    let near = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-12;
    assert!(
        found.len() == expected.len() && found.iter().zip(expected).all(near),
        "{found:?}"
    );
}

#[test]
fn one_drop_is_read_however_it_is_written() {
    let expected = [0.0, 0.5, 0.9, 1.22];
    for text in [
        "0\n0.5\n0.9\n1.22\n",
        "time_s\n0\n0.50\n0.9\n1.22",
        "Time (ms)\r\n0\r\n500\r\n900\r\n1220\r\n",
        "0\n500\n900\n1220\n",
        "500\n400\n320\n",
        "# by light gate\nflight/ms\n500\n400\n320\n",
        "0.5\n0.4\n0.32\n",
        "500000\n400000\n320000\n",
        "Zeit\n0,0\n0,5\n0,9\n1,22\n",
        "0,0\n0,50\n0,9\n1,22\n0,0"
            .strip_suffix("\n0,0")
            .unwrap_or(""),
    ] {
        let reading = Reading {
            decimal: text.starts_with("0,0").then_some(Decimal::Comma),
            ..Reading::default()
        };
        let found = read(text.as_bytes(), reading).unwrap_or_else(|e| panic!("{text:?}: {e}"));
        assert_eq!((found.drops_s.len(), found.names.len()), (1, 0), "{text:?}");
        assert_near(&found.drops_s[0], &expected);
    }
}

#[test]
fn drops_stand_in_the_order_of_their_first_line_under_their_names() {
    for text in [
        "t;drop\n0;b\n0,5;b\n0;a\n0,6;a\n0,9;b\n",
        "0.0,b\n0.5,b\n0.0,a\n0.6,a\n0.9,b\n",
        "b\t0,0\nb\t0,5\na\t0,0\na\t0,6\nb\t0,9\n",
        "0,0 b\n0,5 b\n0,0 a\n0,6 a\n0,9 b\n",
        "no,drop,time,level\n1,b,0,-3\n2,b,0.5,-5\n3,a,0,-3\n4,a,0.6,-4\n5,b,0.9,-7\n",
    ] {
        let found = typed(text);
        assert_eq!(found.names, ["b", "a"], "{text}");
        assert_near(&found.drops_s[0], &[0.0, 0.5, 0.9]);
        assert_near(&found.drops_s[1], &[0.0, 0.6]);
    }
}

#[test]
fn a_first_flight_of_each_drop_is_one_interval() {
    let found = typed("0.82,1\n0.81,2\n0.80,3\n");
    assert_eq!((found.kind, found.drops_s.len()), (Kind::Intervals, 3));
    assert_near(&found.drops_s[2], &[0.0, 0.8]);
}

#[test]
fn rounding_is_that_of_the_last_place_written() {
    for (text, last_place_s) in [
        ("0\n0.5\n0.9", 0.1),
        ("0\n500\n900.25", 1e-5),
        ("0,00;1\n0,5;1\n0,9;1", 0.01),
    ] {
        let std = typed(text).rounding_std_s;
        assert!(
            (std * 12.0_f64.sqrt() / last_place_s - 1.0).abs() < 1e-12,
            "{text}"
        );
    }
}

#[test]
fn what_can_be_read_in_two_ways_is_asked_about() {
    let two = "0,523\n0,418\n0,334\n";
    let said = refused(two, Reading::default());
    assert!(
        said.starts_with("line 1: '0,523' may be one number"),
        "{said}"
    );
    let comma = Reading {
        decimal: Some(Decimal::Comma),
        ..Reading::default()
    };
    assert_near(
        &read(two.as_bytes(), comma).unwrap().drops_s[0],
        &[0.0, 0.523, 0.941, 1.275],
    );
    // A zero behind the comma begins no number of a drop.
    assert_near(&typed("0,5\n0,05\n").drops_s[0], &[0.0, 0.5, 0.55]);
}

#[test]
fn what_is_no_list_of_impacts_is_refused_with_its_line() {
    let none = Reading::default();
    let times = Reading {
        kind: Some(Kind::Times),
        ..none
    };
    for (text, reading, said) in [
        ("", none, "line 1: there are no times in it"),
        ("time\n", none, "line 1: there are no times in it"),
        ("0\n0.5\nabc\n", none, "line 3: 'abc' is no time"),
        ("0\n0.5\ninf\n", none, "line 3: 'inf' is no time"),
        (
            "0\n0.5\n0.4\n0.9\n",
            none,
            "line 3: times grow from line to line",
        ),
        ("0\n0.5\n0.4\n0.9\n", times, "line 3: the time is not after"),
        (
            "0.5,a\n0.4,a\n0.3,\n",
            none,
            "line 3: the column of the drop is empty",
        ),
        (
            "0.5;a\n0.4;a\n-0.3;a\n",
            none,
            "line 3: an interval is above 0",
        ),
        ("1.5\n", times, "line 1: one time bounds no flight"),
        ("1.5,2,3\n", none, "line 1: 3 columns"),
        ("a b\nc d\n", none, "line 2: no number in it"),
    ] {
        let found = refused(text, reading);
        assert!(found.starts_with(said), "{text:?}: {found}");
    }
    assert!(refused("\u{0}\u{d8}", none).starts_with("line 1"));
    assert!(read(&[0xff, 0xfe, 0x00, 0xd8], none).is_err());
}
