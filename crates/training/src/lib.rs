//! Training on Burn: the loop of every `fit`, export to ONNX, import of weights.
//!
//! A learner says what it trains ([`Objective`]: network, batches, loss, container); [`fit_learner`] does the rest:
//! optimiser and schedule by name, gradient clipping and accumulation, an average of the weights, validation by the
//! task's metric, early stopping, checkpoints that resume bit for bit, and the log.

mod average;
mod checkpoint;
mod device;
pub mod export;
mod fit_learner;
pub mod fuzzing;
mod gradient;
mod kept_heap;
pub mod layers;
mod memory;
mod objective;
mod optimizer;
mod params;
mod schedule;
mod standing;
mod training;
pub mod weights;

pub use device::training_device;
pub use fit_learner::{fit_learner, open_for_training};
pub use objective::{Container, Loss, Objective};
pub use optimizer::OptimizerKind;
pub use params::TrainingParams;
pub use schedule::{Schedule, ScheduleKind};
pub use training::{Score, Validate, begin, fit_network};
