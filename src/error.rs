//! The one error type of the library: variants carry facts, sentences are made here. What only a feature can meet is there
//! with that feature alone.

/// What can go wrong. Messages are lower case without a full stop, so that causes chain with `: `.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number given to a function or on the command line is outside the range in which it means something.
    #[error("{argument} is {got}, expected {expected}")]
    Argument {
        /// The argument, field or option at fault.
        argument: &'static str,
        /// What was given.
        got: String,
        /// The range or form that is accepted.
        expected: &'static str,
    },
    /// An equation has no solution for these inputs.
    #[error("no {quantity} gives {got}: attainable is {low} to {high}")]
    NoRoot {
        /// The unknown that was sought.
        quantity: &'static str,
        /// The value that cannot be reached, with its unit.
        got: String,
        /// Lower end of what can be reached, with its unit.
        low: String,
        /// Upper end of what can be reached, with its unit.
        high: String,
    },
    /// The content of a WAV file breaks its own format.
    #[error("not a readable WAV: {problem}")]
    #[cfg(feature = "audio")]
    Wav {
        /// What is wrong with it.
        problem: String,
    },
    /// What is no WAV cannot be read.
    #[error("not a readable recording: {problem}")]
    #[cfg(feature = "audio")]
    Recording {
        /// Why not, and what converts it.
        problem: String,
    },
    /// A line of a text is not what it should be.
    #[error("line {line}: {problem}")]
    Line {
        /// The line, from 1.
        line: usize,
        /// What is wrong with it and what is expected.
        problem: String,
    },
    /// A picture could not be drawn.
    #[error("cannot draw: {problem}")]
    #[cfg(feature = "plots")]
    Plot {
        /// Why not.
        problem: String,
    },
    /// Doing what was asked would lose something, or there is nothing to do it with.
    #[error("{problem}")]
    #[cfg(feature = "cli")]
    Refused {
        /// Why, and what to do about it.
        problem: String,
    },
    /// Reading or writing failed.
    #[error("{}", Self::of_system(.0))]
    #[cfg(feature = "audio")]
    Io(#[from] std::io::Error),
    /// An error that happened while working on one file.
    #[error("{file}: {source}")]
    #[cfg(feature = "audio")]
    InFile {
        /// The name of the file.
        file: String,
        /// What happened to it.
        source: Box<Error>,
    },
}

/// A number as a person would write it: `1e300` rather than a one and 300 zeros.
fn in_words(number: f64) -> String {
    if number == 0.0 || (1e-6..1e15).contains(&number.abs()) {
        number.to_string()
    } else {
        format!("{number:e}")
    }
}

impl Error {
    /// An [`Error::Argument`] for a number that is out of range.
    pub(crate) fn argument(argument: &'static str, got: f64, expected: &'static str) -> Self {
        Self::Argument {
            argument,
            got: in_words(got),
            expected,
        }
    }

    /// An [`Error::Refused`].
    #[cfg(feature = "cli")]
    pub(crate) fn refused(problem: impl Into<String>) -> Self {
        Self::Refused {
            problem: problem.into(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::in_words;

    #[test]
    fn numbers_are_short() {
        for (number, words) in [
            (0.0, "0"),
            (-1.5, "-1.5"),
            (4e9, "4000000000"),
            (1e300, "1e300"),
            (-2e-9, "-2e-9"),
            (f64::NAN, "NaN"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(in_words(number), words);
        }
    }
}
