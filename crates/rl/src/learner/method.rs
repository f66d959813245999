//! The training methods of policy learners.

use opendr_engine::environment::{Environment, EnvironmentSpec, Space};
use opendr_engine::learner::Spec;
use opendr_engine::params::Params;
use opendr_engine::{Result, Task};
use opendr_kernels::Compute;

use super::training_params::{RlTrainingParams, over_preset};
use crate::algorithm::Algorithm;
use crate::policy::Policy;
use crate::prior::{
    ClonedDemonstrations, Demonstrating, MakeEnvironment, ReplayedDemonstrations, Shield, ShieldParams,
};
use crate::{Dqn, DqnConfig, Ppo, PpoConfig, Preset, Sac, SacConfig, Td3, Td3Config};

/// A training algorithm with the parameters of its learner.
pub trait Method: Send + Sync + 'static {
    /// Name, task and description of its learner.
    const SPEC: Spec;
    /// Training parameters.
    type FitParams: Params;
    /// Type of the algorithm.
    type Algorithm: Algorithm;

    /// Returns the parameters with the preset of the environment `id` filled in, if `params` enables presets.
    fn with_preset(params: &Self::FitParams, id: &str) -> Self::FitParams;

    /// Wraps an environment as the policy expects it: observations always, rewards only if `in_training`.
    ///
    /// # Errors
    /// `InvalidInput` for an environment that the learner does not support.
    fn wrap(
        params: &Self::FitParams,
        environment: Box<dyn Environment>,
        in_training: bool,
    ) -> Result<Box<dyn Environment>> {
        let _ = (params, in_training);
        Ok(environment)
    }

    /// Returns entries for the inputs of the container's manifest, e.g. the prior that the policy corrects.
    ///
    /// # Errors
    /// `NotFound` for a prior that does not exist.
    fn inputs(params: &Self::FitParams) -> Result<Vec<(&'static str, serde_json::Value)>> {
        let _ = params;
        Ok(Vec::new())
    }

    /// Returns the shield of an environment with observations of `space`; none where `shield` disables it.
    ///
    /// # Errors
    /// `InvalidParam` for a shield that the policy does not support; as [`ShieldParams::shield`].
    fn shield(params: &Self::FitParams, shield: &ShieldParams, space: &Space) -> Result<Option<Shield>> {
        let _ = params;
        shield.shield(space)
    }

    /// Prepares the algorithm before the training, e.g. by demonstrations in an environment that `make` creates. `from_base` states
    /// whether it starts from a policy.
    ///
    /// # Errors
    /// As [`Demonstrating::prepare`].
    fn prepare(
        params: &Self::FitParams,
        algorithm: &mut Self::Algorithm,
        from_base: bool,
        make: MakeEnvironment<'_>,
    ) -> Result<()> {
        let _ = (params, algorithm, from_base, make);
        Ok(())
    }

    /// Returns the parameters that do not depend on the method.
    fn training(params: &Self::FitParams) -> &RlTrainingParams;

    /// Creates the algorithm; it starts from the policy `base` if given.
    ///
    /// # Errors
    /// The errors of the algorithm's constructor.
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
        $algorithm:ident($config:ident), $spec:expr, $preset:expr $(, $demonstrations:ident)?
    ) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy)]
        pub struct $method;

        $(#[$fit_doc])*
        #[derive(Debug, Clone, PartialEq, Params)]
        pub struct $fit_params {
            /// Settings of the method.
            #[param(flatten)]
            pub config: $config,
            $(
                /// Settings of demonstrations.
                #[param(flatten)]
                pub demonstrations: $demonstrations,
            )?
            /// Settings of any training in environments.
            #[param(flatten)]
            pub training: RlTrainingParams,
        }

        impl Method for $method {
            const SPEC: Spec = $spec;
            type FitParams = $fit_params;
            type Algorithm = $algorithm;

            fn with_preset(params: &$fit_params, id: &str) -> $fit_params {
                let preset: fn(&str) -> Option<Preset<$config>> = $preset;
                let Some(Preset { environments, timesteps, config }) =
                    preset(id).filter(|_| params.training.preset)
                else {
                    return params.clone();
                };
                let defaults = RlTrainingParams::default();
                let training =
                    RlTrainingParams { n_envs: environments, total_timesteps: timesteps, ..defaults };
                let preset = $fit_params {
                    config,
                    $(demonstrations: $demonstrations::default(),)?
                    training,
                };
                over_preset(params, &preset)
            }

            $(
                fn prepare(
                    params: &$fit_params,
                    algorithm: &mut $algorithm,
                    from_base: bool,
                    make: MakeEnvironment<'_>,
                ) -> Result<()> {
                    let demonstrations: &$demonstrations = &params.demonstrations;
                    demonstrations.prepare(algorithm, from_base, make)
                }
            )?

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
    /// Proximal policy optimisation.
    PpoMethod,
    /// Training parameters of PPO.
    PpoFitParams,
    Ppo(PpoConfig),
    Spec::new("ppo", Task::ReinforcementLearning)
        .class("PpoLearner")
        .about("Proximal policy optimisation: a robust first choice, for discrete and continuous actions."),
    PpoConfig::preset,
    ClonedDemonstrations
}

method! {
    /// Soft actor-critic.
    SacMethod,
    /// Training parameters of SAC.
    SacFitParams,
    Sac(SacConfig),
    Spec::new("sac", Task::ReinforcementLearning)
        .class("SacLearner")
        .about("Soft actor-critic: sample-efficient, for continuous actions and environments with expensive steps."),
    SacConfig::preset,
    ReplayedDemonstrations
}

method! {
    /// Twin delayed deep deterministic policy gradient.
    Td3Method,
    /// Training parameters of TD3.
    Td3FitParams,
    Td3(Td3Config),
    Spec::new("td3", Task::ReinforcementLearning)
        .class("Td3Learner")
        .about("Twin delayed deep deterministic policy gradient: deterministic policies for continuous actions."),
    Td3Config::preset,
    ReplayedDemonstrations
}

method! {
    /// Deep Q-learning.
    DqnMethod,
    /// Training parameters of DQN.
    DqnFitParams,
    Dqn(DqnConfig),
    Spec::new("dqn", Task::ReinforcementLearning)
        .class("DqnLearner")
        .about("Deep Q-learning: discrete actions, trained from a replay buffer."),
    DqnConfig::preset
}
