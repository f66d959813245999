//! Online fine-tuning: a policy goes on learning while it controls, within limits that are checked at every step.
//!
//! An [`OnlineAdapter`] is a controller around a pre-trained network (any [`AdaptablePolicy`]; [`NeuralPolicy`] is one of
//! `opendr-rl`) in an environment that states a [`TrackingTask`](opendr_engine::environment::TrackingTask). At every control step it
//! - estimates which change of the last layer would have made the observed velocity follow the reference ([`ReferenceFeatures`]: a
//!   constant for loads, and functions of the reference; a Kalman filter for each axis), and makes that change;
//! - bounds each step and the total distance of the weights, lets them leak back to the base, and holds the command within a band
//!   around a conventional controller ([`AdaptationParams`]);
//! - freezes while the state estimate is stale, the actuators are saturated or the observation lies outside the [`Envelope`] of the
//!   training data, where the conventional controller acts;
//! - compares its running cost with the predicted cost of the frozen base, and rolls back to the last good weights when it is
//!   worse ([`Monitor`]).
//!
//! Everything that happens is in an [`EventLog`]. The base is never changed.

mod adapter;
mod calibration;
mod envelope;
mod estimator;
mod events;
mod features;
mod lineage;
mod monitor;
mod params;
mod phase;
mod policy;
mod requirements;
mod response;

pub use adapter::OnlineAdapter;
pub use calibration::Calibration;
pub use envelope::Envelope;
pub use events::{Event, EventKind, EventLog, FreezeReason};
pub use features::ReferenceFeatures;
pub use lineage::{ADAPTATION, Adaptation};
pub use monitor::{Monitor, MonitorParams, Verdict};
pub use params::AdaptationParams;
pub use policy::{AdaptablePolicy, NeuralPolicy};
pub use requirements::{tracking_bounds, tracking_task};
