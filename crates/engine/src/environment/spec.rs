//! What is known of an environment before it is used.

use super::Space;

/// Name, spaces and limits of an environment.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvironmentSpec {
    /// Name and version, as in `CartPole-v1`: anything that changes returns gets a new version.
    pub id: String,
    /// What an observation looks like.
    pub observation: Space,
    /// What an action looks like.
    pub action: Space,
    /// After so many steps an episode is truncated; `None` is never.
    pub max_episode_steps: Option<u32>,
    /// Smallest and largest reward of one step; infinite where it is not known.
    pub reward_range: (f64, f64),
    /// The mean return at which the task counts as solved.
    pub reward_threshold: Option<f64>,
}

impl EnvironmentSpec {
    /// A spec without limits.
    pub fn new(id: impl Into<String>, observation: Space, action: Space) -> Self {
        Self {
            id: id.into(),
            observation,
            action,
            max_episode_steps: None,
            reward_range: (f64::NEG_INFINITY, f64::INFINITY),
            reward_threshold: None,
        }
    }

    /// The same with a time limit.
    #[must_use]
    pub fn with_max_episode_steps(mut self, steps: u32) -> Self {
        self.max_episode_steps = Some(steps);
        self
    }

    /// The same with a range of rewards.
    #[must_use]
    pub fn with_reward_range(mut self, low: f64, high: f64) -> Self {
        self.reward_range = (low, high);
        self
    }

    /// The same with a threshold for "solved".
    #[must_use]
    pub fn with_reward_threshold(mut self, threshold: f64) -> Self {
        self.reward_threshold = Some(threshold);
        self
    }
}
