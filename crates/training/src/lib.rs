//! Training on Burn: the loop of every `fit`, export to ONNX, import of weights.
//!
//! A learner implements [`Objective`]: network, batches, loss, container. [`fit_learner`] does the rest: optimiser and schedule
//! by name, gradient clipping and accumulation, an average of the weights, validation by the task's metric, early stopping,
//! checkpoints that resume bit for bit, and the log. [`export`] writes a network as ONNX, [`weights`] reads safetensors,
//! PyTorch checkpoints and ONNX models into a network, [`layers`] has layers and backbones. Data loading and augmentation are
//! in the crate `opendr-datasets`, the log and checkpoint files in `opendr-runlog`, reinforcement learning in `opendr-rl`.
//!
//! Begin with [`Objective`] and [`fit_network`]; `examples/own_module.rs` trains a module of its own.
//!
//! ```
//! use opendr_training::{Schedule, ScheduleKind, TrainingParams};
//!
//! let params = TrainingParams { lr: 0.1, lr_schedule: ScheduleKind::Cosine, ..Default::default() };
//! let schedule = Schedule::new(&params, 100, 10);
//! assert!(schedule.lr(0) > schedule.lr(50) && schedule.lr(50) > schedule.lr(99));
//! ```

mod any_collate;
mod average;
mod checkpoint;
mod device;
pub mod export;
mod fit_learner;
pub mod fuzzing;
mod gradients;
#[doc(hidden)]
pub mod instances;
mod kept_heap;
pub mod layers;
mod memory;
mod objective;
mod opening;
pub mod operations;
mod optimizer;
mod params;
mod payload;
mod running_statistics;
mod schedule;
mod step_sum;
mod trained_network;
mod training;
mod training_state;
mod traversal;
pub mod weights;

pub use device::training_device;
pub use fit_learner::fit_learner;
pub use objective::{Container, Loss, Objective};
pub use opening::{open_accepted, open_for_training, open_for_validation};
pub use params::{OptimizerKind, ScheduleKind, TrainingParams};
pub use schedule::Schedule;
pub use training::{Score, Validate, fit_network, seeded_device};
