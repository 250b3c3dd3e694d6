//! Settings: known properties of the ball and how to listen, asked for by the user and repeated in the document.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use crate::Error;
use crate::fit::model_selection::Choice;
use crate::timing::Timing;

/// Known properties of the ball and how to listen: defaults, and a setter for each that may differ.
///
/// Numbers are taken as they come. [`analyze`](crate::analyze), [`Listener::new`](crate::Listener::new) and all else that
/// listens checks them once, before anything else: [`check`](Self::check) says which ranges they have.
///
/// ```
/// use bounce_audio::{ModelChoice, Settings};
///
/// let settings = Settings::default().height_m(0.305).mass_kg(2.5e-3).diameter_m(38e-3).model(ModelChoice::Drag);
/// assert!(settings.check().is_ok());
/// assert!(settings.height_m(-1.0).check().is_err());
/// ```
///
/// In JSON it is the `settings` of a document. Read from JSON, what is missing has its default and a name that is not
/// known is an error.
///
/// ```
/// use bounce_audio::Settings;
///
/// let settings: Settings = serde_json::from_str(r#"{"height_m": 0.305, "model": "drag"}"#)?;
/// assert_eq!((settings.height_m, settings.gravity_m_per_s2), (Some(0.305), 9.81));
/// assert!(serde_json::from_str::<Settings>(r#"{"hight_m": 0.305}"#).is_err());
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct Settings {
    /// From the ball's lowest point to the surface at release, in metres, if known. It applies to every drop.
    pub height_m: Option<f64>,
    /// Standard error of the height in metres. Default 1 mm: a ruler read by eye.
    pub height_std_m: f64,
    /// Gravity in m/s². Default 9.81.
    pub gravity_m_per_s2: f64,
    /// Mass of the ball in kg, if known: with the diameter it gives the drag of the air, with a contact time k and c.
    pub mass_kg: Option<f64>,
    /// Diameter of the ball in metres, if known.
    pub diameter_m: Option<f64>,
    /// Time in contact at each impact in seconds, if known, taken to be right within 5 %.
    pub contact_time_s: Option<f64>,
    /// The model of the intervals. Default: the one that the recording supports.
    pub model: Choice,
    /// Listen from here, in seconds. Default: the start.
    pub start_s: Option<f64>,
    /// Listen up to here, in seconds. Default: the end.
    pub end_s: Option<f64>,
    /// How impacts are timed. Default: correlation.
    pub timing: Timing,
    /// Time that a recording takes over the time that passed: 8 for sound slowed down eight times. Default 1. All times of a
    /// report are those that passed; where listening starts and ends is time of the recording.
    pub time_scale: f64,
    /// Relative standard error of the clock that the times are by. Default 0: that of a sound card, below 0.0001, counts for
    /// nothing.
    pub clock_std: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            height_m: None,
            height_std_m: 1e-3,
            gravity_m_per_s2: 9.81,
            mass_kg: None,
            diameter_m: None,
            contact_time_s: None,
            model: Choice::Auto,
            start_s: None,
            end_s: None,
            timing: Timing::default(),
            time_scale: 1.0,
            clock_std: 0.0,
        }
    }
}

impl Settings {
    /// The same with another [`height_m`](Self#structfield.height_m).
    #[must_use]
    pub fn height_m(mut self, height_m: impl Into<Option<f64>>) -> Self {
        self.height_m = height_m.into();
        self
    }

    /// The same with another [`height_std_m`](Self#structfield.height_std_m).
    #[must_use]
    pub const fn height_std_m(mut self, height_std_m: f64) -> Self {
        self.height_std_m = height_std_m;
        self
    }

    /// The same with another [`gravity_m_per_s2`](Self#structfield.gravity_m_per_s2).
    #[must_use]
    pub const fn gravity_m_per_s2(mut self, gravity_m_per_s2: f64) -> Self {
        self.gravity_m_per_s2 = gravity_m_per_s2;
        self
    }

    /// The same with another [`mass_kg`](Self#structfield.mass_kg).
    #[must_use]
    pub fn mass_kg(mut self, mass_kg: impl Into<Option<f64>>) -> Self {
        self.mass_kg = mass_kg.into();
        self
    }

    /// The same with another [`diameter_m`](Self#structfield.diameter_m).
    #[must_use]
    pub fn diameter_m(mut self, diameter_m: impl Into<Option<f64>>) -> Self {
        self.diameter_m = diameter_m.into();
        self
    }

    /// The same with another [`contact_time_s`](Self#structfield.contact_time_s).
    #[must_use]
    pub fn contact_time_s(mut self, contact_time_s: impl Into<Option<f64>>) -> Self {
        self.contact_time_s = contact_time_s.into();
        self
    }

    /// The same with another [`model`](Self#structfield.model).
    #[must_use]
    pub const fn model(mut self, model: Choice) -> Self {
        self.model = model;
        self
    }

    /// The same with another [`start_s`](Self#structfield.start_s).
    #[must_use]
    pub fn start_s(mut self, start_s: impl Into<Option<f64>>) -> Self {
        self.start_s = start_s.into();
        self
    }

    /// The same with another [`end_s`](Self#structfield.end_s).
    #[must_use]
    pub fn end_s(mut self, end_s: impl Into<Option<f64>>) -> Self {
        self.end_s = end_s.into();
        self
    }

    /// The same with another [`timing`](Self#structfield.timing).
    #[must_use]
    pub const fn timing(mut self, timing: Timing) -> Self {
        self.timing = timing;
        self
    }

    /// The same with another [`time_scale`](Self#structfield.time_scale).
    #[must_use]
    pub const fn time_scale(mut self, time_scale: f64) -> Self {
        self.time_scale = time_scale;
        self
    }

    /// The same with another [`clock_std`](Self#structfield.clock_std).
    #[must_use]
    pub const fn clock_std(mut self, clock_std: f64) -> Self {
        self.clock_std = clock_std;
        self
    }

    /// Whether the settings mean something, whatever the recording. Ranges reach far beyond any ball, and stay where no
    /// product of settings leaves those of the physics.
    ///
    /// # Errors
    /// [`Error::Argument`] for the first that is out of range.
    pub fn check(&self) -> Result<(), Error> {
        let within = |name, value: Option<f64>, range: RangeInclusive<f64>, expected| match value {
            Some(value) if !range.contains(&value) => Err(Error::argument(name, value, expected)),
            _ => Ok(()),
        };
        let gravity = Some(self.gravity_m_per_s2);
        within("gravity", gravity, 1e-3..=1e6, "0.001 to 1000000 m/s²")?;
        within("height", self.height_m, 1e-6..=1e4, "1 µm to 10 km")?;
        let height_error = Some(self.height_std_m);
        within("height error", height_error, 0.0..=1e4, "0 to 10 km")?;
        within("mass", self.mass_kg, 1e-9..=1e6, "1 µg to 1000 t")?;
        within("diameter", self.diameter_m, 1e-6..=1e3, "1 µm to 1 km")?;
        let contact_time = self.contact_time_s;
        within("contact time", contact_time, 1e-9..=1.0, "1 ns to 1 s")?;
        within(
            "time scale",
            Some(self.time_scale),
            1e-3..=1e3,
            "0.001 to 1000",
        )?;
        within(
            "clock error",
            Some(self.clock_std),
            0.0..=0.1,
            "0 to 0.1, or 0 to 10 %",
        )?;
        within("start", self.start_s, 0.0..=f64::MAX, "0 s or more")?;
        within("end", self.end_s, 0.0..=f64::MAX, "0 s or more")?;
        match (self.start_s, self.end_s) {
            (Some(start), Some(end)) if end <= start => {
                Err(Error::argument("end", end, "after the start"))
            }
            _ => Ok(()),
        }
    }
}
