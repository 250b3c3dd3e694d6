//! Flights, residuals, heights and e of a drop, each with its error, beside what the model expects.

use super::fitted::{Observed, nearest};
use super::{around, around_by_ratio, at_least};
use crate::physics::BallModel;
use crate::plot::{Axis, Band, Colour, Curve, Dots, Layer, Panel, Shape, Stroke};
use crate::report::{Drop, Impact};
use crate::statistics::sorted;
use crate::units::real;

/// Residuals and e are not shown more closely than this.
const LEAST_REACH_PERCENT: f64 = 0.01;
const LEAST_RANGE: f64 = 0.002;
/// Fewer points than this show nothing that their numbers would not.
const LEAST_POINTS: usize = 3;
/// Fewer flights than this leave nothing that could be told from the model.
const LEAST_LEFT: usize = 5;
/// Steps of a line over speeds.
const STEPS: u8 = 60;

/// The bounces of a drop with the line of its model.
pub(super) struct Bounces<'a> {
    drop: &'a Drop,
    ball: Option<BallModel>,
    /// Intervals that the model expects, in seconds; fewer or none where it does not say.
    line: Vec<f64>,
    /// The same for both ends of the 95 % interval of e.
    ends: Option<[Vec<f64>; 2]>,
}

impl<'a> Bounces<'a> {
    pub(super) fn of(drop: &'a Drop, gravity_m_per_s2: f64) -> Self {
        let ball = drop.ball_model(gravity_m_per_s2);
        let bounce_std = drop.scatter.bounce_std.unwrap_or(0.0);
        let flights = drop.impacts.len().saturating_sub(1);
        let impacts = drop.impacts.iter().take(flights).enumerate();
        let observed: Vec<Observed> = impacts
            .map(|(number, impact)| Observed {
                number,
                interval_s: impact.interval_s,
                weight: 1.0
                    / (bounce_std.powi(2) + ln_interval_std(impact).powi(2)).max(LEAST_VARIANCE),
            })
            .collect();
        let nearest = |ball: &BallModel| nearest(ball, drop, &observed);
        let interval = drop
            .restitution
            .as_ref()
            .and_then(|r| r.estimate.interval95);
        let with_end = |e: f64| drop.ball_model_with(e, gravity_m_per_s2);
        Self {
            drop,
            line: ball.as_ref().map(nearest).unwrap_or_default(),
            ends: interval.and_then(|[low, high]| {
                Some([nearest(&with_end(low)?), nearest(&with_end(high)?)])
            }),
            ball,
        }
    }

    /// The panels that these bounces fill: each has the points that it needs.
    pub(super) fn panels(&self) -> Vec<Panel> {
        let panels = [
            (LEAST_POINTS, self.flights()),
            (LEAST_LEFT - 1, self.restitutions()),
            (LEAST_LEFT, self.residuals()),
            (LEAST_POINTS, self.heights()),
        ];
        let filled = panels.into_iter().filter(|(least, panel)| {
            let dots = panel.layers.iter().filter_map(|layer| match layer {
                Layer::Dots(dots) => Some(dots.points.len()),
                _ => None,
            });
            dots.max().unwrap_or(0) >= *least
        });
        filled.map(|(_, panel)| panel).collect()
    }

    /// The flights against their number, on a logarithmic axis, with line and band.
    fn flights(&self) -> Panel {
        let (points, errors) = self.points(|i| Some((1e3 * i.interval_s?, ln_interval_std(i))));
        let line = self.line.iter().map(|t| 1e3 * t);
        let (low, high) = around_by_ratio(points.iter().map(|p| p.1).chain(line.clone()), 0.06);
        let errors = points.iter().zip(errors).map(|(p, e)| p.1 * e);
        let errors: Vec<f64> = errors.collect();
        let panel =
            Panel::new(self.numbers(), Axis::logarithmic("T (ms)", low, high)).headed("Flights");
        let panel = self.banded(panel, Some("95 % of e"), |t, _| 1e3 * t);
        self.lined(panel, line.collect(), "model").with(Layer::Dots(
            Dots::new(points, Shape::Point, Colour::BLUE)
                .with_errors(errors)
                .named("measured"),
        ))
    }

    /// What the line leaves of ln T, in percent, with the error of each flight by its times.
    fn residuals(&self) -> Panel {
        let residual = |number: usize, interval_s: f64| {
            let expected = self.line.get(number)?;
            Some(100.0 * (interval_s / expected).ln())
        };
        let impacts = self.drop.impacts.iter().enumerate();
        let rows = impacts.filter_map(|(n, impact)| {
            let left = residual(n, impact.interval_s?)?;
            Some(((real(n + 1), left), 100.0 * ln_interval_std(impact)))
        });
        let (points, errors): (Vec<_>, Vec<_>) = rows.unzip();
        let (low, high) = most(&points, &errors);
        let reach = high.max(-low).max(LEAST_REACH_PERCENT);
        let residual = Axis::linear("T − model (%)", -reach, reach).with_ticks(5);
        let panel = Panel::new(self.numbers(), residual).headed("Flights, less the model");
        let panel = self.banded(panel, None, |t, expected| 100.0 * (t / expected).ln());
        let zero = vec![(panel.x.from, 0.0), (panel.x.to, 0.0)];
        let zero = Curve::new(zero, Colour::RED).stroke(Stroke::Dashed);
        with_points(panel.with(Layer::Curve(zero)), points, errors)
    }

    /// e of each impact against its speed, with the line of the model.
    fn restitutions(&self) -> Panel {
        let impacts = self.drop.impacts.iter();
        let rows = impacts.filter_map(|i| {
            let b = &i.bounce;
            let at = (b.impact_speed_m_per_s?, b.restitution?);
            Some((at, b.restitution_std.unwrap_or(0.0)))
        });
        let (points, errors): (Vec<_>, Vec<f64>) = rows.unzip();
        let (slow, fast) = around_by_ratio(points.iter().map(|p| p.0), 0.06);
        let speeds = (0..=STEPS).map(|k| {
            let share = f64::from(k) / f64::from(STEPS);
            slow * (fast / slow).powf(share)
        });
        let law = self.ball.iter().flat_map(|ball| {
            let at = |speed| Some((speed, ball.restitution(speed)?.value()));
            speeds.clone().filter_map(at)
        });
        let law: Vec<(f64, f64)> = law.collect();
        let (low, high) = most(&points, &errors);
        let interval = self.drop.restitution.as_ref();
        let interval = interval.and_then(|r| Some((r.estimate.value, r.estimate.interval95?)));
        // The interval is what the panel tells: it is within the axis however few the points.
        let ends = interval.iter().flat_map(|(_, ends)| *ends);
        let (low, high) = around(law.iter().map(|p| p.1).chain([low, high]).chain(ends), 0.02);
        let (low, high) = at_least((low, high), LEAST_RANGE);
        let speed = Axis::logarithmic("impact speed (m/s)", slow, fast);
        let mut panel = Panel::new(speed, Axis::linear("e", low, high).with_ticks(6))
            .headed("e of each bounce");
        if let Some((e, [from, to])) = interval {
            let band = law.iter().map(|(v, at)| (*v, at * from / e, at * to / e));
            panel = panel.with(band_layer(band.collect(), None));
        }
        if !law.is_empty() {
            panel = panel.with(Layer::Curve(Curve::new(law, Colour::RED)));
        }
        with_points(panel, points, errors)
    }

    /// Heights of the rebounds against their number, on a logarithmic axis.
    fn heights(&self) -> Panel {
        let height = |i: &Impact| {
            let std_m = i.rebound_height_std_m.unwrap_or(0.0);
            Some((1e2 * i.rebound_height_m?, 1e2 * std_m))
        };
        let (points, errors) = self.points(height);
        let (low, high) = around_by_ratio(points.iter().map(|p| p.1), 0.06);
        Panel::new(self.numbers(), Axis::logarithmic("height (cm)", low, high))
            .headed("Rebounds g·T²/8")
            .with(Layer::Dots(
                Dots::new(points, Shape::Point, Colour::BLUE).with_errors(errors),
            ))
    }

    /// A value and its error for each impact that has them, against its number.
    fn points(&self, of: impl Fn(&Impact) -> Option<(f64, f64)>) -> (Vec<(f64, f64)>, Vec<f64>) {
        let impacts = self.drop.impacts.iter().enumerate();
        let rows = impacts.filter_map(|(n, impact)| {
            let (value, error) = of(impact)?;
            Some(((real(n + 1), value), error))
        });
        rows.unzip()
    }

    fn numbers(&self) -> Axis {
        let last = real(self.drop.impacts.len()).max(2.0);
        let room = 0.02 * last + 0.3;
        Axis::counting("impact n", 1.0 - room, last + room).with_ticks(8)
    }

    fn lined(&self, panel: Panel, line: Vec<f64>, name: &str) -> Panel {
        if line.is_empty() {
            return panel;
        }
        let points = (1..).zip(line).map(|(n, t)| (real(n), t)).collect();
        panel.with(Layer::Curve(Curve::new(points, Colour::RED).named(name)))
    }

    /// Adds the band between both ends of e, each scaled by a function of its interval and that of the line.
    fn banded(&self, panel: Panel, name: Option<&str>, scaled: impl Fn(f64, f64) -> f64) -> Panel {
        let Some([low, high]) = &self.ends else {
            return panel;
        };
        let rows = self.line.iter().zip(low.iter().zip(high)).enumerate();
        let points = rows.map(|(n, (&line, (&a, &b)))| {
            let (a, b) = (scaled(a, line), scaled(b, line));
            (real(n + 1), a.min(b), a.max(b))
        });
        panel.with(band_layer(points.collect(), name))
    }
}

/// Variances of ln T are not taken to be less than this, or the flights with the best times alone would place the line.
const LEAST_VARIANCE: f64 = 1e-12;

/// The 95 % interval of e; the first panel names it for all.
fn band_layer(points: Vec<(f64, f64, f64)>, name: Option<&str>) -> Layer {
    Layer::Band(Band {
        points,
        colour: Colour::ORANGE,
        name: name.map(str::to_owned),
    })
}

/// Standard error of ln T by those of the times: half of that of ln of the height.
fn ln_interval_std(impact: &Impact) -> f64 {
    let height = impact.rebound_height_m.zip(impact.rebound_height_std_m);
    height.map_or(0.0, |(height, std)| 0.5 * std / height)
}

/// Ends of an axis for points with error bars: it holds them all, but for the few that would leave the rest no room.
fn most(points: &[(f64, f64)], errors: &[f64]) -> (f64, f64) {
    let values = sorted(points.iter().map(|p| p.1));
    let tenth = values.len() / 10;
    let middle = values.get(tenth..values.len() - tenth).unwrap_or(&[]);
    let (Some(low), Some(high)) = (middle.first(), middle.last()) else {
        return around([], 0.0);
    };
    let beyond = BEYOND * (high - low).max(1e-6 * high.abs());
    let bars = points.iter().zip(errors);
    let ends = bars.flat_map(|(p, e)| [p.1 - e, p.1 + e]);
    around(ends.map(|end| end.clamp(low - beyond, high + beyond)), 0.06)
}

/// What lies further from the middle eighty percent than this many times their range does not make a panel higher.
const BEYOND: f64 = 2.0;

/// Points with their errors; those off the scale stand at its edge, as rings.
fn with_points(panel: Panel, points: Vec<(f64, f64)>, errors: Vec<f64>) -> Panel {
    let (low, high) = (panel.y.from, panel.y.to);
    let beyond = points.iter().filter(|p| !(low..=high).contains(&p.1));
    let beyond: Vec<(f64, f64)> = beyond.map(|p| (p.0, p.1.clamp(low, high))).collect();
    let dots = Dots::new(points, Shape::Point, Colour::BLUE).with_errors(errors);
    let panel = panel.with(Layer::Dots(dots));
    if beyond.is_empty() {
        return panel;
    }
    let beyond = Dots::new(beyond, Shape::Circlet, Colour::BLUE);
    panel.with(Layer::Dots(beyond.named("off the scale")))
}
