//! A drop of which only the times are known: from a camera, a switch, or a paper.

use super::Settings;
use super::drop::{Extent, fit};
use super::stretch::Stretch;
use crate::Error;
use crate::impact::{Impact, Status};
use crate::report::{Drop, Warning, WarningCode};
use crate::sequence::Chain;
use crate::signal::sound::Sound;
use crate::units::real;

/// Fewest impacts. Derived: they bound one flight.
const FEWEST: usize = 2;

/// Fits the times of a drop's impacts, each with its standard error, in seconds: `(time, error)`.
///
/// There is no sound: no impact has a level, and the drop is taken to have been watched from before its first impact until
/// it was over. Where listening starts and ends, and how impacts are timed, has no meaning here.
///
/// ```
/// use bounce_audio::{Settings, analyze_times};
///
/// let times_s = [1.0, 1.5, 1.9, 2.22, 2.476, 2.6808];
/// let drop = analyze_times(&times_s.map(|time_s| (time_s, 1e-4)), &Settings::default())?;
/// let e = drop.restitution.map(|r| r.estimate.value);
/// assert!((e.unwrap_or(0.0) - 0.8).abs() < 0.002);
/// # Ok::<(), bounce_audio::Error>(())
/// ```
///
/// # Errors
/// [`Error::Argument`] for fewer than two times, times that do not ascend, an error that is not above 0, or a setting out
/// of range.
pub fn analyze_times(times: &[(f64, f64)], settings: &Settings) -> Result<Drop, Error> {
    settings.check()?;
    check(times)?;
    let impact = |&(time_s, std_s): &(f64, f64)| Impact {
        time_s,
        std_s,
        status: Status::Heard,
        nats: f64::INFINITY,
    };
    let chain = Chain {
        impacts: times.iter().map(impact).collect(),
        rejected: Vec::new(),
    };
    let silence = Stretch {
        sound: Sound::from_start(&[], 1.0),
        listened_from_s: f64::NEG_INFINITY,
    };
    let mut measured = fit(&silence, chain, 0, settings)?;
    measured.given = Some(Warning::new(
        WarningCode::ImpactsGiven,
        "the impacts are the times that were given",
    ));
    let all = Extent {
        first_channel: 0,
        end_s: f64::INFINITY,
    };
    measured.within(all, settings)
}

fn check(times: &[(f64, f64)]) -> Result<(), Error> {
    if times.len() < FEWEST {
        let expected = "two or more: they bound a flight";
        return Err(Error::argument(
            "number of times",
            real(times.len()),
            expected,
        ));
    }
    for &(time_s, std_s) in times {
        if !time_s.is_finite() {
            return Err(Error::argument(
                "time",
                time_s,
                "a finite number of seconds",
            ));
        }
        if !(std_s > 0.0 && std_s.is_finite()) {
            let expected = "a number of seconds above 0";
            return Err(Error::argument("error of a time", std_s, expected));
        }
    }
    match times.windows(2).find(|w| w[1].0 <= w[0].0) {
        Some(pair) => Err(Error::argument("time", pair[1].0, "after the one before")),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Impacts of a ball with e = 0.8 whose first flight takes half a second.
    fn times(count: i32) -> Vec<(f64, f64)> {
        let at = |n: i32| 1.0 + 0.5 * (1.0 - 0.8_f64.powi(n)) / 0.2;
        (0..count).map(|n| (at(n), 1e-5)).collect()
    }

    #[test]
    fn times_alone_give_e() {
        let drop = analyze_times(&times(10), &Settings::default()).unwrap();
        let e = drop.restitution.unwrap().estimate;
        assert!((e.value - 0.8).abs() < 1e-3, "{e:?}");
        assert!(
            e.interval95
                .is_some_and(|[low, high]| low < 0.8 && 0.8 < high)
        );
        assert_eq!((drop.bounces, drop.impacts[0].level_db), (10, None));
        let codes: Vec<_> = drop.warnings.iter().map(|w| w.code).collect();
        assert!(codes.contains(&WarningCode::ImpactsGiven), "{codes:?}");
        assert!(!codes.contains(&WarningCode::LateStart), "{codes:?}");
        assert!(!codes.contains(&WarningCode::CutEnd), "{codes:?}");
    }

    #[test]
    fn what_is_no_drop_is_refused_by_name() {
        let settings = Settings::default();
        let said = |times: &[(f64, f64)]| analyze_times(times, &settings).unwrap_err().to_string();
        assert!(said(&times(1)).contains("number of times is 1"));
        assert!(said(&[(1.0, 1e-5), (1.0, 1e-5)]).contains("after the one before"));
        assert!(said(&[(1.0, 1e-5), (f64::NAN, 1e-5)]).contains("finite"));
        assert!(said(&[(1.0, 1e-5), (2.0, 0.0)]).contains("error of a time is 0"));
    }
}
