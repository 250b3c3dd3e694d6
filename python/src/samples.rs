//! Samples of an array where they are, and without what is no number.

use std::borrow::Cow;

use bounce_audio::{Error, Warning, WarningCode};

/// The channels of an array. Rows whose samples are all finite are not copied.
pub(crate) struct Samples<'a> {
    pub channels: Vec<Cow<'a, [f32]>>,
    /// Samples that were no finite numbers.
    pub not_finite: usize,
}

impl<'a> Samples<'a> {
    /// Of rows one after another, each of this length.
    pub(crate) fn of(all: &'a [f32], length: usize) -> Self {
        let mut not_finite = 0;
        let rows = all.chunks_exact(length.max(1));
        let channels = rows.map(|row| {
            let bad = row.iter().filter(|x| !x.is_finite()).count();
            not_finite += bad;
            if bad == 0 {
                return Cow::Borrowed(row);
            }
            // As it is read from a file: a NaN would reach every sum that touches it.
            let finite = |&x: &f32| if x.is_finite() { x } else { 0.0 };
            Cow::Owned(row.iter().map(finite).collect())
        });
        let channels = channels.collect();
        Self {
            channels,
            not_finite,
        }
    }
}

/// What a file with such samples says too.
pub(crate) fn repaired(not_finite: usize) -> Option<Warning> {
    let message = format!("samples that are not finite numbers were read as zero: {not_finite}");
    (not_finite > 0).then(|| Warning::new(WarningCode::Repaired, message))
}

/// The index of the one channel that is asked for, numbered from 1, of so many.
pub(crate) fn index(number: usize, channels: usize) -> Result<usize, Error> {
    if (1..=channels).contains(&number) {
        return Ok(number - 1);
    }
    Err(Error::Argument {
        argument: "channel",
        got: format!("{number} of {channels}"),
        expected: "\"best\" or the number of a channel, from 1",
    })
}
