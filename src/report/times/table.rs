//! Lines to fields: what separates columns, and the decimal mark.

use super::{Decimal, at_line};
use crate::Error;

/// A row: its line, from 1, and its fields.
pub(super) type Row<'a> = (usize, Vec<&'a str>);

/// The fields of a text.
#[derive(Debug)]
pub(super) struct Table<'a> {
    /// The first row, if no field of it is a number.
    pub heading: Option<Vec<&'a str>>,
    pub rows: Vec<Row<'a>>,
    /// Whether a comma stands before decimals.
    pub has_comma: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Separator {
    Of(char),
    Blanks,
}

impl<'a> Table<'a> {
    pub(super) fn read(text: &'a str, decimal: Option<Decimal>) -> Result<Self, Error> {
        let lines = text
            .lines()
            .zip(1..)
            .map(|(content, line)| (line, content.trim()));
        let lines = lines.filter(|(_, content)| !content.is_empty() && !content.starts_with('#'));
        let lines: Vec<(usize, &str)> = lines.collect();
        let (separator, has_comma) = layout(&lines, decimal)?;
        let split = |&(line, content): &(usize, &'a str)| (line, separator.split(content));
        let mut rows: Vec<Row<'a>> = lines.iter().map(split).collect();
        let has_number = |row: &Row<'_>| row.1.iter().any(|f| number(f, has_comma).is_some());
        let headed = rows.first().is_some_and(|row| !has_number(row));
        Ok(Self {
            heading: headed.then(|| rows.remove(0).1),
            rows,
            has_comma,
        })
    }

    pub(super) fn number(&self, field: &str) -> Option<f64> {
        number(field, self.has_comma)
    }
}

/// A finite number with this decimal mark.
fn number(field: &str, has_comma: bool) -> Option<f64> {
    let starts = |c: char| c.is_ascii_digit() || "+-.,".contains(c);
    if !field.starts_with(starts) || (has_comma && field.contains('.')) {
        return None;
    }
    let text = if has_comma {
        field.replace(',', ".")
    } else {
        field.to_owned()
    };
    text.parse().ok().filter(|x: &f64| x.is_finite())
}

impl Separator {
    fn split(self, content: &str) -> Vec<&str> {
        match self {
            Self::Of(separator) => content.split(separator).map(unquoted).collect(),
            Self::Blanks => content.split_whitespace().map(unquoted).collect(),
        }
    }
}

fn unquoted(field: &str) -> &str {
    field.trim().trim_matches('"').trim()
}

/// What separates columns, and whether a comma is the decimal mark.
fn layout(lines: &[(usize, &str)], decimal: Option<Decimal>) -> Result<(Separator, bool), Error> {
    let any = |mark: char| lines.iter().any(|(_, content)| content.contains(mark));
    let clear = ['\t', ';'].into_iter().find(|&mark| any(mark));
    let comma = match decimal {
        _ if !any(',') => false,
        Some(mark) => mark == Decimal::Comma,
        // Where something else separates columns, a comma can be nothing else.
        None => clear.is_some() || before_decimals(lines)?,
    };
    let separator = match clear {
        Some(mark) => Separator::Of(mark),
        None if any(',') && !comma => Separator::Of(','),
        None => Separator::Blanks,
    };
    Ok((separator, comma))
}

/// Whether the commas of lines that nothing else separates stand before decimals.
fn before_decimals(lines: &[(usize, &str)]) -> Result<bool, Error> {
    let is_digit = |c: Option<char>| c.is_some_and(|c| c.is_ascii_digit());
    let digits = |content: &str| content.starts_with(|c: char| c.is_ascii_digit() || c == ',');
    let is_heading = |content: &str| !content.contains(|c: char| c.is_ascii_digit());
    let headed = lines.first().filter(|(_, content)| is_heading(content));
    let body = &lines[usize::from(headed.is_some())..];
    let has_point = body.iter().any(|(_, content)| content.contains('.'));
    let parts = |content: &str| content.matches(',').count() + 1;
    let apart = |content: &str| {
        let next = content.split(',').skip(1).map(|part| part.chars().next());
        next.into_iter().any(|c| !is_digit(c)) || parts(content) > 2 || !digits(content)
    };
    if has_point || body.iter().any(|(_, content)| apart(content)) {
        return Ok(false);
    }
    if let Some((_, heading)) = headed {
        return Ok(!heading.contains(','));
    }
    let blank = |content: &str| content.contains(char::is_whitespace);
    // No one writes a number of a drop as 05.
    let zero = |content: &str| {
        content
            .split(',')
            .nth(1)
            .is_some_and(|d| d.len() > 1 && d.starts_with('0'))
    };
    if body
        .iter()
        .any(|(_, content)| blank(content) || zero(content))
    {
        return Ok(true);
    }
    let (line, content) = body
        .iter()
        .find(|(_, c)| c.contains(','))
        .copied()
        .unwrap_or((1, ""));
    Err(at_line(
        line,
        format!(
            "'{content}' may be one number with a decimal comma or a time and the number of its drop: separate columns with \
             semicolons, or say whether decimals stand behind a point or a comma"
        ),
    ))
}
