//! Parameters of online adaptation.

use opendr_engine::params::Params;

use super::LearningSignal;
use super::monitor::MonitorParams;

/// Parameters of an [`OnlineAdapter`](super::OnlineAdapter). Defaults fit a position loop of about 1 Hz that is called at 100 Hz,
/// with errors in metres and commands in m/s^2.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct AdaptationParams {
    /// What the parameters learn from.
    #[param(default = LearningSignal::ReferenceModel)]
    pub signal: LearningSignal,
    /// Change of the command per second and unit of the signal.
    #[param(default = 3.0, range = 0.0..=1e4, log)]
    pub rate: f32,
    /// Weight of the error's rate in the signal.
    #[param(default = 0.6, range = 0.0..=100.0, unit = "s")]
    pub rate_weight: f32,
    /// Rate at which the reference model follows the observed velocity.
    #[param(default = 6.0, range = 0.01..=1000.0, unit = "1/s")]
    pub observer: f32,
    /// Magnitude at which the expert rule saturates, in units of the error.
    #[param(default = 0.3, range = 1e-6..=1e6, log)]
    pub scale: f32,
    /// Signals up to this magnitude are noise and teach nothing.
    #[param(default = 0.01, range = 0.0..=1e6)]
    pub dead_zone: f32,
    /// Time constant of the filter of the signal against noise.
    #[param(default = 0.05, range = 0.0..=10.0, unit = "s")]
    pub filter: f32,
    /// Time from a command to its effect on the error: the parameters of the command of then are changed.
    #[param(default = 0.3, range = 0.0..=2.0, unit = "s")]
    pub delay: f32,
    /// Share of the distance from the base that is given back each second.
    #[param(default = 0.005, range = 0.0..=100.0)]
    pub leak: f32,
    /// Largest distance that the parameters move in one step (Euclidean norm).
    #[param(default = 0.05, range = 0.0..=1e6)]
    pub step_limit: f32,
    /// Largest distance of the parameters from the base (Euclidean norm).
    #[param(default = 10.0, range = 0.0..=1e6)]
    pub radius: f32,
    /// Largest distance of a command from the conventional controller's.
    #[param(default = 5.0, range = 0.0..=1e6)]
    pub band: f32,
    /// Age of a state estimate from which it is stale.
    #[param(default = 0.06, range = 0.0..=100.0, unit = "s")]
    pub max_age: f32,
    /// Steps are taken along the gradient at an error of 0: what is learned is a function of the reference. Along the gradient at
    /// the observed error the signal, which contains that error, would raise the feedback gains without end.
    #[param(default = true)]
    pub reference_only: bool,
    /// Only the last layer is adapted.
    #[param(default = false)]
    pub last_layer_only: bool,
    /// Time between two calls.
    #[param(default = 0.01, range = 1e-6..=10.0, unit = "s")]
    pub period: f32,
    /// Parameters of the monitor.
    #[param(flatten)]
    pub monitor: MonitorParams,
}
