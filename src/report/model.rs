//! The model of a drop as data, and the ball that it stands for.

use serde::{Deserialize, Serialize, Serializer};

use super::Drop;
use crate::fit::model_selection::{Candidate, Unfit};
use crate::fit::{BallParameters, Estimate, ModelKind};
use crate::physics::BallModel;
use crate::words::words;

/// The model of the flights.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Model {
    /// The model fitted; constant e where there are too few impacts for any.
    pub selected: ModelKind,
    /// Terms that were given and are in the model too, whatever its name.
    pub given: Vec<Given>,
    /// Its parameters.
    pub parameters: Parameters,
    /// The models that were compared.
    pub candidates: Vec<Candidate>,
    /// Those that could not be fitted, and why.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unfitted: Vec<Unfit>,
    /// Another model that explains the drop as well, with something else in place of what was selected.
    pub alike: Option<ModelKind>,
}

words! {
    /// Known properties of the ball, which are part of every model.
    #[non_exhaustive]
    pub enum Given {
        /// The contact time.
        ContactTime = "contact_time",
        /// The drag, by mass and diameter.
        Drag = "drag",
    }
}

/// The parameters of a model; those that it does not have are left out of the document.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Parameters {
    /// C, the contact time; of fast impacts for a linear ball.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "by_name")]
    pub contact_time_s: Option<Estimate>,
    /// K, the drag of the air.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "by_name")]
    pub drag_per_s2: Option<Estimate>,
    /// e at the mean speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub restitution: Option<f64>,
    /// p of `e ∝ v^(−p)`.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "by_name")]
    pub speed_exponent: Option<Estimate>,
}

/// The fields of a parameter stand in the document in the order of their names.
fn by_name<S: Serializer>(estimate: &Option<Estimate>, serializer: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct ByName {
        interval95: Option<[f64; 2]>,
        std_error: Option<f64>,
        value: f64,
    }
    let by_name = estimate.map(|e| ByName {
        interval95: e.interval95,
        std_error: e.std_error,
        value: e.value,
    });
    by_name.serialize(serializer)
}

impl Drop {
    /// The ball of the selected model: e and contact time at every speed, and its flight. None without e.
    #[must_use]
    pub fn ball_model(&self, gravity_m_per_s2: f64) -> Option<BallModel> {
        let e = self.restitution.as_ref()?.estimate.value;
        self.ball_model_with(e, gravity_m_per_s2)
    }

    /// The same with another e at the mean speed.
    #[must_use]
    pub fn ball_model_with(&self, restitution: f64, gravity_m_per_s2: f64) -> Option<BallModel> {
        let value = |estimate: Option<Estimate>| estimate.map_or(0.0, |e| e.value);
        let Parameters {
            contact_time_s,
            drag_per_s2,
            speed_exponent,
            ..
        } = self.model.parameters;
        let parameters = BallParameters {
            restitution,
            at_speed_m_per_s: self.restitution.as_ref()?.at_speed_m_per_s?,
            contact_time_s: value(contact_time_s),
            drag_per_s2: value(drag_per_s2),
            speed_exponent: value(speed_exponent),
            gravity_m_per_s2,
        };
        self.model.selected.ball(&parameters).ok()
    }
}
