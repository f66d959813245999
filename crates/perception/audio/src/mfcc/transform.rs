//! Spectra of frames, and coefficients of bands.

use std::f64::consts::PI;

use opendr_kernels::{Compute, FourierScratch, Isa, Matrix, MatrixMut, Product, RealFourier, Spectrum};

use crate::mfcc::mel_bank::{Frames, MelBank};
use crate::mfcc::options::{CosineScale, Edges, MfccOptions};

/// Window function and Fourier transform of several frames at a time.
pub(super) struct FrameSpectrum {
    fourier: RealFourier,
    window: Vec<f32>,
    /// Offset of the window in the transformed frame.
    begin: usize,
    hop: usize,
    edges: Edges,
    kind: Spectrum,
}

/// Buffers of the frames that are transformed together.
#[derive(Default)]
pub(super) struct FrameWork {
    /// Windowed frames; samples outside the window stay zero.
    samples: Vec<Frames>,
    fourier: FourierScratch,
    /// Magnitude or power of each frequency.
    values: Vec<Frames>,
    /// Sums of each band.
    sums: Vec<Frames>,
}

impl FrameSpectrum {
    pub fn new(options: &MfccOptions) -> Self {
        let MfccOptions { window, hop, fft, edges, spectrum: kind, .. } = *options;
        let hann = |at: usize| 0.5 - 0.5 * (2.0 * PI * at as f64 / window as f64).cos();
        Self {
            fourier: RealFourier::new(fft),
            window: (0..window).map(|at| hann(at) as f32).collect(),
            begin: if edges == Edges::Inside { 0 } else { (fft - window) / 2 },
            hop,
            edges,
            kind,
        }
    }

    /// Writes frame `index` of `samples`, which are not empty, into lane `lane` of `work`.
    pub fn fill(&self, samples: &[f32], index: usize, lane: usize, work: &mut FrameWork) {
        let (size, start) = (self.fourier.size(), index * self.hop);
        let inside = |first: usize| samples.get(first..first + self.window.len());
        let first = match self.edges {
            Edges::Inside => Some(start),
            Edges::Reflected | Edges::Silent => (start + self.begin).checked_sub(size / 2),
        };
        if let Some(frame) = first.and_then(inside) {
            return self.place(frame.iter().copied(), lane, work);
        }
        let sample = |at: usize| {
            let at = (start + self.begin + at) as isize - (size / 2) as isize;
            match usize::try_from(at).ok().and_then(|at| samples.get(at)) {
                Some(sample) => *sample,
                None if self.edges == Edges::Reflected => samples[reflected(at, samples.len())],
                None => 0.0,
            }
        };
        self.place((0..self.window.len()).map(sample), lane, work);
    }

    /// Writes the samples of a frame, as many as the window spans, into lane `lane` of `work`.
    pub fn place(&self, frame: impl Iterator<Item = f32>, lane: usize, work: &mut FrameWork) {
        work.samples.resize(self.fourier.size(), Frames::default());
        let places = work.samples[self.begin..].iter_mut().zip(&self.window);
        places.zip(frame).for_each(|((place, weight), sample)| place[lane] = weight * sample);
    }

    /// Computes the bands' sums of the frames in `work`.
    pub fn band_sums<'w>(&self, bank: &MelBank, work: &'w mut FrameWork) -> &'w [Frames] {
        let FrameWork { samples, fourier, values, sums } = work;
        self.fourier.run(Isa::best(), self.kind, samples, fourier, values);
        bank.sums(values, sums);
        sums
    }
}

/// Returns the index within `count` samples to which `at` is reflected at the first and the last sample, repeatedly.
fn reflected(at: isize, count: usize) -> usize {
    let period = (2 * (count - 1)).max(1);
    let at = at.rem_euclid(period as isize) as usize;
    at.min(period - at).min(count - 1)
}

/// The first coefficients of a DCT-II.
pub(super) struct CosineTransform {
    bands: usize,
    coefficients: usize,
    /// Matrix `[bands, coefficients]`.
    table: Vec<f32>,
    compute: Compute,
}

impl CosineTransform {
    pub fn new(bands: usize, coefficients: usize, scale: CosineScale) -> Self {
        let entry = |index: usize| {
            let (band, coefficient) = (index / coefficients, index % coefficients);
            let size = match (coefficient, scale) {
                (0, CosineScale::Orthonormal) => 1.0,
                _ => 2.0,
            };
            let angle = PI * coefficient as f64 * (2 * band + 1) as f64 / (2 * bands) as f64;
            ((size / bands as f64).sqrt() * angle.cos()) as f32
        };
        let table = (0..bands * coefficients).map(entry).collect();
        Self { bands, coefficients, table, compute: Compute::single() }
    }

    /// Replaces `cepstra`, `[frames, coefficients]`, by the coefficients of `bands`, `[frames, bands]`.
    pub fn run(&self, bands: &[f32], cepstra: &mut [f32]) {
        let frames = bands.len() / self.bands;
        Product::new().run(
            &self.compute,
            Matrix::new(bands, frames, self.bands),
            Matrix::new(&self.table, self.bands, self.coefficients),
            MatrixMut::new(cepstra, frames, self.coefficients),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::reflected;

    /// Expected values of `numpy.pad(range(4), 7, "reflect")`, and of one sample.
    #[test]
    fn reflections_repeat() {
        let places: Vec<usize> = (-7..8).map(|at| reflected(at, 4)).collect();
        assert_eq!(places, [1, 0, 1, 2, 3, 2, 1, 0, 1, 2, 3, 2, 1, 0, 1]);
        assert!((-3..4).all(|at| reflected(at, 1) == 0));
    }
}
