//! Whether the flights of a chain shrink as those of a ball do, and by how much.

use super::chain::Chain;
use crate::impact::Impact;
use crate::units::real;

/// Scatter of one ln ratio before any is known, and how many ratios that knowledge is worth.
const SCATTER: (f64, f64) = (3e-3, 2.0);

/// Drops of one ball differ in ln e by at most this many standard errors …
const AGREEMENT: f64 = 3.0;
/// … and by this, as e depends on the speed.
const CHANGE: f64 = 0.02;

/// ln of the ratios of neighbouring flights, all of whose impacts were heard: their mean and what it rests on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Shrinkage {
    /// Mean of ln(T'/T): ln e.
    pub ln_ratio: f64,
    /// Standard error of that.
    pub std: f64,
    /// Number of ratios.
    count: f64,
}

impl Shrinkage {
    /// None where fewer than two ratios are known.
    pub(super) fn of(chain: &Chain) -> Option<Self> {
        let heard = chain.impacts.windows(3);
        let heard = heard.filter(|w| w.iter().all(Impact::is_heard));
        let ln: Vec<f64> = heard
            .map(|w| ((w[2].time_s - w[1].time_s) / (w[1].time_s - w[0].time_s)).ln())
            .collect();
        let count = real(ln.len());
        let ln_ratio = ln.iter().sum::<f64>() / count;
        let squares: f64 = ln.iter().map(|r| (r - ln_ratio).powi(2)).sum();
        let (scatter, worth) = SCATTER;
        let variance = (worth * scatter * scatter + squares) / (worth + count - 1.0);
        (ln.len() > 1).then(|| Self {
            ln_ratio,
            std: (variance / count).sqrt(),
            count,
        })
    }

    /// How much better the flights are explained by a ball than by a hand or a clock, whose ratios have mean 0, in nats.
    ///
    /// # Formula
    /// `(m + ν)/2 · ln(1 + t²/(m − 1 + ν))` with Student's `t = mean/std` of m ratios and what is known of their scatter
    /// beforehand, worth ν = 2; 0 where they grow.
    pub(super) fn nats(&self) -> f64 {
        if self.ln_ratio >= 0.0 {
            return 0.0;
        }
        let t = self.ln_ratio / self.std;
        0.5 * (self.count + SCATTER.1) * (t * t / (self.count - 1.0 + SCATTER.1)).ln_1p()
    }

    /// Whether two chains may be drops of one ball: their ratios agree.
    pub(super) fn agrees(&self, other: &Self) -> bool {
        let off = (self.ln_ratio - other.ln_ratio).abs();
        off < AGREEMENT * self.std.hypot(other.std) + CHANGE
    }
}
