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
        "more than they claim",
        "outlier  two\\n.wav drop 2: e 0.9500",
        "Without them:\n  mean e   0.90039 ± 0.00033",
        "no more than they claim",
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
