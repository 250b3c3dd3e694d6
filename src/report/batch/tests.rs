//! What a batch says at its end.

use super::*;

fn digest(file: &str, values: &[f64]) -> Digest {
    let drop = |&value: &f64| DropDigest {
        bounces: 9,
        restitution: Some(Estimate {
            value,
            std_error: Some(0.001),
            interval95: Some([value - 0.002, value + 0.002]),
        }),
        ..DropDigest::default()
    };
    Digest {
        file: file.to_owned(),
        found: Found::Drops(values.iter().map(drop).collect()),
    }
}

#[test]
fn a_batch_says_each_file_then_the_mean_and_who_is_far() {
    let mut digests: Vec<Digest> = (0..8)
        .map(|i| digest(&format!("{i}.wav"), &[0.9 + 0.0005 * f64::from(i % 3)]))
        .collect();
    digests.push(digest("two\n.wav", &[0.9, 0.95]));
    digests.push(Digest {
        file: "none.wav".to_owned(),
        found: Found::Nothing("only 2 sharp sounds".to_owned()),
    });
    let failed = Digest::failed("bad.wav".to_owned(), "it is empty".to_owned());
    digests.push(failed);
    let said = summary(&digests);
    for part in [
        "0.wav: e 0.9000 ± 0.0010, 9 bounces\n",
        "two\\n.wav drop 2: e 0.9500 ± 0.0010, 9 bounces\n",
        "none.wav: only 2 sharp sounds\n",
        "bad.wav: failed: it is empty\n",
        "11 recordings, 10 drops; without a drop: 1; failed: 1\n",
        "more than their errors explain",
        "outlier  two\\n.wav drop 2: e 0.9500",
        "Without it:\n  mean e   0.90039 ± 0.00033",
        "no more than their errors explain",
    ] {
        assert!(said.contains(part), "{part} is missing in\n{said}");
    }
    assert!(said.lines().count() < 30 && !said.contains('\r'));
}

#[test]
fn lines_are_no_wider_than_a_terminal_and_names_stay_whole() {
    let name = format!("a drop {}.wav", "of many words ".repeat(4).trim_end());
    let mut digests: Vec<Digest> = (0..8)
        .map(|i| digest(&format!("{i}.wav"), &[0.9 + 0.0005 * f64::from(i % 3)]))
        .collect();
    digests.push(digest(&name, &[0.95]));
    digests.push(Digest {
        file: name.clone(),
        found: Found::Nothing(
            "nothing rises out of its noise "
                .repeat(5)
                .trim_end()
                .into(),
        ),
    });
    digests.push(Digest {
        file: name.clone(),
        found: Found::Failed(
            "it is no recording of any kind "
                .repeat(5)
                .trim_end()
                .into(),
        ),
    });
    let said = summary(&digests);
    assert!(
        said.lines().all(|line| line.chars().count() <= 80),
        "{said}"
    );
    // Its drop, that it is an outlier, that it has none, that it failed.
    assert_eq!(said.matches(&name).count(), 4, "{said}");
    assert!(said.contains(&format!("{name}: failed:")), "{said}");
}

#[test]
fn drops_without_an_error_are_in_no_mean() {
    let mut bare = digest("a.wav", &[0.9]);
    let Found::Drops(drops) = &mut bare.found else {
        panic!("made with a drop");
    };
    drops[0].restitution = Some(Estimate::bare(0.9));
    let said = summary(&[bare.clone(), bare, digest("b.wav", &[0.8])]);
    assert!(
        said.contains("a.wav: e 0.900 (no error") && !said.contains("mean e"),
        "{said}"
    );
    assert!(said.ends_with("3 recordings, 3 drops\n"), "{said}");
}

/// A drop with this e, known to 0.001, at a speed by its logarithm.
fn at_speed(value: f64, ln_speed: f64) -> DropDigest {
    let e = Estimate {
        value,
        std_error: Some(0.001),
        interval95: None,
    };
    DropDigest {
        at_speed_m_per_s: Some(ln_speed.exp()),
        ..DropDigest::new(9, Some(e))
    }
}

/// A line through one odd drop at a speed of its own would make it like the others.
#[test]
fn a_drop_that_is_odd_is_not_taken_for_a_change_with_the_speed() {
    let same = |i: u32| at_speed(0.93 + 0.0004 * f64::from(i % 3), 0.01 * f64::from(i % 4));
    let odd = at_speed(0.876, 0.25);
    let found = Found::Drops((0..7).map(same).chain([odd]).collect());
    let digests = [Digest::new("many.wav".to_owned(), found)];
    let said = conclusion(&digests);
    let pooled = Pooled::of(&digests);
    assert_eq!(pooled.outliers, [7]);
    let rest = pooled.without_outliers.unwrap();
    assert!(
        rest.count == 7 && (rest.mean - 0.9304).abs() < 1e-4,
        "{rest:?}"
    );
    assert!(!said.contains("  speed  "), "{said}");
    assert!(
        said.contains("outlier  many.wav drop 8: e 0.8760 ±"),
        "{said}"
    );
}

/// e of an outlier is that of the table, and beside it the one that is compared.
#[test]
fn an_outlier_at_another_speed_is_told_by_both() {
    let drop = |i: u32| {
        let ln_speed = 0.2 * f64::from(i);
        let odd = if i == 6 { 0.02 } else { 0.0 };
        at_speed(
            0.9 - 0.02 * ln_speed + 0.0004 * f64::from(i % 3) - odd,
            ln_speed,
        )
    };
    let found = Found::Drops((0..14).map(drop).collect());
    let said = conclusion(&[Digest::new("many.wav".to_owned(), found)]);
    assert!(
        said.contains("many.wav drop 7: e 0.8560 ± 0.0010, at the speed of all 0.85"),
        "{said}"
    );
}

#[test]
fn heights_that_do_not_fit_are_counted() {
    let drop = |i: u32| DropDigest {
        is_height_unfit: i < 3,
        ..at_speed(0.9, 0.0)
    };
    let found = Found::Drops((0..8).map(drop).collect());
    let said = conclusion(&[Digest::new("many.wav".to_owned(), found)]);
    assert!(
        said.contains("  height   does not fit 3 of 8 drops"),
        "{said}"
    );
    assert!(!said.contains("speed"), "{said}");
}

#[test]
fn drops_from_different_heights_are_compared_at_one_speed() {
    let drop = |i: u32| {
        let ln_speed = 0.2 * f64::from(i);
        at_speed(0.9 - 0.02 * ln_speed + 0.0004 * f64::from(i % 3), ln_speed)
    };
    let found = Found::Drops((0..8).map(drop).collect());
    let said = conclusion(&[Digest::new("many.wav".to_owned(), found)]);
    assert!(
        said.contains("the drops differ no more than their errors explain"),
        "{said}"
    );
    assert!(
        said.contains("  speed    all at 2.01 m/s: over the drops e changes by -0.0"),
        "{said}"
    );
}
