//! Sorting by a number.

/// Sorts by a number of each item, ascending; items of equal numbers stay in their order.
///
/// The sort itself is compiled once for all kinds of items: with `sort_by` it is 3 kB of a page for each kind and each order.
pub(crate) fn sort_by_number<T>(items: &mut [T], number: impl Fn(&T) -> f64) {
    items.sort_by_cached_key(|item| total_order(number(item)));
}

/// An integer whose order is that of [`f64::total_cmp`]: the bits, of which those below the sign are turned round where it is
/// negative.
fn total_order(number: f64) -> i64 {
    let bits = number.to_bits().cast_signed();
    bits ^ ((bits >> 63) & i64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_in_their_total_order_and_equal_ones_stay_as_they_were() {
        let numbers = [
            3.0,
            -0.0,
            f64::NAN,
            0.0,
            f64::NEG_INFINITY,
            -3.0,
            1e-310,
            0.0,
            -f64::NAN,
            f64::INFINITY,
            3.0,
        ];
        let mut expected: Vec<(usize, f64)> = numbers.into_iter().enumerate().collect();
        let mut sorted = expected.clone();
        expected.sort_by(|a, b| a.1.total_cmp(&b.1));
        sort_by_number(&mut sorted, |item| item.1);
        let places = |items: &[(usize, f64)]| items.iter().map(|i| i.0).collect::<Vec<_>>();
        assert_eq!(places(&sorted), places(&expected));
        expected.sort_by(|a, b| b.1.total_cmp(&a.1));
        sort_by_number(&mut sorted, |item| -item.1);
        assert_eq!(places(&sorted), places(&expected));
    }
}
