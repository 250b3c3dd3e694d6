//! The models of one law of the impacts, fitted together: made linear about the likeliest of them.

use super::bounces::Bounces;
use super::hypotheses::Hypothesis;
use super::least_squares::NormalEquations;
use super::noise::{Noise, Sizes};
use super::posterior::{Model, Posterior, likeliest, ln_density};
use super::state::State;
use super::unfitted::Unfitted;

/// The models of one law, before intervals and budget are computed.
#[derive(Debug)]
pub(super) struct Fitted<'a> {
    pub state: State<'a>,
    pub bounces: Bounces,
    pub noise: Noise,
    pub hypotheses: Vec<Hypothesis>,
    pub models: Vec<Model>,
    pub posterior: Posterior,
}

impl<'a> Fitted<'a> {
    /// The posterior about a trial that has come to rest.
    pub(super) fn about(state: State<'a>, hypotheses: &[Hypothesis]) -> Result<Self, Unfitted> {
        let bounces = state.bounces().ok_or(Unfitted::NoFlight)?;
        let noise = state.noise(&bounces);
        let models = models(&state, hypotheses);
        let posterior = Posterior::over_noise(&bounces, &noise, &models).ok_or(Unfitted::Bound)?;
        Ok(Self {
            state,
            bounces,
            noise,
            hypotheses: hypotheses.to_vec(),
            models,
            posterior,
        })
    }
}

/// Brings a trial to rest about the likeliest of the models; gives ln of how likely that is.
///
/// The first trial is that of the model with the most of contact and drag and an e that is the same at all speeds, or else
/// of the first model.
pub(super) fn settle(state: &mut State<'_>, hypotheses: &[Hypothesis]) -> Result<f64, Unfitted> {
    let sharp = hypotheses.iter().rposition(|h| h.terms.speed.is_none());
    let mut at = sharp.unwrap_or(0);
    let begun = state.clone();
    state.terms = hypotheses[at].terms;
    if let Err(why) = state.converge() {
        if at == 0 {
            return Err(why);
        }
        at = 0;
        *state = begun;
        state.terms = hypotheses[at].terms;
        state.converge()?;
    }
    let mut tried = vec![at];
    loop {
        let (best, ln) = best(state, hypotheses)?;
        if tried.contains(&best) {
            return Ok(ln);
        }
        tried.push(best);
        let mut about_best = state.clone();
        about_best.terms = hypotheses[best].terms;
        if about_best.converge().is_err() {
            return Ok(ln);
        }
        *state = about_best;
    }
}

/// The likeliest of the models about a trial, and ln of how likely it is: at the scatter of the trial's own model and at
/// others about it, as models that explain less leave more to scatter.
fn best(state: &State<'_>, hypotheses: &[Hypothesis]) -> Result<(usize, f64), Unfitted> {
    let bounces = state.bounces().ok_or(Unfitted::NoFlight)?;
    let noise = state.noise(&bounces);
    let models = models(state, hypotheses);
    let (own, _) = likeliest(&bounces, &noise, &state.priors()).ok_or(Unfitted::NoNoise)?;
    let with_bends = hypotheses.iter().any(|h| h.terms.bend.is_some());
    let mut best: Option<(usize, f64)> = None;
    for factor in SCATTERS {
        let sizes = Sizes {
            bounce: factor * own.bounce,
            ..own
        };
        let Some(equations) = NormalEquations::of(&bounces, &noise, sizes, with_bends) else {
            continue;
        };
        for (number, model) in models.iter().enumerate() {
            let Some((ln_likelihood, _)) = equations.ln_likelihood(&model.priors) else {
                continue;
            };
            let ln = ln_likelihood + model.ln_odds + ln_density(sizes.bounce.ln());
            if best.is_none_or(|(_, most)| ln > most) {
                best = Some((number, ln));
            }
        }
    }
    best.ok_or(Unfitted::NoNoise)
}

/// Multiples of the scatter at which models are compared: the likelihood is flat within a factor of √2 for a dozen bounces.
const SCATTERS: [f64; 3] = [0.5, 1.0, 2.0];

fn models(state: &State<'_>, hypotheses: &[Hypothesis]) -> Vec<Model> {
    let model = |h: &Hypothesis| Model {
        ln_odds: h.ln_odds,
        priors: state.priors_of(&h.terms),
    };
    hypotheses.iter().map(model).collect()
}
