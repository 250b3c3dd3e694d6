//! How far a batch is, on a terminal.

use indicatif::{ProgressBar, ProgressStyle};

/// A line with count and time left on a terminal's standard error; nothing anywhere else.
#[derive(Debug)]
pub(super) struct Progress(ProgressBar);

impl Progress {
    /// Of a batch of which some are done already.
    pub(super) fn new(all: usize, done: usize) -> Self {
        let bar = ProgressBar::new(all as u64).with_position(done as u64);
        let template = "{bar:30} {pos} of {len} recordings, {eta} left";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        // What was done before says nothing of the rate.
        bar.reset_eta();
        Self(bar)
    }

    pub(super) fn one_more(&self) {
        self.0.inc(1);
    }

    /// Prints something without the line in between.
    pub(super) fn aside<R>(&self, print: impl FnOnce() -> R) -> R {
        self.0.suspend(print)
    }

    pub(super) fn end(&self) {
        self.0.finish_and_clear();
    }
}
