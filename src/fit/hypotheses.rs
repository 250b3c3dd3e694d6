//! The models that may have made a drop, with their odds beforehand.
//!
//! Every ball touches and flies through air, so each model has a contact and a drag, little or much; what sets them apart
//! is the size of these, whether the weight acts in contact, and how e goes with the speed.

use super::bounces::{ImpactLaw, Terms};
use super::model_kind::ModelKind;
use super::model_selection::Inputs;
use crate::physics::priors::{
    BEND, Known, LITTLE_CONTACT_S, LITTLE_DRAG_PER_S2, LONG_CONTACT_S, MIDDLE_CONTACT_S,
    MUCH_DRAG_PER_S2, SPEED_EXPONENT,
};

/// A model, ln of its odds beforehand, and its kind.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Hypothesis {
    pub kind: ModelKind,
    pub ln_odds: f64,
    pub terms: Terms,
}

/// Odds of a little, middling and long contact. Convention: as balls are played with.
const CONTACT_ODDS: [f64; 3] = [0.25, 0.4, 0.35];
/// Odds of little and of much drag. Convention.
const DRAG_ODDS: [f64; 2] = [0.6, 0.4];
/// Odds of an e that is the same at all speeds, of one that is a power of the speed, and of any smooth e. Measured
/// (`examples/coverage outside`): with .6, .1 and .3 balls of other laws are held in .946 of the drops, with these in .958.
const SHAPE_ODDS: [f64; 3] = [0.25, 0.05, 0.7];

/// The course of e with the speed.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Shape {
    Same,
    Power,
    Smooth(f64),
}

/// A value that a term can have: what is known of it, its odds, and whether it makes a model of its own name.
type Likely = (Known, f64, bool);

/// The hypotheses of a law of the impacts. Only where these are alike does e depend on the speed in other ways: measured,
/// a smooth departure from the linear ball's course adds a tenth to the width of intervals and holds no more balls.
pub(super) fn of(law: ImpactLaw, inputs: &Inputs) -> Vec<Hypothesis> {
    let mut hypotheses = Vec::new();
    for (shape, shape_odds) in shapes(law) {
        for (contact, contact_odds, touches) in contacts(inputs) {
            for (drag, drag_odds, drags) in drags(inputs) {
                hypotheses.push(Hypothesis {
                    kind: kind(law, shape, touches, drags),
                    ln_odds: (shape_odds * contact_odds * drag_odds).ln(),
                    terms: Terms {
                        contact: Some(contact),
                        drag: Some(drag),
                        speed: (shape != Shape::Same).then_some(SPEED_EXPONENT),
                        bend: shape.bend(),
                        law,
                    },
                });
            }
        }
    }
    hypotheses
}

impl Shape {
    const fn bend(self) -> Option<f64> {
        match self {
            Self::Smooth(size) => Some(size),
            Self::Same | Self::Power => None,
        }
    }
}

fn shapes(law: ImpactLaw) -> Vec<(Shape, f64)> {
    let [same, power, smooth] = SHAPE_ODDS;
    if law != ImpactLaw::Alike {
        // As likely as that all impacts are alike: weight acts in every contact, but which share of e it takes hangs on the ball.
        return vec![(Shape::Same, same)];
    }
    let each = smooth / crate::units::real(BEND.len());
    let mut shapes = vec![(Shape::Same, same), (Shape::Power, power)];
    shapes.extend(BEND.map(|size| (Shape::Smooth(size), each)));
    shapes
}

fn contacts(inputs: &Inputs) -> Vec<Likely> {
    let [little, middle, long] = CONTACT_ODDS;
    inputs.contact_s.map_or_else(
        || {
            vec![
                (LITTLE_CONTACT_S, little, false),
                (MIDDLE_CONTACT_S, middle, true),
                (LONG_CONTACT_S, long, true),
            ]
        },
        |known| vec![(known, 1.0, false)],
    )
}

fn drags(inputs: &Inputs) -> Vec<Likely> {
    let [little, much] = DRAG_ODDS;
    inputs.drag_per_s2.map_or_else(
        || {
            vec![
                (LITTLE_DRAG_PER_S2, little, false),
                (MUCH_DRAG_PER_S2, much, true),
            ]
        },
        |known| vec![(known, 1.0, false)],
    )
}

fn kind(law: ImpactLaw, shape: Shape, touches: bool, drags: bool) -> ModelKind {
    match (law, shape) {
        (ImpactLaw::Viscoelastic, _) => ModelKind::Viscoelastic,
        (ImpactLaw::Linear, Shape::Same) if drags => ModelKind::LinearDrag,
        (ImpactLaw::Linear, Shape::Same) => ModelKind::Linear,
        (ImpactLaw::Alike, Shape::Same) => match (touches, drags) {
            (false, false) => ModelKind::Constant,
            (true, false) => ModelKind::Contact,
            (false, true) => ModelKind::Drag,
            (true, true) => ModelKind::ContactDrag,
        },
        (ImpactLaw::Alike, Shape::Power) if !drags && touches => ModelKind::ContactSpeed,
        (ImpactLaw::Alike, Shape::Power) if !drags => ModelKind::Speed,
        _ => ModelKind::Flexible,
    }
}
