//! The ladder of models: constant e, and what is added where the recording supports it or the user knows it.

use super::bounces::{Known, Law, Terms};
use super::flights::Impact;
use super::model::{Fit, Fitted, Rival};

/// Which rung to take.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Choice {
    /// The one that the recording supports.
    #[default]
    Auto,
    /// Constant e.
    Constant,
    /// And the time in contact, which stands in every interval.
    Contact,
    /// And a linear ball that has this contact time: by its weight slow impacts last longer and lose more.
    Linear,
    /// And the drag of the air.
    Drag,
    /// And a power of the impact speed.
    Speed,
    /// Viscoelastic spheres: 1 − e goes with the fifth root of the impact speed.
    Viscoelastic,
}

/// What is known of the ball beforehand.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inputs {
    /// Contact time in seconds.
    pub contact_s: Option<Known>,
    /// `K = (g/v_t)²` in s⁻², from mass and diameter.
    pub drag_per_s2: Option<Known>,
}

/// One rung: what is fitted on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Rung {
    name: &'static str,
    contact: bool,
    drag: bool,
    speed: bool,
    law: Law,
}

/// Constant e.
const CONSTANT: Rung = Rung {
    name: "constant",
    contact: false,
    drag: false,
    speed: false,
    law: Law::Alike,
};

/// And the contact time.
const CONTACT: Rung = Rung {
    name: "contact",
    contact: true,
    ..CONSTANT
};

/// And the weight of a linear ball.
const LINEAR: Rung = Rung {
    name: "linear",
    law: Law::Linear,
    ..CONTACT
};

/// And slow impacts that lose less.
const VISCOELASTIC: Rung = Rung {
    name: "viscoelastic",
    law: Law::Viscoelastic,
    ..CONSTANT
};

/// From the simplest up. A model is compared with those that stand before it.
const RUNGS: [Rung; 9] = [
    CONSTANT,
    VISCOELASTIC,
    CONTACT,
    LINEAR,
    Rung {
        name: "drag",
        drag: true,
        ..CONSTANT
    },
    Rung {
        name: "speed",
        speed: true,
        ..CONSTANT
    },
    Rung {
        name: "contact+drag",
        drag: true,
        ..CONTACT
    },
    Rung {
        name: "linear+drag",
        drag: true,
        ..LINEAR
    },
    Rung {
        name: "contact+speed",
        speed: true,
        ..CONTACT
    },
];

/// C of balls at large, in seconds: from a steel ball's tenth of a millisecond to a basketball's twelve.
const CONTACT_KNOWN: Known = Known {
    value: 2e-3,
    std: 6e-3,
};
/// K of balls at large, s⁻²: nearly 0 for steel, 1.4 for a ping-pong ball, 5 for a foam ball.
const DRAG_KNOWN: Known = Known {
    value: 1.0,
    std: 2.0,
};
/// K where drag is no rung of its own: there is air all the same, 0.02 for steel, 0.1 for a golf ball. One in ten of what is
/// thought of as such a ball has more than 0.1.
const LITTLE_DRAG_KNOWN: Known = Known {
    value: 0.0,
    std: 0.06,
};
/// p of balls at large: e of a tennis ball falls by 6 % where the speed grows by e, that of a plastic one by 25 %.
const EXPONENT_KNOWN: Known = Known {
    value: 0.05,
    std: 0.1,
};
/// A rung is climbed where the data are likelier on it by this many nats: odds of 7 to 1.
const WORTH: f64 = 2.0;
/// Two models whose evidence differs by less than this are not told apart: odds of 20 to 1.
pub const ALIKE: f64 = 3.0;

/// A rung and how well it explains the drop.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Candidate {
    /// Its name.
    pub model: &'static str,
    /// ln of its evidence, less that of the first.
    pub gain_nats: f64,
    /// Its e.
    pub restitution: f64,
}

/// The rung taken and those compared.
#[derive(Debug, Clone, PartialEq)]
pub struct Climb {
    /// Name of the rung.
    pub selected: &'static str,
    /// The fit.
    pub fit: Fit,
    /// All that were fitted.
    pub candidates: Vec<Candidate>,
    /// Another model, with something else in place of what was selected, that explains the drop as well.
    pub alike: Option<&'static str>,
}

/// Fits the rung chosen, or climbs as far as the recording supports.
///
/// Evidence is the likelihood of the times with all parameters and the sizes of the noises integrated out over what is
/// known of balls at large, so a parameter that buys nothing costs. The error of e counts in that another rung may be
/// the right one. None for fewer than three impacts.
#[must_use]
pub fn climb(impacts: &[Impact], inputs: &Inputs, choice: Choice) -> Option<Climb> {
    let (contact, drag) = (inputs.contact_s.is_some(), inputs.drag_per_s2.is_some());
    let wanted = |rung: &Rung| match choice {
        Choice::Auto => true,
        Choice::Contact if !contact => rung.name == "contact",
        Choice::Linear => rung.law == Law::Linear && !rung.drag,
        Choice::Drag if !drag => rung.name == "drag",
        Choice::Speed => rung.name == "speed",
        Choice::Viscoelastic => rung.name == "viscoelastic",
        // What is known is in every rung.
        Choice::Constant | Choice::Contact | Choice::Drag => rung.name == "constant",
    };
    let fits: Vec<(&Rung, Fitted<'_>)> = RUNGS
        .iter()
        .filter(|r| wanted(r))
        .filter(|r| is_fitted(r, inputs))
        .filter_map(|r| Some((r, Fitted::new(impacts, &terms(r, inputs))?)))
        .collect();
    let lowest = fits.first()?.1.ln_evidence();
    let gain = |i: usize| fits[i].1.ln_evidence() - lowest;
    let mut best = 0;
    for (i, (rung, _)) in fits.iter().enumerate() {
        // Two parameters have to earn twice as much as one.
        let dearer = parameters(rung, inputs) - parameters(fits[best].0, inputs);
        if gain(i) > gain(best) + WORTH * dearer.max(0.0) {
            best = i;
        }
    }
    let candidates: Vec<Candidate> = fits
        .iter()
        .enumerate()
        .map(|(i, (rung, fit))| Candidate {
            model: rung.name,
            gain_nats: gain(i),
            restitution: fit.ln_restitution().exp(),
        })
        .collect();
    let selected = fits[best].0;
    let rival =
        |rung: &Rung| rung.drag != selected.drag && rung.is_by_speed() != selected.is_by_speed();
    let alike = (0..fits.len())
        .find(|&i| rival(fits[i].0) && (gain(i) - gain(best)).abs() < ALIKE)
        .map(|i| fits[i].0.name);
    // A rung is not preferred by less than it costs, so the one taken may have the lower evidence. What is much less likely
    // is discarded (Occam's window): far off, it would widen the standard error and not the interval.
    let highest = (0..fits.len()).map(gain).fold(f64::NEG_INFINITY, f64::max);
    let rivals: Vec<Rival> = (0..fits.len())
        .filter(|&i| i == best || gain(i) > highest - ALIKE)
        .filter_map(|i| fits[i].1.rival((gain(i) - gain(best)).exp()))
        .collect();
    let (_, fit) = fits.into_iter().nth(best)?;
    let mut fit = fit.summary().among(&rivals);
    if !selected.drag && inputs.drag_per_s2.is_none() {
        // It is not told from none.
        fit.drag_per_s2 = None;
    }
    Some(Climb {
        selected: selected.name,
        fit,
        candidates,
        alike,
    })
}

impl Rung {
    fn is_by_speed(&self) -> bool {
        self.speed || self.law == Law::Viscoelastic
    }
}

/// A term whose value is known is part of every rung and not a rung of its own.
fn is_fitted(rung: &Rung, inputs: &Inputs) -> bool {
    // The weight is: it comes with a contact, known or not.
    let contact_known = rung.contact && rung.law != Law::Linear && inputs.contact_s.is_some();
    !(contact_known || rung.drag && inputs.drag_per_s2.is_some())
}

fn terms(rung: &Rung, inputs: &Inputs) -> Terms {
    Terms {
        contact: inputs
            .contact_s
            .or_else(|| rung.contact.then_some(CONTACT_KNOWN)),
        drag: Some(inputs.drag_per_s2.unwrap_or(if rung.drag {
            DRAG_KNOWN
        } else {
            LITTLE_DRAG_KNOWN
        })),
        speed: rung.speed.then_some(EXPONENT_KNOWN),
        law: rung.law,
    }
}

/// How many parameters a rung fits; that e goes with speed has to earn as much where a law says how.
fn parameters(rung: &Rung, inputs: &Inputs) -> f64 {
    let contact = rung.contact && inputs.contact_s.is_none();
    let viscoelastic = rung.law == Law::Viscoelastic;
    [contact, rung.drag, rung.speed, viscoelastic]
        .iter()
        .filter(|on| **on)
        .map(|_| 1.0)
        .sum()
}
