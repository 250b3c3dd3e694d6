//! One impact of a drop, from the tracker over timing to the fit.

use crate::words::words;

words! {
    /// Whether an impact was heard.
    #[non_exhaustive]
    pub enum Status {
        /// It was.
        Heard = "heard",
        /// Something was heard, but chance offers as much nearby.
        Doubtful = "doubtful",
        /// Nothing was heard; its neighbours say that it was there.
        Inferred = "inferred",
    }
}

/// One impact of a drop: the tracker finds it, timing makes its time exact, the fit reads it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impact {
    /// Seconds from the start of the recording.
    pub time_s: f64,
    /// Standard error of the time in seconds; of no meaning where the impact is inferred.
    pub std_s: f64,
    /// Whether it was heard; an inferred impact bounds no flight that was measured.
    pub status: Status,
    /// What it adds to the evidence that this is a drop, in nats; infinite where a person set it.
    pub nats: f64,
}

impl Impact {
    /// An impact that was heard beyond doubt, at a time with its standard error, in seconds, as examples and tests make it.
    #[cfg(any(test, feature = "internals"))]
    #[must_use]
    pub const fn heard(time_s: f64, std_s: f64) -> Self {
        Self {
            time_s,
            std_s,
            status: Status::Heard,
            nats: 0.0,
        }
    }

    /// Whether something was heard, doubtful or not.
    #[must_use]
    pub fn is_heard(&self) -> bool {
        self.status != Status::Inferred
    }
}
