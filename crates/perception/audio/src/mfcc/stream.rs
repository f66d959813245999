//! Cepstra of a stream of audio.

use opendr_engine::{Error, Result};
use opendr_kernels::FOURIER_FRAMES;

use crate::mfcc::{Edges, Log, Mfcc, Work};

/// State of a stream: less than a window of samples.
#[derive(Debug, Default, Clone)]
pub struct MfccStream {
    /// Samples from the start of the next frame on.
    pending: Vec<f32>,
    /// Number of samples to skip before the next frame, where the hop is longer than the window.
    skip: usize,
}

impl MfccStream {
    /// Resets the stream; the next piece starts a new one.
    pub fn reset(&mut self) {
        self.pending.clear();
        self.skip = 0;
    }
}

impl Mfcc {
    /// Adds a piece of any length and passes the coefficients of each completed frame to `frame`; in total the same as
    /// [`Mfcc::run_into`] of the stream in one piece.
    ///
    /// # Errors
    /// `Unsupported` for options that need the whole recording: padding at its edges, or a range relative to its loudest band.
    pub fn push(&self, stream: &mut MfccStream, piece: &[f32], mut frame: impl FnMut(&[f32])) -> Result<()> {
        let options = self.options();
        if options.edges != Edges::Inside || matches!(options.log, Log::Decibel { range: Some(_), .. }) {
            return Err(Error::unsupported(
                "these MFCC options need the whole recording; for a stream, use Edges::Inside and no decibel range",
            ));
        }
        let left_out = stream.skip.min(piece.len());
        stream.skip -= left_out;
        stream.pending.extend(&piece[left_out..]);
        let Work { frames, bands } = &mut *self.work.take();
        let (count, coefficients) = (options.bands.count, options.coefficients);
        bands.resize(FOURIER_FRAMES * (count + coefficients), 0.0);
        let (bands, cepstra) = bands.split_at_mut(FOURIER_FRAMES * count);
        let mut start = 0;
        loop {
            let mut together = 0;
            while together < FOURIER_FRAMES
                && let Some(samples) = stream.pending.get(start..start + options.window)
            {
                self.spectrum.place(samples.iter().copied(), together, frames);
                start += options.hop;
                together += 1;
            }
            if together == 0 {
                break;
            }
            let (bands, cepstra) = (&mut bands[..together * count], &mut cepstra[..together * coefficients]);
            self.log_bands(frames, 1.0, bands);
            self.cosine.run(bands, cepstra);
            cepstra.chunks_exact(coefficients).for_each(&mut frame);
        }
        stream.skip += start.saturating_sub(stream.pending.len());
        stream.pending.drain(..start.min(stream.pending.len()));
        Ok(())
    }
}
