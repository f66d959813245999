//! Options of a search.

use std::time::Duration;

use opendr_engine::Device;
use opendr_engine::params::ParamMap;

/// Options of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct TuneOptions {
    /// Parameters to search, of the training or of the learner, as `NAME`, `NAME=LOW..HIGH` or `NAME=A,B,C`.
    pub search: Vec<String>,
    /// Fixed parameters of the training.
    pub fit_params: ParamMap,
    /// Fixed parameters of the learner.
    pub params: ParamMap,
    /// Total number of configurations, including those of earlier calls.
    pub trials: usize,
    /// Number of seeds of each configuration that completes.
    pub seeds: usize,
    /// Steps of a complete training.
    pub steps: u64,
    /// Steps between two evaluations.
    pub interval: u64,
    /// Pruner: `"asha"`, `"median"`, `"hyperband"` or `"none"`.
    pub pruner: String,
    /// Number of trials that run in parallel.
    pub jobs: usize,
    /// Time after which no trial starts.
    pub timeout: Option<Duration>,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Device of the trainings.
    pub device: Device,
}
