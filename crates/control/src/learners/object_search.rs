//! The training of multi-object search.

use opendr_engine::environment::EnvironmentSpec;
use opendr_engine::learner::Spec;
use opendr_engine::params::Params;
use opendr_engine::{Result, Task};
use opendr_kernels::Compute;
use opendr_rl::prior::{DemonstratedSteps, MakeEnvironment, begin_as_clone};
use opendr_rl::{
    Algorithm as _, BehaviourCloningConfig, Method, Policy, Ppo, PpoConfig, PpoFitParams, PpoMethod,
    RlTrainingParams, Schedule,
};
use opendr_simulation::RegisteredEnvironment as _;
use opendr_simulation::object_search::{FrontierSearch, ObjectsNearer};

/// Training parameters of multi-object search.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct MultiObjectSearchRlFitParams {
    /// Settings of PPO.
    #[param(
        flatten,
        learning_rate = 1e-3,
        learning_rate_schedule = Schedule::Linear,
        n_steps = 256,
        batch_size = 512,
        n_epochs = 4,
        gae_lambda = 0.9
    )]
    pub config: PpoConfig,
    /// Episodes of frontier exploration that prefers seen objects, from which the policy is cloned before the training; 0 begins without.
    #[param(default = 60, range = 0..=1_000_000)]
    pub demonstration_episodes: u64,
    /// Settings of any training in environments.
    #[param(
        flatten,
        total_timesteps = 100_000,
        n_envs = 16,
        num_workers = 2,
        eval_freq = 0,
        n_eval_episodes = 100
    )]
    pub training: RlTrainingParams,
}

/// Seed of the first demonstrated episode, far from those of trainings and evaluations.
const FIRST_SEED: u64 = 1 << 42;
/// Weight of the entropy while the policy is cloned: it still tries what is about as near.
const CLONED_ENTROPY: f32 = 0.1;

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

    fn prepare(
        params: &MultiObjectSearchRlFitParams,
        algorithm: &mut Ppo,
        from_base: bool,
        make: MakeEnvironment<'_>,
    ) -> Result<()> {
        let mut environment = make()?;
        if from_base || environment.spec().id != FrontierSearch::ID || params.demonstration_episodes == 0 {
            return Ok(());
        }
        let seeds = FIRST_SEED..FIRST_SEED + params.demonstration_episodes;
        let steps = DemonstratedSteps::record(&mut ObjectsNearer, &mut *environment, seeds)?;
        let config =
            BehaviourCloningConfig { ent_weight: CLONED_ENTROPY, ..BehaviourCloningConfig::default() };
        begin_as_clone(algorithm, &steps, &config, &Compute::single()).map(drop)
    }

    fn algorithm(
        params: &MultiObjectSearchRlFitParams,
        spec: &EnvironmentSpec,
        compute: Compute,
        base: Option<&Policy>,
    ) -> Result<Ppo> {
        let params = PpoFitParams { config: params.config.clone(), ..PpoFitParams::default() };
        if spec.id != FrontierSearch::ID {
            return PpoMethod::algorithm(&params, spec, compute, base);
        }
        let mut config = params.config;
        if let Some(base) = base {
            config.network = base.network().clone();
            config.norm_obs = base.encoder().normaliser.is_some();
        }
        let ppo = Ppo::new(&config, spec)?.with_compute(compute);
        let mut ppo = ppo.scoring_choices(FrontierSearch::FEATURES)?;
        base.map_or(Ok(()), |base| ppo.set_policy(base))?;
        Ok(ppo)
    }
}
