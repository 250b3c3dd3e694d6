//! Bounces that do not go by the e of the others: single odd ones, flights that lost time, and e that changed for good.

mod alternating;
mod robust;

use std::ops::Range;

use super::flights::Flights;
use crate::impact::Impact;
use crate::statistics::median;
use crate::units::real;
use crate::words::words;
pub use alternating::Alternation;
use alternating::alternation;
use robust::{Accident, line, ln_odds, spread};

/// Of one bounce: what the tracker allows for.
const ODD: Accident = (0.02, 0.3);
/// Of a drop, e changing for good: as rare, and another surface differs by some per cent to a tenth.
const CHANGE: Accident = (0.02, 0.1);
/// Regular ratios on each side by which the local trend is judged: the trend by contact or drag is straight over these.
const NEIGHBOURS: usize = 5;
/// Regular ratios on each side by whose deviations the scatter is judged, which grows as impacts get faint.
const NEIGHBOURHOOD: usize = 10;
/// Fewest ratios of a drop that is judged: of fewer, three regular ones hardly outvote one that is odd.
const FEWEST: usize = 6;
/// Fewest and most ratios on each side of a change of e: with five, Theil and Sen's line stands one outlier among them.
const RUN: (usize, usize) = (5, 15);
/// Share of its deviation that each neighbour of a bounce has with the other sign if one wrong time explains all three: half
/// for equal flights, less where the scatter covers it.
const OF_WRONG_TIME: f64 = 0.25;
words! {
    /// How a bounce is irregular.
    #[non_exhaustive]
    pub enum Kind {
        /// It alone kept another share of the speed.
        Odd = "odd",
        /// From here on e is another.
        Changed = "changed",
        /// The flight after it is too short, and the bounces beside it are regular: the recording lacks a piece.
        LostTime = "lost_time",
    }
}

/// An irregular bounce.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Irregularity {
    /// Number of the impact, from 0.
    pub impact: usize,
    /// How.
    pub kind: Kind,
    /// Ratio of the flight after it to the one before; of a change, that of the bounces from it on.
    pub ratio: f64,
    /// The ratio to be expected by the bounces around it.
    pub expected: f64,
}

/// What is regular in a drop and what is not.
#[derive(Debug, Clone, PartialEq)]
pub struct Regularity {
    /// The irregular bounces in order of time.
    pub irregular: Vec<Irregularity>,
    /// The impacts whose bounces share one e; the part that lasts longer where it changed: the place of a change is uncertain by
    /// some of the many bounces at the end, and those last but little.
    pub part: Range<usize>,
    /// The impacts of the other part.
    pub other: Option<Range<usize>>,
    /// How bounces alternate that lose more and less by turns, which is regular.
    pub alternation: Option<Alternation>,
}

/// A bounce, by ln of its ratio: number, value, variance by the errors of the times.
type Ratio = (usize, f64, f64);

impl Regularity {
    /// Judges the ratios of neighbouring flights.
    ///
    /// # Formula
    /// With d the deviation of ln(T'/T) from the line of Theil and Sen through five ratios on each side, and s their scatter by
    /// the median deviation (of all, or of those near where that is more), a bounce is odd where
    /// ```text
    /// π·t(d; √(S² + s² + timing)) > (1 − π)·t(d; √(s² + timing)),   π = 0.02,  S = 0.3
    /// ```
    /// t is Student's density with the degrees of freedom of s. Two neighbours that deviate by −d and +d have a flight between them
    /// that is too short: lost time. e changes where lines through up to fifteen ratios before and after differ by as much more
    /// than their errors. A wrong time, +a, −a−b, +b, is no irregular bounce.
    #[must_use]
    pub fn of(impacts: &[Impact]) -> Self {
        let mut ratios = ratios(impacts);
        // Bounces that lose more and less by turns are regular about their mean.
        let turns = alternation(&ratios);
        for ratio in &mut ratios {
            ratio.1 -= turns.map_or(0.0, |turns| turns.at(ratio.0));
        }
        let Some(place) = change(&ratios) else {
            return Self {
                irregular: singles(&ratios),
                part: 0..impacts.len(),
                other: None,
                alternation: turns,
            };
        };
        let (before, after) = ratios.split_at(place);
        let middle = |part: &[Ratio]| median(part.iter().map(|r| r.1)).map_or(1.0, f64::exp);
        let impact = after[0].0;
        let changed = Irregularity {
            impact,
            kind: Kind::Changed,
            ratio: middle(after),
            expected: middle(before),
        };
        let mut irregular = singles(before);
        irregular.push(changed);
        irregular.extend(singles(after));
        // The flight before the change is the last of the one part and the first of the other.
        let parts = (0..impact + 1, impact - 1..impacts.len());
        let lasts_s =
            |part: &Range<usize>| impacts[part.end - 1].time_s - impacts[part.start].time_s;
        let (part, other) = if lasts_s(&parts.0) > lasts_s(&parts.1) {
            parts
        } else {
            (parts.1, parts.0)
        };
        Self {
            irregular,
            part,
            other: Some(other),
            alternation: turns,
        }
    }

    /// Odd bounces of a part, and those on either side of a flight that lost time.
    #[must_use]
    pub fn odd_in(&self, part: &Range<usize>) -> Vec<usize> {
        let bounces = self.irregular.iter().flat_map(|found| match found.kind {
            Kind::Odd => found.impact..found.impact + 1,
            Kind::LostTime => found.impact..found.impact + 2,
            Kind::Changed => 0..0,
        });
        let inside = |i: &usize| part.start < *i && i + 1 < part.end;
        bounces.filter(inside).collect()
    }
}

/// ln of each ratio with its variance by the errors of three times.
fn ratios(impacts: &[Impact]) -> Vec<Ratio> {
    let flights = Flights::between(impacts);
    let ratio = |(i, ln): (usize, f64)| {
        let (before, after) = (flights.after(i - 1)?, flights.after(i)?);
        let slopes = [1.0 / before, 1.0 / before + 1.0 / after, 1.0 / after];
        let errors = impacts[i - 1..].iter().zip(slopes);
        Some((
            i,
            ln,
            errors.map(|(t, slope)| (t.std_s * slope).powi(2)).sum(),
        ))
    };
    flights.ln_ratios().into_iter().filter_map(ratio).collect()
}

fn points(ratios: &[Ratio]) -> Vec<(f64, f64)> {
    ratios.iter().map(|r| (real(r.0), r.1)).collect()
}

/// The first bounce with another e, as an index into the ratios.
fn change(ratios: &[Ratio]) -> Option<usize> {
    let last = ratios.len().checked_sub(RUN.0)?;
    let places = real((last + 1).saturating_sub(RUN.0));
    let odds = |k: usize| {
        let run = RUN.1.min(k).min(ratios.len() - k);
        let (before, after) = (&ratios[k - run..k], &ratios[k..k + run]);
        let middle = 0.5 * (real(before.last()?.0) + real(after.first()?.0));
        let (from, off_before) = line(&points(before), middle)?;
        let (to, off_after) = line(&points(after), middle)?;
        let count = real(run);
        let (scatter, freedom) = spread(&[off_before, off_after].concat());
        // Two numbers are fitted to the points of each line; the errors of the times are in the scatter.
        let variance = scatter.powi(2) * count / (count - 2.0);
        // Of a line through m points, half a step past its end: 1/m + 3m/(m² − 1).
        let of_line = 1.0 / count + 3.0 * count / (count * count - 1.0);
        let prior = (CHANGE.0 / places, CHANGE.1);
        Some((
            ln_odds(to - from, (2.0 * of_line * variance, freedom), prior),
            k,
        ))
    };
    let best = (RUN.0..=last)
        .filter_map(odds)
        .max_by(|a, b| a.0.total_cmp(&b.0))?;
    (best.0 > 0.0).then(|| placed(ratios, best.1))
}

/// The place near one where two lines leave the least deviations: a longer run is surer of a change than of its place.
fn placed(ratios: &[Ratio], place: usize) -> usize {
    let near = points(&ratios[around(place, RUN.1, ratios.len())]);
    let first = place.saturating_sub(RUN.1);
    let left = |k: &usize| {
        let parts = [&near[..k - first], &near[k - first..]];
        let off = parts.iter().filter_map(|part| Some(line(part, 0.0)?.1));
        off.flatten().map(f64::abs).sum::<f64>()
    };
    let places = first + RUN.0 - 1..first + near.len() - RUN.0 + 2;
    places
        .min_by(|a, b| left(a).total_cmp(&left(b)))
        .unwrap_or(place)
}

/// So many places on each side of one, of all.
fn around(k: usize, side: usize, count: usize) -> Range<usize> {
    k.saturating_sub(side)..(k + side + 1).min(count)
}

/// Odd bounces and lost time among ratios of one e.
fn singles(ratios: &[Ratio]) -> Vec<Irregularity> {
    if ratios.len() < FEWEST {
        return Vec::new();
    }
    let expected: Vec<f64> = (0..ratios.len())
        .map(|k| {
            let mut near = points(&ratios[around(k, NEIGHBOURS, ratios.len())]);
            near.retain(|p| (p.0 - real(ratios[k].0)).abs() > 0.5);
            line(&near, real(ratios[k].0)).map_or(ratios[k].1, |(level, _)| level)
        })
        .collect();
    let off: Vec<f64> = ratios.iter().zip(&expected).map(|(r, e)| r.1 - e).collect();
    let all = spread(&off);
    let usual = |k: usize| {
        let near = spread(&off[around(k, NEIGHBOURHOOD, off.len())]);
        let (scatter, freedom) = if near.0 > all.0 { near } else { all };
        (scatter.powi(2) + ratios[k].2, freedom)
    };
    let wide = |k: usize| k < off.len() && ln_odds(off[k], usual(k), ODD) > 0.0;
    let found = |k: usize, kind| Irregularity {
        impact: ratios[k].0,
        kind,
        ratio: ratios[k].1.exp(),
        expected: expected[k].exp(),
    };
    let mut irregular = Vec::new();
    let mut k = 0;
    // The time of the last impact stands in the last ratio alone: it cannot be told from an odd bounce.
    while k + 1 < off.len() {
        let length = (k..off.len()).take_while(|&j| wide(j)).count();
        let cancels = |a: usize, b: usize| {
            (off[a] + off[b]).powi(2) < 9.0 * (usual(a).0 + usual(b).0) && off[a] < 0.0
        };
        let next = ratios[k + 1].0 == ratios[k].0 + 1;
        match length {
            1 if !is_wrong_time(&off, k) => irregular.push(found(k, Kind::Odd)),
            2 if next && cancels(k, k + 1) => irregular.push(found(k, Kind::LostTime)),
            2 if off[k] * off[k + 1] > 0.0 => {
                irregular.extend([found(k, Kind::Odd), found(k + 1, Kind::Odd)]);
            }
            _ => (),
        }
        k += length.max(1);
    }
    irregular
}

/// Whether one wrong time explains a deviation: then both neighbours deviate the other way.
fn is_wrong_time(off: &[f64], k: usize) -> bool {
    let against = |j: Option<usize>| {
        j.and_then(|j| off.get(j))
            .is_some_and(|o| -o / off[k] > OF_WRONG_TIME)
    };
    against(k.checked_sub(1)) && against(Some(k + 1))
}

#[cfg(test)]
mod tests;
