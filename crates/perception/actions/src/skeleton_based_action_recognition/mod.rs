//! Action recognition from skeletons.
//!
//! [`SpatioTemporalGcn`] classifies clips; [`CoStGcn`] classifies a stream frame by frame with the same weights and equal
//! predictions. [`ProgressiveSpatioTemporalGcn`] classifies clips with a network whose size is found in its training.
//! [`SkeletonBuffer`] collects the poses of a video as input of all.

#[cfg(feature = "training")]
mod augment;
#[cfg(feature = "training")]
mod block;
mod clip_network;
mod co_st_gcn;
#[cfg(feature = "training")]
mod edges;
#[cfg(feature = "training")]
mod frame_selection;
mod graph;
#[cfg(feature = "training")]
mod joint_attention;
mod model_checks;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;
mod persons;
mod progressive_spatio_temporal_gcn;
mod sizes;
mod skeleton_buffer;
mod spatio_temporal_gcn;
#[cfg(feature = "training")]
mod stream_state;

pub use clip_network::SkeletonClipParams;
pub use co_st_gcn::{Backbone, CoStGcn, CoStGcnParams, CoStGcnState};
#[cfg(feature = "training")]
pub use co_st_gcn::{CoStGcnFitParams, co_st_gcn_from};
pub use graph::GraphType;
pub use progressive_spatio_temporal_gcn::{ProgressiveSpatioTemporalGcn, ProgressiveSpatioTemporalGcnParams};
pub use skeleton_buffer::{SkeletonBuffer, SkeletonBufferOptions};
#[cfg(feature = "training")]
pub use spatio_temporal_gcn::SpatioTemporalGcnFitParams;
pub use spatio_temporal_gcn::{Method, SpatioTemporalGcn, SpatioTemporalGcnParams};

#[cfg(test)]
#[cfg(feature = "training")]
mod tests;
