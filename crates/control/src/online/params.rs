//! Parameters of online adaptation.

use opendr_engine::params::Params;

use super::monitor::MonitorParams;

/// Parameters of an [`OnlineAdapter`](super::OnlineAdapter). Defaults fit a position loop of about 1 Hz, with errors in metres and
/// commands in m/s^2.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct AdaptationParams {
    /// Rate at which the reference model follows the observed velocity.
    #[param(default = 10.0, range = 0.01..=1000.0, unit = "1/s")]
    pub observer: f32,
    /// Deviation of the lacking acceleration that counts as noise; larger values adapt more slowly.
    #[param(default = 4.0, range = 1e-6..=1e6, log, unit = "m/s^2")]
    pub noise: f32,
    /// Deviation of constant loads.
    #[param(default = 3.0, range = 0.0..=1e6, unit = "m/s^2")]
    pub load: f32,
    /// Time in which loads change.
    #[param(default = 5.0, range = 0.1..=1e6, log, unit = "s")]
    pub load_time: f32,
    /// Deviation of each function of the reference.
    #[param(default = 3.0, range = 0.0..=1e6, unit = "m/s^2")]
    pub feature: f32,
    /// Time in which these functions change.
    #[param(default = 100.0, range = 0.1..=1e6, log, unit = "s")]
    pub feature_time: f32,
    /// Largest innovation that is learned from; a larger one is cut.
    #[param(default = 3.0, range = 0.0..=1e6, unit = "m/s^2")]
    pub innovation_limit: f32,
    /// Share of the weights that is given back each second.
    #[param(default = 0.005, range = 0.0..=100.0)]
    pub leak: f32,
    /// Largest change of the weights in one step (Euclidean norm).
    #[param(default = 0.5, range = 0.0..=1e6)]
    pub step_limit: f32,
    /// Largest norm of the weights: they are 0 for the base.
    #[param(default = 12.0, range = 0.0..=1e6)]
    pub radius: f32,
    /// Largest distance of a command from the conventional controller's.
    #[param(default = 5.0, range = 0.0..=1e6)]
    pub band: f32,
    /// Age of a state estimate from which it is stale.
    #[param(default = 0.06, range = 0.0..=100.0, unit = "s")]
    pub max_age: f32,
    /// Time for which learning pauses after a freeze, until its effects have passed.
    #[param(default = 0.5, range = 0.0..=100.0, unit = "s")]
    pub settle: f32,
    /// Parameters of the monitor.
    #[param(flatten)]
    pub monitor: MonitorParams,
}
