//! How wide the terminal is, if there is one.

use std::io::{self, IsTerminal};

use terminal_size::{Width, terminal_size_of};

/// Columns of help and errors where there is no terminal, and the most that are used on one: longer lines are hard to read.
const MOST: usize = 100;

/// Columns of the terminal on standard output; none where that is a file or a pipe.
pub(super) fn output_width() -> Option<usize> {
    let output = io::stdout();
    let width = output.is_terminal().then(|| terminal_size_of(output));
    // A terminal that does not say how wide it is has the usual 80 columns.
    width.map(|size| size.map_or(80, |(Width(columns), _)| usize::from(columns)))
}

/// Columns of help and errors.
pub(super) fn help_width() -> usize {
    let errors = io::stderr();
    let of_errors = || terminal_size_of(errors).map(|(Width(columns), _)| usize::from(columns));
    output_width()
        .or_else(of_errors)
        .map_or(MOST, |columns| columns.min(MOST))
}
