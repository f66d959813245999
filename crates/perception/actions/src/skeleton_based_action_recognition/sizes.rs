//! Sizes and architecture of the network.

use opendr_engine::{Error, Result};
use opendr_perception_common::frame_features::FEATURES_PER_COORDINATE;

use super::GraphType;

/// Network architecture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Architecture {
    /// Spatial-temporal graph convolutions (Yan et al., 2018).
    StGcn,
    /// Temporal attention-augmented graph convolutions (Heidari and Iosifidis, 2020): after two graph convolutions, only the
    /// `subframes` frames with the highest attention are processed.
    TaGcn { subframes: usize },
    /// Spatio-temporal bilinear network (Heidari and Iosifidis, 2020).
    StBln { symmetric: bool },
    /// Progressive spatio-temporal graph convolutions (Heidari and Iosifidis, 2020).
    PstGcn,
    /// Adaptive graph convolutions (Shi et al., 2019).
    AGcn,
    /// Spatial transformer (Plizzari et al., 2021): self-attention among the joints of a frame, from the fourth block on.
    STr,
}

/// Number of blocks before the selection of frames; they do not convolve through time.
pub(super) const BLOCKS_BEFORE_SELECTION: usize = 2;
/// Number of graph convolutions before the blocks with self-attention.
pub(super) const BLOCKS_BEFORE_ATTENTION: usize = 3;
/// Number of heads of the self-attention.
pub(super) const HEADS: usize = 8;
/// Output channels per feature of queries and keys.
pub(super) const CHANNELS_PER_QUERY: usize = 4;

/// Sizes of the network.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NetworkSizes {
    pub architecture: Architecture,
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

    /// Returns whether a block convolves through time.
    pub fn is_temporal(&self, block: usize) -> bool {
        !matches!(self.architecture, Architecture::TaGcn { .. }) || block >= BLOCKS_BEFORE_SELECTION
    }

    /// Returns the number of frames that remain after the unpadded blocks.
    ///
    /// # Errors
    /// `InvalidParam` when no frame remains, there is no block, the kernel is even, or a size contradicts the architecture.
    pub fn pooled_frames(&self) -> Result<usize> {
        let NetworkSizes { frames, kernel, .. } = *self;
        let count = self.channels.len();
        if kernel.is_multiple_of(2) || count == 0 {
            return Err(Error::invalid_param(format!(
                "{count} blocks with temporal_kernel = {kernel}; channels needs at least one entry, and temporal_kernel must be odd"
            )));
        }
        self.check_architecture()?;
        let (frames, what) = match self.architecture {
            Architecture::TaGcn { subframes } => (subframes, "num_subframes"),
            _ => (frames, "frames"),
        };
        let blocks = (0..count).filter(|block| self.is_temporal(*block)).count();
        frames.checked_sub(blocks * (kernel - 1)).filter(|left| *left > 0).ok_or_else(|| {
            Error::invalid_param(format!(
                "{blocks} blocks with temporal_kernel = {kernel} need clips of {} frames, not {frames}; use more {what}, fewer \
                 blocks or a smaller temporal_kernel",
                blocks * (kernel - 1) + 1
            ))
        })
    }

    fn check_architecture(&self) -> Result<()> {
        let (frames, count) = (self.frames, self.channels.len());
        match self.architecture {
            Architecture::TaGcn { subframes } if subframes > frames => Err(Error::invalid_param(format!(
                "num_subframes = {subframes}, but clips have num_frames = {frames}; give at most {frames}"
            ))),
            Architecture::TaGcn { .. } if count <= BLOCKS_BEFORE_SELECTION => {
                Err(Error::invalid_param(format!(
                    "channels has {count} entries, but tagcn has {BLOCKS_BEFORE_SELECTION} graph convolutions before the selection of \
                 frames; give more than {BLOCKS_BEFORE_SELECTION}"
                )))
            }
            Architecture::STr if count <= BLOCKS_BEFORE_ATTENTION => Err(Error::invalid_param(format!(
                "channels has {count} entries, but costr has self-attention from block {} on; give more, or choose costgcn",
                BLOCKS_BEFORE_ATTENTION + 1
            ))),
            Architecture::STr => {
                let unit = HEADS * CHANNELS_PER_QUERY;
                let odd = self
                    .channels
                    .iter()
                    .skip(BLOCKS_BEFORE_ATTENTION)
                    .find(|width| !width.is_multiple_of(unit));
                odd.map_or(Ok(()), |width| {
                    Err(Error::invalid_param(format!(
                        "channels contains {width}, but the self-attention of costr has {HEADS} heads; from block {} on, give \
                         multiples of {unit}",
                        BLOCKS_BEFORE_ATTENTION + 1
                    )))
                })
            }
            _ => Ok(()),
        }
    }

    /// Returns the length of the state vector of one person, of a network all of whose blocks convolve through time.
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
