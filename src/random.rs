//! Random numbers whose stream never changes: a seed gives the same recording on every machine and in every version.

/// Steele, Lea and Flood's generator (OOPSLA 2014), with the constants of its reference implementation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SplitMix64 {
    state: u64,
}

impl SplitMix64 {
    /// The stream of this seed.
    #[must_use]
    pub const fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    /// The next 64 bits.
    pub const fn next_u64(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number above 0 and up to 1, in steps of 2⁻⁵³. Never 0, so its logarithm is finite.
    #[expect(
        clippy::cast_precision_loss,
        reason = "53 bits and their successor are exact in f64"
    )]
    pub const fn uniform(&mut self) -> f64 {
        let steps = (self.next_u64() >> 11) + 1;
        steps as f64 / (1_u64 << 53) as f64
    }

    /// A normally distributed number of mean 0 and variance 1, by Box and Muller; takes two numbers off the stream.
    pub fn normal(&mut self) -> f64 {
        let radius = libm::sqrt(-2.0 * libm::log(self.uniform()));
        radius * libm::cos(std::f64::consts::TAU * self.uniform())
    }

    /// A factor whose logarithm has mean 0 and this standard deviation.
    pub fn factor(&mut self, ln_std: f64) -> f64 {
        libm::exp(ln_std * self.normal())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stream_is_that_of_the_reference_implementation() {
        let mut stream = SplitMix64::new(1_234_567);
        let first: Vec<u64> = (0..3).map(|_| stream.next_u64()).collect();
        assert_eq!(
            first,
            [
                6_457_827_717_110_365_317,
                3_203_168_211_198_807_973,
                9_817_491_932_198_370_423
            ]
        );
    }

    #[test]
    fn normal_numbers_never_change() {
        let mut stream = SplitMix64::new(7);
        let bits: Vec<u64> = (0..3).map(|_| stream.normal().to_bits()).collect();
        assert_eq!(
            bits,
            [
                4_608_826_197_974_838_881,
                13_824_186_797_681_467_973,
                4_571_836_469_702_388_853
            ]
        );
    }

    #[test]
    fn normal_numbers_have_mean_0_variance_1_and_kurtosis_3() {
        let mut stream = SplitMix64::new(11);
        let count = 200_000;
        let moments = (0..count).fold([0.0; 3], |[mean, square, fourth], _| {
            let x = stream.normal();
            [mean + x, square + x * x, fourth + x.powi(4)]
        });
        let [mean, square, fourth] = moments.map(|sum| sum / f64::from(count));
        // Five standard errors of each.
        assert!(mean.abs() < 5.0 / f64::from(count).sqrt(), "{mean}");
        assert!((square - 1.0).abs() < 5.0 * (2.0 / f64::from(count)).sqrt());
        assert!((fourth - 3.0).abs() < 5.0 * (96.0 / f64::from(count)).sqrt());
    }
}
