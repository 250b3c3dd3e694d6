//! Restitution from the ratios of successive flights.

use super::Estimate;
use super::irregular::Regularity;
use crate::impact::Impact;
use crate::units::real;

/// The flights between impacts heard.
#[derive(Debug, Clone, PartialEq)]
pub struct Flights {
    /// Number of the impact before each flight, and its length in seconds.
    lengths: Vec<(usize, f64)>,
    /// How many of them there are up to the last that is known well enough for a ratio.
    clear: usize,
    /// Numbers of the bounces that are left out of the ratios, in order.
    left_out: Vec<usize>,
}

/// A flight at the end whose length errs by more than this share says nothing of e: the flights before foretell it as well.
const VAGUE: f64 = 0.03;
/// Fewest clear flights: where there are fewer all have to do.
const FEWEST_CLEAR: usize = 4;

impl Flights {
    /// The flights between neighbouring impacts that were both heard, which are in order of time.
    #[must_use]
    pub fn between(impacts: &[Impact]) -> Self {
        let (mut lengths, mut clear) = (Vec::new(), 0);
        for (i, pair) in impacts.windows(2).enumerate() {
            let length_s = pair[1].time_s - pair[0].time_s;
            if !(pair[0].is_heard() && pair[1].is_heard() && length_s > 0.0) {
                continue;
            }
            lengths.push((i, length_s));
            if pair[0].std_s.hypot(pair[1].std_s) < VAGUE * length_s {
                clear = lengths.len();
            }
        }
        Self {
            clear: if clear < FEWEST_CLEAR {
                lengths.len()
            } else {
                clear
            },
            lengths,
            left_out: Vec::new(),
        }
    }

    /// The same without the ratios of irregular bounces, and with those of the part alone that has the drop's e.
    #[must_use]
    pub fn regular(impacts: &[Impact], regularity: &Regularity) -> Self {
        let part = &regularity.part;
        let odd = regularity.odd_in(part);
        let is_regular = |i: &usize| part.start < *i && i + 1 < part.end && !odd.contains(i);
        Self {
            left_out: (1..impacts.len()).filter(|i| !is_regular(i)).collect(),
            ..Self::between(impacts)
        }
    }

    fn is_left_out(&self, bounce: usize) -> bool {
        self.left_out.binary_search(&bounce).is_ok()
    }

    /// Length in seconds of the flight after impact `number`, counted from 0, if both its ends were heard.
    #[must_use]
    pub fn after(&self, number: usize) -> Option<f64> {
        let place = self
            .lengths
            .binary_search_by_key(&number, |&(i, _)| i)
            .ok()?;
        Some(self.lengths[place].1)
    }

    /// ln of the ratio of each flight to the one before it, with the number of the impact between them; not of those left out.
    #[must_use]
    pub fn ln_ratios(&self) -> Vec<(usize, f64)> {
        self.lengths[..self.clear]
            .windows(2)
            .filter(|pair| pair[1].0 == pair[0].0 + 1 && !self.is_left_out(pair[1].0))
            .map(|pair| (pair[1].0, (pair[1].1 / pair[0].1).ln()))
            .collect()
    }

    /// The plain geometric mean of the ratios, from the first flight to the last that is known well enough.
    ///
    /// # Formula
    /// ```text
    /// ln e = Σ ln(T_b / T_a) / Σ (b − a),   σ = s / √m
    /// ```
    /// `T_a` and `T_b` are the first and last flight; where bounces are left out, those of each piece between them. s
    /// is the standard deviation of the m ratios about their mean. Where
    /// each rebound scatters by itself this is the right error; where the times' jitter rules, neighbouring ratios
    /// err in opposite directions and it is too wide, never too narrow. A trend (drag) widens it too. One ratio has no
    /// error.
    ///
    /// None for fewer than two flights.
    #[must_use]
    pub fn ratio(&self) -> Option<Estimate> {
        let (mut bounces, mut lost) = (0, 0.0);
        for pair in self.lengths[..self.clear].windows(2) {
            let ((a, before), (b, after)) = (pair[0], pair[1]);
            if !(a + 1..=b).any(|bounce| self.is_left_out(bounce)) {
                bounces += b - a;
                lost += (after / before).ln();
            }
        }
        if bounces == 0 {
            return None;
        }
        let ln = lost / real(bounces);
        let Some(scatter) = self.scatter() else {
            return Some(Estimate::bare(ln.exp()));
        };
        let count = real(self.ln_ratios().len());
        Some(Estimate::from_ln(ln, scatter / count.sqrt(), count - 1.0))
    }

    /// Standard deviation of the ln ratios about their mean; none for fewer than two.
    #[must_use]
    pub fn scatter(&self) -> Option<f64> {
        let ratios = self.ln_ratios();
        if ratios.len() < 2 {
            return None;
        }
        let mean = ratios.iter().map(|(_, r)| r).sum::<f64>() / real(ratios.len());
        let squares: f64 = ratios.iter().map(|(_, r)| (r - mean).powi(2)).sum();
        Some((squares / real(ratios.len() - 1)).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::impact::Status;

    fn drop(first: f64, ratios: &[f64]) -> Vec<Impact> {
        let mut flight = first;
        let mut time_s = 1.0 + first;
        let mut impacts = vec![1.0, time_s];
        for r in ratios {
            flight *= r;
            time_s += flight;
            impacts.push(time_s);
        }
        impacts
            .into_iter()
            .map(|time_s| Impact::heard(time_s, 1e-6))
            .collect()
    }

    #[test]
    fn the_ratio_of_a_geometric_drop_is_exact() {
        let estimate = Flights::between(&drop(0.5, &[0.8; 12])).ratio().unwrap();
        assert!((estimate.value - 0.8).abs() < 1e-12 && estimate.std_error.unwrap() < 1e-12);
    }

    #[test]
    fn scatter_makes_the_error() {
        // ln ratios alternate by ±s about the mean: the standard deviation of ten of them is s·√(10/9).
        let s = 0.01_f64;
        let ratios: Vec<f64> = (0..10)
            .map(|i| 0.9 * if i % 2 == 0 { s.exp() } else { (-s).exp() })
            .collect();
        let estimate = Flights::between(&drop(0.5, &ratios)).ratio().unwrap();
        assert!((estimate.value - 0.9).abs() < 1e-12);
        let expected = 0.9 * s * (10.0_f64 / 9.0).sqrt() / 10.0_f64.sqrt();
        assert!((estimate.std_error.unwrap() - expected).abs() < 1e-12);
        let [low, high] = estimate.interval95.unwrap();
        assert!((((high / low).ln() / 2.0) / (expected / 0.9) - 2.262).abs() < 1e-3);
    }

    #[test]
    fn an_inferred_impact_bounds_no_flight_but_keeps_its_number() {
        let mut impacts = drop(0.5, &[0.8; 8]);
        impacts[4].status = Status::Inferred;
        impacts[4].time_s += 0.02;
        let flights = Flights::between(&impacts);
        assert_eq!(
            (
                flights.after(2).is_some(),
                flights.after(3),
                flights.after(4)
            ),
            (true, None, None)
        );
        assert!((flights.ratio().unwrap().value - 0.8).abs() < 1e-12);
    }

    #[test]
    fn vague_flights_at_the_end_have_no_say() {
        let mut impacts = drop(0.5, &[0.8; 12]);
        for impact in &mut impacts[11..] {
            impact.time_s += 0.01;
            impact.std_s = 0.02;
        }
        let estimate = Flights::between(&impacts).ratio().unwrap();
        assert!((estimate.value - 0.8).abs() < 1e-12);
    }

    #[test]
    fn three_impacts_give_one_ratio_without_an_error() {
        let estimate = Flights::between(&drop(0.5, &[0.8])).ratio().unwrap();
        assert!((estimate.value - 0.8).abs() < 1e-12 && estimate.std_error.is_none());
        assert!(Flights::between(&drop(0.5, &[])).ratio().is_none());
    }
}
