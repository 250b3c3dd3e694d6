//! What a ball would do in another drop: how high its bounces rise, and from where it must fall for one to reach a height.

use super::Settings;
use crate::fit::Estimate;
use crate::physics::priors::{ONE_BOUNCE, SPEED_EXPONENT_BEYOND};
use crate::physics::{BallModel, DRAG_RELATIVE_STD, FlightLaw};
use crate::report::{Drop, HIGHEST, Prediction, Reach, Rebounds};
use crate::statistics::bisected;
use crate::units::real;

/// What is asked.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Question {
    /// How high does the ball come back from this height, in metres?
    pub from_m: Option<f64>,
    /// From where must it fall for the bounce of this number, from 1, to rise to this height in metres?
    pub reach: Option<(usize, f64)>,
}

/// As many bounces are predicted, which is what two lines of text hold.
const BOUNCES: usize = 10;
/// Halvings of the range of a height: to 10⁻¹² of it.
const HALVINGS: usize = 43;
/// A change of a height of which the change of a rebound is taken, relative.
const STEP: f64 = 1e-3;

/// What the law that a drop was fitted by says; none where e is not known, with its error.
///
/// # Formula
/// ```text
/// v₁² = 2·g·h₀,   uᵢ = e(vᵢ)·vᵢ,   hᵢ = uᵢ²/2g,   vᵢ₊₁ = uᵢ        (with drag those of its falls and rises)
/// (σ/2h_n)² = (n·σ_e/e)² + (0.05·Σ|ln(vᵢ/v)|)² + Σsᵢ² + (σ_drag)²,   σ_h₀ = σ·dh₀/dh_n
/// ```
/// v is the nearest speed that e was measured at: beyond those e may change with the speed. s is the scatter of the bounces, and
/// beyond those speeds what one bounce of balls at large is off.
#[must_use]
pub fn predict(drop: &Drop, settings: &Settings, question: &Question) -> Option<Prediction> {
    let law = Law::of(drop, settings)?;
    let rebounds = question.from_m.map(|from_m| {
        let heights = (1..=BOUNCES).map_while(|n| law.height(from_m, n));
        Rebounds::new(from_m, heights.collect())
    });
    let reach = question
        .reach
        .map(|(bounce, height_m)| Reach::new(bounce, height_m, law.release(bounce, height_m)));
    Some(Prediction { rebounds, reach })
}

/// A fitted ball with its errors.
struct Law {
    ball: BallModel,
    /// Flights with the drag as it is, and off by a standard deviation to both sides.
    flight: FlightLaw,
    off: [FlightLaw; 2],
    /// Relative standard error of e.
    e_std: f64,
    /// Scatter of ln e from bounce to bounce, and of one at a speed that was not heard.
    bounce_std: f64,
    unheard_std: f64,
    /// The slowest and the fastest speed that e was measured at.
    heard: [f64; 2],
    clock_std: f64,
}

impl Law {
    fn of(drop: &Drop, settings: &Settings) -> Option<Self> {
        let e = drop.restitution.as_ref()?.estimate;
        let ball = drop.ball_model(settings.gravity_m_per_s2)?;
        let speeds = drop.impacts.iter().map(|i| &i.bounce);
        let speeds = speeds.filter(|b| b.restitution.is_some());
        let speeds: Vec<f64> = speeds.filter_map(|b| b.impact_speed_m_per_s).collect();
        let least = speeds.iter().copied().fold(f64::INFINITY, f64::min);
        let most = speeds.iter().copied().fold(0.0, f64::max);
        let flight = *ball.flight();
        let drag = flight.drag_per_s2();
        let fitted = drop.model.parameters.drag_per_s2;
        let std = fitted.and_then(|k| k.std_error);
        let std = std.unwrap_or(DRAG_RELATIVE_STD * drag);
        let gravity = flight.gravity_m_per_s2();
        let with = |drag: f64| FlightLaw::with_drag(gravity, drag.max(0.0)).ok();
        let known = settings.mass_kg.is_some() && settings.diameter_m.is_some();
        Some(Self {
            ball,
            flight,
            off: [with(drag - std)?, with(drag + std)?],
            e_std: e.std_error? / e.value,
            bounce_std: drop.scatter.bounce_std.unwrap_or(ONE_BOUNCE.0),
            unheard_std: if known { ONE_BOUNCE.0 } else { ONE_BOUNCE.1 },
            heard: (most > 0.0).then_some([least, most])?,
            clock_std: settings.clock_std,
        })
    }

    /// The impact speeds up to bounce `n` and the height after it, in these flights; none where the ball does not leave.
    fn course(&self, flight: &FlightLaw, from_m: f64, n: usize) -> Option<(Vec<f64>, f64)> {
        let mut speeds = vec![flight.fall(from_m).ok()?.landing_speed_m_per_s];
        loop {
            let speed = speeds[speeds.len() - 1];
            let leaving = self.ball.restitution(speed)?.value() * speed;
            if speeds.len() == n {
                return Some((speeds, flight.rise(leaving).ok()?.height_m));
            }
            speeds.push(flight.hop(leaving).ok()?.landing_speed_m_per_s);
        }
    }

    fn height_m(&self, from_m: f64, n: usize) -> Option<f64> {
        self.course(&self.flight, from_m, n)
            .map(|(_, height)| height)
    }

    /// Relative standard error of the height after bounce `n`.
    fn relative_std(&self, from_m: f64, n: usize) -> Option<f64> {
        let (speeds, _) = self.course(&self.flight, from_m, n)?;
        let [slowest, fastest] = self.heard;
        let beyond = |v: f64| (v / fastest).ln().max((slowest / v).ln()).max(0.0);
        let way: f64 = speeds.iter().map(|&v| beyond(v)).sum();
        let scatter = speeds.iter().map(|&v| {
            let heard = beyond(v) == 0.0;
            if heard {
                self.bounce_std
            } else {
                self.bounce_std.max(self.unheard_std)
            }
        });
        let scatter = scatter.map(|s| s * s).sum::<f64>().sqrt();
        let [less, more] = &self.off;
        let [less, more] = [less, more].map(|flight| self.course(flight, from_m, n));
        let drag = 0.5 * (less?.1 / more?.1).ln().abs();
        let speed = (real(n) * self.e_std)
            .hypot(SPEED_EXPONENT_BEYOND * way)
            .hypot(scatter)
            .hypot(self.clock_std);
        Some((2.0 * speed).hypot(drag))
    }

    fn height(&self, from_m: f64, n: usize) -> Option<Estimate> {
        let value = self.height_m(from_m, n)?;
        Some(Estimate::with_relative_std(
            value,
            self.relative_std(from_m, n)?,
        ))
    }

    /// The height of release from which bounce `n` rises to a height; none where not even [`HIGHEST`] times that is enough.
    fn release(&self, n: usize, height_m: f64) -> Option<Estimate> {
        let lower = |ln: f64| self.height_m(ln.exp(), n).is_none_or(|h| h < height_m);
        let (least, most) = (height_m.ln(), (HIGHEST * height_m).ln());
        if lower(most) {
            return None;
        }
        let from_m = bisected((least, most), HALVINGS, lower).exp();
        let [less, more] = [from_m / (1.0 + STEP), from_m * (1.0 + STEP)];
        let rise = (self.height_m(more, n)? / self.height_m(less, n)?).ln();
        let slope = rise / (2.0 * (1.0 + STEP).ln());
        Some(Estimate::with_relative_std(
            from_m,
            self.relative_std(from_m, n)? / slope,
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::fit_times;
    use crate::random::SplitMix64;

    /// Impacts of a ball without air from 1 m, whose e scatters.
    fn times(e: f64, scatter: f64, rng: &mut SplitMix64) -> Vec<(f64, f64)> {
        let (mut time, mut height) = (1.0, 1.0_f64);
        let mut times = vec![(time, 1e-4)];
        for _ in 0..8 {
            height *= (e * (scatter * rng.normal()).exp()).powi(2);
            time += 2.0 * (2.0 * height / 9.81).sqrt();
            times.push((time + 1e-4 * rng.normal(), 1e-4));
        }
        times
    }

    fn asked(times: Vec<(f64, f64)>, question: &Question) -> Prediction {
        let settings = Settings::default().contact_time_s(1e-6);
        let analysis = fit_times(&[times], &settings).unwrap();
        predict(&analysis.drops[0], &settings, question).unwrap()
    }

    #[test]
    fn heights_and_the_height_of_release_are_those_of_the_law() {
        let question = Question {
            from_m: Some(1.0),
            reach: Some((2, 1.0)),
        };
        let found = asked(times(0.8, 0.0, &mut SplitMix64::new(1)), &question);
        let heights = found.rebounds.unwrap().heights_m;
        assert_eq!(heights.len(), BOUNCES);
        for (n, height) in (1..).zip(&heights) {
            let truth = 0.64_f64.powi(n);
            assert!((height.value / truth - 1.0).abs() < 0.05, "{n}: {height:?}");
        }
        let from = found.reach.unwrap().drop_height_m.unwrap();
        assert!(
            (from.value / 0.8_f64.powi(-4) - 1.0).abs() < 0.03,
            "{from:?}"
        );
        // Faster than anything heard: the error is that of balls at large.
        assert!(from.std_error.unwrap() > 0.05 * from.value, "{from:?}");
    }

    #[test]
    fn intervals_hold_the_next_drop_as_often_as_they_say() {
        let mut rng = SplitMix64::new(7);
        let question = Question {
            from_m: Some(0.5),
            reach: None,
        };
        let (mut held, mut all) = (0, 0);
        for _ in 0..400 {
            let found = asked(times(0.8, 0.01, &mut rng), &question);
            let mut height = 0.5;
            for predicted in &found.rebounds.unwrap().heights_m[..4] {
                height *= (0.8 * (0.01 * rng.normal()).exp()).powi(2);
                let [low, high] = predicted.interval95.unwrap();
                held += usize::from(low <= height && height <= high);
                all += 1;
            }
        }
        let share = real(held) / real(all);
        assert!((0.92..=0.97).contains(&share), "{share}");
    }

    #[test]
    fn in_thick_air_no_height_is_enough_and_without_an_error_nothing_is_predicted() {
        let settings = Settings::default().mass_kg(1e-3).diameter_m(0.1);
        let times = times(0.8, 0.0, &mut SplitMix64::new(1));
        let analysis = fit_times(&[times], &settings).unwrap();
        let question = Question {
            from_m: None,
            reach: Some((2, 50.0)),
        };
        let found = predict(&analysis.drops[0], &settings, &question).unwrap();
        assert_eq!(found.reach.unwrap().drop_height_m, None);
        assert_eq!(found.rebounds, None);
        let mut drop = analysis.drops[0].clone();
        drop.restitution.as_mut().unwrap().estimate.std_error = None;
        assert_eq!(predict(&drop, &settings, &question), None);
    }
}
