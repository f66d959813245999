//! The integration tests of this crate, one program: each program more is linked once more.

#![allow(clippy::unwrap_used, clippy::panic)]

mod conformance;
mod corpus;
#[cfg(feature = "depth")]
mod depth_eval;
#[cfg(all(feature = "faces", feature = "training"))]
mod faces;
#[cfg(all(feature = "faces", feature = "pose"))]
mod falls;
#[cfg(all(feature = "detection", feature = "faces", feature = "pose", feature = "test-learner"))]
mod fit;
#[cfg(all(feature = "classification", feature = "training"))]
mod formats;
#[cfg(feature = "hands")]
mod hands;
mod models;
#[cfg(feature = "detection")]
mod optimize;
#[cfg(feature = "panoptic")]
mod panoptic;
#[cfg(feature = "segmentation")]
mod persons;
#[cfg(all(feature = "actions", feature = "detection", feature = "faces", feature = "pose"))]
mod pipelines;
#[cfg(all(feature = "classification", feature = "grasping", feature = "segmentation"))]
mod scenes;
#[cfg(feature = "tracking")]
mod single_object;
#[cfg(feature = "clouds")]
mod space;
#[cfg(feature = "speech")]
mod speech;
#[cfg(feature = "stereo")]
mod stereo;
#[cfg(all(feature = "detection", feature = "segmentation", feature = "tracking"))]
mod tiling;
#[cfg(feature = "tracking")]
mod tracker_eval;
#[cfg(feature = "speech")]
mod whisper;
mod wrong_input;
