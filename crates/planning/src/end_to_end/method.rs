//! The training of end-to-end planning.

use opendr_engine::environment::{Environment, EnvironmentSource, EnvironmentSpec};
use opendr_engine::learner::{FitJob, Learner as _, LearnerRl, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::{Result, Statistics};
use opendr_kernels::Compute;
use opendr_rl::{
    Algorithm as _, Method, Policy, PolicyParams, Ppo, PpoConfig, RlTrainingParams, Schedule, fit_policy,
};
use opendr_simulation::uav_corridor::FlightMemoryWrapper;

use super::{DenseObstacles, EndToEndPlanningRl, TrainingRewards};

/// Parameters of the training, with OpenDR's names, and its defaults unless stated otherwise.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct EndToEndPlanningFitParams {
    /// Initial learning rate of Adam; it decreases linearly to zero.
    /// With OpenDR's values of this and the next two parameters (3e-4, 1024, 64) noise moves the policy away from the
    /// proposals of the planner.
    #[param(default = 1e-4, range = 0.0..=1.0, log)]
    pub lr: f32,
    /// Steps of all environments together between two updates.
    #[param(default = 8192, range = 1..=1_000_000, log)]
    pub n_steps: usize,
    /// Minibatch size in steps.
    #[param(default = 1024, range = 1..=1_000_000, log)]
    pub batch_size: usize,
    /// Seed of all random numbers.
    #[param(default = 0)]
    pub seed: u64,
    /// Parameters of every training in environments.
    #[param(
        flatten,
        total_timesteps = 300_000,
        n_envs = 8,
        num_workers = 2,
        eval_freq = 0,
        n_eval_episodes = 100
    )]
    pub training: RlTrainingParams,
}

/// PPO on the memory of a flight and the proposals of the planner, with rewards that favour arrival.
#[derive(Debug, Clone, Copy)]
pub struct PpoInCorridors;

impl Method for PpoInCorridors {
    const SPEC: Spec = EndToEndPlanningRl::SPEC;
    type FitParams = EndToEndPlanningFitParams;
    type Algorithm = Ppo;

    fn with_preset(params: &EndToEndPlanningFitParams, _: &str) -> EndToEndPlanningFitParams {
        params.clone()
    }

    fn wrap(environment: Box<dyn Environment>, in_training: bool) -> Result<Box<dyn Environment>> {
        Ok(match in_training {
            true => Box::new(TrainingRewards(FlightMemoryWrapper::new(DenseObstacles::new(environment))?)),
            false => Box::new(FlightMemoryWrapper::new(environment)?),
        })
    }

    fn training(params: &EndToEndPlanningFitParams) -> &RlTrainingParams {
        &params.training
    }

    fn algorithm(
        params: &EndToEndPlanningFitParams,
        spec: &EnvironmentSpec,
        compute: Compute,
        base: Option<&Policy>,
    ) -> Result<Ppo> {
        let config = PpoConfig {
            learning_rate: params.lr,
            learning_rate_schedule: Schedule::Linear,
            n_steps: (params.n_steps / params.training.n_envs).max(1),
            batch_size: params.batch_size,
            // The proposals are good, so exploration should stay near them.
            log_std_init: -2.0,
            norm_reward: true,
            seed: params.seed,
            ..PpoConfig::default()
        };
        let mut ppo = Ppo::new(&config, spec)?.with_compute(compute);
        base.map_or(Ok(()), |base| ppo.set_policy(base))?;
        Ok(ppo)
    }
}

impl LearnerRl for EndToEndPlanningRl {
    type FitParams = EndToEndPlanningFitParams;

    fn fit(
        base: Option<&Model>,
        params: &PolicyParams,
        fit_params: &EndToEndPlanningFitParams,
        env: &dyn EnvironmentSource,
        val_env: Option<&dyn EnvironmentSource>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        fit_policy::<PpoInCorridors>(base, &params.to_map(), fit_params, env, val_env, job)
    }
}
