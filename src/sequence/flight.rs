//! What is known of the next flight, given the flights so far.

use super::scatter::{Scatter, Variances};
use crate::linalg::dot;
use crate::physics::priors::{Known, LN_RESTITUTION, TRACKED_CONTACT_S, TRACKED_DRAG_PER_S2};
use crate::units::real;

/// A line for ln of the flights' ratios, kept as a Kalman filter of three states with its own scatter.
///
/// # Formula
/// ```text
/// ln(T_{i+1} / T_i) = ρ − κ·T_i² + C·(1 − r)/(r·T_i) + noise,   r = exp(ρ − κ·T_i²)
/// ```
/// ρ is ln e at low speed and wanders a little from bounce to bounce (e depends on speed); κ is the drag of the air,
/// which grows with the square of the speed and so of the flight (0.17 s⁻² for a ping-pong ball, nearly 0 for steel);
/// C is the part of the contact time that stands in every interval from touch to touch, which slows the shrinking of
/// the last flights of a soft ball. The noise is the bounce's own scatter and the jitter of the times. The scatter is
/// learnt from the last few bounces, because a ball that starts to spin or reaches a worse spot scatters tenfold; so
/// a deviation is Student's and not normal, and a stray one teaches little.
#[derive(Debug, Clone, Copy)]
pub struct FlightLaw {
    /// ρ, κ and C.
    state: [f64; STATES],
    covariance: [[f64; STATES]; STATES],
    scatter: Scatter,
}

const STATES: usize = 3;

/// The flight before another is known once a round moves it by less than this share (convention) …
const REST: f64 = 1e-5;
/// … and after this number of rounds at most: a bound for laws that have no flight before.
const LIMIT: usize = 100;

/// What is doubtful about two flights besides the bounce between them.
#[derive(Debug, Clone, Copy)]
pub struct Doubt {
    /// How many of the last impacts are only inferred.
    pub unheard: usize,
    /// How far off the times may be, in seconds.
    pub jitter_s: f64,
}

/// ρ, κ = K/8 and C before any flight is known.
const PRIOR: [Known; STATES] = [
    LN_RESTITUTION,
    TRACKED_DRAG_PER_S2.times(1.0 / 8.0),
    TRACKED_CONTACT_S,
];
/// How much ln e wanders from one bounce to the next.
const WANDER: f64 = 3e-3;
/// How often e stays another after an accident.
const CHANGED: f64 = 0.3;
/// A match farther off than this many standard deviations is none.
pub(super) const GATE: f64 = 6.0;
/// A flight is longer than the one before by at most so many standard deviations of their times (convention).
const LONGER: f64 = 3.0;

/// What is expected of ln(T'/T).
#[derive(Debug, Clone, Copy)]
pub struct Expected {
    /// The expected value.
    pub mean: f64,
    scatter: Scatter,
    variances: Variances,
}

impl Expected {
    /// Its variance by all causes together, accidents left out.
    #[must_use]
    pub(super) fn variance(&self) -> f64 {
        self.scatter.variance(&self.variances)
    }

    /// Greatest ln(T'/T): no bounce gives energy, so a flight is longer than the one before by the jitter of times alone, or by
    /// the scatter of impacts that are only inferred.
    #[must_use]
    pub(super) fn greatest(&self) -> f64 {
        let doubt = self.variances.jitter + (self.variances.spread - 1.0) * self.variance();
        LONGER * doubt.sqrt()
    }

    /// ln of the density of a deviation from the mean.
    #[must_use]
    pub(super) fn ln_density(&self, deviation: f64) -> f64 {
        self.scatter.ln_density(deviation, &self.variances)
    }
}

impl FlightLaw {
    /// What holds for balls at large.
    #[must_use]
    pub fn prior() -> Self {
        let mut covariance = [[0.0; STATES]; STATES];
        for (i, known) in PRIOR.into_iter().enumerate() {
            covariance[i][i] = known.std * known.std;
        }
        Self {
            state: PRIOR.map(|known| known.value),
            covariance,
            scatter: Scatter::at_large(),
        }
    }

    /// The same law with the scatter of balls at large: what follows may lie far from what was learnt last.
    #[must_use]
    pub const fn at_large(mut self) -> Self {
        self.scatter = Scatter::at_large();
        self
    }

    /// What to expect of `ln(later/earlier)`.
    #[must_use]
    pub fn expect(&self, earlier_s: f64, later_s: f64, doubt: Doubt) -> Expected {
        let slopes = self.slopes(earlier_s);
        let jitter = doubt.jitter_s * doubt.jitter_s;
        Expected {
            mean: dot(&slopes, &self.state),
            scatter: self.scatter,
            variances: Variances {
                law: dot(&slopes, &self.gains(&slopes)),
                // An impact that is only inferred may be off by the scatter of its flight, in both flights that it ends.
                spread: 1.0 + 4.0 * real(doubt.unheard),
                // The flights share the impact between them, so its jitter counts in both:
                // ln T' − ln T moves by ε₂/T' − ε₁(1/T' + 1/T) + ε₀/T.
                jitter: jitter
                    * (earlier_s.powi(-2)
                        + later_s.powi(-2)
                        + (1.0 / earlier_s + 1.0 / later_s).powi(2)),
            },
        }
    }

    /// The flight after one of `earlier_s` seconds.
    #[must_use]
    pub fn next_s(&self, earlier_s: f64) -> f64 {
        earlier_s * dot(&self.slopes(earlier_s), &self.state).exp()
    }

    /// The flight before one of `later_s` seconds, by `earlier = later·exp(−ln ratio(earlier))` until it rests.
    #[must_use]
    pub fn previous_s(&self, later_s: f64) -> f64 {
        let mut earlier = later_s * (-self.state[0]).exp();
        for _ in 0..LIMIT {
            let ln_ratio = dot(&self.slopes(earlier), &self.state);
            // Drag lengthens the flight before by at most a factor of two here, or the step would run away.
            let next = later_s
                * (-ln_ratio)
                    .min(std::f64::consts::LN_2 - self.state[0])
                    .exp();
            let moved = (next / earlier - 1.0).abs();
            earlier = next;
            if moved < REST {
                break;
            }
        }
        earlier
    }

    /// Learns from one ratio, the less the farther it is off, as Student's distribution weighs it; gives the probability
    /// that the bounce was an accident, after which e may be another.
    pub fn learn(&mut self, earlier_s: f64, later_s: f64, doubt: Doubt) -> f64 {
        let Expected {
            mean, variances, ..
        } = self.expect(earlier_s, later_s, doubt);
        let deviation = (later_s / earlier_s).ln() - mean;
        let squared = deviation * deviation;
        let lesson = self.scatter.learn(deviation, &variances);
        let weight = 5.0 / (4.0 + squared / (variances.law + lesson.variance));
        let gains = self.gains(&self.slopes(earlier_s));
        let variance = variances.law + lesson.variance / weight;
        for (i, gain) in gains.iter().enumerate() {
            self.state[i] += gain / variance * deviation;
            for (j, other) in gains.iter().enumerate() {
                self.covariance[i][j] -= gain * other / variance;
            }
        }
        self.covariance[0][0] += WANDER * WANDER + CHANGED * lesson.accident * squared;
        lesson.accident
    }

    /// How ln(T'/T) depends on ρ, κ and C.
    fn slopes(&self, earlier_s: f64) -> [f64; STATES] {
        let square = earlier_s * earlier_s;
        let ratio = (self.state[0] - self.state[1] * square).exp();
        [1.0, -square, (1.0 - ratio) / (ratio * earlier_s)]
    }

    /// Covariance of the states with what the slopes measure.
    fn gains(&self, slopes: &[f64; STATES]) -> [f64; STATES] {
        std::array::from_fn(|i| dot(&self.covariance[i], slopes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHARP: Doubt = Doubt {
        unheard: 0,
        jitter_s: 1e-4,
    };

    #[test]
    fn a_flight_is_longer_than_the_one_before_by_the_doubt_of_its_times_alone() {
        let greatest = |flight_s: f64, unheard: usize| {
            let doubt = Doubt { unheard, ..SHARP };
            FlightLaw::prior()
                .expect(flight_s, flight_s, doubt)
                .greatest()
        };
        // 3·√(1 + 1 + 2²) of 0.1 ms, as a share of the flight.
        assert!((greatest(1.0, 0) - 3e-4 * 6.0_f64.sqrt()).abs() < 1e-12);
        assert!((greatest(0.02, 0) / greatest(1.0, 0) - 50.0).abs() < 1e-9);
        assert!(greatest(1.0, 1) > 0.1);
    }

    #[test]
    fn a_law_taught_by_a_ball_with_drag_knows_its_next_and_previous_flight() {
        let (e, kappa) = (0.94_f64, 0.15);
        let mut flights = vec![0.6];
        for _ in 0..20 {
            let t = flights[flights.len() - 1];
            flights.push(t * e * (-kappa * t * t).exp());
        }
        let mut law = FlightLaw::prior();
        for pair in flights.windows(2) {
            law.learn(pair[0], pair[1], SHARP);
        }
        assert!((law.state[0] - e.ln()).abs() < 0.005, "{law:?}");
        for pair in flights.windows(2).rev().take(10) {
            assert!((law.next_s(pair[0]) / pair[1] - 1.0).abs() < 0.01);
            assert!((law.previous_s(pair[1]) / pair[0] - 1.0).abs() < 0.01);
        }
    }

    #[test]
    fn the_flight_before_leads_to_the_one_after() {
        let mut law = FlightLaw::prior();
        law.state = [-0.2, 0.15, 2e-3];
        for later_s in [0.05, 0.2, 0.4] {
            let earlier_s = law.previous_s(later_s);
            let off = law.next_s(earlier_s) / later_s - 1.0;
            assert!(off.abs() < 2e-5, "{later_s}: {off}");
        }
    }

    #[test]
    fn a_wild_bounce_moves_the_law_little() {
        let mut law = FlightLaw::prior();
        for _ in 0..10 {
            law.learn(0.3, 0.27, SHARP);
        }
        let before = law.state[0];
        law.learn(0.3, 0.27 * 1.2, SHARP);
        assert!((law.state[0] - before).abs() < 0.02);
    }
}
