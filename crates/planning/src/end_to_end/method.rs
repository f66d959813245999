//! The training of end-to-end planning.

use opendr_engine::Result;
use opendr_engine::environment::{Environment, EnvironmentSpec};
use opendr_engine::learner::{Learner as _, Spec};
use opendr_engine::params::Params;
use opendr_kernels::Compute;
use opendr_rl::prior::begin_as_prior;
use opendr_rl::{Algorithm as _, Method, Policy, Ppo, PpoConfig, RlTrainingParams, Schedule};

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
    /// Flights in embedded corridors from which the map learns what is likely in cells that the camera has not observed; 0 disables it, and
    /// unobserved cells are free.
    #[param(default = 600, range = 0..=1_000_000)]
    pub surroundings_flights: u64,
    /// Flights in embedded corridors, each repeated from some of its places with other steps, from which the proposals learn after which
    /// steps flights fail; 0 disables it. It needs surroundings.
    #[param(default = 4000, range = 0..=1_000_000)]
    pub foresight_flights: u64,
    /// Steps of all environments before the actor is trained; only the critic is trained until then.
    #[param(default = 16_384, range = 0..=1_000_000_000)]
    pub critic_warmup: u64,
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

/// Initial log standard deviation of the corrections. The proposals are good, so exploration should stay near them.
const CORRECTION_LOG_STD: f32 = -2.0;

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

    fn wrap(
        _: &EndToEndPlanningFitParams,
        environment: Box<dyn Environment>,
        in_training: bool,
    ) -> Result<Box<dyn Environment>> {
        Ok(match in_training {
            true => Box::new(TrainingRewards(DenseObstacles::new(environment))),
            false => environment,
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
            log_std_init: CORRECTION_LOG_STD,
            actor_starts: params.critic_warmup,
            norm_reward: true,
            seed: params.seed,
            ..PpoConfig::default()
        };
        let mut ppo = Ppo::new(&config, spec)?.with_compute(compute);
        match base {
            Some(base) => ppo.set_policy(base)?,
            None => begin_as_prior(&mut ppo, CORRECTION_LOG_STD)?,
        }
        Ok(ppo)
    }
}
