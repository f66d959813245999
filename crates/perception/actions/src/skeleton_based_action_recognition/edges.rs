//! Edges through which the joints of a frame exchange features.

use super::sizes::{Architecture, BLOCKS_BEFORE_ATTENTION};

/// Edges through which joints exchange features.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Edges {
    /// The bones, each with a learnt factor.
    Scaled,
    /// The bones, and a learnt weight of every pair of joints.
    Extended,
    /// As `Extended`, and weights from the similarity of the joints in the frame.
    Adaptive,
    /// A learnt weight of every pair of joints.
    Learnt,
    /// A learnt weight of every pair of joints, the same in both directions.
    Symmetric,
    /// Weights from the similarity of the joints in the frame.
    Attention,
}

impl Edges {
    /// Returns the edges of a block.
    pub fn of_block(architecture: Architecture, block: usize) -> Self {
        match architecture {
            Architecture::StGcn => Self::Scaled,
            Architecture::TaGcn { .. } | Architecture::PstGcn => Self::Extended,
            Architecture::StBln { symmetric: false } => Self::Learnt,
            Architecture::StBln { symmetric: true } => Self::Symmetric,
            Architecture::AGcn => Self::Adaptive,
            Architecture::STr if block < BLOCKS_BEFORE_ATTENTION => Self::Scaled,
            Architecture::STr => Self::Attention,
        }
    }
}
