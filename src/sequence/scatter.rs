//! How far one bounce lies from the law of the others.

/// Scatter of ln(T'/T) of one bounce: a fine ball, a usual one, a seam or a rough floor, a worse one, an accident.
const SCALES: [f64; CLASSES] = [0.003, 0.01, 0.03, 0.09, 0.3];
/// How often each is met among balls at large; every ball meets the last now and then.
const SHARES: [f64; CLASSES] = [0.30, 0.50, 0.14, 0.04, 0.02];
/// Share of balls at large in what is believed of the next bounce: a scale is remembered for ten bounces.
const FORGETTING: f64 = 0.1;

const CLASSES: usize = 5;
const ACCIDENT: usize = CLASSES - 1;

/// A mixture of Student's distributions of five widths, whose shares are learnt from bounce to bounce.
///
/// # Formula
/// ```text
/// p(d) = Σ_k w_k · 3/(8σ_k) · (1 + d²/(4σ_k²))^(−5/2),   σ_k² = law + spread·s_k² + jitter
/// ```
/// Student's with four degrees of freedom each. The shares w follow Bayes' rule and forget a tenth at each bounce; the
/// share of accidents stays what it is for any ball, and an accident says nothing of the other four.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scatter {
    shares: [f64; CLASSES],
}

/// The other variances of a deviation: of the law itself, of the jitter of the times, and the factor of the bounce's own.
#[derive(Debug, Clone, Copy)]
pub(super) struct Variances {
    pub law: f64,
    pub jitter: f64,
    /// Variance of the bounce itself in units of that of one bounce: more where impacts between are only inferred.
    pub spread: f64,
}

impl Variances {
    const fn of_class(&self, class: usize) -> f64 {
        self.law + self.bounce(class)
    }

    const fn bounce(&self, class: usize) -> f64 {
        self.spread * SCALES[class] * SCALES[class] + self.jitter
    }
}

/// What a deviation taught.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lesson {
    /// Variance of the bounce with its jitter, as the classes have it on average in their precision.
    pub variance: f64,
    /// Probability that it was an accident.
    pub accident: f64,
}

impl Scatter {
    pub(super) const fn at_large() -> Self {
        Self { shares: SHARES }
    }

    /// Density of each class at a deviation.
    fn parts(&self, deviation: f64, variances: &Variances) -> [f64; CLASSES] {
        std::array::from_fn(|k| {
            let variance = variances.of_class(k);
            let tail = 1.0 + 0.25 * deviation * deviation / variance;
            0.375 * self.shares[k] / (variance * tail).sqrt() / (tail * tail)
        })
    }

    /// ln of the density of a deviation.
    pub(super) fn ln_density(&self, deviation: f64, variances: &Variances) -> f64 {
        self.parts(deviation, variances).iter().sum::<f64>().ln()
    }

    /// Variance of a deviation where no accident happens.
    pub(super) fn variance(&self, variances: &Variances) -> f64 {
        let of = |k: usize| self.shares[k] * variances.of_class(k);
        (0..ACCIDENT).map(of).sum::<f64>() / (1.0 - self.shares[ACCIDENT])
    }

    /// Learns from a deviation.
    pub(super) fn learn(&mut self, deviation: f64, variances: &Variances) -> Lesson {
        let parts = self.parts(deviation, variances);
        let sum: f64 = parts.iter().sum();
        let odds = parts.map(|p| p / sum);
        let precision = |k: usize| odds[k] / variances.bounce(k);
        let lesson = Lesson {
            variance: 1.0 / (0..CLASSES).map(precision).sum::<f64>(),
            accident: odds[ACCIDENT],
        };
        let own = 1.0 - SHARES[ACCIDENT];
        for k in 0..ACCIDENT {
            let now = odds[k] + odds[ACCIDENT] * self.shares[k] / own;
            self.shares[k] = own * (1.0 - FORGETTING) * now + FORGETTING * SHARES[k];
        }
        lesson
    }
}
