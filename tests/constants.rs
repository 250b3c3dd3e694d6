//! `docs/constants.md` lists the constants of the source as they are, and what each rests on.
#![allow(clippy::unwrap_used, reason = "a failing test should panic")]

#[path = "../examples/ablation/constants.rs"]
#[expect(dead_code, reason = "the program that measures them needs more")]
mod constants;
#[path = "../examples/ablation/mask.rs"]
mod mask;
#[path = "../examples/ablation/rows.rs"]
mod rows;

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
        let numbers = c.numbers().into_iter();
        numbers
            .map(|(name, value)| (c.file.clone(), name, value))
            .collect()
    };
    let found: Vec<_> = of_source().iter().flat_map(numbers).collect();
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
    assert_eq!((d.name.as_str(), d.value.as_str(), d.line), ("D", "1.0", 9));
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
fn the_numbers_of_a_tuple_are_apart() {
    let found = of_text("const A: (f64, f64) = (1e-3, -2.0);");
    let expected = [("A.0", "1e-3"), ("A.1", "-2.0")];
    assert_eq!(
        found[0].numbers(),
        expected.map(|(name, value)| (name.to_owned(), value.to_owned()))
    );
}
