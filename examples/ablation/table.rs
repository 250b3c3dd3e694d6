//! `docs/constants.md`: what is written by hand in it is kept, all else is made anew.

use std::path::Path;

use bounce_audio::units::real;

use super::constants::Constant;
use super::figures::{COLUMNS, Figures};
use super::rows::{Row, read};
use super::run::result;

const PREFACE: &str = include_str!("preface.md");
/// The word for what the compiler has to know and no run can change.
const STRUCTURAL: &str = "structural";

/// The rows of the document.
#[derive(Debug, Clone, Default)]
pub(crate) struct Table {
    pub rows: Vec<Row>,
}

/// How a number is changed, in the order of [`Row::effects`].
fn ways(off: &str) -> [String; 3] {
    ["half".to_owned(), "double".to_owned(), off.to_owned()]
}

impl Table {
    pub(crate) fn read(text: &str) -> Self {
        Self { rows: read(text) }
    }

    /// The row of a number; of another file if it moved there and no other has its name.
    fn of(&self, constant: &Constant, name: &str) -> Option<&Row> {
        let same: Vec<&Row> = self.rows.iter().filter(|r| r.name == name).collect();
        let here = same.iter().find(|r| r.file == constant.file).copied();
        here.or_else(|| same.first().copied().filter(|_| same.len() == 1))
    }

    /// The class of a constant: that of its first number.
    pub(crate) fn class(&self, constant: &Constant) -> String {
        let numbers = constant.numbers();
        let row = numbers
            .first()
            .and_then(|(name, _)| self.of(constant, name));
        match row {
            Some(row) if !row.class.is_empty() => row.class.clone(),
            _ if constant.structural => STRUCTURAL.to_owned(),
            _ => String::new(),
        }
    }

    /// Whether another value of a constant would still be a program.
    pub(crate) fn is_tuned(&self, constant: &Constant) -> bool {
        !constant.structural && !self.class(constant).starts_with(STRUCTURAL)
    }

    /// All changes of the constants whose key contains a part.
    pub(crate) fn changes(&self, constants: &[Constant], part: &str) -> Vec<String> {
        let mut changes = Vec::new();
        for constant in constants
            .iter()
            .filter(|c| self.is_tuned(c) && c.key().contains(part))
        {
            for (name, _) in constant.numbers() {
                let off = self.of(constant, &name).map_or("", |r| &r.off);
                let ways = ways(off).into_iter().filter(|way| !way.is_empty());
                changes.extend(ways.map(|way| change(constant, &name, &way)));
            }
        }
        changes
    }

    /// The document for the constants as they are and the results that there are.
    pub(crate) fn written(&self, constants: &[Constant], results: &Path) -> String {
        let base = result(results, "");
        let mut text = PREFACE.to_owned();
        text += &summary(self, constants, base.as_ref());
        let mut file = "";
        for constant in constants {
            if constant.file != file {
                file = &constant.file;
                text += &format!(
                    "\n## `{file}`\n\n| constant | value | | class and source | halved | doubled | off at | off |\n|---|---|---|---|---|---|---|---|\n"
                );
            }
            for (name, value) in constant.numbers() {
                let old = self.of(constant, &name).cloned().unwrap_or_default();
                let mut row = Row {
                    value,
                    ..old.clone()
                };
                if row.class.is_empty() {
                    row.class = self.class(constant);
                }
                for (effect, way) in row.effects.iter_mut().zip(ways(&row.off)) {
                    if old.value != row.value {
                        effect.clear();
                    }
                    if let (true, Some(base)) = (self.is_tuned(constant), &base) {
                        if let Some(new) = effect_of(results, &change(constant, &name, &way), base)
                        {
                            *effect = new;
                        }
                    } else if !self.is_tuned(constant) {
                        effect.clear();
                    }
                }
                text += &line(&name, &row, &constant.about);
            }
        }
        text
    }
}

fn change(constant: &Constant, name: &str, way: &str) -> String {
    format!("{}::{name}={way}", constant.file)
}

fn line(name: &str, row: &Row, about: &str) -> String {
    let [halved, doubled, off] = &row.effects;
    let about = about.replace('|', "∣");
    format!(
        "| `{name}` | `{}` | {about} | {} | {halved} | {doubled} | {} | {off} |\n",
        row.value, row.class, row.off
    )
}

/// What a change did, in words; none if it was not measured.
fn effect_of(results: &Path, change: &str, base: &Figures) -> Option<String> {
    if !super::run::result_path(results, change).is_file() {
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
    Some(
        format!("{touched}: {}", words.join(", "))
            .trim_end_matches([':', ' '])
            .to_owned(),
    )
}

fn summary(table: &Table, constants: &[Constant], base: Option<&Figures>) -> String {
    let tuned: Vec<&Constant> = constants.iter().filter(|c| table.is_tuned(c)).collect();
    let numbers: usize = tuned.iter().map(|c| c.numbers().len()).sum();
    let mut text = format!(
        "\n{} constants; {} of them can be tuned, with {numbers} numbers.\n",
        constants.len(),
        tuned.len()
    );
    if let Some(base) = base {
        let figures = COLUMNS.iter().zip(&base.all);
        let figures: Vec<String> = figures
            .map(|(c, v)| format!("{} {v:.3e}", c.name))
            .collect();
        text += &format!(
            "\nAs it is, {} recordings: {}.\n",
            base.documents.len(),
            figures.join(", ")
        );
    }
    text
}
