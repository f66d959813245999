//! Activity recognition in videos and action recognition of skeletons.
//!
//! [`activity_recognition`] classifies videos with [`X3d`](activity_recognition::X3d), clip by clip, and
//! [`CoX3d`](activity_recognition::CoX3d), frame by frame. [`skeleton_based_action_recognition`] classifies skeleton sequences with
//! [`SpatioTemporalGcn`](skeleton_based_action_recognition::SpatioTemporalGcn) and
//! [`CoStGcn`](skeleton_based_action_recognition::CoStGcn); its [`SkeletonBuffer`](skeleton_based_action_recognition::SkeletonBuffer)
//! collects the poses of a video into such sequences. The feature `training` adds `fit`. The poses come from the crate
//! `opendr-pose`, the metrics from `opendr-metrics`.
//!
//! Begin with `SpatioTemporalGcn` for skeletons or `X3d` for videos.
//!
//! ```
//! use opendr_actions::activity_recognition::{X3d, X3dParams};
//! use opendr_engine::Device;
//! use opendr_engine::learner::Handle;
//!
//! let learner = Handle::<X3d>::new(X3dParams::default(), Device::Cpu)?;
//! // After `load`, `infer` returns the `Category` of a `Video`.
//! assert!(!learner.is_ready());
//! # Ok::<(), opendr_engine::Error>(())
//! ```

pub mod activity_recognition;
pub mod skeleton_based_action_recognition;
