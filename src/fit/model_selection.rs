//! Model selection: constant e, and the terms that the recording supports or the user knows. The candidates are models of the
//! intervals, compared by their evidence.

use super::bounces::Terms;
use super::model::{Fit, Fitted, Parameter, Rival};
use super::model_kind::{BallParameters, ModelKind};
use crate::Error;
use crate::impact::Impact;
use crate::physics::BallModel;
use crate::physics::priors::{CONTACT_S, DRAG_PER_S2, Known, LITTLE_DRAG_PER_S2, SPEED_EXPONENT};
use crate::words::words;

words! {
    /// The model to fit.
    #[derive(Default)]
    #[non_exhaustive]
    pub enum Choice {
        /// The one that the recording supports.
        #[default]
        Auto = "auto",
        /// Constant e.
        Constant = "constant",
        /// And the time in contact, which stands in every interval.
        Contact = "contact",
        /// And a linear ball that has this contact time: by gravity in contact slow impacts last longer and lose more.
        Linear = "linear",
        /// And the drag of the air.
        Drag = "drag",
        /// And a power of the impact speed.
        Speed = "speed",
        /// Viscoelastic spheres: 1 − e goes with the fifth root of the impact speed.
        Viscoelastic = "viscoelastic",
    }
}

/// Known properties of the ball.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inputs {
    /// Contact time in seconds.
    pub contact_s: Option<Known>,
    /// `K = (g/v_t)²` in s⁻², from mass and diameter.
    pub drag_per_s2: Option<Known>,
}

/// From the simplest up. A model is compared with those that stand before it.
const CANDIDATES: [ModelKind; 9] = [
    ModelKind::Constant,
    ModelKind::Viscoelastic,
    ModelKind::Contact,
    ModelKind::Linear,
    ModelKind::Drag,
    ModelKind::Speed,
    ModelKind::ContactDrag,
    ModelKind::LinearDrag,
    ModelKind::ContactSpeed,
];

/// A dearer candidate is selected where its evidence is greater by this many nats for each parameter: odds of 7 to 1.
const WORTH: f64 = 2.0;
/// Two models whose evidence differs by less than this are not told apart: odds of 20 to 1.
pub(crate) const ALIKE: f64 = 3.0;

/// A model and how well it explains the drop.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub struct Candidate {
    /// Which.
    pub model: ModelKind,
    /// ln of its evidence, less that of the first.
    pub gain_nats: f64,
    /// Its e.
    pub restitution: f64,
}

/// The model selected and the candidates compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Selection {
    /// The model.
    pub selected: ModelKind,
    /// The fit.
    pub fit: Fit,
    /// All that were fitted.
    pub candidates: Vec<Candidate>,
    /// Another model, with something else in place of what was selected, that explains the drop as well.
    pub alike: Option<ModelKind>,
}

/// Fits the model chosen, or selects the one that the recording supports.
///
/// Evidence is the likelihood of the times with all parameters and the sizes of the noises integrated out over what is
/// known of balls at large, so a parameter that buys nothing costs. The bounces called odd, by their numbers from 0 with an impact
/// before and after each, have no say. The error of e counts in that another model may be
/// the right one. None for fewer than three impacts.
#[must_use]
pub fn select(
    impacts: &[Impact],
    odd: &[usize],
    inputs: &Inputs,
    choice: Choice,
) -> Option<Selection> {
    let (contact, drag) = (inputs.contact_s.is_some(), inputs.drag_per_s2.is_some());
    let wanted = match choice {
        Choice::Auto => None,
        Choice::Contact if !contact => Some(ModelKind::Contact),
        Choice::Linear => Some(ModelKind::Linear),
        Choice::Drag if !drag => Some(ModelKind::Drag),
        Choice::Speed => Some(ModelKind::Speed),
        Choice::Viscoelastic => Some(ModelKind::Viscoelastic),
        // Known terms are in every candidate.
        Choice::Constant | Choice::Contact | Choice::Drag => Some(ModelKind::Constant),
    };
    let fits: Vec<(ModelKind, Fitted<'_>)> = CANDIDATES
        .into_iter()
        .filter(|&r| wanted.is_none_or(|wanted| r == wanted))
        .filter(|&r| is_fitted(r, inputs))
        .filter_map(|r| Some((r, Fitted::new(impacts, odd, &terms(r, inputs))?)))
        .collect();
    let lowest = fits.first()?.1.ln_evidence();
    let gain = |i: usize| fits[i].1.ln_evidence() - lowest;
    let mut best = 0;
    for (i, (kind, _)) in fits.iter().enumerate() {
        // Two parameters have to earn twice as much as one.
        let dearer = parameters(*kind, inputs) - parameters(fits[best].0, inputs);
        if gain(i) > gain(best) + WORTH * dearer.max(0.0) {
            best = i;
        }
    }
    let candidates: Vec<Candidate> = fits
        .iter()
        .enumerate()
        .map(|(i, (kind, fit))| Candidate {
            model: *kind,
            gain_nats: gain(i),
            restitution: fit.ln_restitution().exp(),
        })
        .collect();
    let selected = fits[best].0;
    let rival = |kind: ModelKind| {
        kind.has_drag() != selected.has_drag() && kind.is_by_speed() != selected.is_by_speed()
    };
    let alike = (0..fits.len())
        .find(|&i| rival(fits[i].0) && (gain(i) - gain(best)).abs() < ALIKE)
        .map(|i| fits[i].0);
    // A candidate is not preferred by less than it costs, so the one selected may have the lower evidence. What is much less likely
    // is discarded (Occam's window): far off, it would widen the standard error and not the interval.
    let highest = (0..fits.len()).map(gain).fold(f64::NEG_INFINITY, f64::max);
    let rivals: Vec<Rival> = (0..fits.len())
        .filter(|&i| i == best || gain(i) > highest - ALIKE)
        .filter_map(|i| fits[i].1.rival((gain(i) - gain(best)).exp()))
        .collect();
    let (_, fit) = fits.into_iter().nth(best)?;
    let mut fit = fit.summary().among(&rivals);
    if !selected.has_drag() && inputs.drag_per_s2.is_none() {
        // The little drag of the prior is no result of the data.
        fit.drag_per_s2 = None;
    }
    Some(Selection {
        selected,
        fit,
        candidates,
        alike,
    })
}

impl Selection {
    /// The ball of the model selected, with e as fitted at the mean speed.
    ///
    /// # Errors
    /// As [`ModelKind::ball`].
    pub fn ball(&self, gravity_m_per_s2: f64) -> Result<BallModel, Error> {
        let value = |p: Option<Parameter>| p.map_or(0.0, |p| p.value);
        self.selected.ball(&BallParameters {
            restitution: self.fit.own_ln_restitution.exp(),
            at_speed_m_per_s: 0.5 * gravity_m_per_s2 * self.fit.mean_speed_s,
            contact_time_s: value(self.fit.contact_s),
            drag_per_s2: value(self.fit.drag_per_s2),
            speed_exponent: value(self.fit.exponent),
            gravity_m_per_s2,
        })
    }
}

/// Whether a model is a candidate: a term whose value is known is part of every model and makes none of its own.
fn is_fitted(kind: ModelKind, inputs: &Inputs) -> bool {
    // Gravity in contact comes with a contact, known or not.
    let contact_known = kind.has_contact() && !kind.is_linear() && inputs.contact_s.is_some();
    !(contact_known || kind.has_drag() && inputs.drag_per_s2.is_some())
}

fn terms(kind: ModelKind, inputs: &Inputs) -> Terms {
    Terms {
        contact: inputs
            .contact_s
            .or_else(|| kind.has_contact().then_some(CONTACT_S)),
        drag: Some(inputs.drag_per_s2.unwrap_or(if kind.has_drag() {
            DRAG_PER_S2
        } else {
            LITTLE_DRAG_PER_S2
        })),
        speed: kind.has_exponent().then_some(SPEED_EXPONENT),
        law: kind.law(),
    }
}

/// Number of parameters that a model fits; an e that goes with speed counts as one, also where a law fixes its course.
fn parameters(kind: ModelKind, inputs: &Inputs) -> f64 {
    let contact = kind.has_contact() && inputs.contact_s.is_none();
    [contact, kind.has_drag(), kind.is_by_speed()]
        .iter()
        .filter(|on| **on)
        .map(|_| 1.0)
        .sum()
}
