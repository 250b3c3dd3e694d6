//! The report as CSV: one row per impact. [`drops`](super::drops) has the CSV of many reports, one row per drop.

use super::Report;

/// The columns, in order.
pub const HEADER: &str = "file,drop,impact,time_s,time_std_s,level_db,interval_s,ratio,\
                          rebound_height_m,status,rebound_height_std_m,\
                          impact_speed_m_per_s,impact_speed_std_m_per_s,\
                          rebound_speed_m_per_s,rebound_speed_std_m_per_s,\
                          restitution,restitution_std,energy_kept,energy_kept_std";

/// A table as spreadsheets read it where the decimal mark is a comma: semicolons between fields, commas in numbers.
#[must_use]
pub fn with_decimal_commas(table: &str) -> String {
    let (mut out, mut field, mut quoted) =
        (String::with_capacity(table.len()), String::new(), false);
    for c in table.chars() {
        match c {
            '"' => {
                quoted = !quoted;
                field.push(c);
            }
            ',' | '\n' if !quoted => {
                out += &with_comma(&field);
                out.push(if c == ',' { ';' } else { '\n' });
                field.clear();
            }
            _ => field.push(c),
        }
    }
    out + &with_comma(&field)
}

fn with_comma(field: &str) -> String {
    let is_number = field.parse::<f64>().is_ok();
    match field {
        number if is_number => number.replace('.', ","),
        text if text.contains(';') && !text.starts_with('"') => format!("\"{text}\""),
        text => text.to_owned(),
    }
}

/// One row per impact with its drop's number, under [`HEADER`]; values that do not exist are empty.
#[must_use]
pub fn to_csv(report: &Report) -> String {
    let mut table = format!("{HEADER}\n");
    let file = quoted(&report.file);
    for (d, drop) in report.drops.iter().enumerate() {
        for (i, impact) in drop.impacts.iter().enumerate() {
            let bounce = &impact.bounce;
            // Columns that came later stand behind the status, so that those before keep their places.
            let row = [
                file.clone(),
                (d + 1).to_string(),
                (i + 1).to_string(),
                impact.time_s.to_string(),
                cell(impact.time_std_s),
                cell(impact.level_db),
                cell(impact.interval_s),
                cell(impact.ratio),
                cell(impact.rebound_height_m),
                impact.status.word().to_owned(),
                cell(impact.rebound_height_std_m),
                cell(bounce.impact_speed_m_per_s),
                cell(bounce.impact_speed_std_m_per_s),
                cell(bounce.rebound_speed_m_per_s),
                cell(bounce.rebound_speed_std_m_per_s),
                cell(bounce.restitution),
                cell(bounce.restitution_std),
                cell(bounce.energy_kept),
                cell(bounce.energy_kept_std),
            ];
            table.push_str(&row.join(","));
            table.push('\n');
        }
    }
    table
}

/// A number, or nothing.
pub(super) fn cell(number: Option<f64>) -> String {
    number.map_or_else(String::new, |n| n.to_string())
}

/// A field as RFC 4180 wants it: in quotes where it holds a comma, a quote or a line break.
pub(super) fn quoted(field: &str) -> String {
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

#[cfg(test)]
mod comma_tests {
    use super::with_decimal_commas;

    #[test]
    fn numbers_have_commas_and_fields_stay_apart() {
        let table =
            "file,e,note\n\"a, b.wav\",0.93,\n\"say \"\"1,5\"\"\",-1.5e-3,x;y\nc.1.wav,7,2.5\n";
        let expected =
            "file;e;note\n\"a, b.wav\";0,93;\n\"say \"\"1,5\"\"\";-1,5e-3;\"x;y\"\nc.1.wav;7;2,5\n";
        assert_eq!(with_decimal_commas(table), expected);
        assert_eq!(with_decimal_commas(""), "");
    }
}
