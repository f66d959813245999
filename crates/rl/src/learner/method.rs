//! The methods by which policies are trained, as learners have them.

use opendr_engine::environment::{Environment, EnvironmentSpec};
use opendr_engine::learner::Spec;
use opendr_engine::params::Params;
use opendr_engine::{Result, Task};
use opendr_kernels::Compute;

use super::training_params::{RlTrainingParams, over_preset};
use crate::algorithm::Algorithm;
use crate::policy::Policy;
use crate::{Dqn, DqnConfig, Ppo, PpoConfig, Preset, Sac, SacConfig, Td3, Td3Config};

/// A method with its settings.
pub trait Method: Send + Sync + 'static {
    /// The name of its learner.
    const SPEC: Spec;
    /// What a user may set of a training.
    type FitParams: Params;
    /// What learns.
    type Algorithm: Algorithm;

    /// The settings with those that are known to solve the environment called `id`, where the user wants them.
    fn for_environment(params: &Self::FitParams, id: &str) -> Self::FitParams;

    /// An environment as the policy sees it: what the learner makes of observations, and in training of rewards.
    ///
    /// # Errors
    /// `InvalidInput` for an environment that the learner is not for.
    fn seen(
        params: &Self::FitParams,
        environment: Box<dyn Environment>,
        in_training: bool,
    ) -> Result<Box<dyn Environment>> {
        let _ = (params, in_training);
        Ok(environment)
    }

    /// What the container says beside the environment that the policy is for, e.g. the prior that the policy corrects.
    ///
    /// # Errors
    /// Those of finding it.
    fn inputs(params: &Self::FitParams) -> Result<Vec<(&'static str, serde_json::Value)>> {
        let _ = params;
        Ok(Vec::new())
    }

    /// What does not depend on the method.
    fn training(params: &Self::FitParams) -> &RlTrainingParams;

    /// A learner, that begins from the policy `base` where there is one.
    ///
    /// # Errors
    /// As those of the algorithm.
    fn algorithm(
        params: &Self::FitParams,
        spec: &EnvironmentSpec,
        compute: Compute,
        base: Option<&Policy>,
    ) -> Result<Self::Algorithm>;
}

macro_rules! method {
    (
        $(#[$doc:meta])* $method:ident, $(#[$fit_doc:meta])* $fit_params:ident,
        $algorithm:ident($config:ident), $spec:expr, $preset:expr
    ) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy)]
        pub struct $method;

        $(#[$fit_doc])*
        #[derive(Debug, Clone, PartialEq, Params)]
        pub struct $fit_params {
            /// Of the method.
            #[param(flatten)]
            pub config: $config,
            /// Of any training in environments.
            #[param(flatten)]
            pub training: RlTrainingParams,
        }

        impl Method for $method {
            const SPEC: Spec = $spec;
            type FitParams = $fit_params;
            type Algorithm = $algorithm;

            fn for_environment(params: &$fit_params, id: &str) -> $fit_params {
                let preset: fn(&str) -> Option<Preset<$config>> = $preset;
                let Some(Preset { environments, timesteps, config }) =
                    preset(id).filter(|_| params.training.preset)
                else {
                    return params.clone();
                };
                let defaults = RlTrainingParams::default();
                let training =
                    RlTrainingParams { n_envs: environments, total_timesteps: timesteps, ..defaults };
                over_preset(params, &$fit_params { config, training })
            }

            fn training(params: &$fit_params) -> &RlTrainingParams {
                &params.training
            }

            fn algorithm(
                params: &$fit_params,
                spec: &EnvironmentSpec,
                compute: Compute,
                base: Option<&Policy>,
            ) -> Result<$algorithm> {
                let mut config = params.config.clone();
                if let Some(base) = base {
                    config.network = base.config.clone();
                    config.set("norm_obs", base.encoder().normaliser.is_some().into())?;
                }
                let mut algorithm = $algorithm::new(&config, spec)?.with_compute(compute);
                base.map_or(Ok(()), |base| algorithm.set_policy(base))?;
                Ok(algorithm)
            }
        }
    };
}

method! {
    /// PPO.
    PpoMethod,
    /// What a user may set of a training by PPO.
    PpoFitParams,
    Ppo(PpoConfig),
    Spec::new("ppo", Task::ReinforcementLearning)
        .class("PpoLearner")
        .about("Proximal policy optimisation: the method to begin with, for actions of any kind."),
    PpoConfig::preset
}

method! {
    /// SAC.
    SacMethod,
    /// What a user may set of a training by SAC.
    SacFitParams,
    Sac(SacConfig),
    Spec::new("sac", Task::ReinforcementLearning)
        .class("SacLearner")
        .about("Soft actor-critic: few steps for continuous actions, where steps are dear."),
    SacConfig::preset
}

method! {
    /// TD3.
    Td3Method,
    /// What a user may set of a training by TD3.
    Td3FitParams,
    Td3(Td3Config),
    Spec::new("td3", Task::ReinforcementLearning)
        .class("Td3Learner")
        .about("Twin delayed policy gradients: deterministic policies of continuous actions."),
    Td3Config::preset
}

method! {
    /// DQN.
    DqnMethod,
    /// What a user may set of a training by DQN.
    DqnFitParams,
    Dqn(DqnConfig),
    Spec::new("dqn", Task::ReinforcementLearning)
        .class("DqnLearner")
        .about("Deep Q-learning: one choice among few, learnt from steps of the past."),
    DqnConfig::preset
}
