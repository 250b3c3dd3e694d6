//! Drops of one ball in one recording: what one of them explains is no clutter to another.

use super::chain::Track;
use super::reasons::associated;
use super::reassociate::against_bursts;
use super::shape::Shrinkage;
use super::track::Scene;

/// The chains that are drops beside one another, though none of them is alone.
///
/// Each of the chains, which share no event, begins a group with those that may be further drops of its ball: their flights
/// shrink alike at another time. Among all events but those of the group every member is judged, and the one with the
/// least evidence leaves it, until all of them have enough. A member alone is none.
pub(super) fn together(scene: &Scene<'_>, chains: &[Track], least_evidence: f64) -> Vec<Track> {
    for first in chains {
        let Some(shrinkage) = Shrinkage::of(&first.chain) else {
            continue;
        };
        let others = chains.iter().filter(|other| {
            let agrees = Shrinkage::of(&other.chain).is_some_and(|s| shrinkage.agrees(&s));
            agrees && is_apart(first, other)
        });
        let group = std::iter::once(first).chain(others).collect();
        let group = enough(scene, group, least_evidence);
        if group.len() > 1 {
            return group;
        }
    }
    Vec::new()
}

fn is_apart(a: &Track, b: &Track) -> bool {
    let ((a_first, a_last), (b_first, b_last)) = (a.chain.span_s(), b.chain.span_s());
    a_last < b_first || b_last < a_first
}

/// Gives back the member with the least evidence until all have enough.
fn enough(scene: &Scene<'_>, mut group: Vec<&Track>, least_evidence: f64) -> Vec<Track> {
    while group.len() > 1 {
        let own = group.iter().flat_map(|track| associated(scene, track));
        let mut own: Vec<usize> = own.collect();
        own.sort_unstable();
        own.dedup();
        let mut rates = scene.rates_without(&own);
        let among = group
            .iter()
            .map(|track| Track::new(against_bursts(track.steps.clone(), &mut rates)));
        let judged: Vec<Track> = among.collect();
        let evidences = judged
            .iter()
            .map(|track| track.chain.evidence())
            .enumerate();
        let worst = evidences.min_by(|a, b| a.1.total_cmp(&b.1));
        match worst {
            Some((worst, evidence)) if evidence < least_evidence => group.remove(worst),
            _ => return judged,
        };
    }
    Vec::new()
}
