//! `docs/constants.md`: what is written by hand in it is kept, all else is made anew.

use std::path::Path;

use bounce_audio::units::real;

use super::constants::Constant;
use super::figures::{COLUMNS, Figures};
use super::rows::Row;
use super::run::{result, result_path};

const PREFACE: &str = include_str!("preface.md");
/// The word for what the program is built of, and no run changes.
const STRUCTURAL: &str = "structural";
const HEAD: &str = "\
| constant | value | | class and source | halved | doubled | off at | off |
|---|---|---|---|---|---|---|---|
";

/// A number of a constant, and its row.
#[derive(Debug)]
pub(crate) struct Entry<'a> {
    pub(crate) constant: &'a Constant,
    pub(crate) row: Row,
}

/// All numbers of the constants with what is known of them; and the rows of which nothing is left.
pub(crate) fn entries(constants: &[Constant], mut old: Vec<Row>) -> (Vec<Entry<'_>>, Vec<Row>) {
    let listed = constants.iter().filter(|c| c.is_listed());
    let mut entries: Vec<Entry> = listed.flat_map(fresh).collect();
    let mut open: Vec<&mut Entry> = entries.iter_mut().collect();
    // A constant keeps its place; or it moved, or has another name.
    let same: [fn(&Row, &Row) -> bool; 4] = [
        |a, b| a.file == b.file && a.name == b.name,
        |a, b| a.name == b.name && a.value == b.value,
        |a, b| a.name == b.name,
        |a, b| a.file == b.file && a.value == b.value,
    ];
    for same in same {
        open.retain_mut(|entry| {
            let found = old.iter().position(|row| same(&entry.row, row));
            if let Some(found) = found {
                take_over(&mut entry.row, old.remove(found));
            }
            found.is_none()
        });
    }
    (entries, old)
}

fn fresh(constant: &Constant) -> impl Iterator<Item = Entry<'_>> {
    let class = if constant.structural { STRUCTURAL } else { "" };
    constant.numbers.iter().map(move |number| Entry {
        constant,
        row: Row {
            file: constant.file.clone(),
            name: number.name.clone(),
            value: number.value.clone(),
            class: class.to_owned(),
            ..Row::default()
        },
    })
}

fn take_over(row: &mut Row, old: Row) {
    // What another value did says nothing of this one.
    if row.value == old.value {
        row.effects = old.effects;
    }
    row.class = old.class;
    row.off = old.off;
}

impl Entry<'_> {
    /// Whether another value would still be a program.
    pub(crate) fn is_tuned(&self) -> bool {
        !self.constant.structural && !self.row.class.starts_with(STRUCTURAL)
    }

    /// Whether what it rests on is judgement or a figure of the suite, and not a formula, a convention or a limit.
    pub(crate) fn is_open(&self) -> bool {
        let class = self.row.class.as_str();
        class.is_empty() || class.starts_with("unproven") || class.starts_with("measured")
    }

    /// Halved, doubled and switched off, as the changed program takes it; empty where there is no such change.
    pub(crate) fn changes(&self) -> [String; 3] {
        let Row {
            file, name, off, ..
        } = &self.row;
        ["half", "double", off].map(|way| {
            if way.is_empty() || !self.is_tuned() {
                String::new()
            } else {
                format!("{file}::{name}={way}")
            }
        })
    }

    /// The row with what the results say.
    fn measured(&self, results: &Path, base: Option<&Figures>) -> Row {
        let mut row = self.row.clone();
        for (effect, change) in row.effects.iter_mut().zip(self.changes()) {
            if change.is_empty() {
                effect.clear();
            } else if let Some(new) = base.and_then(|base| effect_of(results, &change, base)) {
                *effect = new;
            }
        }
        row
    }
}

/// The document.
pub(crate) fn written(entries: &[Entry<'_>], results: &Path) -> String {
    let base = result(results, "");
    let mut text = PREFACE.to_owned() + &summary(entries, base.as_ref());
    for of_file in entries.chunk_by(|a, b| a.constant.file == b.constant.file) {
        text += &format!("\n## `{}`\n\n{HEAD}", of_file[0].constant.file);
        for entry in of_file {
            let row = entry.measured(results, base.as_ref());
            text += &line(&row, &entry.constant.about);
        }
    }
    text
}

fn line(row: &Row, about: &str) -> String {
    let [halved, doubled, off] = &row.effects;
    let about = about.replace('|', "∣");
    format!(
        "| `{}` | `{}` | {about} | {} | {halved} | {doubled} | {} | {off} |\n",
        row.name, row.value, row.class, row.off
    )
}

/// What a change did, in words; none if it was not measured.
fn effect_of(results: &Path, change: &str, base: &Figures) -> Option<String> {
    if !result_path(results, change).is_file() {
        return None;
    }
    let Some(figures) = result(results, change) else {
        return Some("fails".to_owned());
    };
    let touched = figures.touched(base);
    if touched == 0 {
        return Some("0".to_owned());
    }
    let mut words = figures.moved(base);
    if figures.missed != base.missed {
        let more = real(figures.missed) - real(base.missed);
        words.push(format!("thresholds {more:+}"));
    }
    let time = figures.cpu_s / base.cpu_s;
    if !(0.75..=1.3).contains(&time) {
        words.push(format!("time ×{time:.1}"));
    }
    let words = words.join(", ");
    let colon = if words.is_empty() { "" } else { ": " };
    Some(format!("{touched}{colon}{words}"))
}

fn summary(entries: &[Entry<'_>], base: Option<&Figures>) -> String {
    let mut text = String::from("\n| class | numbers |\n|---|---:|\n");
    for class in super::rows::CLASSES {
        let count = entries.iter().filter(|e| e.row.class.starts_with(class));
        text += &format!("| {class} | {} |\n", count.count());
    }
    if let Some(base) = base {
        let figures = COLUMNS.iter().zip(&base.all);
        let words: Vec<String> = figures
            .map(|(c, v)| format!("{} {}", c.name, c.shown(*v)))
            .collect();
        let count = base.documents.len();
        text += &format!(
            "\nWithout a change, {count} recordings: {}.\n",
            words.join(", ")
        );
    }
    text
}
