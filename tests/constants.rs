//! `docs/constants.md` lists the constants of the source as they are, and what each rests on.
#![allow(clippy::unwrap_used, reason = "a failing test should panic")]

#[path = "../examples/ablation/constants.rs"]
mod constants;
#[path = "../examples/ablation/mask.rs"]
mod mask;
#[path = "../examples/ablation/rows.rs"]
mod rows;
#[path = "../examples/ablation/uses.rs"]
mod uses;

use std::fs;
use std::path::Path;

use constants::{Constant, Source};
use rows::{CLASSES, Row};

fn listed() -> Vec<Row> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/constants.md");
    rows::read(&fs::read_to_string(path).unwrap())
}

fn of_source() -> Vec<Constant> {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    constants::constants(&constants::sources(&src).unwrap())
}

#[test]
fn every_constant_is_listed_with_its_value() {
    let numbers = |c: &Constant| -> Vec<(String, String, String)> {
        let numbers = c.numbers.iter();
        numbers
            .map(|n| (c.file.clone(), n.name.clone(), n.value.clone()))
            .collect()
    };
    let constants = of_source();
    let of_lists = constants.iter().filter(|c| c.is_listed());
    let found: Vec<_> = of_lists.flat_map(numbers).collect();
    let rows = listed().into_iter();
    let listed: Vec<_> = rows.map(|r| (r.file, r.name, r.value)).collect();
    assert_eq!(
        found, listed,
        "`cargo run --release --example ablation -- table` lists them anew"
    );
}

#[test]
fn every_constant_says_what_it_rests_on() {
    for row in listed() {
        let class = row.class.split([':', ' ']).next().unwrap();
        assert!(CLASSES.contains(&class), "{}: {}", row.file, row.name);
    }
}

fn of_text(text: &str) -> Vec<Constant> {
    let source = Source {
        file: "detect/a.rs".to_owned(),
        text: text.to_owned(),
        code: mask::code(text),
    };
    constants::constants(&[source])
}

#[test]
fn comments_strings_and_tests_hold_no_constants() {
    let text = r#"
// const A: f64 = 1.0;
/* const B: f64 = 1.0; */
fn f<'a>(c: &'a str) -> char {
    let _ = "const C: f64 = \" 1.0;";
    '"'
}
/// The one that is. And more.
pub(super) const D: f64 = 1.0;
#[cfg(test)]
mod tests {
    const E: f64 = 1.0;
}
"#;
    let found = of_text(text);
    assert_eq!(found.len(), 1);
    let d = &found[0];
    assert_eq!((d.name.as_str(), d.line), ("D", 9));
    assert_eq!(d.numbers[0].value, "1.0");
    assert_eq!(d.about, "The one that is");
}

#[test]
fn lengths_and_what_they_are_made_of_are_structural() {
    let text = "
const A: usize = 2;
const B: usize = 3 * A;
const C: usize = 4;
const D: usize = 5;
fn f() -> [f64; B] {
    let c = vec![0.0; C];
    c.as_chunks::<D>();
}
";
    let structural: Vec<bool> = of_text(text).iter().map(|c| c.structural).collect();
    assert_eq!(structural, [true, true, false, true]);
}

#[test]
fn the_numbers_of_tuples_and_structures_are_apart() {
    let numbers = |text: &str| -> Vec<(String, String)> {
        let found = of_text(text);
        let numbers = found.iter().flat_map(|c| &c.numbers);
        numbers.map(|n| (n.name.clone(), n.value.clone())).collect()
    };
    let pairs = |expected: [(&str, &str); 2]| expected.map(|(n, v)| (n.to_owned(), v.to_owned()));
    let tuple = "const A: (f64, f64) = (1e-3, -2.0);";
    assert_eq!(numbers(tuple), pairs([("A.0", "1e-3"), ("A.1", "-2.0")]));
    let structure = "const B: Known = Known { value: 1.0 / 3.0, std: 2.0, };";
    let expected = pairs([("B.value", "1.0 / 3.0"), ("B.std", "2.0")]);
    assert_eq!(numbers(structure), expected);
    assert_eq!(
        numbers("const C: Named = Named { name: NAME, std: 2.0 };"),
        []
    );
}
