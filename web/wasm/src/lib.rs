//! bounce-audio for the page: a recording that is asked again and again, and a microphone that is listened to.
//!
//! What the page gets are the documents of the command: the JSON of `analyze`, its CSV, labels and SVG.

#![cfg_attr(
    test,
    allow(clippy::unwrap_used, reason = "a failing test should panic")
)]

mod asked;
mod live;
mod peaks;
mod recorded;
mod slices;

pub use asked::rules;
pub use live::Live;
pub use recorded::Recorded;

use std::io::Cursor;

use bounce_audio::Error;
use bounce_audio::audio::{Form, write_wav};
use wasm_bindgen::JsError;
use wasm_bindgen::prelude::wasm_bindgen;

/// A file of the library's error, with its whole sentence.
#[expect(clippy::needless_pass_by_value, reason = "`map_err` hands it over")]
fn told(error: Error) -> JsError {
    JsError::new(&error.to_string())
}

/// Samples of one channel as a WAV file, to the last bit.
///
/// # Errors
/// If there are more than a WAV file holds.
#[wasm_bindgen]
pub fn wav(samples: &[f32], sample_rate_hz: u32) -> Result<Vec<u8>, JsError> {
    let mut file = Cursor::new(Vec::new());
    write_wav(&mut file, sample_rate_hz, &[samples], Form::Float32).map_err(told)?;
    Ok(file.into_inner())
}
