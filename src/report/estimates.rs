//! e and the ways to it, as data.

use serde::{Deserialize, Serialize};

use crate::fit::Estimate;
use crate::words::words;

/// The coefficient of restitution of ball and surface.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Restitution {
    /// e.
    #[serde(flatten)]
    pub estimate: Estimate,
    /// Geometric mean of the impact speeds it was measured at.
    pub at_speed_m_per_s: Option<f64>,
    /// The estimate it comes from.
    pub method: Method,
}

words! {
    /// How e was estimated.
    #[non_exhaustive]
    pub enum Method {
        /// By the model, over all impacts.
        LeastSquares = "least_squares",
        /// By one ratio of flights; its error is that of single bounces of balls at large.
        SingleRatio = "single_ratio",
        /// By the height and the flight after the first impact.
        FirstRebound = "first_rebound",
    }
}

/// Ways to e, side by side.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Estimates {
    /// Geometric mean of the ratios of successive flights.
    pub flight_ratio: Option<Estimate>,
    /// Equation (25) of the paper.
    pub eq25: Option<Estimate>,
    /// Equation (30) of the paper.
    pub eq30: Option<Estimate>,
    /// √(h1/h0) of the first impact.
    pub first_rebound: Option<Estimate>,
}

/// How much times and bounces scatter.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Scatter {
    /// Median standard error of the times heard, in seconds.
    pub timing_std_s: Option<f64>,
    /// Standard deviation of ln e from bounce to bounce, the times' errors taken out.
    pub bounce_std: Option<f64>,
}
