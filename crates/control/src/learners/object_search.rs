//! The training of multi-object search.

use opendr_engine::environment::EnvironmentSpec;
use opendr_engine::learner::Spec;
use opendr_engine::params::Params;
use opendr_engine::{Result, Task};
use opendr_kernels::Compute;
use opendr_rl::{Method, Policy, Ppo, PpoConfig, PpoFitParams, PpoMethod, RlTrainingParams};

/// Training parameters of multi-object search.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct MultiObjectSearchRlFitParams {
    /// Settings of PPO.
    #[param(
        flatten,
        n_steps = 128,
        batch_size = 256,
        n_epochs = 4,
        gamma = 0.99,
        ent_coef = 0.005,
        norm_obs = true
    )]
    pub config: PpoConfig,
    /// Settings of any training in environments.
    #[param(
        flatten,
        total_timesteps = 300_000,
        n_envs = 16,
        num_workers = 2,
        eval_freq = 0,
        n_eval_episodes = 100
    )]
    pub training: RlTrainingParams,
}

/// PPO in `ObjectSearch2D-frontier-v1`, whose actions choose among the frontiers of the map. It also trains in
/// `ObjectSearch2D-v1`, whose actions are OpenDR's speed and turn rate.
#[derive(Debug, Clone, Copy)]
pub struct MultiObjectSearchRlMethod;

impl Method for MultiObjectSearchRlMethod {
    const SPEC: Spec = Spec::new("multi_object_search_rl", Task::ReinforcementLearning)
        .class("MultiObjectSearchRLLearner")
        .about("Multi-object search: chooses where a robot drives next to find objects in a flat.");
    type FitParams = MultiObjectSearchRlFitParams;
    type Algorithm = Ppo;

    fn with_preset(params: &MultiObjectSearchRlFitParams, _: &str) -> MultiObjectSearchRlFitParams {
        params.clone()
    }

    fn training(params: &MultiObjectSearchRlFitParams) -> &RlTrainingParams {
        &params.training
    }

    fn algorithm(
        params: &MultiObjectSearchRlFitParams,
        spec: &EnvironmentSpec,
        compute: Compute,
        base: Option<&Policy>,
    ) -> Result<Ppo> {
        let params = PpoFitParams { config: params.config.clone(), ..PpoFitParams::default() };
        PpoMethod::algorithm(&params, spec, compute, base)
    }
}
