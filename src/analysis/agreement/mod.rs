//! Agreement of the ways to e, and the usual causes of disagreement.

mod comparable;

use super::Settings;
use super::model::Modelled;
use crate::Error;
use crate::fit::Estimate;
use crate::fit::flights::Flights;
use crate::impact::Impact;
use crate::report::{Estimates, Warning, WarningCode};
use comparable::{first, without_contact};

/// Two values disagree that differ by more than this many standard deviations of their difference. Convention: 99 % of a
/// normal distribution. The errors count as independent; the scatter that estimates share makes that cautious.
const DISAGREE: f64 = 2.58;

/// A value with its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Value {
    value: f64,
    std: f64,
}

impl Value {
    fn of(estimate: Estimate) -> Option<Self> {
        Some(Self {
            value: estimate.value,
            std: estimate.std_error?,
        })
    }

    fn is_below(self, other: Self) -> bool {
        other.value - self.value > DISAGREE * self.std.hypot(other.std)
    }
}

/// The source of the drag of the air.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Drag {
    /// The model has none.
    Unknown,
    /// The model has it, or an e that falls with speed, which does the same to the flights.
    Fitted,
    /// By mass and diameter.
    Given,
}

/// The ways to e, made comparable: the contact time of the model is taken out of the flights, and its drag out of the
/// first rebound. Gravity is exact.
#[derive(Debug, Clone, Copy)]
pub(super) struct Agreement {
    bounces: usize,
    ratio: Value,
    eq25: Option<Value>,
    eq30: Option<Value>,
    /// e of the first impact by the height, the scatter of one bounce included, and e of the model.
    first: Option<(Value, Value)>,
    drag: Drag,
}

/// A cause of disagreement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Cause {
    Drag,
    HeightTooSmall,
    HeightTooLarge,
    Unheard,
    NotKnown,
}

impl Cause {
    /// The code of the warning.
    const fn code(self) -> WarningCode {
        match self {
            Self::Drag => WarningCode::AirDrag,
            Self::HeightTooSmall | Self::HeightTooLarge => WarningCode::WrongHeight,
            Self::Unheard => WarningCode::BouncesUnheard,
            Self::NotKnown => WarningCode::EstimatesDisagree,
        }
    }
}

impl Agreement {
    /// None where the flights give no e with an error.
    pub(super) fn of(
        timed: &[Impact],
        flights: &Flights,
        estimates: &Estimates,
        modelled: &Modelled,
        settings: &Settings,
    ) -> Result<Option<Self>, Error> {
        let Some(ratio) = estimates.flight_ratio.and_then(Value::of) else {
            return Ok(None);
        };
        let first = match estimates.first_rebound {
            // The model fits e at the speed of the first impact.
            Some(_) if !modelled.by_speed => first(timed, flights, modelled, settings)?,
            _ => None,
        };
        Ok(Some(Self {
            bounces: timed.len(),
            ratio: without_contact(ratio, timed, flights, modelled),
            eq25: estimates.eq25.and_then(Value::of),
            eq30: estimates.eq30.and_then(Value::of),
            first,
            drag: match (settings.mass_kg, settings.diameter_m) {
                (Some(_), Some(_)) => Drag::Given,
                _ if modelled.drag.is_some() || modelled.by_speed => Drag::Fitted,
                _ => Drag::Unknown,
            },
        }))
    }

    /// The cause of disagreement; none where the estimates agree, or where a drag that is given explains it.
    ///
    /// | cause | first rebound | (30) | (25) |
    /// |---|---|---|---|
    /// | drag of the air | low: the fall and the fastest flight lose most | low, by nearly as much | low |
    /// | height wrong by dh/h | off by −½·e·dh/h | off by −¼·(1 − e²)·dh/h: much less | as (30) |
    /// | last bounces unheard | right | right within its error, which holds what is unheard | low: n contacts of (20) are too long |
    fn cause(&self) -> Option<Cause> {
        let low = |q: Option<Value>| q.is_some_and(|q| q.is_below(self.ratio));
        let high = |q: Option<Value>| q.is_some_and(|q| self.ratio.is_below(q));
        if let Some((first, e)) = self.first {
            if e.is_below(first) {
                return Some(Cause::HeightTooSmall);
            }
            if first.is_below(e) {
                let drag = self.drag == Drag::Unknown && self.is_lower_than_by_height(first, e);
                return Some(if drag {
                    Cause::Drag
                } else {
                    Cause::HeightTooLarge
                });
            }
        }
        if high(self.eq25) || high(self.eq30) {
            return Some(Cause::NotKnown);
        }
        match self.drag {
            Drag::Given => None,
            _ if low(self.eq30) => Some(Cause::Drag),
            Drag::Fitted if low(self.eq25) => Some(Cause::Drag),
            _ => low(self.eq25).then_some(Cause::Unheard),
        }
    }

    /// Whether (30) is lower than a height alone makes it that brings the first rebound down so far.
    fn is_lower_than_by_height(&self, first: Value, e: Value) -> bool {
        let share = (1.0 - e.value * e.value) / (2.0 * e.value);
        let by_height = Value {
            value: self.ratio.value + share * (first.value - e.value),
            std: self.ratio.std.hypot(share * first.std),
        };
        self.eq30.is_some_and(|q| q.is_below(by_height))
    }

    /// The warning where the ways to e disagree.
    pub(super) fn warning(&self) -> Option<Warning> {
        let cause = self.cause()?;
        Some(Warning::new(cause.code(), self.message(cause)))
    }

    fn message(&self, cause: Cause) -> String {
        let shown =
            |v: Option<Value>| v.map_or_else(|| "-".to_owned(), |v| format!("{:.4}", v.value));
        let (ratio, eq25, eq30) = (shown(Some(self.ratio)), shown(self.eq25), shown(self.eq30));
        let (first, e) = self.first.unzip();
        let (first, e) = (shown(first), shown(e));
        match cause {
            Cause::Drag if self.drag == Drag::Fitted => format!(
                "the plain formulas (25) and (30) give {eq25} and {eq30}, but the flights without contact give {ratio}: the formulas \
                 leave out the air, which slows the ball, and an e that falls with speed. The fitted e allows for both"
            ),
            Cause::Drag => format!(
                "the plain formula (30) gives {eq30} and the first rebound {first}, but the flights give {ratio}: the air \
                 slows a light ball, which reads as a lower e. Give the ball's mass and diameter"
            ),
            Cause::HeightTooSmall => format!(
                "the first rebound gives {first}, but the flights give {e}: the ball was dropped from higher than \
                 the height given, or thrown"
            ),
            Cause::HeightTooLarge => format!(
                "the first rebound gives {first}, but the flights give {e}: the ball was dropped from lower than \
                 the height given. Measure from its lowest point; for a light ball give mass and diameter too"
            ),
            Cause::Unheard => format!(
                "the plain formula (25) gives {eq25}, but the flights give {ratio}: the formula has the ball at rest after the {} \
                 bounces heard, and more were too faint. Their number is a lower bound; trust the flights",
                self.bounces
            ),
            Cause::NotKnown => format!(
                "the plain formulas (25) and (30) give {eq25} and {eq30}, more than the flights' {ratio}: drag and unheard \
                 bounces make them less, so check the height and whether the ball was touched"
            ),
        }
    }
}

#[cfg(test)]
mod tests;
