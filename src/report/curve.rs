//! e against speed, pooled over all drops of many recordings: as data, in words and as CSV.

use super::numbers::{counted, digits_for, plus_minus};
use super::wrap::wrapped;
use super::{Drop, Report};
use crate::fit::Estimate;
use crate::fit::curve::{Curve, Point};

/// Rows of the table, at speeds a constant factor apart.
const ROWS: u8 = 100;

/// The bounces of many drops, to which a curve is fitted once all are there.
#[derive(Debug, Clone, Default)]
pub struct Bounces {
    points: Vec<Point>,
    drops: usize,
}

/// The curve, and the bounces that it is of.
#[derive(Debug, Clone)]
pub struct SpeedCurve {
    curve: Curve,
    points: Vec<Point>,
}

/// e at one speed of the curve.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct AtSpeed {
    /// Speed of arrival.
    pub speed_m_per_s: f64,
    /// e there, with its band.
    pub restitution: Estimate,
    /// Whether the speed lies beyond those heard.
    pub extrapolated: bool,
}

impl Bounces {
    /// Those of a report, among them the first of each drop where its height is known.
    #[must_use]
    pub fn of(report: &Report) -> Self {
        let mut bounces = Self::default();
        for drop in &report.drops {
            let own = points(bounces.drops, drop);
            bounces.drops += usize::from(!own.is_empty());
            bounces.points.extend(own);
        }
        bounces
    }

    /// Adds those of other drops.
    pub fn append(&mut self, other: Self) {
        let moved = other.points.into_iter().map(|point| Point {
            drop: point.drop + self.drops,
            ..point
        });
        self.points.extend(moved);
        self.drops += other.drops;
    }

    /// The curve; none of fewer than three drops.
    #[must_use]
    pub fn curve(self) -> Option<SpeedCurve> {
        Some(SpeedCurve {
            curve: Curve::of(&self.points)?,
            points: self.points,
        })
    }
}

fn points(index: usize, drop: &Drop) -> Vec<Point> {
    let first = drop.first_rebound.as_ref().filter(|_| {
        let impact = drop.impacts.first();
        impact.is_some_and(|i| i.bounce.restitution.is_none())
    });
    let first = first.and_then(|r| {
        let std = r.restitution.std_error?;
        Some((r.impact_speed_m_per_s, r.restitution.value, std))
    });
    let later = drop.impacts.iter().filter_map(|impact| {
        let b = &impact.bounce;
        Some((b.impact_speed_m_per_s?, b.restitution?, b.restitution_std?))
    });
    let all = first
        .into_iter()
        .chain(later)
        .filter(|(v, e, _)| *v > 0.0 && *e > 0.0);
    all.map(|(speed, restitution, std)| Point {
        drop: index,
        ln_speed: speed.ln(),
        restitution,
        std,
    })
    .collect()
}

impl SpeedCurve {
    /// e at a speed in m/s.
    #[must_use]
    pub fn at(&self, speed_m_per_s: f64) -> AtSpeed {
        let (restitution, extrapolated) = self.curve.at(speed_m_per_s);
        AtSpeed {
            speed_m_per_s,
            restitution,
            extrapolated,
        }
    }

    /// The curve from the slowest to the fastest speed that three drops have.
    #[must_use]
    pub fn rows(&self) -> Vec<AtSpeed> {
        let [low, high] = self.curve.speeds_m_per_s;
        let share = |i: u8| f64::from(i) / f64::from(ROWS);
        (0..=ROWS)
            .map(|i| self.at(low * (high / low).powf(share(i))))
            .collect()
    }

    /// Speed, e and its standard error of each bounce within these speeds.
    #[must_use]
    pub fn bounces(&self) -> Vec<(f64, f64, f64)> {
        let [low, high] = self.curve.speeds_m_per_s;
        let within = |p: &&Point| (low..=high).contains(&p.ln_speed.exp());
        let shown = self.points.iter().filter(within);
        shown
            .map(|p| (p.ln_speed.exp(), p.restitution, p.std))
            .collect()
    }

    /// The rows with a heading.
    #[must_use]
    pub fn to_csv(&self) -> String {
        let mut table =
            "speed_m_per_s,restitution,restitution_std,restitution_low95,restitution_high95\n"
                .to_owned();
        for AtSpeed {
            speed_m_per_s,
            restitution,
            ..
        } in self.rows()
        {
            let [low, high] = restitution.interval95.unwrap_or([f64::NAN; 2]);
            let std = restitution.std_error.unwrap_or(f64::NAN);
            table += &format!(
                "{speed_m_per_s:.5},{:.6},{std:.6},{low:.6},{high:.6}\n",
                restitution.value
            );
        }
        table
    }

    /// What it rests on, and e at each of these speeds; of none at both ends and in the middle.
    #[must_use]
    pub fn in_words(&self, speeds_m_per_s: &[f64]) -> String {
        let Curve {
            drops,
            bounces,
            speeds_m_per_s: [low, high],
            bounce_std,
            drop_std,
            ..
        } = self.curve;
        let mut lines = vec![format!(
            "e against speed: {} of {}, {low:.2} to {high:.2} m/s",
            counted(bounces, "bounce"),
            counted(drops, "drop")
        )];
        let usual = [low, (low * high).sqrt(), high];
        let asked = if speeds_m_per_s.is_empty() {
            &usual
        } else {
            speeds_m_per_s
        };
        for speed in asked {
            let AtSpeed {
                restitution: e,
                extrapolated,
                ..
            } = self.at(*speed);
            let (std, [from, to]) = (
                e.std_error.unwrap_or(0.0),
                e.interval95.unwrap_or([e.value; 2]),
            );
            let digits = digits_for(std);
            let beyond = if extrapolated {
                ", beyond the speeds heard"
            } else {
                ""
            };
            lines.push(format!(
                "  at {speed:.2} m/s: e {} (95 %: {from:.digits$} to {to:.digits$}){beyond}",
                plus_minus(e.value, std)
            ));
        }
        let digits = digits_for(bounce_std.min(drop_std).max(1e-5));
        lines.push(format!(
            "  scatter  {bounce_std:.digits$} from bounce to bounce, {drop_std:.digits$} more between drops, one standard deviation"
        ));
        lines.iter().map(|line| wrapped(line, 11) + "\n").collect()
    }
}
