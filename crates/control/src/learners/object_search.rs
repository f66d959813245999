//! The training of multi-object search.

use opendr_engine::environment::{EnvironmentSpec, Space};
use opendr_engine::learner::Spec;
use opendr_engine::params::Params;
use opendr_engine::{Result, Task};
use opendr_kernels::Compute;
use opendr_rl::{Algorithm as _, Method, Policy, Ppo, PpoConfig, PpoFitParams, PpoMethod, RlTrainingParams, Schedule};

/// Training parameters of multi-object search.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct MultiObjectSearchRlFitParams {
    /// Settings of PPO.
    #[param(
        flatten,
        n_steps = 128,
        batch_size = 256,
        n_epochs = 4,
        gamma = 0.998,
        ent_coef = 0.003,
        learning_rate_schedule = Schedule::Linear,
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
        let mut ppo = PpoMethod::algorithm(&params, spec, compute, base)?;
        if let (None, Space::Discrete { n, .. }) = (base, &spec.action) {
            let mut policy = ppo.policy().clone();
            prefer_first(&mut policy, *n as usize);
            ppo.set_policy(&policy)?;
        }
        Ok(ppo)
    }
}

/// Lets a policy over `choices` begin with the first ones as the most likely, each by a factor of e before the next. In the frontier
/// environment the first choice is the nearest one: the training begins at frontier exploration.
fn prefer_first(policy: &mut Policy, choices: usize) {
    let layer = policy.last_layer();
    // The biases are the last parameters of a layer.
    let biases = policy.parameters_mut()[layer].iter_mut().rev().take(choices).rev();
    biases.enumerate().for_each(|(choice, bias)| *bias = -(choice as f32));
}
