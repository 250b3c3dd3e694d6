//! Flight, contact and the equations of Nagurka and Huang. Knows nothing of audio.
//!
//! Plain numbers are in SI units; what they measure is the last word of their name. Restitution is a type,
//! [`Restitution`], because a lively ball depends on `1 − e` and a dead one on `ln e`. Transcendental functions come from
//! `libm`, so results are the same to the last bit on every machine.
//!
//! | equation of the paper | here |
//! |---|---|
//! | (1) free flight | [`FlightLaw`], with drag too |
//! | (2) motion in contact | [`Ball`] |
//! | (3), (7) position | [`LinearContact::position_m`] |
//! | (4) damped frequency | [`Oscillator::damped_frequency_rad_per_s`] |
//! | (5) rest position | [`Oscillator::rest_position_m`] |
//! | (6), (10) contact time and restitution with weight | [`LinearContact::rebound`] |
//! | (8), (11) position and speed without weight | [`Oscillator::weightless_position_m`], [`Oscillator::weightless_velocity_m_per_s`] |
//! | (9) contact time without weight | [`Oscillator::contact_time_s`] |
//! | (12), (13) rebound without weight | [`Oscillator::restitution`] |
//! | (14), (15) stiffness and damping | [`Ball::from_contact`] |
//! | (16), (17) natural frequency and damping ratio | [`Oscillator::from_contact`], [`damping_ratio`] |
//! | (18) heights | [`BounceSeries::height_after_m`] |
//! | (19) rest condition | [`BounceSeries::bounces_to_rest`] |
//! | (20) contact time from n | [`BounceSeries::rest_contact_time_s`] |
//! | (21), (23) total time | [`BounceSeries::total_time_with_contact_s`] |
//! | (22), (24) flight time | [`BounceSeries::flight_time_s`] |
//! | (25) total time from e and n | [`BounceSeries::total_time_s`] |
//! | (25) for e | [`BounceSeries::restitution_from_total_time`] |
//! | (26) stiffness, lively ball | [`Ball::stiffness_approx_n_per_m`] |
//! | (27) contact time, lively ball | [`Oscillator::contact_time_approx_s`] |
//! | (28) contact time from n, lively ball | [`BounceSeries::rest_contact_time_approx_s`] |
//! | (29) damping ratio, lively ball | [`damping_ratio_approx`] |
//! | (30) total time, endless bounces | [`BounceSeries::total_time_approx_s`] |
//! | (30) for e | [`BounceSeries::restitution_from_total_time_approx`] |
//!
//! ```
//! use bounce_audio::physics::{Ball, BounceSeries};
//!
//! // The ball of the paper: 2.5 g, from 30.5 cm, 70 bounces in 7.5 s.
//! let series = BounceSeries::new(0.305, 9.81)?;
//! let e = series.restitution_from_total_time(70, 7.5)?.restitution;
//! let contact_time_s = series.rest_contact_time_s(e, 70)?;
//! let ball = Ball::from_contact(0.0025, e, contact_time_s)?;
//! assert_eq!(format!("{:.4}", e.value()), "0.9335");
//! assert_eq!(format!("{:.0} N/m", ball.stiffness_n_per_m()), "1233 N/m");
//! # Ok::<(), bounce_audio::Error>(())
//! ```

mod ball;
mod bounces;
mod check;
mod contact;
mod drop;
pub(crate) mod ends;
mod flight;
mod impacts;
mod interpolated;
mod inverse;
mod model;
mod motion;
pub mod priors;
mod restitution;
mod restitution_law;
mod root;
mod spiral;
mod uncertainty;

pub use ball::{Ball, Oscillator, damping_ratio, damping_ratio_approx};
pub use bounces::BounceSeries;
pub use contact::{Leaving, LinearContact, Rebound, ReleaseRule};
pub use drop::{Bounce, DropSetup, Scatter};
pub use flight::{
    Air, DRAG_RELATIVE_STD, Fall, FlightLaw, Hop, Rise, Sphere, displaced_mass_fraction,
    gravity_in_air_m_per_s2, terminal_speed_m_per_s,
};
pub use impacts::{Impact, Impacts};
pub(crate) use interpolated::InterpolatedContact;
pub use inverse::{Equation, InputErrors, Inversion};
pub use model::BallModel;
pub use restitution::Restitution;
pub use restitution_law::{RestitutionLaw, VISCOELASTIC_POWER};
pub use uncertainty::{ContactErrors, ParameterErrors};
