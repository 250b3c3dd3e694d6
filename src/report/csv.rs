//! The report as a table: one row per impact.

use std::fmt::Write;

use super::Report;

/// The columns, in order.
pub const HEADER: &str =
    "file,drop,impact,time_s,time_std_s,level_db,interval_s,ratio,rebound_height_m,status";

/// One row per impact with its drop's number, under [`HEADER`]; values that do not exist are empty.
#[must_use]
pub fn to_csv(report: &Report) -> String {
    let mut table = format!("{HEADER}\n");
    let file = quoted(&report.file);
    for (d, drop) in report.analysis.drops.iter().enumerate() {
        for (i, impact) in drop.impacts.iter().enumerate() {
            let mut row = format!("{file},{},{},{}", d + 1, i + 1, impact.time_s);
            let numbers = [
                impact.time_std_s,
                impact.level_db,
                impact.interval_s,
                impact.ratio,
                impact.rebound_height_m,
            ];
            for number in numbers {
                row.push(',');
                if let Some(number) = number {
                    // Writing to a string cannot fail.
                    let _: std::fmt::Result = write!(row, "{number}");
                }
            }
            table.push_str(&row);
            table.push(',');
            table.push_str(impact.status.word());
            table.push('\n');
        }
    }
    table
}

/// A field as RFC 4180 wants it: in quotes where it holds a comma, a quote or a line break.
fn quoted(field: &str) -> String {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_with_commas_and_quotes_stays_one_field() {
        assert_eq!(quoted("a.wav"), "a.wav");
        assert_eq!(quoted("5\", soft.wav"), "\"5\"\", soft.wav\"");
    }
}
