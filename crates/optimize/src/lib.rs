//! Smaller and faster models: weights in 16 bits, or everything in 8.
//!
//! [`OptimizeJob`] makes a container of a container with a learner and a data set: it runs the learner, records what
//! it gives its sessions, and takes the ranges of every tensor from that, so that no learner needs a line for it.
//! [`optimize`] does the same with recordings of the caller's own.

mod histogram;
mod integer_graph;
mod learner;
mod optimize;
mod options;
mod plan;
mod quantise;
mod range;
mod report;
mod watched;
mod weights;

pub use learner::OptimizeJob;
pub use optimize::{Judge, Measured, optimize};
pub use options::{Calibration, OptimizeOptions, Precision};
pub use report::{Accuracy, LayerReport, Report};
