//! Model selection: constant e, and the terms that the recording supports or the user knows. The candidates are models of the
//! intervals, compared by their evidence.

use super::bounces::{ImpactLaw, Terms};
use super::fitted::{Fitted, settle};
use super::found::Found;
use super::hypotheses::{self, Hypothesis};
use super::model::{FEWEST, Fit, Parameter};
use super::model_kind::{BallParameters, ModelKind};
use super::outlier::{self, Outliers};
use super::state::State;
use super::unfitted::Unfitted;
use crate::Error;
use crate::impact::Impact;
use crate::physics::BallModel;
use crate::physics::priors::{Known, LITTLE_CONTACT_S, LITTLE_DRAG_PER_S2};
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
        /// Contact, drag, and any smooth course of e with the speed.
        Flexible = "flexible",
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
const CANDIDATES: [ModelKind; 10] = [
    ModelKind::Constant,
    ModelKind::Viscoelastic,
    ModelKind::Contact,
    ModelKind::Linear,
    ModelKind::Drag,
    ModelKind::Speed,
    ModelKind::ContactDrag,
    ModelKind::LinearDrag,
    ModelKind::ContactSpeed,
    ModelKind::Flexible,
];

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

/// A model that could not be fitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[non_exhaustive]
pub struct Unfit {
    /// Which.
    pub model: ModelKind,
    /// Why.
    pub reason: Unfitted,
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
    /// Those that could not be fitted.
    pub unfitted: Vec<Unfit>,
    /// Another model, with something else in place of what was selected, that explains the drop as well.
    pub alike: Option<ModelKind>,
}

/// Fits all models, or those of the kind chosen; e is that by all of them, and the one that describes the drop is selected.
///
/// Evidence is the likelihood of the times with all parameters and the sizes of the noises integrated out over what is
/// known of balls at large, so a parameter that buys nothing costs. All models have the same outliers, which are found
/// under the likeliest, and state e at the same speed. The bounces called odd, by their numbers from 0 with an impact
/// before and after each, have no say. None for fewer than three impacts, nor where a contact that is given is longer than the
/// shortest interval.
#[must_use]
pub fn select(
    impacts: &[Impact],
    odd: &[usize],
    inputs: &Inputs,
    choice: Choice,
) -> Option<Selection> {
    let intervals = impacts.windows(2).map(|w| w[1].time_s - w[0].time_s);
    let shortest_s = intervals.fold(f64::INFINITY, f64::min);
    if inputs.contact_s.is_some_and(|c| c.value >= shortest_s) {
        return None;
    }
    fit_laws(impacts, odd, &laws(inputs, choice))
}

/// The models of each law of the impacts.
fn laws(inputs: &Inputs, choice: Choice) -> Vec<Vec<Hypothesis>> {
    let wanted = wanted(inputs, choice);
    let laws: &[ImpactLaw] = match choice {
        Choice::Viscoelastic => &[ImpactLaw::Viscoelastic],
        _ => &[ImpactLaw::Alike, ImpactLaw::Linear],
    };
    let models = laws.iter().map(|&law| {
        let mut models = hypotheses::of(law, inputs);
        models.retain(|m| wanted.is_none_or(|wanted| m.kind == wanted));
        models
    });
    models.filter(|models| !models.is_empty()).collect()
}

/// The kind of model that is forced.
const fn wanted(inputs: &Inputs, choice: Choice) -> Option<ModelKind> {
    let (contact, drag) = (inputs.contact_s.is_some(), inputs.drag_per_s2.is_some());
    match choice {
        Choice::Auto => None,
        Choice::Contact if !contact => Some(ModelKind::Contact),
        Choice::Linear => Some(ModelKind::Linear),
        Choice::Drag if !drag => Some(ModelKind::Drag),
        Choice::Speed => Some(ModelKind::Speed),
        Choice::Viscoelastic => Some(ModelKind::Viscoelastic),
        Choice::Flexible => Some(ModelKind::Flexible),
        // Known terms are in every candidate.
        Choice::Constant | Choice::Contact | Choice::Drag => Some(ModelKind::Constant),
    }
}

/// Fits the models of these laws.
pub(super) fn fit_laws(
    impacts: &[Impact],
    odd: &[usize],
    laws: &[Vec<Hypothesis>],
) -> Option<Selection> {
    if impacts.len() < FEWEST {
        return None;
    }
    let Fits {
        fits,
        failed,
        outliers,
    } = Fits::of(impacts, odd, laws)?;
    let lost: f64 = failed.iter().map(|(law, _)| odds(&laws[*law])).sum();
    let fitted: f64 = fits.iter().map(|f| odds(&f.hypotheses)).sum();
    let found: Vec<Found> = CANDIDATES
        .into_iter()
        .filter_map(|kind| Found::of(kind, &fits))
        .collect();
    let best = Found::described(&found)?;
    let (selected, lowest) = (best.kind, found.first()?.ln_evidence);
    let candidates = found.iter().map(|f| Candidate {
        model: f.kind,
        gain_nats: f.ln_evidence - lowest,
        restitution: f.ln_restitution.exp(),
    });
    let rival = |f: &&Found| {
        let (kind, gain) = (f.kind, f.ln_evidence - best.ln_evidence);
        kind.has_drag() != selected.has_drag()
            && kind.is_by_speed() != selected.is_by_speed()
            && gain.abs() < ALIKE
    };
    let mut fit = Fit::of(&fits, (best.law, selected), lost / fitted, outliers)?;
    if !selected.has_drag() && !is_given(&fits, |t| t.drag, LITTLE_DRAG_PER_S2) {
        // The little drag of the prior is no result of the data, …
        fit.drag_per_s2 = None;
    }
    if !selected.has_contact() && !is_given(&fits, |t| t.contact, LITTLE_CONTACT_S) {
        // … nor is the little contact.
        fit.contact_s = None;
    }
    Some(Selection {
        selected,
        candidates: candidates.collect(),
        unfitted: unfit(laws, &failed, &found),
        alike: found.iter().find(rival).map(|f| f.kind),
        fit,
    })
}

/// Fits one model alone.
#[cfg(test)]
pub(super) fn fit(impacts: &[Impact], terms: &Terms) -> Option<Fit> {
    let alone = Hypothesis {
        kind: ModelKind::Constant,
        ln_odds: 0.0,
        terms: *terms,
    };
    Some(fit_laws(impacts, &[], &[vec![alone]])?.fit)
}

/// Whether a term is known, and not the little that every ball has.
fn is_given(fits: &[Fitted<'_>], term: fn(&Terms) -> Option<Known>, little: Known) -> bool {
    let mut models = fits.iter().flat_map(|f| &f.hypotheses);
    models.all(|m| term(&m.terms).is_some_and(|t| t != little))
}

fn odds(models: &[Hypothesis]) -> f64 {
    models.iter().map(|m| m.ln_odds.exp()).sum()
}

/// The laws fitted, and those that could not be, by their numbers.
struct Fits<'a> {
    fits: Vec<Fitted<'a>>,
    failed: Vec<(usize, Unfitted)>,
    outliers: Outliers,
}

impl<'a> Fits<'a> {
    /// All laws under one set of outliers and one speed of reference: those of the likeliest model.
    fn of(impacts: &'a [Impact], odd: &[usize], laws: &[Vec<Hypothesis>]) -> Option<Self> {
        let mut failed = Vec::new();
        let mut settled = Vec::new();
        for (number, models) in laws.iter().enumerate() {
            let mut state = State::new(impacts, odd, &models.first()?.terms);
            match settle(&mut state, models) {
                Ok(ln) => settled.push((number, ln, state)),
                Err(why) => failed.push((number, why)),
            }
        }
        let best = (0..settled.len()).max_by(|&a, &b| settled[a].1.total_cmp(&settled[b].1))?;
        let outliers = outlier::find(&mut settled[best].2)?;
        let leader = settled[best].2.clone();
        let reference = leader.bounces()?.reference;
        let mut fits = Vec::new();
        for (number, _, mut state) in settled {
            state.reference = Some(reference);
            let resettled = if outliers == Outliers::default() {
                Ok(0.0)
            } else {
                state.doubt_like(&leader);
                settle(&mut state, &laws[number])
            };
            match resettled.and_then(|_| Fitted::about(state, &laws[number])) {
                Ok(fit) => fits.push(fit),
                Err(why) => failed.push((number, why)),
            }
        }
        Some(Self {
            fits,
            failed,
            outliers,
        })
    }
}

/// The kinds that could not be fitted under any law.
fn unfit(laws: &[Vec<Hypothesis>], failed: &[(usize, Unfitted)], found: &[Found]) -> Vec<Unfit> {
    let lacking = CANDIDATES
        .into_iter()
        .filter(|&kind| found.iter().all(|f| f.kind != kind));
    lacking
        .filter_map(|model| {
            let of = |failed: &&(usize, Unfitted)| laws[failed.0].iter().any(|m| m.kind == model);
            let (_, reason) = *failed.iter().find(of)?;
            Some(Unfit { model, reason })
        })
        .collect()
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
