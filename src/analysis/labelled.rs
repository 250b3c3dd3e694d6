//! Drops whose impacts a person set: they are fitted as they are.

use super::Settings;
use super::drop::{Extent, Measured, fit};
use super::stretch::Stretch;
use crate::Error;
use crate::impact::Impact;
use crate::report::labels::Marked;
use crate::report::{Analysis, Warning, WarningCode, counted};
use crate::sequence::Chain;
use crate::signal::sound::Sound;
use crate::units::real;

/// Fewest impacts of a drop. Derived: they bound one flight.
const FEWEST: usize = 2;
/// The sound of an impact, from its onset on, in seconds.
const SOUND_S: f64 = 4e-3;

/// Fits drops whose impacts are given, to the recording they are of: exactly those, nothing is searched for.
///
/// The samples only tell how loud the impacts are, and when the recording ends. Of several channels that is taken on
/// which the impacts stand out most; its index is given, the first being `first_channel` of the recording. Where listening starts and ends, and how impacts are timed,
/// has no meaning here.
///
/// # Errors
/// [`Error::Line`] for an impact after the recording's end and for a drop of which fewer than two impacts were heard,
/// [`Error::Argument`] for a setting out of range or no channels.
pub fn analyze_labelled<C: AsRef<[f32]>>(
    channels: &[C],
    first_channel: usize,
    sample_rate_hz: f64,
    drops: &[Vec<Marked>],
    settings: &Settings,
) -> Result<(usize, Analysis), Error> {
    settings.check()?;
    let stretches: Vec<Stretch<'_>> = channels
        .iter()
        .map(|samples| Stretch {
            sound: Sound::from_start(samples.as_ref(), sample_rate_hz),
            listened_from_s: 0.0,
        })
        .collect();
    let by_loudness = |a: &usize, b: &usize| {
        let loudness = |channel: &usize| standing_out(&stretches[*channel], drops);
        loudness(a).total_cmp(&loudness(b))
    };
    let best = (0..stretches.len()).rev().max_by(by_loudness);
    let Some(channel) = best else {
        return Err(Error::argument("channels", 0.0, "at least one"));
    };
    let stretch = &stretches[channel];
    let fitted = drops
        .iter()
        .map(|d| measured(stretch, d, channel, settings));
    let fitted = fitted.collect::<Result<Vec<Measured>, Error>>()?;
    let extent = Extent {
        first_channel,
        end_s: stretch.sound.end_s(),
    };
    let drops = fitted.into_iter().map(|m| m.within(extent, settings));
    Ok((
        first_channel + channel,
        Analysis {
            drops: drops.collect::<Result<_, Error>>()?,
            candidate: None,
            rejected: Vec::new(),
            rejected_weak: 0,
            warnings: Vec::new(),
        },
    ))
}

fn measured(
    stretch: &Stretch<'_>,
    marked: &[Marked],
    channel: usize,
    settings: &Settings,
) -> Result<Measured, Error> {
    let end_s = stretch.sound.end_s();
    if let Some(late) = marked.iter().find(|m| m.time_s >= end_s) {
        return Err(Error::Line {
            line: late.line,
            problem: format!(
                "{} s is after the recording ends, at {end_s} s",
                late.time_s
            ),
        });
    }
    let impact = |m: &Marked| Impact {
        time_s: m.time_s,
        std_s: m.std_s,
        status: m.status,
        nats: f64::INFINITY,
    };
    let chain = Chain {
        impacts: marked.iter().map(impact).collect(),
        rejected: Vec::new(),
    };
    if chain.heard() < FEWEST {
        return Err(Error::Line {
            line: marked.first().map_or(1, |m| m.line),
            problem: format!(
                "the drop that begins here has {} heard, a flight needs {FEWEST}",
                counted(chain.heard(), "impact")
            ),
        });
    }
    let mut measured = fit(stretch, chain, channel, settings)?;
    measured.given = Some(note(marked));
    Ok(measured)
}

/// That a person had a say in this.
fn note(marked: &[Marked]) -> Warning {
    let by_hand = marked.iter().filter(|m| m.by_hand).count();
    let message = format!(
        "the impacts are those of the labels: {by_hand} of {} set or moved by hand",
        marked.len()
    );
    Warning::new(WarningCode::ImpactsGiven, message)
}

/// Loudness of the impacts over that of the whole channel: the mean of ln(peak/rms).
fn standing_out(stretch: &Stretch<'_>, drops: &[Vec<Marked>]) -> f64 {
    let energy: f64 = stretch.sound.samples.iter().map(|x| f64::from(x * x)).sum();
    let rms = (energy / real(stretch.sound.samples.len()).max(1.0)).sqrt();
    let peak = |m: &Marked| {
        let sound = stretch.sound.between(m.time_s, m.time_s + SOUND_S);
        sound.iter().map(|x| x.abs()).fold(0.0, f32::max)
    };
    let marked = drops.iter().flatten();
    // A silent channel is the last choice; what is not there cannot make it infinite.
    let ln = |m: &Marked| (f64::from(peak(m)).max(1e-9) / rms.max(1e-9)).ln();
    marked.map(ln).sum()
}
