//! The table of `fixtures/oracle` and the library's answer to each of its rows.

use bounce_audio::Error;
use bounce_audio::physics::{
    Air, Ball, Bounce, BounceSeries, DropSetup, FlightLaw, Leaving, LinearContact, Oscillator,
    Rebound, ReleaseRule, Restitution, RestitutionLaw, Sphere, damping_ratio, damping_ratio_approx,
    displaced_mass_fraction, terminal_speed_m_per_s,
};

const TABLE: &str = include_str!("../../fixtures/oracle/table.csv");

/// Half of the distance between 1 and the next double: the greatest relative error of one rounding.
const ONE_ROUNDING: f64 = f64::EPSILON / 2.0;

/// One row of the table.
#[derive(Debug)]
pub(crate) struct Row {
    pub(crate) function: &'static str,
    pub(crate) inputs: Vec<f64>,
    reference: f64,
    correction: f64,
    condition: f64,
}

impl Row {
    /// Relative error of an answer, against all digits of the reference.
    pub(crate) fn error_of(&self, answer: f64) -> f64 {
        let difference = ((answer - self.reference) - self.correction).abs();
        if difference == 0.0 {
            0.0
        } else {
            difference / self.reference.abs()
        }
    }

    /// What is allowed: 1e-12, or eight times what rounding the inputs once causes.
    pub(crate) fn goal(&self) -> f64 {
        (8.0 * self.condition * ONE_ROUNDING).max(1e-12)
    }

    /// An error in units of eight times what rounding the inputs once causes.
    pub(crate) fn in_roundings(&self, error: f64) -> f64 {
        error / (8.0 * self.condition.max(1.0) * ONE_ROUNDING)
    }
}

/// All rows, those of one function next to each other.
pub(crate) fn rows() -> Vec<Row> {
    let number = |text: &str| text.parse::<f64>().unwrap();
    let mut rows: Vec<Row> = (TABLE.lines().skip(1))
        .map(|line| {
            let fields: Vec<&'static str> = line.split(',').collect();
            Row {
                function: fields[0],
                inputs: fields[1].split(';').map(number).collect(),
                reference: number(fields[2]),
                correction: number(fields[3]),
                condition: number(fields[4]),
            }
        })
        .collect();
    rows.sort_by_key(|row| row.function);
    rows
}

/// The library's answer to a row.
pub(crate) fn answer(function: &str, inputs: &[f64]) -> f64 {
    let (name, part) = function.split_once(' ').unwrap_or((function, ""));
    let answered = match name {
        "rebound" | "leaves" | "least_leaving_speed" => contact(name, part, inputs),
        "position" | "velocity" | "weightless_position" | "weightless_velocity" => {
            motion(name, inputs)
        }
        "deepest_position" => contact(name, "zero_displacement", inputs),
        "drag" | "fall_time" | "fall_speed" | "terminal_speed" | "displaced_mass_fraction" => {
            flight(name, part, inputs)
        }
        "viscoelastic" | "power_law" => law(name, part, inputs),
        "drop" => drop(part, inputs),
        _ => bounces(name, part, inputs).unwrap_or_else(|| ball(name, part, inputs)),
    };
    answered.unwrap_or_else(|error| panic!("{function} of {inputs:?}: {error}"))
}

/// The table writes e − 1 where e is nearer to 1.
fn restitution(r: f64) -> Restitution {
    if r > 0.0 {
        Restitution::new(r).unwrap()
    } else {
        Restitution::from_one_minus(-r).unwrap()
    }
}

fn part_of(restitution: Restitution, part: &str) -> f64 {
    match part {
        "e" => restitution.value(),
        "1-e" => restitution.one_minus(),
        "ln_e" => restitution.ln(),
        _ => panic!("no part {part} of a restitution"),
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the table holds whole numbers up to 1e6"
)]
fn count(n: f64) -> usize {
    n as usize
}

fn ball(name: &str, part: &str, inputs: &[f64]) -> Result<f64, Error> {
    let made = |r: f64, contact_time: f64| Oscillator::from_contact(restitution(r), contact_time);
    Ok(match (name, inputs) {
        ("damped_frequency", &[w, z]) => Oscillator::new(w, z)?.damped_frequency_rad_per_s()?,
        ("contact_time_weightless", &[w, z]) => Oscillator::new(w, z)?.contact_time_s()?,
        ("restitution_weightless", &[z]) => part_of(Oscillator::new(1.0, z)?.restitution()?, part),
        ("natural_frequency", &[r, t]) => made(r, t)?.natural_frequency_rad_per_s(),
        ("damping_ratio", &[r]) => damping_ratio(restitution(r)),
        ("damping_ratio_approx", &[r]) => damping_ratio_approx(restitution(r)),
        ("stiffness", &[m, r, t]) => Ball::from_contact(m, restitution(r), t)?.stiffness_n_per_m(),
        ("damping", &[m, r, t]) => Ball::from_contact(m, restitution(r), t)?.damping_n_s_per_m(),
        ("stiffness_approx", &[m, t]) => Ball::stiffness_approx_n_per_m(m, t)?,
        ("contact_time_approx", &[w]) => Oscillator::new(w, 0.0)?.contact_time_approx_s(),
        ("rest_position", &[w, g]) => Oscillator::new(w, 0.0)?.rest_position_m(g)?,
        ("ball_damping_ratio", &[m, k, c]) => Ball::new(m, k, c)?.oscillator().damping_ratio(),
        ("ball_natural_frequency", &[m, k]) => {
            (Ball::new(m, k, 0.0)?.oscillator()).natural_frequency_rad_per_s()
        }
        _ => panic!("no function {name} of {} numbers", inputs.len()),
    })
}

fn bounces(name: &str, part: &str, inputs: &[f64]) -> Option<Result<f64, Error>> {
    let series = |h: f64, g: f64| BounceSeries::new(h, g).unwrap();
    Some(match (name, inputs) {
        ("height_after", &[h, r, i]) => {
            Ok(series(h, 9.81).height_after_m(restitution(r), count(i)))
        }
        ("flight_after", &[h, g, r, i]) => {
            Ok(series(h, g).flight_after_s(restitution(r), count(i)))
        }
        ("bounces_to_rest", &[h, g, r, t]) => series(h, g).bounces_to_rest(restitution(r), t),
        ("rest_contact_time", &[h, g, r, n]) => {
            series(h, g).rest_contact_time_s(restitution(r), count(n))
        }
        ("rest_contact_time_approx", &[h, g, r, n]) => {
            series(h, g).rest_contact_time_approx_s(restitution(r), count(n))
        }
        ("contact_time_amplification", &[r, n]) => {
            BounceSeries::contact_time_amplification(restitution(r), count(n))
        }
        ("flight_time", &[h, g, r, n]) => series(h, g).flight_time_s(restitution(r), count(n)),
        ("total_time_with_contact", &[h, g, r, n, t]) => {
            series(h, g).total_time_with_contact_s(restitution(r), count(n), t)
        }
        ("total_time", &[h, g, r, n]) => series(h, g).total_time_s(restitution(r), count(n)),
        ("total_time_approx", &[h, g, r]) => series(h, g).total_time_approx_s(restitution(r)),
        ("restitution_from_total_time", &[h, g, n, t]) => series(h, g)
            .restitution_from_total_time(count(n), t)
            .map(|found| part_of(found.restitution, part)),
        ("per_total_time", &[h, g, n, t]) => series(h, g)
            .restitution_from_total_time(count(n), t)
            .map(|found| found.per_total_time_per_s),
        ("restitution_with_contact_time", &[h, g, n, t, contact]) => series(h, g)
            .restitution_with_contact_time(count(n), t, contact)
            .map(|found| part_of(found.restitution, part)),
        ("restitution_from_total_time_approx", &[h, g, t]) => series(h, g)
            .restitution_from_total_time_approx(t)
            .map(|found| part_of(found.restitution, part)),
        _ => return None,
    })
}

fn contact(name: &str, part: &str, inputs: &[f64]) -> Result<f64, Error> {
    let (rule, part) = part.split_once(' ').unwrap_or((part, ""));
    let rule = match rule {
        "zero_displacement" => ReleaseRule::ZeroDisplacement,
        "zero_force" => ReleaseRule::ZeroForce,
        _ => panic!("no release rule {rule}"),
    };
    let contact = LinearContact::new(Oscillator::new(inputs[0], inputs[1])?, inputs[2], rule)?;
    Ok(match (name, inputs) {
        ("least_leaving_speed", _) => contact.least_leaving_speed_m_per_s().unwrap(),
        ("deepest_position", &[.., v]) => contact.deepest_position_m(v)?,
        ("leaves", &[.., v]) => f64::from(u8::from(contact.rebound(v)? != Rebound::Stays)),
        ("rebound", &[.., v]) => match contact.rebound(v)? {
            Rebound::Stays => f64::NAN,
            Rebound::Leaves(leaving) => part_of_leaving(&leaving, part),
        },
        _ => panic!("no function {name}"),
    })
}

fn part_of_leaving(leaving: &Leaving, part: &str) -> f64 {
    match part {
        "contact_time" => leaving.contact_time_s,
        "position" => leaving.position_m,
        _ => part_of(leaving.restitution, part),
    }
}

fn motion(name: &str, inputs: &[f64]) -> Result<f64, Error> {
    let ball = Oscillator::new(inputs[0], inputs[1])?;
    let contact = |g: f64| LinearContact::new(ball, g, ReleaseRule::ZeroForce);
    match (name, inputs) {
        ("position", &[_, _, g, v, t]) => contact(g)?.position_m(v, t),
        ("velocity", &[_, _, g, v, t]) => contact(g)?.velocity_m_per_s(v, t),
        ("weightless_position", &[_, _, v, t]) => ball.weightless_position_m(v, t),
        ("weightless_velocity", &[_, _, v, t]) => ball.weightless_velocity_m_per_s(v, t),
        _ => panic!("no function {name} of {} numbers", inputs.len()),
    }
}

fn flight(name: &str, part: &str, inputs: &[f64]) -> Result<f64, Error> {
    let sphere = |mass_kg, diameter_m| Sphere {
        mass_kg,
        diameter_m,
    };
    let air = |density_kg_per_m3, drag_coefficient| Air {
        density_kg_per_m3,
        drag_coefficient,
    };
    Ok(match (name, inputs) {
        ("fall_time", &[g, h]) => FlightLaw::without_air(g)?.fall(h)?.time_s,
        ("fall_speed", &[g, h]) => FlightLaw::without_air(g)?.fall(h)?.landing_speed_m_per_s,
        ("terminal_speed", &[g, m, d, p, c]) => terminal_speed_m_per_s(g, sphere(m, d), air(p, c))?,
        ("displaced_mass_fraction", &[m, d, p]) => {
            displaced_mass_fraction(sphere(m, d), air(p, 0.45))?
        }
        ("drag", &[g, terminal, x]) => {
            let law = FlightLaw::with_terminal_speed(g, terminal)?;
            match part {
                "fall_time" => law.fall(x)?.time_s,
                "fall_speed" => law.fall(x)?.landing_speed_m_per_s,
                "rise_time" => law.rise(x)?.time_s,
                "rise_height" => law.rise(x)?.height_m,
                "hop_time" => law.hop(x)?.time_s,
                "hop_apex" => law.hop(x)?.apex_m,
                "hop_landing_speed" => law.hop(x)?.landing_speed_m_per_s,
                _ => panic!("no part {part} of a flight"),
            }
        }
        _ => panic!("no function {name} of {} numbers", inputs.len()),
    })
}

fn law(name: &str, part: &str, inputs: &[f64]) -> Result<f64, Error> {
    let (law, speed) = match (name, inputs) {
        ("viscoelastic", &[v, gamma1, gamma2]) => {
            (RestitutionLaw::Viscoelastic { gamma1, gamma2 }, v)
        }
        ("power_law", &[v, r, yield_speed_m_per_s, exponent]) => (
            RestitutionLaw::Power {
                restitution_at_yield: restitution(r),
                yield_speed_m_per_s,
                exponent,
            },
            v,
        ),
        _ => panic!("no function {name} of {} numbers", inputs.len()),
    };
    law.at(speed).map(|e| part_of(e, part))
}

fn drop(part: &str, inputs: &[f64]) -> Result<f64, Error> {
    let given = |r: f64, contact_time_s: f64| Bounce::Given {
        restitution: RestitutionLaw::Constant(restitution(r)),
        contact_time_s,
    };
    let free = FlightLaw::without_air;
    let (setup, touch) = match (part, inputs) {
        ("given touch", &[h, g, r, i]) => (DropSetup::new(h, free(g)?, given(r, 0.0)), i),
        ("linear touch", &[w, z, g, h, i]) => {
            let bounce = Bounce::Linear {
                ball: Oscillator::new(w, z)?,
                release_rule: ReleaseRule::ZeroDisplacement,
            };
            (DropSetup::new(h, free(g)?, bounce), i)
        }
        ("drag touch", &[g, terminal, h, r, i]) => {
            let flight = FlightLaw::with_terminal_speed(g, terminal)?;
            (DropSetup::new(h, flight, given(r, 0.0)), i)
        }
        _ => panic!("no function {part} of {} numbers", inputs.len()),
    };
    let setup = DropSetup {
        most_impacts: Some(count(touch)),
        ..setup
    };
    Ok(setup
        .impacts()?
        .nth(count(touch) - 1)
        .map_or(f64::NAN, |i| i.time_s))
}
