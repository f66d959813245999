//! Tracking of objects in pictures and in space.
//!
//! Begin with [`object_tracking_2d::ByteTrack`], which links the boxes of any detector, or [`object_tracking_3d::Ab3dmot`] for boxes
//! in space. [`tracking`] holds the filters and the pairing that trackers are made of.

pub mod object_tracking_2d;
pub mod object_tracking_3d;
pub mod tracking;
