//! The table of a batch on a terminal, no wider than that: file, e with its error, bounces, and a remark.

use std::iter::once;

use textwrap::core::display_width;

use crate::report::batch::{Digest, DropDigest, Found, visible};
use crate::report::{Report, short};

/// Columns of e with its error: `0.999999 ± 0.000012`.
const RESTITUTION: usize = 19;
/// Columns of the number of bounces, which has a heading.
const BOUNCES: usize = 7;
/// Columns between two others.
const GAP: &str = "  ";
/// A remark may be cut down to this many columns before names are.
const SHORTEST_REMARK: usize = 18;
/// Columns that every name may have.
const SHORTEST_NAME: usize = 12;
/// Columns behind a name for the number of a drop, where there is room: nobody knows yet how many there are.
const NUMBER: usize = " drop 9".len();

/// How wide the columns are.
#[derive(Debug, Clone, Copy)]
pub(super) struct Screen {
    name: usize,
    remark: usize,
}

impl Screen {
    /// For files of these names on a terminal of so many columns.
    pub(super) fn new<'a>(names: impl Iterator<Item = &'a str>, columns: usize) -> Self {
        let fixed = RESTITUTION + BOUNCES + 3 * GAP.len();
        let longest = names.map(|name| display_width(&visible(name))).max();
        let left = columns.saturating_sub(fixed);
        let most = left.saturating_sub(SHORTEST_REMARK).max(SHORTEST_NAME);
        let name = longest
            .map_or(0, |longest| longest + NUMBER)
            .clamp(SHORTEST_NAME, most);
        Self {
            name,
            remark: left.saturating_sub(name),
        }
    }

    pub(super) fn heading(&self) -> String {
        self.row("file", "e", "bounces", "remark")
    }

    /// A row per drop, or one with the reason why there is none.
    pub(super) fn rows(&self, digest: &Digest, remarks: &[String]) -> String {
        let file = visible(&digest.file);
        match &digest.found {
            Found::Nothing(reason) => {
                self.row(&file, "-", "-", &format!("no drop: {}", visible(reason)))
            }
            Found::Failed(reason) => {
                self.row(&file, "-", "-", &format!("failed: {}", visible(reason)))
            }
            Found::Drops(drops) => {
                let remarks = remarks.iter().map(String::as_str).chain(once("").cycle());
                let rows = drops.iter().zip(remarks).enumerate();
                rows.map(|(i, (drop, remark))| {
                    let name = match drops.len() {
                        1 => file.clone(),
                        _ => self.numbered(&file, i + 1),
                    };
                    self.row(&name, &restitution(drop), &drop.bounces.to_string(), remark)
                })
                .collect()
            }
        }
    }

    /// The name with the number of a drop, which stays whole.
    fn numbered(&self, file: &str, number: usize) -> String {
        let number = format!(" drop {number}");
        let left = self.name.saturating_sub(number.len());
        end_of(file, left) + &number
    }

    fn row(&self, name: &str, restitution: &str, bounces: &str, remark: &str) -> String {
        let cells = [
            padded(&end_of(name, self.name), self.name),
            padded(restitution, RESTITUTION),
            format!("{bounces:>BOUNCES$}"),
            start_of(remark, self.remark),
        ];
        cells.join(GAP).trim_end().to_owned() + "\n"
    }
}

/// What to know about each drop, in few words.
pub(super) fn remarks(report: &Report) -> Vec<String> {
    let of_recording = &report.warnings;
    let one = |drop: &crate::report::Drop| {
        let warnings = drop.warnings.iter().chain(of_recording);
        let words: Vec<String> = warnings.map(|w| w.code.word().replace('_', " ")).collect();
        words.join(", ")
    };
    report.drops.iter().map(one).collect()
}

fn restitution(drop: &DropDigest) -> String {
    match drop.restitution {
        None => "-".to_owned(),
        Some(e) => match e.std_error {
            Some(std) => short(e.value, std),
            None => format!("{:.3}", e.value),
        },
    }
}

fn padded(text: &str, columns: usize) -> String {
    text.to_owned() + &" ".repeat(columns.saturating_sub(display_width(text)))
}

/// The end of a name, which tells it from others.
fn end_of(text: &str, columns: usize) -> String {
    let reversed: String = text.chars().rev().collect();
    start_of(&reversed, columns).chars().rev().collect()
}

/// The start of a text, with an ellipsis where something is left out.
fn start_of(text: &str, columns: usize) -> String {
    if display_width(text) <= columns {
        return text.to_owned();
    }
    let mut kept = String::new();
    for c in text.chars() {
        kept.push(c);
        if display_width(&kept) >= columns {
            kept.pop();
            break;
        }
    }
    kept + "…"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::Estimate;

    fn drops(count: usize) -> Found {
        let drop = DropDigest::new(
            67,
            Some(Estimate {
                value: 0.929_45,
                std_error: Some(0.000_7),
                interval95: None,
            }),
        );
        Found::Drops(vec![drop; count])
    }

    fn digest(file: &str, found: Found) -> Digest {
        Digest::new(file.to_owned(), found)
    }

    #[test]
    fn a_table_fits_any_terminal() {
        let long = "recordings of tuesday/ball number 12, third drop, with a long name.wav";
        for columns in [60, 80, 200] {
            let screen = Screen::new(["a.wav", long].into_iter(), columns);
            let rows = screen.heading()
                + &screen.rows(
                    &digest("a.wav", drops(1)),
                    &["late start, few impacts".repeat(9)],
                )
                + &screen.rows(&digest(long, drops(2)), &[])
                + &screen.rows(&digest(long, Found::Failed("it is empty ".repeat(30))), &[]);
            for line in rows.lines() {
                assert!(display_width(line) <= columns, "{columns}: {line}");
            }
            let numbered = if columns > 60 {
                "name.wav drop 2  0.9294 ± 0.0007"
            } else {
                "…"
            };
            assert!(
                rows.contains(numbered) && rows.contains(" drop 2  0.9294"),
                "{rows}"
            );
            assert!(
                rows.contains("failed: it is") && rows.contains('…'),
                "{rows}"
            );
            assert_eq!(
                rows.contains("recordings of tuesday/ball"),
                columns == 200,
                "{rows}"
            );
        }
    }

    #[test]
    fn columns_stand_below_their_headings() {
        let screen = Screen::new(["a.wav", "übung-14.wav"].into_iter(), 80);
        let rows = screen.heading()
            + &screen.rows(
                &digest("übung-14.wav", drops(1)),
                &["late start".to_owned()],
            )
            + &screen.rows(&digest("a.wav", Found::Nothing("silent".to_owned())), &[]);
        assert_eq!(
            rows,
            "file                 e                    bounces  remark\n\
             übung-14.wav         0.9294 ± 0.0007           67  late start\n\
             a.wav                -                          -  no drop: silent\n"
        );
    }

    #[test]
    fn a_name_with_a_line_feed_stays_in_its_row() {
        let screen = Screen::new(["a\n.wav"].into_iter(), 80);
        assert_eq!(
            screen
                .rows(&digest("a\n.wav", drops(1)), &[])
                .lines()
                .count(),
            1
        );
    }
}
