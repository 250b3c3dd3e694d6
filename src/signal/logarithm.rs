//! A natural logarithm that runs side by side in the machine's vectors.

/// √½ as bits: mantissas are taken from there to √2, around 1, where the series is best.
const ROOT_HALF_BITS: u32 = 0x3F35_04F3;
/// 2²³ as bits and as a number: a small whole number in the mantissa of the one exceeds the other by itself.
const WHOLE_BITS: u32 = 0x4B00_0000;
const WHOLE: f32 = 8_388_608.0;
/// ln(1 + f) = f − f²/2 + f³·P(f) for √½ ≤ 1 + f < √2, highest power first.
///
/// Reference: S. L. Moshier, Cephes mathematical library, `logf.c`.
const SERIES: [f32; 9] = [
    7.037_683_6e-2,
    -1.151_461e-1,
    1.167_699_9e-1,
    -1.242_014_1e-1,
    1.424_932_3e-1,
    -1.666_805_8e-1,
    2.000_071_5e-1,
    -2.499_999_4e-1,
    3.333_333e-1,
];

/// ln x for finite x ≥ 1, to an error of 2·10⁻⁷ (of the result where that exceeds 1); exactly 0 for 1.
///
/// Without branches or calls, so that a loop over many values needs a few nanoseconds for each.
pub(crate) fn ln_from_one(x: f32) -> f32 {
    let bits = x.to_bits();
    let exponent = bits.wrapping_sub(ROOT_HALF_BITS) >> 23;
    let f = f32::from_bits(bits.wrapping_sub(exponent << 23)) - 1.0;
    let powers = f32::from_bits(exponent | WHOLE_BITS) - WHOLE;
    let p = SERIES.iter().fold(0.0, |p, c| p * f + c);
    powers * std::f32::consts::LN_2 + (f - f * f * (0.5 - f * p))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_logarithm() {
        assert_eq!(ln_from_one(1.0), 0.0);
        let mut x = 1.0_f32;
        while x < 1e37 {
            let (fast, exact) = (f64::from(ln_from_one(x)), f64::from(x).ln());
            assert!(
                (fast - exact).abs() < 2e-7 * exact.max(1.0),
                "{x}: {fast} for {exact}"
            );
            x *= 1.000_37;
        }
    }
}
