//! How large the network is.

use opendr_engine::{Error, Result};
use opendr_perception_common::frame_features::KINDS;

use super::GraphType;

/// Sizes of the network.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NetworkSizes {
    pub graph: GraphType,
    /// Coordinates of a joint.
    pub coordinates: usize,
    /// Frames of a clip.
    pub frames: usize,
    /// Channels of the blocks.
    pub channels: Vec<usize>,
    /// Frames that a block sees; odd.
    pub kernel: usize,
}

impl NetworkSizes {
    /// Features of a joint.
    pub fn features(&self) -> usize {
        KINDS * self.coordinates
    }

    /// Frames that are left after the blocks, none of which is padded.
    ///
    /// # Errors
    /// `InvalidParam` when none is, there is no block, or the kernel is even.
    pub fn pooled_frames(&self) -> Result<usize> {
        let NetworkSizes { frames, kernel, .. } = *self;
        let blocks = self.channels.len();
        if kernel.is_multiple_of(2) || blocks == 0 {
            return Err(Error::invalid_param(format!(
                "{blocks} blocks over {kernel} frames; give at least one channels, and an odd temporal_kernel"
            )));
        }
        frames.checked_sub(blocks * (kernel - 1)).filter(|left| *left > 0).ok_or_else(|| {
            Error::invalid_param(format!(
                "{blocks} blocks over {kernel} frames each need clips of {} frames, not {frames}; give more frames, fewer \
                 blocks or a smaller temporal_kernel",
                blocks * (kernel - 1) + 1
            ))
        })
    }

    /// Numbers that are kept from one frame to the next.
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
