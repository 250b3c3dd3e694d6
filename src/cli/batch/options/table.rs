//! `--options TABLE.csv`: a row for each file.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

use super::{Given, NAMES};
use crate::Error;
use crate::cli::listen::name;

/// The rows of a table by the file that they name.
#[derive(Debug)]
pub(in crate::cli::batch) struct Table {
    rows: HashMap<PathBuf, Row>,
}

#[derive(Debug, Clone, Copy)]
struct Row {
    given: Given,
    line: u64,
}

impl Table {
    /// Reads a table with a heading: `file` and one or more of [`NAMES`], in any order, separated by commas, or by semicolons
    /// as a spreadsheet writes them where numbers have decimal commas.
    pub(in crate::cli::batch) fn read(path: &Path) -> Result<Self, Error> {
        let text = fs::read(path).map_err(|e| Error::from(e).in_file(path))?;
        Self::parse(&text, path)
    }

    fn parse(text: &[u8], path: &Path) -> Result<Self, Error> {
        let heading = text.split(|byte| *byte == b'\n').next().unwrap_or_default();
        let semicolons = heading.contains(&b';') && !heading.contains(&b',');
        let broken = |e: csv::Error| Error::from(io::Error::other(e)).in_file(path);
        let in_line = |line: u64| format!("{}, line {line}", path.display());
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .delimiter(if semicolons { b';' } else { b',' })
            .from_reader(text);
        let heading = reader.headers().map_err(broken)?.clone();
        check(&heading).map_err(|e| e.in_file(in_line(1)))?;
        let mut rows = HashMap::new();
        for record in reader.records() {
            let record = record.map_err(broken)?;
            let line = record.position().map_or(0, csv::Position::line);
            let (file, row) =
                row(&heading, &record, line, semicolons).map_err(|e| e.in_file(in_line(line)))?;
            if rows.insert(file.clone(), row).is_some() {
                let again = Error::Argument {
                    argument: "file",
                    got: format!("'{}' again", file.display()),
                    expected: "one row for each file",
                };
                return Err(again.in_file(in_line(line)));
            }
        }
        Ok(Self { rows })
    }

    /// What is given of a file.
    pub(in crate::cli::batch) fn of(&self, path: &Path) -> Option<Given> {
        self.row(path).map(|row| row.given)
    }

    /// The row that names most of the end of a path.
    fn row(&self, path: &Path) -> Option<Row> {
        let path = plain(Path::new(&name(path)));
        let parts: Vec<Component<'_>> = path.components().collect();
        let mut ends = (0..parts.len()).map(|from| parts[from..].iter().collect::<PathBuf>());
        ends.find_map(|end| self.rows.get(&end).copied())
    }

    /// The files without a row, and the names of no file with their lines.
    pub(in crate::cli::batch) fn unmatched<'a>(
        &self,
        files: impl Iterator<Item = &'a Path>,
    ) -> (Vec<&'a Path>, Vec<(&Path, u64)>) {
        let (mut missing, mut used) = (Vec::new(), HashSet::new());
        for file in files {
            match self.row(file) {
                Some(row) => used.extend([row.line]),
                None => missing.push(file),
            }
        }
        let rows = self
            .rows
            .iter()
            .map(|(file, row)| (file.as_path(), row.line));
        let mut unused: Vec<_> = rows.filter(|(_, line)| !used.contains(line)).collect();
        unused.sort_by_key(|(_, line)| *line);
        (missing, unused)
    }
}

fn check(heading: &csv::StringRecord) -> Result<(), Error> {
    let known = |column: &str| column == "file" || NAMES.contains(&column);
    let problem = match heading.iter().find(|column| !known(column)) {
        Some(column) => format!("'{column}'"),
        None if !heading.iter().any(|column| column == "file") => "without 'file'".to_owned(),
        None => return Ok(()),
    };
    Err(Error::Argument {
        argument: "column",
        got: problem,
        expected: "file and any of height, mass, diameter, separated by commas or by semicolons, named in the first line",
    })
}

fn row(
    heading: &csv::StringRecord,
    record: &csv::StringRecord,
    line: u64,
    decimal_commas: bool,
) -> Result<(PathBuf, Row), Error> {
    let (mut file, mut given) = (PathBuf::new(), Given::default());
    for (column, text) in heading.iter().zip(record) {
        match column {
            "file" => file = plain(Path::new(text)),
            _ if text.is_empty() => {}
            _ if decimal_commas => given.set(column, &text.replace(',', "."))?,
            _ => given.set(column, text)?,
        }
    }
    if file.as_os_str().is_empty() {
        return Err(Error::Argument {
            argument: "file",
            got: "empty".to_owned(),
            expected: "the name of a recording",
        });
    }
    Ok((file, Row { given, line }))
}

/// A path without `.`.
fn plain(path: &Path) -> PathBuf {
    let parts = path.components();
    parts.filter(|part| *part != Component::CurDir).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Table, Error> {
        Table::parse(text.as_bytes(), Path::new("t.csv"))
    }

    #[test]
    fn the_row_that_names_most_of_a_path_counts() {
        let table = parse(
            "\u{feff}mass, file,height\n2.5g,a.wav,30cm\n,tue/a.wav,40 cm\n2g,\"b, c.wav\",\n,x.wav,1m\n",
        )
        .unwrap();
        let height = |path: &str| table.of(Path::new(path)).and_then(|g| g.height_m);
        assert_eq!(height("./mon/a.wav"), Some(0.3));
        assert_eq!(height("/r/tue/a.wav"), Some(0.4));
        assert_eq!(height("ba.wav"), None);
        let given = table.of(Path::new("b, c.wav")).unwrap();
        assert_eq!((given.height_m, given.mass_kg), (None, Some(0.002)));
        let files = ["a.wav", "tue/a.wav", "b, c.wav", "d.wav"].map(Path::new);
        let (missing, unused) = table.unmatched(files.into_iter());
        assert_eq!(missing, [files[3]]);
        assert_eq!(unused, [(Path::new("x.wav"), 5)]);
    }

    #[test]
    fn a_table_of_a_spreadsheet_with_decimal_commas_is_read() {
        let table =
            parse("\u{feff}file;height;mass\r\na, b.wav;30,5 cm;2,7g\r\nc.wav;0.4;\r\n").unwrap();
        let first = table.of(Path::new("a, b.wav")).unwrap();
        assert_eq!((first.height_m, first.mass_kg), (Some(0.305), Some(0.0027)));
        assert_eq!(table.of(Path::new("c.wav")).unwrap().height_m, Some(0.4));
    }

    #[test]
    fn a_table_that_says_nothing_clear_is_refused_with_its_line() {
        for (text, line, expected) in [
            (
                "file|height\na.wav|1m\n",
                1,
                "separated by commas or by semicolons",
            ),
            ("file,height\na.wav,\"30,5cm\"\n", 2, "a decimal point"),
            ("name,height\na.wav,1m\n", 1, "column is 'name'"),
            ("height\n1m\n", 1, "without 'file'"),
            ("file,height\na.wav,1kg\n", 2, "30.5cm"),
            ("file,height\na.wav,1m\nb.wav,-1m\n", 3, "above 0"),
            ("file,height\na.wav,1m\n./a.wav,1m\n", 3, "one row for each"),
            ("file,height\n,1m\n", 2, "file is empty"),
            ("file,height\na.wav\n", 2, "fields"),
        ] {
            let error = parse(text).unwrap_err().to_string();
            assert!(
                error.contains("t.csv") && error.contains(expected),
                "{error}"
            );
            assert!(
                error.contains(&format!("line {line}")) || expected == "fields",
                "{error}"
            );
        }
    }
}
