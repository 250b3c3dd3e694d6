//! Why a model could not be fitted.

use crate::words::words;

words! {
    /// Why a model could not be fitted.
    #[non_exhaustive]
    pub enum Unfitted {
        /// A flight would not be longer than the contact before it.
        NoFlight = "no_flight",
        /// Contact or drag would be greater than any ball has, or the flights can hold.
        Bound = "at_bound",
        /// The rounds of the fit find no rest.
        Restless = "no_rest",
        /// No scatter of the bounces explains the flights.
        NoNoise = "no_noise",
    }
}

impl Unfitted {
    /// The reason as words that follow the name of the model.
    #[must_use]
    pub const fn in_words(self) -> &'static str {
        match self {
            Self::NoFlight => "a flight would not be longer than the contact before it",
            Self::Bound => "contact or drag would be longer or greater than these flights can hold",
            Self::Restless => "its fit finds no rest",
            Self::NoNoise => "no scatter of the bounces explains the flights",
        }
    }
}
