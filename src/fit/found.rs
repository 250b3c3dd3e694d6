//! What the models of each kind make of a drop, and the kind that describes it.

use super::fitted::Fitted;
use super::model_kind::ModelKind;

/// A dearer candidate is selected where its evidence is greater by this many nats for each parameter: odds of 7 to 1.
const WORTH: f64 = 2.0;
/// What all models of a kind make of a drop.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found {
    pub kind: ModelKind,
    /// Number of the law under which it is likeliest.
    pub law: usize,
    /// ln of its evidence, and its mean ln e.
    pub ln_evidence: f64,
    pub ln_restitution: f64,
    /// Whether it has a share in the posterior.
    is_likely: bool,
}

impl Found {
    /// The evidence of a kind is the mean over its models by their odds. One that has no share in the posterior is known by its
    /// peaks alone, against that of the likeliest model.
    pub(super) fn of(kind: ModelKind, fits: &[Fitted<'_>]) -> Option<Self> {
        let by_law = fits.iter().enumerate().filter_map(|(law, fit)| {
            let models = fit.hypotheses.iter().enumerate();
            let own: Vec<usize> = models
                .filter(|(_, h)| h.kind == kind)
                .map(|(i, _)| i)
                .collect();
            let ln_odds = own
                .iter()
                .map(|&i| fit.hypotheses[i].ln_odds.exp())
                .sum::<f64>()
                .ln();
            let posterior = &fit.posterior;
            if let Some(given) = posterior.given(|p| own.contains(&p.model)) {
                let ln = given.ln_evidence - ln_odds;
                return Some((law, ln, given.moments(0).0, true));
            }
            let peaks = || posterior.peaks.iter().flatten();
            let top = peaks().map(|p| p.0).fold(f64::NEG_INFINITY, f64::max);
            let own = own.iter().filter_map(|&i| posterior.peaks[i]);
            let (peak, ln_e) = own.max_by(|a, b| a.0.total_cmp(&b.0))?;
            Some((
                law,
                posterior.ln_evidence + peak - top - ln_odds,
                ln_e,
                false,
            ))
        });
        let (law, ln_evidence, ln_restitution, is_likely) =
            by_law.max_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(Self {
            kind,
            law,
            ln_evidence,
            ln_restitution,
            is_likely,
        })
    }

    /// The one that describes the drop: a dearer one has to explain more.
    pub(super) fn described(found: &[Self]) -> Option<Self> {
        let mut likely = found.iter().filter(|f| f.is_likely);
        let mut best = *likely.next()?;
        for other in likely {
            // Two parameters have to earn twice as much as one.
            let dearer = parameters(other.kind) - parameters(best.kind);
            if other.ln_evidence > best.ln_evidence + WORTH * dearer.max(0.0) {
                best = *other;
            }
        }
        Some(best)
    }
}

/// Number of parameters that a kind of model has beside e; an e that goes with speed counts as one, also where a law fixes its
/// course.
fn parameters(kind: ModelKind) -> f64 {
    [kind.has_contact(), kind.has_drag(), kind.is_by_speed()]
        .iter()
        .filter(|on| **on)
        .map(|_| 1.0)
        .sum()
}
