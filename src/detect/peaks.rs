//! Local maxima of the evidence.

/// A local maximum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Peak {
    /// Its index.
    pub index: usize,
    /// Its height.
    pub height: f64,
}

/// Least prominence of a peak, as a share of its height: how far it rises above the lowest value between it and any higher
/// one. Smaller maxima are ripples on the slope of that one.
const PROMINENCE: f32 = 0.5;

/// Maxima of at least `lowest` that no higher value is nearer to than `separation` indices and that stand out by half
/// their height, in order.
#[must_use]
pub fn pick(values: &[f32], separation: f64, lowest: f64) -> Vec<Peak> {
    let reach = crate::units::whole(separation).max(1);
    let mut peaks = Vec::new();
    for (i, &height) in values.iter().enumerate() {
        if f64::from(height) < lowest {
            continue;
        }
        let before = &values[i.saturating_sub(reach)..i];
        let after = &values[i + 1..(i + 1 + reach).min(values.len())];
        // Of equals the first is the peak.
        let highest = before.iter().all(|&v| v < height) && after.iter().all(|&v| v <= height);
        if highest && stands_out(values, i) {
            peaks.push(Peak {
                index: i,
                height: f64::from(height),
            });
        }
    }
    peaks
}

/// Whether the values fall to half of this one before they exceed it, on both sides.
fn stands_out(values: &[f32], i: usize) -> bool {
    falls_first(values[..i].iter().rev(), values[i])
        && falls_first(values[i + 1..].iter(), values[i])
}

fn falls_first<'a>(mut side: impl Iterator<Item = &'a f32>, height: f32) -> bool {
    side.find(|&&v| v > height || v <= (1.0 - PROMINENCE) * height)
        .is_none_or(|&v| v <= height)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_highest_of_near_ones_is_a_peak() {
        let values = [0.0, 3.0, 0.0, 4.0, 0.0, 0.0, 0.0, 0.0, 2.5, 2.5, 0.0, 1.0];
        let found: Vec<usize> = pick(&values, 3.0, 2.0).iter().map(|p| p.index).collect();
        assert_eq!(found, [3, 8]);
    }

    #[test]
    fn a_shoulder_is_no_peak() {
        let values = [0.0, 2.0, 5.0, 4.0, 4.5, 8.0, 3.0, 4.5, 0.0];
        let found: Vec<usize> = pick(&values, 1.0, 2.0).iter().map(|p| p.index).collect();
        assert_eq!(found, [5]);
    }
}
