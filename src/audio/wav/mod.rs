//! From the bytes of a WAV file to the samples of each channel, in blocks, and back.
//!
//! [`container`] finds the samples, [`stream`] reads them block by block, from any [`std::io::Read`], so a pipe is as
//! good as a file. [`write`](mod@write) makes one.

mod container;
mod decode;
mod format;
mod stream;
mod write;

pub(super) use container::fill;
pub(super) use decode::zero_what_is_not_finite;
pub(super) use stream::Stream;
pub use write::{Form, write_wav};

use crate::Error;

/// An [`Error::Wav`] for a problem.
fn wav(problem: impl Into<String>) -> Error {
    Error::Wav {
        problem: problem.into(),
    }
}
