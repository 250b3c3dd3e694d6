//! `bounce-audio solve`: the ball from numbers typed in.

use std::io;
use std::path::PathBuf;

use clap::{ArgGroup, Args, ValueEnum};

use super::Outcome;
use super::picture::Target;
use super::quantity::{acceleration, contact_time, height, length_error, mass, share, time};
use crate::Error;
use crate::picture::total_time::{Point, figure};
use crate::solve::{self, ContactInputs, GivenErrors, Surroundings, TotalTimeInputs, text};

/// Find the ball from numbers instead of a recording.
///
/// Its restitution, contact time, stiffness and damping.
///
/// Two ways lead to it. From a whole drop: --bounces, --total-time and --height. From one bounce: --restitution and
/// --contact-time. With --mass there are stiffness and damping, without it both divided by the mass.
///
/// Exit status: 0 solved, 2 an argument is wrong or no ball fits the numbers.
#[derive(Debug, Args)]
#[command(
    group = ArgGroup::new("way").args(["bounces", "restitution"]).required(true),
    after_help = "Examples:
  A ping-pong ball, heard from release to rest:
    bounce-audio solve --bounces 70 --total-time 7.5s --height 30.5cm --mass 2.5g
  The same with the errors of what was measured:
    bounce-audio solve --bounces 70 --total-time 7.5s --total-time-error 50ms \\
        --height 30.5cm --height-error 1mm --mass 2.5g
  The same with a contact time known from video:
    bounce-audio solve --bounces 70 --total-time 7.5s --height 30.5cm --contact-time 1ms
  From one bounce:
    bounce-audio solve --restitution 0.93 --contact-time 1ms --mass 2.5g"
)]
pub(super) struct Arguments {
    /// Number of bounces from release to rest
    #[arg(
        long,
        value_name = "N",
        requires_all = ["total_time", "height"],
        allow_hyphen_values = true
    )]
    bounces: Option<usize>,
    /// Time from release to rest: 7.5s
    #[arg(
        long,
        value_name = "TIME",
        value_parser = time,
        requires = "bounces",
        conflicts_with = "restitution",
        allow_hyphen_values = true
    )]
    total_time: Option<f64>,
    /// Height of release, from the ball's lowest point to the surface: 30.5cm, 12in, 0.305
    #[arg(long, value_name = "LENGTH", value_parser = height, allow_hyphen_values = true)]
    height: Option<f64>,
    /// Coefficient of restitution, between 0 and 1: 0.93, 93%
    #[arg(
        long,
        value_name = "E",
        value_parser = share,
        requires = "contact_time",
        allow_hyphen_values = true
    )]
    restitution: Option<f64>,
    /// Contact time of one bounce: 1ms
    #[arg(long, value_name = "TIME", value_parser = contact_time, allow_hyphen_values = true)]
    contact_time: Option<f64>,
    /// Mass of the ball: 2.5g, 0.1oz
    #[arg(long, value_name = "MASS", value_parser = mass, allow_hyphen_values = true)]
    mass: Option<f64>,
    /// Gravity in m/s²
    #[arg(
        long,
        value_name = "M/S²",
        value_parser = acceleration,
        default_value = "9.81",
        allow_hyphen_values = true
    )]
    gravity: f64,
    /// Form of the result
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Draw total time against the number of bounces, with this drop in it (Figure 4 of the paper)
    #[arg(
        long,
        value_name = "OUT.svg|png",
        requires = "bounces",
        conflicts_with = "restitution"
    )]
    plot: Option<PathBuf>,
    #[command(flatten)]
    errors: ErrorArguments,
}

#[derive(Debug, Clone, Copy, Args)]
#[command(next_help_heading = "Standard errors of the inputs (results then have theirs)")]
struct ErrorArguments {
    /// Of the total time: 50ms
    #[arg(
        long,
        value_name = "TIME",
        value_parser = time,
        requires = "total_time",
        conflicts_with = "restitution",
        allow_hyphen_values = true
    )]
    total_time_error: Option<f64>,
    /// Of the height: 1mm
    #[arg(
        long,
        value_name = "LENGTH",
        value_parser = length_error,
        requires = "bounces",
        conflicts_with = "restitution",
        allow_hyphen_values = true
    )]
    height_error: Option<f64>,
    /// Of gravity
    #[arg(
        long,
        value_name = "M/S²",
        value_parser = acceleration,
        requires = "bounces",
        conflicts_with = "restitution",
        allow_hyphen_values = true
    )]
    gravity_error: Option<f64>,
    /// Of the mass: 10mg
    #[arg(
        long,
        value_name = "MASS",
        value_parser = mass,
        requires = "mass",
        allow_hyphen_values = true
    )]
    mass_error: Option<f64>,
    /// Of the contact time
    #[arg(
        long,
        value_name = "TIME",
        value_parser = time,
        requires = "contact_time",
        allow_hyphen_values = true
    )]
    contact_time_error: Option<f64>,
    /// Of the restitution
    #[arg(
        long,
        value_name = "E",
        value_parser = share,
        requires = "restitution",
        conflicts_with = "bounces",
        allow_hyphen_values = true
    )]
    restitution_error: Option<f64>,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Format {
    /// For a person
    Text,
    /// For programs: everything
    Json,
}

pub(super) fn run(arguments: &Arguments) -> Result<Outcome, Error> {
    let target = arguments.plot.as_deref().map(Target::new).transpose()?;
    let output = solution(arguments, target.as_ref()).map_err(by_option)?;
    Ok(Outcome::of(output))
}

fn solution(arguments: &Arguments, target: Option<&Target>) -> Result<String, Error> {
    match (
        arguments.bounces,
        arguments.total_time,
        arguments.height,
        arguments.restitution,
        arguments.contact_time,
    ) {
        (Some(bounces), Some(total_time_s), Some(height_m), None, contact_time_s) => {
            let solved = solve::from_total_time(&TotalTimeInputs {
                bounces,
                total_time_s,
                height_m,
                contact_time_s,
                ball: arguments.surroundings(),
            })?;
            if let Some(target) = target {
                let e = solved.eq25.values.restitution;
                draw(target, arguments, (bounces, total_time_s, height_m), e)?;
            }
            match arguments.format {
                Format::Text => Ok(text::total_time(&solved)),
                Format::Json => Ok(solve::to_json(&solved).map_err(io::Error::from)?),
            }
        }
        (None, None, height_m, Some(restitution), Some(contact_time_s)) => {
            let solved = solve::from_contact(&ContactInputs {
                restitution,
                contact_time_s,
                height_m,
                ball: arguments.surroundings(),
            })?;
            match arguments.format {
                Format::Text => Ok(text::contact(&solved)),
                Format::Json => Ok(solve::to_json(&solved).map_err(io::Error::from)?),
            }
        }
        // The rules above the arguments let nothing else through.
        _ => Err(Error::Argument {
            argument: "solve",
            got: "incomplete".to_owned(),
            expected: "--bounces, --total-time and --height, or --restitution and --contact-time",
        }),
    }
}

/// Draws n, `T_total` and h0 among the curves of (25).
fn draw(
    target: &Target,
    arguments: &Arguments,
    (bounces, total_time_s, height_m): (usize, f64, f64),
    restitution: f64,
) -> Result<(), Error> {
    let point = Point {
        bounces,
        total_time_s,
        total_time_std_s: arguments.errors.total_time_error,
        restitution: Some(restitution),
        name: format!("n = {bounces}, {total_time_s} s"),
    };
    let title = format!(
        "Total time by eq. (25), h₀ = {} cm",
        shown(100.0 * height_m)
    );
    target.draw(&figure(height_m, arguments.gravity, &point, &title)?)
}

/// A number without the noise of its last binary digits.
fn shown(value: f64) -> f64 {
    (1e6 * value).round() / 1e6
}

impl Arguments {
    fn surroundings(&self) -> Surroundings {
        let errors = self.errors;
        Surroundings {
            gravity_m_per_s2: self.gravity,
            mass_kg: self.mass,
            std_error: GivenErrors {
                total_time_s: errors.total_time_error,
                height_m: errors.height_error,
                gravity_m_per_s2: errors.gravity_error,
                mass_kg: errors.mass_error,
                contact_time_s: errors.contact_time_error,
                restitution: errors.restitution_error,
            },
        }
    }
}

/// Names the option where the library names its argument.
fn by_option(error: Error) -> Error {
    let Error::Argument {
        argument,
        got,
        expected,
    } = error
    else {
        return error;
    };
    let argument = match argument {
        "bounces" => "--bounces",
        "total_time_s" => "--total-time",
        "height_m" => "--height",
        "restitution" => "--restitution",
        "contact_time_s" => "--contact-time",
        "mass_kg" => "--mass",
        "gravity_m_per_s2" => "--gravity",
        "std_error.total_time_s" => "--total-time-error",
        "std_error.height_m" => "--height-error",
        "std_error.gravity_m_per_s2" => "--gravity-error",
        "std_error.mass_kg" => "--mass-error",
        "std_error.contact_time_s" => "--contact-time-error",
        "std_error.restitution" => "--restitution-error",
        other => other,
    };
    Error::Argument {
        argument,
        got,
        expected,
    }
}
