//! What persons do: activities in videos, actions by skeletons.
//!
//! Begin with [`skeleton_based_action_recognition::SpatioTemporalGcn`] for skeletons, or [`activity_recognition::X3d`] for videos.

pub mod activity_recognition;
pub mod skeleton_based_action_recognition;
