//! Online fine-tuning: a policy goes on learning while it controls, within limits that are checked at every step.
//!
//! An [`OnlineAdapter`] is a controller around a pre-trained network (any [`AdaptablePolicy`]; [`NeuralPolicy`] is one of
//! `opendr-rl`). At every control step it
//! - moves the parameters along the gradient of the network's commands, weighted by a learning signal of the tracking error and its
//!   rate ([`LearningSignal`]: the expert rule of Sarabakha and Kayacan, 2019, or feedback-error learning of Kawato, 1990);
//! - bounds each step and the total distance of the parameters, lets them leak back to the base, and holds the command within a band
//!   around a conventional controller ([`AdaptationParams`]);
//! - freezes while the state estimate is stale, the actuators are saturated or the observation lies outside the [`Envelope`] of the
//!   training data;
//! - compares its running cost with the predicted cost of the frozen base, and rolls back to the last good parameters when it is
//!   worse ([`Monitor`]).
//!
//! Everything that happens is in an [`EventLog`]. The base is never changed.

mod adapter;
mod envelope;
mod events;
mod lineage;
mod monitor;
mod params;
mod policy;
mod preconditioner;
mod signal;
mod step;

pub use adapter::OnlineAdapter;
pub use envelope::Envelope;
pub use events::{Event, EventKind, EventLog, FreezeReason};
pub use lineage::{ADAPTATION, Adaptation};
pub use monitor::{Monitor, MonitorParams, Verdict};
pub use params::AdaptationParams;
pub use policy::{AdaptablePolicy, NeuralPolicy};
pub use preconditioner::Preconditioner;
pub use signal::LearningSignal;
