//! Times below one sample.
//!
//! The recording is first [whitened](crate::signal::whiten), so that hum and rumble do not matter and the noise left is white. Then
//! each impact is timed by a constant fraction of its own rise, which does not walk with loudness, or all
//! are timed together (`joint`) by the sound that they have in common, which uses all of it. Where they have little in common
//! each is timed by its onset in several bands (`onset`).

mod joint;
mod onset;
mod pair;

use crate::impact::Impact;
use crate::signal::constant_fraction;
use crate::signal::template::Template;
use crate::signal::whiten::Whitened;
use crate::units::{real, samples_in};
use crate::words::words;

words! {
    /// How impacts are timed, from fastest to most exact.
    #[derive(Default)]
    #[non_exhaustive]
    pub enum Timing {
        /// The detector's own grid: a quarter of a millisecond, and free.
        Envelope = "envelope",
        /// Where the whitened sound first reaches a fixed fraction of its peak.
        Fraction = "fraction",
        /// Best match with the mean impact of the drop.
        #[default]
        Correlation = "correlation",
    }
}

/// Sound kept before and after each coarse time, in seconds: the jitter of the detector, the search, and the first
/// milliseconds of an impact, which hold most of its bandwidth.
const BEFORE_S: f64 = 3e-3;
const AFTER_S: f64 = 5e-3;

/// The impacts of a drop about where they are, and the sound that they have in common.
#[derive(Debug, Clone)]
pub struct Sketch {
    /// The impacts, those heard to a fraction of a millisecond.
    pub impacts: Vec<Impact>,
    /// Their template.
    pub template: Template,
}

/// What more impacts of a drop can be found by: `impacts` are as [`refine`] takes them. None where fewer than three are heard.
#[must_use]
pub fn sketch(sound: &Whitened<'_>, impacts: &[Impact]) -> Option<Sketch> {
    let (timed, template) = joint::sketch(sound, &heard(impacts))?;
    Some(Sketch {
        impacts: in_order(with_inferred(impacts, timed), impacts),
        template,
    })
}

fn heard(impacts: &[Impact]) -> Vec<Impact> {
    let heard = impacts.iter().copied().filter(Impact::is_heard);
    heard.collect()
}

/// All impacts, those heard as they are timed.
fn with_inferred(impacts: &[Impact], timed: Vec<Impact>) -> Vec<Impact> {
    let mut timed = timed.into_iter();
    let impacts = impacts.iter().map(|&impact| {
        let timed = impact.is_heard().then(|| timed.next());
        timed.flatten().unwrap_or(impact)
    });
    impacts.collect()
}

/// Times the heard impacts of one drop in its whitened sound: `impacts` are in ascending order, each with how far off its
/// time may be. The standard errors are without what all impacts of the drop share.
///
/// Where a method fails on an impact (its window is cut by the end of the recording, nothing rises in it, or it would pass
/// another) the coarse time stays, with its error.
#[must_use]
pub fn refine(sound: &Whitened<'_>, impacts: &[Impact], timing: Timing) -> Vec<Impact> {
    let heard = heard(impacts);
    let together = match timing {
        Timing::Correlation => joint::times(sound, &heard),
        Timing::Envelope | Timing::Fraction => None,
    };
    let pair = match (timing, heard.as_slice()) {
        (Timing::Correlation, &[first, second]) => pair::times(sound, [first, second]),
        _ => None,
    };
    // One drop is timed in one way: what its impacts have in common then cancels.
    let timed = match (together, pair, timing) {
        (Some(timed), ..) => timed,
        (None, Some(pair), _) => pair.to_vec(),
        (None, None, Timing::Envelope) => heard,
        (None, None, Timing::Fraction | Timing::Correlation) => {
            let each = heard.iter();
            let timed = each.map(|&coarse| by_fraction(sound, coarse).unwrap_or(coarse));
            timed.collect()
        }
    };
    in_order(with_inferred(impacts, timed), impacts)
}

/// Impacts with the coarse time of each that passed another: of two the one that is known less.
fn in_order(mut timed: Vec<Impact>, coarse: &[Impact]) -> Vec<Impact> {
    let passed = |timed: &[Impact]| timed.windows(2).position(|w| w[1].time_s <= w[0].time_s);
    while let Some(first) = passed(&timed) {
        let (a, b) = (first, first + 1);
        let less_known = if timed[a].std_s > timed[b].std_s {
            [a, b]
        } else {
            [b, a]
        };
        // One that has its coarse time has no other; of two the coarse times are in order.
        let moved = less_known.into_iter().find(|&i| timed[i] != coarse[i]);
        let Some(moved) = moved else { break };
        timed[moved] = coarse[moved];
    }
    timed
}

/// The time of one impact by its own rise.
fn by_fraction(sound: &Whitened<'_>, coarse: Impact) -> Option<Impact> {
    let rate = sound.sample_rate_hz();
    let centre = sound.sound().sample_at(coarse.time_s);
    let start = centre.checked_sub(samples_in(BEFORE_S, rate))?;
    let window = sound.between(start, centre + samples_in(AFTER_S, rate))?;
    let rise = constant_fraction::time(&window, centre - start, rate)?;
    Some(Impact {
        time_s: sound.sound().time_s(real(start) + rise.position),
        std_s: rise.std / rate,
        ..coarse
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_impact_that_passes_another_keeps_its_coarse_time() {
        let heard = |times: &[(f64, f64)]| -> Vec<Impact> {
            let each = times.iter().map(|&(t, std)| Impact::heard(t, std));
            each.collect()
        };
        let coarse = heard(&[(1.0, 1e-3), (1.1, 1e-3), (1.2, 1e-3), (1.3, 1e-3)]);
        // The third of them passed the second, and the last the third; the third is known least.
        let timed = heard(&[(1.001, 1e-6), (1.101, 1e-6), (1.0995, 5e-5), (1.099, 1e-5)]);
        let ordered = in_order(timed.clone(), &coarse);
        assert_eq!(ordered, [timed[0], timed[1], coarse[2], coarse[3]]);
        let kept = heard(&[(1.001, 1e-6), (1.101, 1e-6), (1.2, 1e-5), (1.301, 1e-6)]);
        assert_eq!(in_order(kept.clone(), &coarse), kept);
    }
}
