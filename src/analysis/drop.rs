//! One drop: its impacts timed and measured, its restitution fitted.

use super::agreement::Agreement;
use super::bounce::{bounce, rebound_height_std_m};
use super::first_rebound::FirstRebound;
use super::model::Modelled;
use super::release::release;
use super::stretch::Stretch;
use super::tail::Followed;
use super::warnings::FEWEST_OF_CHAIN;
use super::{Settings, few, irregular, model, rejected, warnings};
use crate::Error;
use crate::fit::Estimate;
use crate::fit::flights::Flights;
use crate::fit::irregular::Regularity;
use crate::fit::total_time::{self, Missing, TotalTime};
use crate::impact::Impact;
use crate::physics::BallModel;
use crate::report::{
    self, Drop, Estimates, Irregular, IrregularKind, Rejected, Scatter, Warning, WarningCode,
};
use crate::sequence::Chain;
use crate::statistics::upper_median;

/// A drop as measured, before its estimates: those depend on the end of the recording, which is known last.
#[derive(Debug, Clone)]
pub(super) struct Measured {
    /// Index of the channel that it was heard on, of those that were listened to.
    pub channel: usize,
    /// The impacts in order of time.
    pub impacts: Vec<report::Impact>,
    /// Evidence that it is a drop, in nats.
    pub evidence_nats: f64,
    timed: Vec<Impact>,
    bounces: usize,
    rejected: Vec<Rejected>,
    regularity: Regularity,
    irregular: Vec<Irregular>,
    modelled: Modelled,
    /// Warnings by impacts and sound.
    pub warnings: Vec<Warning>,
    /// That the impacts were given.
    pub given: Option<Warning>,
}

/// The part of a recording that was listened to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    /// Index of the first channel.
    pub first_channel: usize,
    /// The end, in seconds.
    pub end_s: f64,
}

impl Measured {
    /// The drop in a recording of which so much was listened to: if the ball would go on longer, there is no end and no
    /// total time.
    pub(super) fn within(self, extent: Extent, settings: &Settings) -> Result<Drop, Error> {
        if self.bounces < FEWEST_OF_CHAIN {
            return self.of_few(extent, settings);
        }
        let (timed, modelled) = (&self.timed, self.modelled);
        let flights = Flights::regular(timed, &self.regularity);
        let ratio = flights.ratio();
        let cut = warnings::of_end(timed, &flights, ratio, extent.end_s);
        let height = match (ratio, settings.height_m) {
            (Some(ratio), Some(height_m)) => {
                by_height(timed, &flights, ratio.value, height_m, settings)?
            }
            _ => ByHeight::default(),
        };
        let irregular = self.irregular;
        let lost = irregular.iter().any(|i| i.kind == IrregularKind::LostTime);
        let total = height.total.filter(|_| cut.is_none() && !lost);
        // Equations (25) and (30) are those of one e, and the estimates can agree only by one.
        let one = irregular.is_empty();
        let estimates = estimates(ratio, total.filter(|_| one), height.first_rebound);
        let agreement = Agreement::of(timed, &flights, &estimates, &modelled, settings)?;
        let agreement = agreement.filter(|_| one);
        // That the recording ends early says it all.
        let of_height = height
            .warning
            .filter(|w| cut.is_none() || w.code != WarningCode::EndedEarly);
        let warnings = of_height.into_iter().chain(modelled.warnings.clone());
        let warnings = warnings.chain(self.given).chain(cut);
        let warnings = warnings.chain(agreement.and_then(|a| a.warning()));
        let warnings = warnings.chain(irregular::warnings(&irregular, self.regularity.alternation));
        let first_flight = Flights::between(timed).after(0);
        let rebound = match first_flight.filter(|_| height.first_rebound.is_some()) {
            Some(flight_s) => FirstRebound::of(timed, flight_s, &modelled, settings)?,
            None => None,
        };
        let release = first_flight.map(|t| release(timed, t, &modelled, settings));
        Ok(Drop {
            channel: extent.first_channel + self.channel + 1,
            bounces: self.bounces,
            observed_time_s: observed_s(timed),
            release: release.transpose()?.flatten(),
            prediction: None,
            first_rebound: rebound.map(|r| r.rebound()),
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
            evidence_nats: self.evidence_nats,
            irregular,
            rejected: self.rejected,
            warnings: self.warnings.into_iter().chain(warnings).collect(),
            impacts: self.impacts,
        })
    }

    /// The drop where too few impacts were heard for a scatter, a trend or an end.
    fn of_few(self, extent: Extent, settings: &Settings) -> Result<Drop, Error> {
        let timed = &self.timed;
        let ratio = Flights::between(timed).ratio();
        let first_flight = Flights::between(timed)
            .after(0)
            .filter(|_| self.bounces > 2);
        let release = first_flight.map(|t| release(timed, t, &self.modelled, settings));
        let answer = few::answer(timed, self.modelled, settings)?;
        // An impact before the first would not let its flight fit the height.
        let fits = answer.estimate.is_some();
        let of_sound = self.warnings.into_iter();
        let of_sound = of_sound.filter(|w| !(fits && w.code == WarningCode::LateStart));
        let warnings = answer.warnings.into_iter().chain(self.given);
        let mut impacts = self.impacts;
        few::complete(&mut impacts, answer.first_bounce, settings);
        Ok(Drop {
            channel: extent.first_channel + self.channel + 1,
            bounces: self.bounces,
            observed_time_s: observed_s(timed),
            total_time_s: None,
            restitution: answer.modelled.restitution,
            estimates: estimates(ratio, None, answer.estimate),
            release: release.transpose()?.flatten(),
            prediction: None,
            first_rebound: answer.first_rebound,
            scatter: Scatter {
                timing_std_s: median_std(timed),
                bounce_std: None,
            },
            model: answer.modelled.model,
            ball: answer.modelled.ball,
            budget: None,
            evidence_nats: self.evidence_nats,
            irregular: Vec::new(),
            rejected: self.rejected,
            warnings: of_sound.chain(warnings).collect(),
            impacts,
        })
    }
}

/// From the first impact to the last, in seconds.
fn observed_s(timed: &[Impact]) -> f64 {
    let at = |impact: Option<&Impact>| impact.map_or(0.0, |i| i.time_s);
    at(timed.last()) - at(timed.first())
}

/// Times the impacts of a chain and fits them.
pub(super) fn measure(
    stretch: &Stretch<'_>,
    followed: Followed<'_>,
    channel: usize,
    settings: &Settings,
) -> Result<Measured, Error> {
    let Followed { chain, sound } = followed;
    let impacts = stretch.timed(&chain, &sound, settings.timing);
    fit(stretch, Chain { impacts, ..chain }, channel, settings)
}

/// Fits the impacts of a chain, whose times are as good as they get.
pub(super) fn fit(
    stretch: &Stretch<'_>,
    chain: Chain,
    channel: usize,
    settings: &Settings,
) -> Result<Measured, Error> {
    let timed = &chain.impacts;
    let regularity = Regularity::of(timed);
    let modelled = model::fitted(timed, &regularity.part, &regularity, settings)?;
    let mut warnings = warnings::of_chain(stretch, &chain);
    warnings.extend(warnings::of_contact(settings.contact_time_s, timed));
    let ball = modelled.ball_model.as_ref();
    let gravity = model::gravity_m_per_s2(settings)?;
    let impacts = impacts(stretch, timed, ball, gravity);
    warnings.extend(warnings::of_place(&modelled, &impacts));
    Ok(Measured {
        channel,
        impacts,
        evidence_nats: chain.evidence(),
        bounces: chain.heard(),
        rejected: chain.rejected.iter().map(rejected).collect(),
        irregular: irregular::reported(timed, &regularity, settings)?,
        regularity,
        modelled,
        warnings,
        given: None,
        timed: chain.impacts,
    })
}

/// Estimates by a height.
#[derive(Debug, Default)]
pub(super) struct ByHeight {
    pub total: Option<TotalTime>,
    pub first_rebound: Option<Estimate>,
    /// Why there is no total time.
    pub warning: Option<Warning>,
}

/// Estimates by the height of release, for flights of this ratio.
pub(super) fn by_height(
    timed: &[Impact],
    flights: &Flights,
    ratio: f64,
    height_m: f64,
    settings: &Settings,
) -> Result<ByHeight, Error> {
    let input = total_time::TimedDrop {
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

fn median_std(timed: &[Impact]) -> Option<f64> {
    upper_median(timed.iter().filter(|t| t.is_heard()).map(|t| t.std_s))
}

fn impacts(
    stretch: &Stretch<'_>,
    timed: &[Impact],
    ball: Option<&BallModel>,
    gravity: f64,
) -> Vec<report::Impact> {
    let flights = &Flights::between(timed);
    let impact = |(i, t): (usize, &Impact)| {
        let flight = flights.after(i);
        let before = i.checked_sub(1).and_then(|i| flights.after(i));
        let heard = t.is_heard().then_some(t);
        report::Impact {
            time_s: t.time_s,
            time_std_s: heard.map(|t| t.std_s),
            level_db: heard.and_then(|t| level_db(stretch, t.time_s)),
            interval_s: flight,
            ratio: flight.zip(before).map(|(now, before)| now / before),
            rebound_height_m: flight.map(|t| gravity * t * t / 8.0),
            rebound_height_std_m: rebound_height_std_m(timed, flights, i, gravity),
            bounce: bounce(timed, flights, i, ball, gravity),
            status: t.status,
        }
    };
    timed.iter().enumerate().map(impact).collect()
}

/// The sound of an impact is at its loudest within this many seconds before and after its onset.
const LOUDEST_WITHIN_S: (f64, f64) = (0.5e-3, 4e-3);

/// Peak of the samples of an impact in dB below full scale; none in silence.
fn level_db(stretch: &Stretch<'_>, time_s: f64) -> Option<f64> {
    let sound = stretch
        .sound
        .between(time_s - LOUDEST_WITHIN_S.0, time_s + LOUDEST_WITHIN_S.1);
    let peak = sound.iter().map(|x| x.abs()).fold(0.0, f32::max);
    (peak > 0.0).then(|| 20.0 * f64::from(peak).log10())
}

#[cfg(test)]
impl Measured {
    /// A drop of one impact of which nothing is known but its evidence.
    pub(super) fn with_evidence(evidence_nats: f64) -> Self {
        Self {
            channel: 0,
            impacts: vec![report::Impact::heard(1.0)],
            evidence_nats,
            timed: Vec::new(),
            bounces: 0,
            rejected: Vec::new(),
            regularity: Regularity::of(&[]),
            irregular: Vec::new(),
            modelled: Modelled::default(),
            warnings: Vec::new(),
            given: None,
        }
    }
}
