//! The rows of `docs/constants.md`.

/// What a value can rest on.
pub(crate) const CLASSES: [&str; 6] = [
    "derived",
    "measured",
    "convention",
    "limit",
    "structural",
    "unproven",
];

/// A number of a constant as the document has it.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Row {
    pub file: String,
    pub name: String,
    pub value: String,
    /// Written by hand: derived, measured, convention or structural, and from what.
    pub class: String,
    /// Written by hand: the value that switches off what the constant serves.
    pub off: String,
    /// What halving, doubling and switching off does.
    pub effects: [String; 3],
}

/// All rows of the document. A heading names the file of those below it.
pub(crate) fn read(text: &str) -> Vec<Row> {
    let mut rows = Vec::new();
    let mut file = "";
    for line in text.lines() {
        if let Some(heading) = line.strip_prefix("## ") {
            file = heading.trim_matches('`');
        }
        rows.extend(row(file, line));
    }
    rows
}

fn row(file: &str, line: &str) -> Option<Row> {
    let cells: Vec<&str> = line
        .strip_prefix("| `")?
        .split('|')
        .map(str::trim)
        .collect();
    let [name, value, _, class, halved, doubled, off, effect, ..] = cells.as_slice() else {
        return None;
    };
    Some(Row {
        file: file.to_owned(),
        name: name.trim_end_matches('`').to_owned(),
        value: value.trim_matches('`').to_owned(),
        class: (*class).to_owned(),
        off: (*off).to_owned(),
        effects: [halved, doubled, effect].map(|e| (*e).to_owned()),
    })
}
