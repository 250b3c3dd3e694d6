//! Restitution from the number of bounces and the total time: equations (25) and (30) the other way round.

use super::{BounceSeries, Restitution, bounces::later_flights, check, root};
use crate::Error;

/// Which equation was solved for e.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Equation {
    /// (25): rest after the n-th bounce, contact time by (20).
    Rest,
    /// (21) with (23) and (24): n bounces, each with this contact time.
    ContactTime {
        /// The contact time that was given.
        contact_time_s: f64,
    },
    /// (30): endless bounces without contact time.
    Endless,
}

/// Standard errors of what was measured; zero for what is exact. Default: all zero.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct InputErrors {
    /// Of the total time.
    pub total_time_s: f64,
    /// Of the height of release.
    pub height_m: f64,
    /// Of gravity.
    pub gravity_m_per_s2: f64,
    /// Of the contact time, where it was given.
    pub contact_time_s: f64,
}

/// A restitution found from a total time, and how it leans on what it was found from.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Inversion {
    /// The root: e.
    pub restitution: Restitution,
    /// The equation solved.
    pub equation: Equation,
    /// `∂e/∂T_total`.
    pub per_total_time_per_s: f64,
    /// `∂e/∂h0`.
    pub per_height_per_m: f64,
    /// `∂e/∂g`.
    pub per_gravity_s2_per_m: f64,
    /// `∂e/∂ΔT`; 0 where no contact time went in.
    pub per_contact_time_per_s: f64,
}

impl Inversion {
    /// Standard error of e for independent errors of the inputs, to first order.
    ///
    /// # Errors
    /// [`Error::Argument`] naming the error that is negative or not finite.
    pub fn std_error(&self, errors: &InputErrors) -> Result<f64, Error> {
        let parts = [
            self.per_total_time_per_s
                * check::non_negative("std_error.total_time_s", errors.total_time_s)?,
            self.per_height_per_m * check::non_negative("std_error.height_m", errors.height_m)?,
            self.per_gravity_s2_per_m
                * check::non_negative("std_error.gravity_m_per_s2", errors.gravity_m_per_s2)?,
            self.per_contact_time_per_s
                * check::non_negative("std_error.contact_time_s", errors.contact_time_s)?,
        ];
        Ok(parts.into_iter().fold(0.0, libm::hypot))
    }
}

impl BounceSeries {
    /// Total times that (25) can give with `n` bounces, for e from 0 to 1, both excluded, in s.
    ///
    /// ```text
    /// √(2h0/g)  <  T_total  <  √(h0/g)·(√2·(2n − 1) + n·π)
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] naming `bounces` where it is 0.
    pub fn attainable_total_time_s(&self, bounces: usize) -> Result<(f64, f64), Error> {
        Ok((
            self.first_fall_s(),
            self.total_time_s(Restitution::ELASTIC, bounces)?,
        ))
    }

    /// e from `n` and the total time by (25). The root is unique: (25) increases with e for every n ≥ 1.
    ///
    /// # Errors
    /// [`Error::Argument`] for input out of range; [`Error::NoRoot`] with the attainable interval where no e gives this
    /// total time.
    pub fn restitution_from_total_time(
        &self,
        bounces: usize,
        total_time_s: f64,
    ) -> Result<Inversion, Error> {
        let n = check::bounces("bounces", bounces)?;
        let total = check::positive("total_time_s", total_time_s)?;
        within(total, self.attainable_total_time_s(bounces)?)?;
        let loss = self.solve(total, |loss| {
            let (flights, slope) = flights_and_slope(loss, n);
            let (contacts, contact_slope) = contacts_and_slope(loss, n);
            let fall = std::f64::consts::SQRT_2;
            (flights + contacts / fall, slope + contact_slope / fall)
        });
        Ok(self.inversion(Equation::Rest, total, &loss))
    }

    /// e from `n`, the total time and a known contact time: the ball need not be at rest after the n-th bounce.
    ///
    /// ```text
    /// T_flight(n, e) + n·ΔT = T_total      T_flight by (24)
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] for input out of range, and naming `bounces` where there is only one: then `T_total` does not
    /// depend on e. [`Error::NoRoot`] with the attainable interval where no e gives this total time.
    pub fn restitution_with_contact_time(
        &self,
        bounces: usize,
        total_time_s: f64,
        contact_time_s: f64,
    ) -> Result<Inversion, Error> {
        let n = check::bounces("bounces", bounces)?;
        if bounces < 2 {
            return Err(Error::argument("bounces", n, "a whole number ≥ 2"));
        }
        let total = check::positive("total_time_s", total_time_s)?;
        let contact = check::non_negative("contact_time_s", contact_time_s)?;
        let lowest = self.first_fall_s() + n * contact;
        let highest = self.total_time_with_contact_s(Restitution::ELASTIC, bounces, contact)?;
        within(total, (lowest, highest))?;
        let flight = total - n * contact;
        let loss = self.solve(flight, |loss| flights_and_slope(loss, n));
        let equation = Equation::ContactTime { contact_time_s };
        let mut inversion = self.inversion(equation, flight, &loss);
        inversion.per_contact_time_per_s = -n * inversion.per_total_time_per_s;
        Ok(inversion)
    }

    /// e from the total time alone by (30).
    ///
    /// Speed lost in the air is booked as lost in the bounce, here and with (25): a ball with drag reads too low, not too
    /// high as the paper's Discussion has it. A ping-pong ball of e = 0.94 (2.5 g, 38 mm, drag coefficient 0.5) dropped
    /// from 30.5 cm reads 0.929.
    ///
    /// ```text
    /// e = (q − 1)/(q + 1),   q = T_total/√(2h0/g)
    /// ```
    ///
    /// # Errors
    /// [`Error::Argument`] for input out of range; [`Error::NoRoot`] where the total time is no longer than the first
    /// fall.
    pub fn restitution_from_total_time_approx(
        &self,
        total_time_s: f64,
    ) -> Result<Inversion, Error> {
        let total = check::positive("total_time_s", total_time_s)?;
        let fall = self.first_fall_s();
        if total <= fall {
            return Err(no_root(total, fall, "without limit".to_owned()));
        }
        let restitution = if total < 3.0 * fall {
            Restitution::from_trusted_value((total - fall) / (total + fall))
        } else {
            Restitution::from_trusted_loss(2.0 * fall / (total + fall))
        };
        let per_total_time = 2.0 * fall / (total + fall) / (total + fall);
        Ok(self.with_derivatives(Equation::Endless, total, restitution, per_total_time))
    }

    /// The loss −ln e at which the flights after the first fall take up what `total` leaves for them.
    ///
    /// `later` gives that time in units of the first fall, and its slope, both for a loss.
    fn solve(&self, total: f64, later: impl Fn(f64) -> (f64, f64)) -> Loss {
        let fall = self.first_fall_s();
        let wanted = (total - fall) / fall;
        // (30) turned round is within a factor of about two wherever n does not matter.
        let guess = libm::log1p(2.0 / wanted);
        // On a logarithmic scale the curve is nearly straight for a dead ball and for a lively one.
        let loss = root::increasing(LOSS_RANGE, guess, |loss| {
            let (value, slope) = later(loss);
            (libm::log(wanted / value), -slope / value)
        });
        Loss {
            value: loss,
            slope: later(loss).1,
        }
    }

    fn inversion(&self, equation: Equation, total: f64, loss: &Loss) -> Inversion {
        let restitution = Restitution::from_trusted_ln(-loss.value);
        // de = −e·dloss, and the slope is that of T/fall.
        let per_total_time = -restitution.value() / (loss.slope * self.first_fall_s());
        self.with_derivatives(equation, total, restitution, per_total_time)
    }

    /// T·√(g/h0) is all that (25) and (30) know of T, g and h0, so one derivative gives the others.
    fn with_derivatives(
        &self,
        equation: Equation,
        total: f64,
        restitution: Restitution,
        per_total_time_per_s: f64,
    ) -> Inversion {
        let half = 0.5 * per_total_time_per_s * total;
        Inversion {
            restitution,
            equation,
            per_total_time_per_s,
            per_height_per_m: -half / self.height_m(),
            per_gravity_s2_per_m: half / self.gravity_m_per_s2(),
            per_contact_time_per_s: 0.0,
        }
    }
}

/// −ln e of every root that rounded input can have: e from 1e-43 to 1 − 1e-30.
const LOSS_RANGE: (f64, f64) = (1e-30, 100.0);

/// A root in −ln e, with the slope of the total time there in units of the first fall.
struct Loss {
    value: f64,
    slope: f64,
}

/// Time of all flights after the first fall in units of it, and its slope in −ln e.
///
/// ```text
/// S = 2·Σ e^i,   dS/dx = −2·Σ i·e^i,   i = 1 … n−1,   e = exp(−x)
/// ```
fn flights_and_slope(loss: f64, n: f64) -> (f64, f64) {
    let value = later_flights(Restitution::from_trusted_ln(-loss), n);
    let slope = if n * loss < 1e-3 {
        // The closed form cancels here; the first terms of the series in x are exact to 1e-10.
        let first = loss * (2.0 * n - 1.0) / 3.0;
        let second = loss * loss * n * (n - 1.0) / 4.0;
        -n * (n - 1.0) * (1.0 - first + second)
    } else {
        let growth = libm::expm1(loss);
        2.0 * (n - 1.0) * libm::exp((1.0 - n) * loss) / growth - value * (growth + 1.0) / growth
    };
    (value, slope)
}

/// Time of the n contacts of (20) in units of √(h0/g), and its slope in −ln e.
fn contacts_and_slope(loss: f64, n: f64) -> (f64, f64) {
    let restitution = Restitution::from_trusted_ln(-loss);
    let norm = restitution.pi_norm();
    let value = n * restitution.power(n) * norm;
    (value, value * (loss / norm / norm - n))
}

fn within(total: f64, (lowest, highest): (f64, f64)) -> Result<(), Error> {
    if total > lowest && total < highest {
        Ok(())
    } else {
        Err(no_root(total, lowest, format!("{highest} s")))
    }
}

fn no_root(total: f64, lowest: f64, high: String) -> Error {
    Error::NoRoot {
        quantity: "restitution between 0 and 1",
        got: format!("a total time of {total} s"),
        low: format!("{lowest} s"),
        high,
    }
}
