//! Fourier transforms of real samples, two sequences at a time.

use rustfft::algorithm::Radix4;
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftDirection, Length};

use crate::units::real;

/// Memory that transforms work in, kept from one to the next.
#[derive(Debug, Default)]
pub(crate) struct Workspace {
    lines: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
}

/// Transforms of one length, a power of two, without the vectors of one machine or another.
pub(crate) struct Fourier {
    forward: Radix4<f64>,
    inverse: Radix4<f64>,
}

impl std::fmt::Debug for Fourier {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Fourier")
            .field("length", &self.len())
            .finish_non_exhaustive()
    }
}

impl Fourier {
    /// Transforms of as many samples, a power of two.
    pub(crate) fn of(length: usize) -> Self {
        Self {
            forward: Radix4::new(length, FftDirection::Forward),
            inverse: Radix4::new(length, FftDirection::Inverse),
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.forward.len()
    }

    /// All lines of the spectrum of some samples and silence after them.
    pub(crate) fn spectrum(&self, samples: &[f64]) -> Vec<Complex<f64>> {
        let mut lines = Vec::new();
        pair(&mut lines, samples, &[], self.len());
        self.forward.process(&mut lines);
        lines
    }

    /// Two sequences, silence after each, with every line of their spectra times its gain: a convolution around with what the
    /// gains are the spectrum of. That must be of real samples, so that the one stays the real part and the other the imaginary
    /// part.
    pub(crate) fn filtered<'w, G>(
        &self,
        a: &[f64],
        b: &[f64],
        gains: &[G],
        work: &'w mut Workspace,
    ) -> &'w [Complex<f64>]
    where
        G: Copy,
        Complex<f64>: std::ops::Mul<G, Output = Complex<f64>>,
    {
        let Workspace { lines, scratch } = work;
        pair(lines, a, b, self.len());
        let needed = [&self.forward, &self.inverse].map(Fft::get_inplace_scratch_len);
        scratch.resize(needed[0].max(needed[1]), Complex::default());
        self.forward.process_with_scratch(lines, scratch);
        let scale = 1.0 / real(self.len());
        for (line, &gain) in lines.iter_mut().zip(gains) {
            *line = (*line * gain).scale(scale);
        }
        self.inverse.process_with_scratch(lines, scratch);
        lines
    }
}

/// One sequence as the real part and one as the imaginary part, silence after each.
fn pair(both: &mut Vec<Complex<f64>>, a: &[f64], b: &[f64], length: usize) {
    both.clear();
    both.resize(length, Complex::default());
    for (z, &x) in both.iter_mut().zip(a) {
        z.re = x;
    }
    for (z, &x) in both.iter_mut().zip(b) {
        z.im = x;
    }
}
