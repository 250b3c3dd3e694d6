//! The level of a recording over time, for a picture in which impacts are moved.

/// Length of a cell in seconds: a third of the shortest flight that is told apart, a pixel at most where it is looked at
/// closely.
const CELL_S: f64 = 5e-4;

/// The greatest size of the samples of one channel in each cell.
#[derive(Debug, Clone, Default)]
pub(crate) struct Peaks {
    /// Samples of a cell.
    cell: usize,
    /// Samples so far.
    heard: usize,
    /// One number for each cell that began.
    pub(crate) values: Vec<f32>,
}

impl Peaks {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "`as` saturates, and rates are small"
    )]
    pub(crate) fn new(sample_rate_hz: f64) -> Self {
        Self {
            cell: ((CELL_S * sample_rate_hz).round() as usize).max(1),
            ..Self::default()
        }
    }

    /// Length of a cell in seconds.
    #[expect(clippy::cast_precision_loss, reason = "a cell has few samples")]
    pub(crate) fn cell_s(&self, sample_rate_hz: f64) -> f64 {
        self.cell as f64 / sample_rate_hz
    }

    /// Takes in the next samples.
    pub(crate) fn hear(&mut self, mut samples: &[f32]) {
        while !samples.is_empty() {
            let filled = self.heard % self.cell;
            let (part, rest) = samples.split_at(samples.len().min(self.cell - filled));
            let peak = part.iter().map(|x| x.abs()).fold(0.0, f32::max);
            match self.values.last_mut().filter(|_| filled > 0) {
                Some(last) => *last = last.max(peak),
                None => self.values.push(peak),
            }
            self.heard += part.len();
            samples = rest;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Peaks;

    #[test]
    fn blocks_of_any_length_give_the_same_peaks() {
        let samples: Vec<f32> = (0..103_u8).map(|i| f32::from(i % 17) - 9.0).collect();
        let by_definition: Vec<f32> = samples
            .chunks(8)
            .map(|cell| cell.iter().map(|x| x.abs()).fold(0.0, f32::max))
            .collect();
        for block in [1, 3, 8, 9, 50, 103] {
            let mut peaks = Peaks::new(16_000.0);
            samples.chunks(block).for_each(|part| peaks.hear(part));
            assert_eq!(peaks.values, by_definition, "blocks of {block}");
        }
    }
}
