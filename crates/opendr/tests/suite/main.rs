//! The integration tests of this crate, one program: each program more is linked once more.

#![allow(clippy::unwrap_used, clippy::panic)]

mod conformance;
mod corpus;
#[cfg(feature = "training")]
mod faces;
mod falls;
#[cfg(feature = "test-learner")]
mod fit;
mod hands;
mod models;
mod optimize;
mod panoptic;
mod persons;
mod pipelines;
mod scenes;
mod single_object;
mod space;
mod speech;
mod stereo;
mod tiling;
mod tracker_eval;
mod whisper;
mod wrong_input;
