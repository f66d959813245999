//! The training of mobile manipulation.

use opendr_engine::environment::{Environment, EnvironmentSpec, ResetOptions};
use opendr_engine::learner::Spec;
use opendr_engine::params::Params;
use opendr_engine::{Result, Task};
use opendr_kernels::Compute;
use opendr_rl::{Method, Policy, Ppo, PpoConfig, PpoFitParams, PpoMethod, RlTrainingParams, Schedule};

use super::WithResetOptions;

/// Training parameters of mobile manipulation. OpenDR trains by SAC; PPO reaches the same in a fraction of the time.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct MobileRlFitParams {
    /// Settings of PPO.
    #[param(
        flatten,
        learning_rate_schedule = Schedule::Linear,
        n_steps = 256,
        batch_size = 512,
        n_epochs = 5,
        norm_obs = true,
        norm_reward = true,
        log_std_init = -1.0
    )]
    pub config: PpoConfig,
    /// Failures of the inverse kinematics after which an episode of the training terminates, as in OpenDR.
    #[param(default = 20, range = 1..=100_000)]
    pub ik_fail_limit: u32,
    /// Standard deviation of the noise on the motion of the base in a step of the training, in metres and radians.
    #[param(default = 0.0, range = 0.0..=0.1)]
    pub base_noise: f64,
    /// Settings of any training in environments.
    #[param(
        flatten,
        total_timesteps = 400_000,
        n_envs = 16,
        num_workers = 2,
        eval_freq = 0,
        n_eval_episodes = 100
    )]
    pub training: RlTrainingParams,
}

/// PPO in `MobileManipReach-v1` and its siblings.
#[derive(Debug, Clone, Copy)]
pub struct MobileRlMethod;

/// Start of the names of the environments whose episodes have the options of [`MobileRlFitParams`].
const FAMILY: &str = "MobileManip";
/// Part of the names of those with a differential drive, and the steps of a training in them.
const DIFF: &str = "-diff-";
const DIFF_TIMESTEPS: u64 = 1_000_000;

impl Method for MobileRlMethod {
    const SPEC: Spec = Spec::new("mobile_rl", Task::ReinforcementLearning).class("MobileRLLearner").about(
        "Mobile manipulation: moves the base so that the arm can follow a planned motion of its gripper.",
    );
    type FitParams = MobileRlFitParams;
    type Algorithm = Ppo;

    fn with_preset(params: &MobileRlFitParams, id: &str) -> MobileRlFitParams {
        let mut chosen = params.clone();
        let default = MobileRlFitParams::default().training.total_timesteps;
        let own = &mut chosen.training;
        if own.preset && own.total_timesteps == default && id.starts_with(FAMILY) && id.contains(DIFF) {
            own.total_timesteps = DIFF_TIMESTEPS;
        }
        chosen
    }

    fn wrap(
        params: &MobileRlFitParams,
        environment: Box<dyn Environment>,
        in_training: bool,
    ) -> Result<Box<dyn Environment>> {
        if !in_training || !environment.spec().id.starts_with(FAMILY) {
            return Ok(environment);
        }
        let options = ResetOptions::from([
            ("ik_fail_limit".to_owned(), i64::from(params.ik_fail_limit).into()),
            ("base_noise".to_owned(), params.base_noise.into()),
        ]);
        Ok(Box::new(WithResetOptions::new(environment, options)))
    }

    fn training(params: &MobileRlFitParams) -> &RlTrainingParams {
        &params.training
    }

    fn algorithm(
        params: &MobileRlFitParams,
        spec: &EnvironmentSpec,
        compute: Compute,
        base: Option<&Policy>,
    ) -> Result<Ppo> {
        let params = PpoFitParams { config: params.config.clone(), ..PpoFitParams::default() };
        PpoMethod::algorithm(&params, spec, compute, base)
    }
}
