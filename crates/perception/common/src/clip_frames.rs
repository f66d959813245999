//! Network inputs from the frames of a video.

use opendr_engine::data::{Image, Layout, PixelFormat, Pixels, Video};
use opendr_engine::{Error, Result};
use opendr_vision::Preprocess;

/// Pre-processing of video frames: resizing to a square without keeping the aspect ratio, normalisation with Kinetics' mean
/// and standard deviation.
#[derive(Debug, Clone)]
pub struct ClipFrames {
    preprocess: Preprocess,
    frames: usize,
}

/// Mean and standard deviation of levels of 0..=255.
const MEAN: f32 = 0.45 * 255.0;
const DEVIATION: f32 = 0.225 * 255.0;

impl ClipFrames {
    /// Creates the pre-processing for clips of `frames` frames of `side` x `side` pixels.
    pub fn new(side: usize, frames: usize) -> Self {
        Self { preprocess: Preprocess::new(side, side).normalise([MEAN; 3], [DEVIATION; 3]), frames }
    }

    /// Returns the number of values per frame.
    pub fn frame_len(&self) -> usize {
        self.preprocess.len()
    }

    /// Replaces `input` by one image, `[3, side, side]`.
    ///
    /// # Errors
    /// As the pre-processing of images.
    pub fn image_into(&self, image: &Image, input: &mut Vec<f32>) -> Result<()> {
        input.resize(self.frame_len(), 0.0);
        self.preprocess.run_into(image.view(), input).map(drop)
    }

    /// Replaces `input` by frames of a clip, `[frames, 3, side, side]`, evenly spaced from the first to the last. Frames
    /// repeat where the clip is shorter.
    ///
    /// # Errors
    /// `InvalidInput` when the clip does not have three channels, or a level is not finite.
    pub fn clip_into(&self, video: &Video, input: &mut Vec<f32>) -> Result<()> {
        let [channels, given, height, width] = video.shape();
        if channels != 3 {
            return Err(Error::invalid_input(format!(
                "the clip has {channels} channels instead of 3; give an RGB clip"
            )));
        }
        if let Some(at) = video.as_slice().iter().position(|level| !level.is_finite()) {
            return Err(Error::invalid_input(format!(
                "level {at} of the clip is {}; give levels of 0 to 1",
                video.as_slice()[at]
            )));
        }
        // The planes of each channel are consecutive, so the clip is one tall image, and a frame is a crop of it.
        let levels = Pixels::F32(video.array().clone().into_data());
        let strip = Image::new(levels, width, given * height, PixelFormat::Rgb, Layout::Chw)?;
        input.resize(self.frames * self.frame_len(), 0.0);
        for (index, part) in input.chunks_exact_mut(self.frame_len()).enumerate() {
            let last = (self.frames - 1).max(1);
            let from = (index * (given - 1) + last / 2) / last;
            if let Some(frame) = strip.view().crop(0, from * height, width, height) {
                self.preprocess.run_into(frame, part)?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_evenly_spaced() {
        // Frame `at` has the level `at / 10` everywhere.
        let levels: Vec<f32> = (0..3).flat_map(|_| (0..10).flat_map(|at| [at as f32 / 10.0; 6])).collect();
        let video = Video::new(levels, [3, 10, 2, 3]).unwrap();
        for (frames, wanted) in [(4, vec![0, 3, 6, 9]), (1, vec![0]), (2, vec![0, 9])] {
            let (taken, mut input) = (ClipFrames::new(32, frames), Vec::new());
            taken.clip_into(&video, &mut input).unwrap();
            let level = |at: &usize| (*at as f32 / 10.0 - 0.45) / 0.225;
            for (part, at) in input.chunks_exact(taken.frame_len()).zip(&wanted) {
                assert!(part.iter().all(|number| (number - level(at)).abs() < 1e-4), "{frames} {at}");
            }
        }
        let mut input = Vec::new();
        let grey = Video::new(vec![0.5; 4], [1, 1, 2, 2]).unwrap();
        assert!(ClipFrames::new(32, 2).clip_into(&grey, &mut input).is_err());
        let broken = Video::new(vec![f32::NAN; 3], [3, 1, 1, 1]).unwrap();
        assert!(ClipFrames::new(32, 2).clip_into(&broken, &mut input).is_err());
    }
}
