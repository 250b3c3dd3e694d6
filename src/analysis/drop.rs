//! One drop: its impacts timed and measured, its restitution fitted.

use super::agreement::Agreement;
use super::bounce::{Corrections, bounce, rebound_height_std_m};
use super::tail::Followed;
use super::{Settings, Stretch, model, rejected, warnings};
use crate::Error;
use crate::fit::Estimate;
use crate::fit::flights::{Flights, Impact as Timed};
use crate::fit::total_time::{self, Missing, TotalTime};
use crate::report::{Drop, Estimates, Impact, Scatter, Status, Warning, WarningCode};
use crate::sequence::{Chain, Link};
use crate::statistics::upper_median;
use crate::timing::Timing;

/// A drop, as far as it can be known before the recording ends.
#[derive(Debug, Clone)]
pub(super) struct Measured {
    /// The drop.
    pub drop: Drop,
    /// How well the ways to e agree.
    agreement: Option<Agreement>,
    /// How long the ball would have gone on after its last impact, in seconds.
    left_s: Option<f64>,
}

impl Measured {
    /// The drop in a recording that was listened to up to `end_s`: if the ball would go on longer, there is no end.
    pub(super) fn until(self, end_s: f64) -> Drop {
        let (mut drop, mut agreement) = (self.drop, self.agreement);
        if let Some(cut) = warnings::of_end(&drop, self.left_s, end_s) {
            drop.total_time_s = None;
            (drop.estimates.eq25, drop.estimates.eq30) = (None, None);
            // That the recording ends early says it all.
            drop.warnings.retain(|w| w.code != WarningCode::EndedEarly);
            drop.warnings.push(cut);
            agreement = agreement.map(Agreement::without_end);
        }
        drop.warnings.extend(agreement.and_then(|a| a.warning()));
        drop
    }
}

/// Times the impacts of a chain and fits them.
pub(super) fn measure(
    stretch: &Stretch<'_>,
    followed: &Followed,
    channel: usize,
    settings: &Settings,
) -> Result<Measured, Error> {
    let timed = times(stretch, followed, settings);
    fit(stretch, &followed.chain, &timed, channel, settings)
}

/// Fits the impacts of a chain, which have these times.
pub(super) fn fit(
    stretch: &Stretch<'_>,
    chain: &Chain,
    timed: &[Timed],
    channel: usize,
    settings: &Settings,
) -> Result<Measured, Error> {
    let flights = Flights::between(timed);
    let ratio = flights.ratio();
    let mut warnings = warnings::of_chain(stretch, timed, chain);
    warnings.extend(warnings::of_contact(settings.contact_time_s, timed));
    let (total, first_rebound) = match (ratio, settings.height_m) {
        (Some(ratio), Some(height_m)) => {
            let height = by_height(timed, &flights, ratio.value, height_m, settings)?;
            warnings.extend(height.warning);
            (height.total, height.first_rebound)
        }
        _ => (None, None),
    };
    let estimates = estimates(ratio, total, first_rebound);
    let modelled = model::fitted(timed, settings)?;
    let agreement = Agreement::of(timed, &flights, &estimates, &modelled, settings)?;
    let corrections = modelled.corrections();
    warnings.extend(modelled.warnings);
    let gravity = settings.gravity_m_per_s2;
    let drop = Drop {
        channel: channel + 1,
        bounces: chain.heard(),
        observed_time_s: timed.last().map_or(0.0, |i| i.time_s)
            - timed.first().map_or(0.0, |i| i.time_s),
        total_time_s: total.map(|t| t.total_time_s),
        restitution: modelled.restitution,
        estimates,
        scatter: Scatter {
            timing_std_s: median_std(timed),
            bounce_std: modelled.bounce_std,
        },
        model: modelled.model,
        ball: modelled.ball,
        budget: modelled.budget,
        evidence_nats: chain.evidence,
        rejected: chain.rejected.iter().map(rejected).collect(),
        warnings,
        impacts: impacts(stretch, chain, timed, &flights, corrections, gravity),
    };
    Ok(Measured {
        drop,
        agreement,
        left_s: ratio.map(|r| total_time::left_s(timed, &flights, r.value)),
    })
}

/// What a height adds.
pub(super) struct ByHeight {
    pub total: Option<TotalTime>,
    pub first_rebound: Option<Estimate>,
    /// Why there is no total time.
    pub warning: Option<Warning>,
}

/// What follows from the height of release, for flights of this ratio.
pub(super) fn by_height(
    timed: &[Timed],
    flights: &Flights,
    ratio: f64,
    height_m: f64,
    settings: &Settings,
) -> Result<ByHeight, Error> {
    let input = total_time::Drop {
        impacts: timed,
        flights,
        restitution: ratio,
        height_m,
        height_std_m: settings.height_std_m,
        gravity_m_per_s2: settings.gravity_m_per_s2,
    };
    let solved = total_time::solve(&input)?;
    let unfit = matches!(
        solved,
        Err(Missing::FirstImpact { .. } | Missing::Height { .. })
    );
    Ok(ByHeight {
        first_rebound: if unfit {
            None
        } else {
            total_time::first_rebound(&input)
        },
        warning: warnings::of_total_time(&solved),
        total: solved.ok(),
    })
}

/// The heard impacts timed below a sample; those inferred stay where their neighbours put them.
fn times(stretch: &Stretch<'_>, followed: &Followed, settings: &Settings) -> Vec<Timed> {
    let chain = &followed.chain;
    let known = followed.timed.as_ref();
    let known = known.filter(|_| settings.timing == Timing::Correlation);
    let refined = known.map_or_else(|| stretch.timed(chain, settings.timing), Vec::clone);
    let mut refined = refined.into_iter();
    let timed = chain
        .links
        .iter()
        .map(|link| match link.event.and_then(|_| refined.next()) {
            Some(t) => Timed {
                time_s: stretch.start_s + t.time_s,
                std_s: t.std_s,
                heard: true,
            },
            None => Timed {
                time_s: link.time_s,
                std_s: 0.0,
                heard: false,
            },
        });
    timed.collect()
}

pub(super) fn estimates(
    ratio: Option<Estimate>,
    total: Option<TotalTime>,
    first_rebound: Option<Estimate>,
) -> Estimates {
    Estimates {
        flight_ratio: ratio,
        eq25: total.and_then(|t| t.eq25),
        eq30: total.and_then(|t| t.eq30),
        first_rebound,
    }
}

fn median_std(timed: &[Timed]) -> Option<f64> {
    upper_median(timed.iter().filter(|t| t.heard).map(|t| t.std_s))
}

fn impacts(
    stretch: &Stretch<'_>,
    chain: &Chain,
    timed: &[Timed],
    flights: &Flights,
    corrections: Corrections,
    gravity: f64,
) -> Vec<Impact> {
    let status = |link: &Link| match (link.event, link.doubtful) {
        (None, _) => Status::Inferred,
        (Some(_), true) => Status::Doubtful,
        (Some(_), false) => Status::Heard,
    };
    chain
        .links
        .iter()
        .zip(timed)
        .enumerate()
        .map(|(i, (link, t))| {
            let flight = flights.after(i);
            let before = i.checked_sub(1).and_then(|i| flights.after(i));
            Impact {
                time_s: t.time_s,
                time_std_s: t.heard.then_some(t.std_s),
                level_db: if t.heard {
                    level_db(stretch, t.time_s)
                } else {
                    None
                },
                interval_s: flight,
                ratio: flight.zip(before).map(|(now, before)| now / before),
                rebound_height_m: flight.map(|t| gravity * t * t / 8.0),
                rebound_height_std_m: rebound_height_std_m(timed, flights, i, gravity),
                bounce: bounce(timed, flights, i, corrections, gravity),
                status: status(link),
            }
        })
        .collect()
}

/// The sound of an impact is at its loudest within this many seconds before and after its onset.
const LOUDEST_WITHIN_S: (f64, f64) = (0.5e-3, 4e-3);

/// Peak of the samples of an impact in dB below full scale; none in silence.
fn level_db(stretch: &Stretch<'_>, time_s: f64) -> Option<f64> {
    let sound = stretch.between(time_s - LOUDEST_WITHIN_S.0, time_s + LOUDEST_WITHIN_S.1);
    let peak = sound.iter().map(|x| x.abs()).fold(0.0, f32::max);
    (peak > 0.0).then(|| 20.0 * f64::from(peak).log10())
}

#[cfg(test)]
impl From<Drop> for Measured {
    fn from(drop: Drop) -> Self {
        Self {
            drop,
            agreement: None,
            left_s: None,
        }
    }
}
