//! The one root finder: Newton's method that never leaves its bracket.

/// Enough to halve any bracket of `f64`s down to neighbours; Newton needs fewer than ten.
const MAX_STEPS: usize = 2200;

/// The root of an increasing function between `low` ≥ 0 and `high`, starting from `guess`.
///
/// `function` gives value and slope. The bracket shrinks at every step and a step that would leave it is replaced by
/// bisection, so neither a bad slope nor a bad guess can lose the root. Where rounding leaves no change of sign, the end
/// of the bracket nearest to the root comes back.
pub(super) fn increasing(
    (mut low, mut high): (f64, f64),
    guess: f64,
    function: impl Fn(f64) -> (f64, f64),
) -> f64 {
    let mut x = if guess >= low && guess <= high {
        guess
    } else {
        middle(low, high)
    };
    for _ in 0..MAX_STEPS {
        let (value, slope) = function(x);
        if value == 0.0 {
            return x;
        }
        if value < 0.0 {
            low = x;
        } else {
            high = x;
        }
        let newton = x - value / slope;
        // Written so that a NaN, from a slope of zero or an infinite value, falls through to bisection.
        let next = if newton > low && newton < high {
            newton
        } else if (newton - x).abs() <= f64::EPSILON * x {
            return x;
        } else {
            middle(low, high)
        };
        if (next - x).abs() <= 0.5 * f64::EPSILON * x {
            return next;
        }
        x = next;
    }
    x
}

/// The middle in ratio where the ends differ by orders of magnitude, else the plain one.
fn middle(low: f64, high: f64) -> f64 {
    if low > 0.0 && high > 4.0 * low {
        libm::sqrt(low) * libm::sqrt(high)
    } else {
        low + 0.5 * (high - low)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_root_is_found_from_a_guess_that_sends_newton_away() {
        // Newton on atan diverges from beyond 1.39.
        let root = increasing((0.0, 1e6), 1e5, |x| {
            ((x - 3.0).atan(), 1.0 / (1.0 + (x - 3.0).powi(2)))
        });
        assert!((root - 3.0).abs() < 1e-15, "{root}");
    }

    #[test]
    fn a_useless_slope_leaves_bisection() {
        let root = increasing((1e-20, 1e20), 1.0, |x| (x * x - 2e-10, 0.0));
        assert!((root * root - 2e-10).abs() < 1e-24, "{root}");
    }
}
