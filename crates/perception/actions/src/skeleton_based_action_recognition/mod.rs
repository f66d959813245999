//! Action recognition from skeletons.
//!
//! [`SpatioTemporalGcn`] classifies clips; [`CoStGcn`] classifies a stream frame by frame with the same weights and equal
//! predictions. [`SkeletonBuffer`] collects the poses of a video as input of both.

#[cfg(feature = "training")]
mod augment;
mod co_st_gcn;
mod graph;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;
mod sizes;
mod skeleton_buffer;
mod spatio_temporal_gcn;

pub use co_st_gcn::{CoStGcn, CoStGcnParams, CoStGcnState};
#[cfg(feature = "training")]
pub use co_st_gcn::{CoStGcnFitParams, co_st_gcn_from};
pub use graph::GraphType;
pub use skeleton_buffer::{SkeletonBuffer, SkeletonBufferOptions};
#[cfg(feature = "training")]
pub use spatio_temporal_gcn::SpatioTemporalGcnFitParams;
pub use spatio_temporal_gcn::{SpatioTemporalGcn, SpatioTemporalGcnParams};

#[cfg(test)]
#[cfg(feature = "training")]
mod tests;
