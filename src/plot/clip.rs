//! Lines cut at the edges of a panel.

use super::Axis;

/// The parts of a line through points that lie between the axes, cut where it crosses their ends.
pub(super) fn inside(points: &[(f64, f64)], x: &Axis, y: &Axis) -> Vec<Vec<(f64, f64)>> {
    let places: Vec<(f64, f64)> = points
        .iter()
        .map(|&(px, py)| (x.place(px), y.place(py)))
        .collect();
    let mut parts: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut end = None;
    for pair in places.windows(2) {
        let Some((from, to)) = segment(pair[0], pair[1]) else {
            continue;
        };
        match parts.last_mut() {
            Some(part) if end == Some(from) => part.push(to),
            _ => parts.push(vec![from, to]),
        }
        end = Some(to);
    }
    for place in parts.iter_mut().flatten() {
        *place = (x.value(place.0), y.value(place.1));
    }
    parts
}

/// The part of a segment within the unit square (Liang and Barsky's way); nothing of one that has no place.
fn segment(a: (f64, f64), b: (f64, f64)) -> Option<((f64, f64), (f64, f64))> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    if !(dx.is_finite() && dy.is_finite()) {
        return None;
    }
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for (start, change) in [(a.0, dx), (a.1, dy)] {
        if change == 0.0 {
            if !(0.0..=1.0).contains(&start) {
                return None;
            }
            continue;
        }
        let [low, high] = [-start / change, (1.0 - start) / change];
        first = first.max(low.min(high));
        last = last.min(low.max(high));
    }
    // Kept as they are where nothing is cut, so that neighbouring segments meet exactly.
    let at = |t: f64| match t {
        0.0 => a,
        1.0 => b,
        t => (a.0 + t * dx, a.1 + t * dy),
    };
    (first < last).then(|| (at(first), at(last)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_that_leaves_and_returns_is_two_parts() {
        let axis = Axis::linear("", 0.0, 1.0);
        let points = [(0.2, 0.5), (0.4, 1.5), (0.6, 0.5), (0.7, 0.5)];
        let parts = inside(&points, &axis, &axis);
        assert_eq!(parts.len(), 2);
        assert!((parts[0][1].0 - 0.3).abs() < 1e-12 && (parts[0][1].1 - 1.0).abs() < 1e-12);
        assert_eq!(parts[1].len(), 3);
    }

    #[test]
    fn what_is_outside_or_has_no_place_is_left_out() {
        let linear = Axis::linear("", 0.0, 1.0);
        let logarithmic = Axis::logarithmic("", 0.1, 1.0);
        assert!(inside(&[(0.2, 2.0), (0.4, 3.0)], &linear, &linear).is_empty());
        assert!(inside(&[(0.2, 0.0), (0.4, 0.5)], &linear, &logarithmic).is_empty());
    }
}
