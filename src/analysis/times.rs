//! Drops whose impact times are known without a recording: they are fitted as those of a recording are.

use super::Settings;
use super::drop::{Extent, fit};
use super::stretch::Stretch;
use crate::Error;
use crate::impact::{Impact, Status};
use crate::report::{Analysis, Drop, Warning, WarningCode, counted};
use crate::sequence::Chain;
use crate::signal::sound::Sound;

/// Fewest impacts of a drop. Derived: they bound one flight.
const FEWEST: usize = 2;

/// Fits drops whose impact times were measured by other means, such as a light gate, a video or a list: what
/// [`analyze`](crate::analyze) says once it has the times of a recording. Each drop is its times with their independent standard
/// errors, `(time, error)` in seconds, by a clock that may run at another rate (`time_scale`). It is taken to have been
/// watched whole. Where listening starts and ends, and how impacts are timed, has no meaning here.
///
/// ```
/// use bounce_audio::{Settings, fit_times};
///
/// // Flights of 0.8, 0.64, 0.512, … s.
/// let mut times = vec![(0.0, 1e-4)];
/// for n in 0..8 {
///     times.push((times[n].0 + 0.8 * 0.8_f64.powi(n as i32), 1e-4));
/// }
/// let analysis = fit_times(&[times], &Settings::default())?;
/// let e = analysis.drops[0].restitution.as_ref().map(|r| r.estimate.value);
/// assert!((e.unwrap_or(0.0) - 0.8).abs() < 0.002);
/// # Ok::<(), bounce_audio::Error>(())
/// ```
///
/// # Errors
/// [`Error::Argument`] for a setting out of range, a standard error that is none, no drops, fewer than two times, and times
/// that do not grow.
pub fn fit_times(drops: &[Vec<(f64, f64)>], settings: &Settings) -> Result<Analysis, Error> {
    settings.check()?;
    if drops.is_empty() {
        return Err(Error::argument("number of drops", 0.0, "1 or more"));
    }
    let fitted = drops
        .iter()
        .zip(1..)
        .map(|(times, number)| fitted(times, number, settings));
    Ok(Analysis {
        drops: fitted.collect::<Result<_, Error>>()?,
        candidate: None,
        rejected: Vec::new(),
        rejected_weak: 0,
        warnings: Vec::new(),
    })
}

fn fitted(times: &[(f64, f64)], number: usize, settings: &Settings) -> Result<Drop, Error> {
    check(times, number)?;
    let impact = |&(time_s, std_s): &(f64, f64)| Impact {
        time_s: time_s / settings.time_scale,
        std_s: std_s / settings.time_scale,
        status: Status::Heard,
        nats: f64::INFINITY,
    };
    let chain = Chain {
        impacts: times.iter().map(impact).collect(),
        rejected: Vec::new(),
    };
    let stds = chain.impacts.iter().map(|i| three_digits(1e3 * i.std_s));
    let (least, most) = stds.fold((f64::INFINITY, 0.0), |(a, b): (f64, f64), s| {
        (a.min(s), b.max(s))
    });
    let errors = if least < most {
        format!("± {least} to {most} ms")
    } else {
        format!("each ± {most} ms")
    };
    let mut measured = fit(&NO_SOUND, chain, 0, settings)?;
    let message = format!(
        "the impact times are those you gave: {}, {errors}",
        counted(times.len(), "impact"),
    );
    measured.given = Some(Warning::new(WarningCode::ImpactsGiven, message));
    measured.within(no_end(), settings)
}

/// A positive number with no more than three digits.
fn three_digits(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// The levels of impacts in it are unknown, and it begins before any of them.
const NO_SOUND: Stretch<'static> = Stretch {
    sound: Sound::from_start(&[], 1.0),
    listened_from_s: f64::NEG_INFINITY,
};
/// Times say nothing of when someone stopped listening.
const fn no_end() -> Extent {
    Extent {
        first_channel: 0,
        end_s: f64::INFINITY,
    }
}

fn check(times: &[(f64, f64)], number: usize) -> Result<(), Error> {
    let wrong = |got: String, expected| Error::Argument {
        argument: "times",
        got,
        expected,
    };
    if times.len() < FEWEST {
        let got = format!("{} in drop {number}", times.len());
        return Err(wrong(got, "two or more, which bound a flight"));
    }
    if let Some((time_s, _)) = times.iter().find(|(t, _)| !t.is_finite()) {
        return Err(wrong(format!("{time_s} s in drop {number}"), "numbers"));
    }
    let certain = |std_s: f64| std_s > 0.0 && std_s.is_finite();
    if let Some(&(_, std_s)) = times.iter().find(|(_, s)| !certain(*s)) {
        return Err(Error::argument("time error", std_s, "above 0"));
    }
    match times.windows(2).find(|pair| pair[1].0 <= pair[0].0) {
        Some(pair) => {
            let got = format!("{} s after {} s in drop {number}", pair[1].0, pair[0].0);
            Err(wrong(got, "times that grow"))
        }
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The times of a ball that keeps e of its speed.
    fn times(e: f64, first_flight_s: f64, impacts: i32) -> Vec<f64> {
        let at = |n| 1.0 + first_flight_s * (1.0 - e.powi(n)) / (1.0 - e);
        (0..impacts).map(at).collect()
    }

    #[test]
    fn what_is_no_drop_is_refused_with_its_number() {
        let settings = Settings::default();
        for (drops, std_s, said) in [
            (vec![], 1e-3, "number of drops is 0"),
            (vec![times(0.8, 0.5, 1)], 1e-3, "times is 1 in drop 1"),
            (
                vec![times(0.8, 0.5, 4), vec![0.0, 0.5, 0.4]],
                1e-3,
                "times is 0.4 s after 0.5 s in drop 2",
            ),
            (vec![vec![0.0, f64::NAN]], 1e-3, "NaN s in drop 1"),
            (vec![times(0.8, 0.5, 4)], 0.0, "time error is 0"),
        ] {
            let with_errors = |times: Vec<f64>| times.into_iter().map(|t| (t, std_s)).collect();
            let drops: Vec<Vec<(f64, f64)>> = drops.into_iter().map(with_errors).collect();
            let error = fit_times(&drops, &settings).unwrap_err().to_string();
            assert!(error.starts_with(said) || error.contains(said), "{error}");
        }
    }

    #[test]
    fn a_list_that_ends_early_has_e_and_no_total_time() {
        let settings = Settings::default().height_m(0.9);
        let fall_s = (2.0_f64 * 0.9 / 9.81).sqrt();
        let times = times(0.8, 1.6 * fall_s, 7);
        let times = times.into_iter().map(|t| (t, 1e-4)).collect();
        let analysis = fit_times(&[times], &settings).unwrap();
        let drop = &analysis.drops[0];
        assert!(drop.total_time_s.is_none() && drop.impacts[0].level_db.is_none());
        let e = drop.estimates.first_rebound.unwrap();
        assert!((e.value - 0.8).abs() < 1e-3, "{e:?}");
        let codes: Vec<_> = drop.warnings.iter().map(|w| w.code).collect();
        assert!(
            codes.contains(&WarningCode::ImpactsGiven) && codes.contains(&WarningCode::EndedEarly)
        );
    }
}
