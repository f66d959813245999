//! Sizes of the networks.

use opendr_engine::Error;
use opendr_engine::Result;

opendr_engine::choices! {
    /// Size of X3D: frames of a clip, side of a frame, depth.
    pub enum Backbone {
        /// 13 frames of 160 pixels.
        S = "s",
        /// 4 frames of 160 pixels.
        Xs = "xs",
        /// 16 frames of 224 pixels.
        M = "m",
        /// 16 frames of 312 pixels, and twice as many blocks.
        L = "l",
    }
}

/// Sizes of a network.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sizes {
    /// Number of frames of a clip.
    pub frames: usize,
    /// Side of a frame in pixels.
    pub side: usize,
    /// Factor on the number of channels.
    pub width: f64,
    /// Factor on the number of blocks per stage, which is 1, 2, 5 and 3.
    pub depth: f64,
}

impl Sizes {
    /// Returns the sizes of `backbone` with the given values in place of its own.
    ///
    /// # Errors
    /// `InvalidParam` for frames below 32 pixels, clips without a frame, or a network that is too large.
    pub fn new(
        backbone: Backbone,
        frames: Option<usize>,
        side: Option<usize>,
        width: f64,
        depth: Option<f64>,
    ) -> Result<Self> {
        let (usual_frames, usual_side, usual_depth) = match backbone {
            Backbone::Xs => (4, 160, 2.2),
            Backbone::S => (13, 160, 2.2),
            Backbone::M => (16, 224, 2.2),
            Backbone::L => (16, 312, 5.0),
        };
        let sizes = Self {
            frames: frames.unwrap_or(usual_frames),
            side: side.unwrap_or(usual_side),
            width,
            depth: depth.unwrap_or(usual_depth),
        };
        if sizes.side < 32 || sizes.frames == 0 {
            return Err(Error::invalid_param(format!(
                "clips of {} frames of {} pixels are too small; at least 1 frame of 32 pixels is required",
                sizes.frames, sizes.side
            )));
        }
        Ok(sizes)
    }

    /// Returns the scaled number of channels, a multiple of eight.
    #[cfg(feature = "training")]
    pub fn channels(&self, channels: usize) -> usize {
        ((channels as f64 * self.width / 8.0).round() as usize).max(1) * 8
    }

    /// Returns the number of blocks of a stage, 0 to 3.
    #[cfg(feature = "training")]
    pub fn blocks(&self, stage: usize) -> usize {
        let usual = [1.0, 2.0, 5.0, 3.0].get(stage).copied().unwrap_or(1.0);
        ((usual * self.depth).ceil() as usize).max(1)
    }
}

#[cfg(test)]
#[cfg(feature = "training")]
mod tests {
    use super::*;

    #[test]
    fn blocks_and_channels_are_those_of_the_paper() {
        let sizes = Sizes::new(Backbone::S, None, None, 1.0, None).unwrap();
        assert_eq!([0, 1, 2, 3].map(|stage| sizes.blocks(stage)), [3, 5, 11, 7]);
        assert_eq!([24, 48, 96, 192].map(|channels| sizes.channels(channels)), [24, 48, 96, 192]);
        let large = Sizes::new(Backbone::L, None, None, 1.0, None).unwrap();
        assert_eq!(([0, 1, 2, 3].map(|stage| large.blocks(stage)), large.side), ([5, 10, 25, 15], 312));
        assert!(Sizes::new(Backbone::Xs, None, Some(16), 1.0, None).is_err());
    }
}
