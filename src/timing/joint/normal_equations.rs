//! Normal equations of the weighted least squares for amplitude and time of one sound.

/// Sums of the weighted least squares for amplitude and time.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct NormalEquations {
    shape_shape: f64,
    shape_slope: f64,
    slope_slope: f64,
    shape_sound: f64,
    slope_sound: f64,
}

impl NormalEquations {
    /// Sums over the samples of a sound.
    pub(super) fn of(sound: &[f64], noise: &[f64], shape: &[f64], slopes: &[f64]) -> Self {
        let mut sums = Self::default();
        for (((x, n), s), d) in sound.iter().zip(noise).zip(shape).zip(slopes) {
            let w = 1.0 / n;
            sums.shape_shape += w * s * s;
            sums.shape_slope += w * s * d;
            sums.slope_slope += w * d * d;
            sums.shape_sound += w * s * x;
            sums.slope_sound += w * d * x;
        }
        sums
    }

    /// Amplitude, time after the present one and its standard error, in samples.
    pub(super) fn solve(&self, amplitude: f64) -> (f64, f64, f64) {
        let determinant = self.shape_shape * self.slope_slope - self.shape_slope.powi(2);
        if determinant <= 0.0 || amplitude <= 0.0 {
            return (amplitude, 0.0, f64::INFINITY);
        }
        let size = (self.slope_slope * self.shape_sound - self.shape_slope * self.slope_sound)
            / determinant;
        let lean = (self.shape_shape * self.slope_sound - self.shape_slope * self.shape_sound)
            / determinant;
        let std = (self.shape_shape / determinant).sqrt() / amplitude;
        (size, -lean / amplitude, std)
    }

    /// Fisher's information on the time for an amplitude of 1, the amplitude being unknown.
    pub(super) fn slope_information(&self) -> f64 {
        self.slope_slope - self.shape_slope.powi(2) / self.shape_shape
    }

    /// An amplitude in standard deviations of the noise.
    pub(super) fn clearness(&self, amplitude: f64) -> f64 {
        amplitude * self.shape_shape.sqrt()
    }

    /// Influence of a sample of the sound on the time, in samples of time, for an amplitude.
    pub(super) fn pull(&self, amplitude: f64, shape: f64, slope: f64, noise: f64) -> f64 {
        let determinant = self.shape_shape * self.slope_slope - self.shape_slope.powi(2);
        if determinant <= 0.0 {
            return 0.0;
        }
        (self.shape_slope * shape - self.shape_shape * slope) / (noise * determinant * amplitude)
    }
}
