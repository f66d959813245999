//! Description of an environment.

use super::{Space, TrackingTask};

/// Name, spaces and limits of an environment.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvironmentSpec {
    /// Name and version, as in `CartPole-v1`: every change that affects returns gets a new version.
    pub id: String,
    /// Space of the observations.
    pub observation: Space,
    /// Space of the actions.
    pub action: Space,
    /// Number of steps after which an episode is truncated; `None` for no limit.
    pub max_episode_steps: Option<u32>,
    /// Smallest and largest reward of a step; infinite if unknown.
    pub reward_range: (f64, f64),
    /// Mean return at which the task counts as solved.
    pub reward_threshold: Option<f64>,
    /// The tracking task, if the environment is one.
    pub tracking: Option<TrackingTask>,
}

impl EnvironmentSpec {
    /// Creates a description without limits.
    pub fn new(id: impl Into<String>, observation: Space, action: Space) -> Self {
        Self {
            id: id.into(),
            observation,
            action,
            max_episode_steps: None,
            reward_range: (f64::NEG_INFINITY, f64::INFINITY),
            reward_threshold: None,
            tracking: None,
        }
    }

    /// Sets the time limit.
    #[must_use]
    pub fn with_max_episode_steps(mut self, steps: u32) -> Self {
        self.max_episode_steps = Some(steps);
        self
    }

    /// Sets the range of rewards.
    #[must_use]
    pub fn with_reward_range(mut self, low: f64, high: f64) -> Self {
        self.reward_range = (low, high);
        self
    }

    /// Sets the return at which the task counts as solved.
    #[must_use]
    pub fn with_reward_threshold(mut self, threshold: f64) -> Self {
        self.reward_threshold = Some(threshold);
        self
    }

    /// States the tracking task.
    #[must_use]
    pub fn with_tracking(mut self, task: TrackingTask) -> Self {
        self.tracking = Some(task);
        self
    }
}
