//! Sizes of the network.

use opendr_engine::{Error, Result};
use opendr_perception_common::frame_features::FEATURES_PER_COORDINATE;

use super::GraphType;

/// Sizes of the network.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NetworkSizes {
    pub graph: GraphType,
    /// Number of coordinates of a joint.
    pub coordinates: usize,
    /// Number of frames of a clip.
    pub frames: usize,
    /// Output channels of the blocks.
    pub channels: Vec<usize>,
    /// Kernel size in time; odd.
    pub kernel: usize,
}

impl NetworkSizes {
    /// Returns the number of features of a joint.
    pub fn features(&self) -> usize {
        FEATURES_PER_COORDINATE * self.coordinates
    }

    /// Returns the number of frames that remain after the unpadded blocks.
    ///
    /// # Errors
    /// `InvalidParam` when no frame remains, there is no block, or the kernel is even.
    pub fn pooled_frames(&self) -> Result<usize> {
        let NetworkSizes { frames, kernel, .. } = *self;
        let blocks = self.channels.len();
        if kernel.is_multiple_of(2) || blocks == 0 {
            return Err(Error::invalid_param(format!(
                "{blocks} blocks with temporal_kernel = {kernel}; channels needs at least one entry, and temporal_kernel must be odd"
            )));
        }
        frames.checked_sub(blocks * (kernel - 1)).filter(|left| *left > 0).ok_or_else(|| {
            Error::invalid_param(format!(
                "{blocks} blocks with temporal_kernel = {kernel} need clips of {} frames, not {frames}; use more frames, fewer \
                 blocks or a smaller temporal_kernel",
                blocks * (kernel - 1) + 1
            ))
        })
    }

    /// Returns the length of the state vector of one person.
    ///
    /// # Errors
    /// As [`NetworkSizes::pooled_frames`].
    pub fn state(&self) -> Result<usize> {
        let (joints, mut inputs) = (self.graph.joints(), self.features());
        let mut state = 0;
        for (index, channels) in self.channels.iter().enumerate() {
            let held = if index == 0 { 0 } else { self.kernel / 2 };
            state += joints * (channels * (self.kernel - 1) + inputs * held);
            inputs = *channels;
        }
        Ok(state + inputs * (self.pooled_frames()? - 1))
    }
}
