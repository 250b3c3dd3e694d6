//! Lines no wider than a terminal.

use textwrap::{Options, WordSeparator, WordSplitter, WrapAlgorithm};

/// Columns of a terminal.
const WIDTH: usize = 80;

/// The text with line feeds for spaces where a line would get wider than a terminal; those that follow the first are
/// indented by `indent` columns. A word that is wider by itself stays whole.
pub(super) fn wrapped(text: &str, indent: usize) -> String {
    wrapped_to(text, indent, WIDTH)
}

/// The same for lines of another width.
pub(crate) fn wrapped_to(text: &str, indent: usize, width: usize) -> String {
    let indent = " ".repeat(indent);
    let options = Options::new(width)
        .subsequent_indent(&indent)
        .break_words(false)
        .word_separator(WordSeparator::AsciiSpace)
        .word_splitter(WordSplitter::NoHyphenation)
        .wrap_algorithm(WrapAlgorithm::FirstFit);
    textwrap::fill(text, options)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_before_the_edge_and_lose_no_word() {
        let text = format!("  head    {}", "seven 7 ± µs ".repeat(30).trim_end());
        let wrapped = wrapped(&text, 10);
        let lines: Vec<&str> = wrapped.split('\n').collect();
        assert!(lines.len() > 4 && lines[0].starts_with("  head    seven"));
        assert!(lines.iter().all(|line| line.chars().count() <= WIDTH));
        assert!(
            lines[1..]
                .iter()
                .all(|line| line.starts_with("          ") && !line.starts_with("           "))
        );
        let words = |text: &str| {
            text.split_whitespace()
                .map(str::to_owned)
                .collect::<Vec<_>>()
        };
        assert_eq!(words(&wrapped), words(&text));
    }

    #[test]
    fn what_fits_is_left_alone() {
        let text = "x".repeat(WIDTH);
        assert_eq!(wrapped(&text, 4), text);
        assert_eq!(wrapped("", 4), "");
    }
}
