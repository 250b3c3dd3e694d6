//! Root mean squares, shares and a slope with its error. What does not exist is `None`.

use crate::units::real;

/// √mean(x²).
pub(super) fn root_mean_square(values: &[f64]) -> Option<f64> {
    let sum: f64 = values.iter().map(|x| x * x).sum();
    (!values.is_empty()).then(|| (sum / real(values.len())).sqrt())
}

/// A share of a count; none of nothing.
pub(super) fn share(part: usize, whole: usize) -> Option<f64> {
    (whole > 0).then(|| real(part) / real(whole))
}

/// Least-squares slope of groups of points with a common slope and an offset for each group, and its standard error.
///
/// # Formula
/// With x and y taken from the means of their group: `b = Σxy/Σx²`, `s² = Σ(y − bx)²/((N − G − 1)·Σx²)` for N points in
/// G groups.
pub(super) fn common_slope(groups: &[Vec<(f64, f64)>]) -> Option<(f64, f64)> {
    let mut centred = Vec::new();
    let mut used = 0;
    for group in groups.iter().filter(|g| g.len() > 1) {
        let count = real(group.len());
        let mean = |of: fn(&(f64, f64)) -> f64| group.iter().map(of).sum::<f64>() / count;
        let (x, y) = (mean(|p| p.0), mean(|p| p.1));
        centred.extend(group.iter().map(|p| (p.0 - x, p.1 - y)));
        used += 1;
    }
    let sum = |of: fn(&(f64, f64)) -> f64| centred.iter().map(of).sum::<f64>();
    let (xx, xy) = (sum(|p| p.0 * p.0), sum(|p| p.0 * p.1));
    let free = centred.len().checked_sub(used + 1).filter(|&n| n > 0)?;
    if xx <= 0.0 {
        return None;
    }
    let slope = xy / xx;
    let left: f64 = centred.iter().map(|(x, y)| (y - slope * x).powi(2)).sum();
    Some((slope, (left / real(free) / xx).sqrt()))
}
