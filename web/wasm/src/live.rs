//! The microphone: drops told while they are played.

use bounce_audio::Hears;
use wasm_bindgen::JsError;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::asked::Asked;
use crate::told;

/// A microphone that is listened to.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Live {
    inner: bounce_audio::Live,
}

#[wasm_bindgen]
impl Live {
    /// Listens to samples of this rate with the settings that are asked for.
    ///
    /// # Errors
    /// If a setting is out of range.
    #[wasm_bindgen(constructor)]
    pub fn new(sample_rate_hz: f64, asked: &str) -> Result<Self, JsError> {
        let settings = Asked::read(asked)?.settings;
        let inner = bounce_audio::Live::new(1, sample_rate_hz, &settings).map_err(told)?;
        Ok(Self { inner })
    }

    /// Hears the next samples; gives the drops that there are to tell, as JSON.
    ///
    /// # Errors
    /// If the rate is too low to listen at.
    pub fn hear(&mut self, samples: &[f32]) -> Result<String, JsError> {
        let drops = self.inner.hear(&[samples]).map_err(told)?;
        Ok(serde_json::to_string(&drops)?)
    }

    /// Whether a drop may be going on.
    #[must_use]
    pub fn hears_something(&self) -> bool {
        self.inner.hears() != Hears::Nothing
    }
}
