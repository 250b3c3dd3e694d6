//! Flights, residuals, heights and e of a drop, each with its error, beside what the model expects.

use super::fitted::{Law, Observed};
use super::{around, around_by_ratio};
use crate::plot::{Axis, Band, Colour, Curve, Dots, Layer, Panel, Shape, Stroke};
use crate::report::{Drop, Impact};
use crate::units::real;

/// Steps of a line over speeds.
const STEPS: u8 = 60;
/// Error bars reach out of a panel rather than make it more than this many times as high as the points do.
const BARS: f64 = 2.0;

/// The bounces of a drop with the line of its model.
pub(super) struct Bounces<'a> {
    drop: &'a Drop,
    law: Option<Law>,
    /// Intervals that the model expects, in seconds; fewer or none where it does not say.
    line: Vec<f64>,
    /// The same for both ends of the 95 % interval of e.
    ends: Option<[Vec<f64>; 2]>,
}

impl<'a> Bounces<'a> {
    pub(super) fn of(drop: &'a Drop, gravity_m_per_s2: f64) -> Self {
        let law = Law::of(drop, gravity_m_per_s2);
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
        let nearest = |law: &Law| law.nearest(&observed);
        let interval = drop
            .restitution
            .as_ref()
            .and_then(|r| r.estimate.interval95);
        let ends = law.as_ref().zip(interval);
        Self {
            drop,
            line: law.as_ref().map(nearest).unwrap_or_default(),
            ends: ends.map(|(law, ends)| ends.map(|e| nearest(&law.with_restitution(e)))),
            law,
        }
    }

    /// The flights against their number, on a logarithmic axis, with line and band.
    pub(super) fn flights(&self) -> Panel {
        let (points, errors) = self.points(|i| Some((1e3 * i.interval_s?, ln_interval_std(i))));
        let line = self.line.iter().map(|t| 1e3 * t);
        let (low, high) = around_by_ratio(points.iter().map(|p| p.1).chain(line.clone()), 0.06);
        let errors = points.iter().zip(errors).map(|(p, e)| p.1 * e);
        let errors: Vec<f64> = errors.collect();
        let panel = Panel::new(self.numbers(), Axis::logarithmic("T (ms)", low, high))
            .headed("Flight T, logarithmic");
        let panel = self.banded(panel, |t, _| 1e3 * t);
        self.lined(panel, line.collect(), "model").with(Layer::Dots(
            Dots::new(points, Shape::Point, Colour::BLUE)
                .with_errors(errors)
                .named("heard"),
        ))
    }

    /// What the line leaves of ln T, in percent, with the error of each flight by its times.
    pub(super) fn residuals(&self) -> Panel {
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
        let (low, high) = with_bars(&points, &errors);
        let reach = high.max(-low);
        let residual = Axis::linear("ln T − model (%)", -reach, reach).with_ticks(5);
        let panel = Panel::new(self.numbers(), residual).headed("Residuals of ln T");
        let panel = self.banded(panel, |t, expected| 100.0 * (t / expected).ln());
        let zero = (0..=self.drop.impacts.len()).map(|n| (real(n), 0.0));
        panel
            .with(Layer::Curve(
                Curve::new(zero.collect(), Colour::RED).stroke(Stroke::Dashed),
            ))
            .with(Layer::Dots(
                Dots::new(points, Shape::Point, Colour::BLUE)
                    .with_errors(errors)
                    .named("± by the times"),
            ))
    }

    /// e of each impact against its speed, with the line of the model.
    pub(super) fn restitutions(&self) -> Panel {
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
        let law = self.law.iter().flat_map(|law| {
            let at = |speed| Some((speed, law.contact(speed)?.0));
            speeds.clone().filter_map(at)
        });
        let law: Vec<(f64, f64)> = law.collect();
        let (low, high) = sure(&points, &errors, &law);
        let speed = Axis::logarithmic("impact speed (m/s)", slow, fast);
        let mut panel = Panel::new(speed, Axis::linear("e", low, high).with_ticks(6))
            .headed("e of each impact");
        let interval = self.drop.restitution.as_ref();
        let interval = interval.and_then(|r| Some((r.estimate.value, r.estimate.interval95?)));
        if let Some((e, [from, to])) = interval {
            let band = law.iter().map(|(v, at)| (*v, at * from / e, at * to / e));
            panel = panel.with(band_layer(band.collect()));
        }
        if !law.is_empty() {
            panel = panel.with(Layer::Curve(Curve::new(law, Colour::RED).named("model")));
        }
        panel.with(Layer::Dots(
            Dots::new(points, Shape::Point, Colour::BLUE)
                .with_errors(errors)
                .named("± by the times"),
        ))
    }

    /// Heights of the rebounds against their number, on a logarithmic axis.
    pub(super) fn heights(&self) -> Panel {
        let height = |i: &Impact| {
            let std_m = i.rebound_height_std_m.unwrap_or(0.0);
            Some((1e2 * i.rebound_height_m?, 1e2 * std_m))
        };
        let (points, errors) = self.points(height);
        let (low, high) = around_by_ratio(points.iter().map(|p| p.1), 0.06);
        Panel::new(self.numbers(), Axis::logarithmic("height (cm)", low, high))
            .headed("Rebound heights g·T²/8, logarithmic")
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
        Axis::counting(
            "n, counted from the first impact heard",
            1.0 - room,
            last + room,
        )
        .with_ticks(8)
    }

    fn lined(&self, panel: Panel, line: Vec<f64>, name: &str) -> Panel {
        if line.is_empty() {
            return panel;
        }
        let points = (1..).zip(line).map(|(n, t)| (real(n), t)).collect();
        panel.with(Layer::Curve(Curve::new(points, Colour::RED).named(name)))
    }

    /// Adds the band between both ends of e, each scaled by a function of its interval and that of the line.
    fn banded(&self, panel: Panel, scaled: impl Fn(f64, f64) -> f64) -> Panel {
        let Some([low, high]) = &self.ends else {
            return panel;
        };
        let rows = self.line.iter().zip(low.iter().zip(high)).enumerate();
        let points = rows.map(|(n, (&line, (&a, &b)))| {
            let (a, b) = (scaled(a, line), scaled(b, line));
            (real(n + 1), a.min(b), a.max(b))
        });
        panel.with(band_layer(points.collect()))
    }
}

/// Variances of ln T are not taken to be less than this, or the flights with the best times alone would place the line.
const LEAST_VARIANCE: f64 = 1e-12;

fn band_layer(points: Vec<(f64, f64, f64)>) -> Layer {
    Layer::Band(Band {
        points,
        colour: Colour::ORANGE,
        name: Some("95 % of e".to_owned()),
    })
}

/// Standard error of ln T by those of the times: half of that of ln of the height.
fn ln_interval_std(impact: &Impact) -> f64 {
    let height = impact.rebound_height_m.zip(impact.rebound_height_std_m);
    height.map_or(0.0, |(height, std)| 0.5 * std / height)
}

/// Ends of an axis with points and, as far as they are not much longer than these scatter, their error bars.
fn with_bars(points: &[(f64, f64)], errors: &[f64]) -> (f64, f64) {
    let (low, high) = around(points.iter().map(|p| p.1).chain([0.0]), 0.0);
    let most = BARS * (high - low);
    let bars = points.iter().zip(errors);
    let ends = bars.flat_map(|(p, e)| [p.1 - e.min(most), p.1 + e.min(most)]);
    around(ends.chain([low, high]), 0.08)
}

/// Ends of an axis for e: it holds the line, and the points that are not so unsure that they would hide the others.
fn sure(points: &[(f64, f64)], errors: &[f64], line: &[(f64, f64)]) -> (f64, f64) {
    let mut sorted = errors.to_vec();
    sorted.sort_by(f64::total_cmp);
    let most = UNSURE
        * sorted
            .get(sorted.len() / 2)
            .copied()
            .unwrap_or(0.0)
            .max(LEAST_STD);
    let rows = points.iter().zip(errors).filter(|(_, e)| **e <= most);
    let ends = rows.flat_map(|(p, e)| [p.1 - e, p.1 + e]);
    around(ends.chain(line.iter().map(|p| p.1)), 0.08)
}

/// A point with an error that is this many times the median, or more, does not make the panel higher.
const UNSURE: f64 = 10.0;
/// An error of e below this is nothing that hides others.
const LEAST_STD: f64 = 1e-3;
