//! `--report OUT.html`: a page to keep, of one recording, a list of times or a batch.

use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use clap::Args;

use super::listen::name;
use super::{output, sha256};
use crate::Error;
use crate::plot::{Figure, to_svg};
use crate::report::Settings;
use crate::report::html::{Content, Page, Section, to_html};

/// Where a page goes, and what it says beside the results.
#[derive(Debug, Args)]
#[command(next_help_heading = "A report to keep")]
pub(super) struct DocumentArguments {
    /// Write a page for a browser or a printer: the answer, pictures, settings, the program's version, the file's SHA-256
    #[arg(long, value_name = "OUT.html")]
    pub report: Option<PathBuf>,
    /// What the page shall say beside that: ball, surface, temperature, who dropped it
    #[arg(long, value_name = "TEXT", requires = "report")]
    note: Option<String>,
}

/// What a page begins as: another file is not replaced.
const BEGINS: &[u8] = b"<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">";

impl DocumentArguments {
    /// Whether a page can be written, before anything is listened to.
    pub(super) fn check(&self) -> Result<(), Error> {
        match &self.report {
            Some(path)
                if !path
                    .extension()
                    .is_some_and(|e| e.eq_ignore_ascii_case("html")) =>
            {
                Err(Error::Argument {
                    argument: "--report",
                    got: format!("'{}'", path.display()),
                    expected: "a name that ends in .html",
                })
            }
            _ => Ok(()),
        }
    }

    /// Writes the page if it was asked for: the answer, the parts, then what it rests on.
    pub(super) fn write(
        &self,
        title: &str,
        answer: Vec<String>,
        parts: impl FnOnce() -> Result<Vec<Section>, Error>,
        settings: &Settings,
        files: &[&Path],
    ) -> Result<(), Error> {
        let Some(path) = &self.report else {
            return Ok(());
        };
        let mut sections = parts()?;
        sections.push(section("Settings", Content::Table(settings_rows(settings))));
        sections.push(section("Origin", Content::Table(origin(files)?)));
        let page = Page {
            title: title.to_owned(),
            answer,
            note: self.note.clone(),
            sections,
        };
        output::write(path, BEGINS, to_html(&page).as_bytes())
    }
}

pub(super) fn section(heading: &str, content: Content) -> Section {
    Section {
        heading: heading.to_owned(),
        content,
    }
}

/// Pictures as a part of a page.
pub(super) fn pictures(figures: &[Figure]) -> Result<Section, Error> {
    let drawn = figures
        .iter()
        .map(to_svg)
        .collect::<Result<Vec<String>, Error>>()?;
    Ok(section("Pictures", Content::Pictures(drawn)))
}

/// Every setting by its name in the JSON document; what was not given is left out.
fn settings_rows(settings: &Settings) -> Vec<(String, String)> {
    let json = serde_json::to_value(settings).unwrap_or_default();
    let fields = json.as_object().into_iter().flatten();
    let given = fields.filter(|(_, value)| !value.is_null());
    let shown = |value: &serde_json::Value| {
        value
            .as_str()
            .map_or_else(|| value.to_string(), ToOwned::to_owned)
    };
    given
        .map(|(name, value)| (name.replace('_', " "), shown(value)))
        .collect()
}

fn origin(files: &[&Path]) -> Result<Vec<(String, String)>, Error> {
    let mut rows = vec![
        (
            "program".to_owned(),
            concat!("bounce-audio ", env!("CARGO_PKG_VERSION")).to_owned(),
        ),
        ("made on".to_owned(), today()),
        ("command".to_owned(), command()),
    ];
    for file in files {
        let hash = sha256::of_file(file).map_err(|e| Error::from(e).in_file(*file))?;
        rows.push((name(file), format!("SHA-256 {hash}")));
    }
    Ok(rows)
}

fn command() -> String {
    let words = std::env::args_os().skip(1);
    let words: Vec<String> = words.map(|word| name(Path::new(&word))).collect();
    format!("bounce-audio {}", words.join(" "))
}

/// The date in Greenwich, as 2026-01-31.
fn today() -> String {
    let since = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .unwrap_or_default();
    date(since.as_secs() / 86_400)
}

/// The date so many days after 1970-01-01, year by year and month by month.
fn date(mut days: u64) -> String {
    let leap = |year: u64| {
        year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400))
    };
    let mut year = 1970;
    while days >= 365 + u64::from(leap(year)) {
        days -= 365 + u64::from(leap(year));
        year += 1;
    }
    let lengths = [
        31,
        28 + u64::from(leap(year)),
        31,
        30,
        31,
        30,
        31,
        31,
        30,
        31,
        30,
        31,
    ];
    let mut month = 1;
    for length in lengths {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    format!("{year}-{month:02}-{:02}", days + 1)
}

#[cfg(test)]
mod tests {
    use super::date;

    #[test]
    fn days_are_dates() {
        for (days, shown) in [
            (0, "1970-01-01"),
            (58, "1970-02-28"),
            (59, "1970-03-01"),
            (11_016, "2000-02-29"),
            (19_722, "2023-12-31"),
            (20_484, "2026-01-31"),
        ] {
            assert_eq!(date(days), shown);
        }
    }
}
