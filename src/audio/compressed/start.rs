//! Where the sound of a recording begins in its stream.

/// A length of time in units of its own, exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Span {
    units: u64,
    per_s: u32,
}

impl Span {
    const NONE: Self = Self { units: 0, per_s: 1 };

    /// So many units, of so many per second; none if that is zero.
    pub(super) fn new(units: u64, per_s: u32) -> Option<Self> {
        (per_s > 0).then_some(Self { units, per_s })
    }

    /// The number of units.
    pub(super) const fn units(self) -> u64 {
        self.units
    }

    /// The nearest number of frames at a sample rate.
    pub(super) fn frames(self, sample_rate_hz: u32) -> u64 {
        let [units, rate, per_s] =
            [self.units, sample_rate_hz.into(), self.per_s.into()].map(u128::from);
        u64::try_from((2 * units * rate + per_s) / (2 * per_s)).unwrap_or(u64::MAX)
    }
}

/// Where the sound of a recording begins in its stream.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Start {
    /// Silence before it.
    pub later: Span,
    /// What is left out at the head of the stream.
    pub hidden: Span,
}

impl Default for Start {
    fn default() -> Self {
        Self {
            later: Span::NONE,
            hidden: Span::NONE,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_span_is_the_nearest_number_of_frames() {
        for (units, per_s, rate, frames) in [
            (1_826, 44_100, 44_100, 1_826),
            (1, 600, 44_100, 74),
            (25, 600, 44_100, 1_838),
            (2_112, 44_100, 22_050, 1_056),
            (u64::MAX, 1, u32::MAX, u64::MAX),
        ] {
            assert_eq!(Span::new(units, per_s).unwrap().frames(rate), frames);
        }
        assert_eq!(Span::new(1, 0), None);
    }
}
