//! Model optimisation: INT8 quantisation with calibration, and FP16 weights.
//!
//! Contents:
//! * [`OptimizeJob`]: optimises the container of a learner with a data set. It runs the learner, records the inputs
//!   of its sessions, and derives the range of every tensor from them; learners need no code for it. Begin here.
//! * [`optimize`](optimize()): the same with recordings that the caller provides.
//! * [`OptimizeOptions`]: precision, calibration, and layers that stay in floats; [`Report`]: size, accuracy and loss
//!   per layer.
//!
//! Recordings come from `opendr_inference::recording`, graph rewriting from `opendr-onnx`, metrics from
//! `opendr-evaluation`.
//!
//! ```
//! use opendr_optimize::{Calibration, OptimizeOptions, Precision};
//!
//! let options = OptimizeOptions { calibration: Calibration::Entropy, ..OptimizeOptions::default() };
//! assert_eq!(options.precision, Precision::Int8);
//! ```

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
pub use optimize::{MeasureFn, MetricValue, optimize};
pub use options::{Calibration, OptimizeOptions, Precision};
pub use report::{Accuracy, LayerReport, Report};
