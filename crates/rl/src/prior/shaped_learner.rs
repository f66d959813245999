//! A policy and the prior that follows its commands, as one learner.

use std::marker::PhantomData;
use std::sync::Arc;

use opendr_engine::data::Observation;
use opendr_engine::environment::{Controller as _, Environment, EnvironmentSource, EnvironmentSpec, Space};
use opendr_engine::learner::{FitJob, Learner, LearnerRl, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::RlTarget;
use opendr_engine::{Device, Error, Result, Statistics, Task};
use opendr_kernels::Compute;
use serde_json::Value;

use super::residual_learner::own_shield;
use super::shaping_config::CommandRecord;
use super::{
    Commanded, CommandedController as _, CommandingPolicy, Prior, PriorId, ShapingConfig, Shield,
    ShieldParams, begin_as_prior,
};
use crate::learner::{Method, PolicyParams, RlTrainingParams, numbers_from_observation, over_preset};
use crate::policy::Policy;
use crate::training::{POLICY_FILE, fit_policy};
use crate::{Ppo, PpoConfig, Preset, Sac, SacConfig};

/// A method that trains commands to a prior.
pub trait ShapedMethod: Method {}

/// A policy whose actions are commands that a prior follows (action shaping), trained by the method `M`: from observations of the
/// environment to its actions. The container names the prior with its version; loading fails where this program has no such prior.
pub struct ShapedLearner<M> {
    policy: Arc<Policy>,
    prior: Prior,
    hold: u32,
    actions: usize,
    params: PolicyParams,
    method: PhantomData<M>,
}

/// State of one stream: an episode of policy and controller.
#[derive(Default)]
pub struct ShapedState {
    controller: Option<CommandingPolicy<Arc<Policy>>>,
    shield: Option<Shield>,
    numbers: Vec<f32>,
}

impl<M> ShapedLearner<M> {
    /// Returns name and version of the prior that follows the commands.
    pub fn prior(&self) -> &PriorId {
        self.prior.id()
    }

    /// Returns the policy, whose actions are commands.
    pub fn policy(&self) -> &Policy {
        &self.policy
    }
}

impl<M: ShapedMethod> Learner for ShapedLearner<M> {
    const SPEC: Spec = M::SPEC;
    type Params = PolicyParams;
    type Input<'a> = &'a Observation;
    type Target = RlTarget;
    type State = ShapedState;

    fn load(model: &Model, params: PolicyParams, device: Device) -> Result<Self> {
        if !matches!(device, Device::Auto | Device::Cpu) {
            return Err(Error::device(format!(
                "policies of {} run on the CPU, not on {device}; set the device to \"cpu\" or \"auto\"",
                M::SPEC.class
            )));
        }
        let policy = Arc::new(Policy::from_bytes(&model.file(POLICY_FILE)?)?);
        let CommandRecord { id, hold } = CommandRecord::of(model)?.ok_or_else(|| {
            Error::format(format!(
                "the container names no commanded prior; train the policy by {}",
                M::SPEC.class
            ))
        })?;
        let prior = Prior::find(&id)?;
        let controller = prior.commanded(policy.observation())?;
        let actions = controller.actions();
        CommandingPolicy::new(Arc::clone(&policy), controller, hold)?;
        own_shield(&params.shield, &prior, policy.observation())?;
        Ok(Self { policy, prior, hold, actions, params, method: PhantomData })
    }

    fn params(&self) -> &PolicyParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut PolicyParams {
        &mut self.params
    }

    fn infer_into(&self, state: &mut ShapedState, seen: &Observation, target: &mut RlTarget) -> Result<()> {
        let ShapedState { controller, shield, numbers } = state;
        let space = self.policy.observation();
        numbers_from_observation(space, seen, numbers)?;
        let controller = match controller {
            Some(controller) => controller,
            None => {
                let prior = self.prior.commanded(space)?;
                let made = CommandingPolicy::new(Arc::clone(&self.policy), prior, self.hold)?;
                let controller = controller.insert(made);
                controller.reset();
                controller
            }
        };
        controller.set_sampled((!self.params.deterministic).then_some(self.params.seed));
        target.values.resize(self.actions, 0.0);
        controller.act(numbers, &mut target.values)?;
        if self.params.shield.shield.is_some() && shield.is_none() {
            *shield = own_shield(&self.params.shield, &self.prior, space)?;
        }
        shield.as_mut().map_or(Ok(()), |shield| shield.arbitrate(numbers, &mut target.values).map(drop))
    }
}

impl<M: ShapedMethod> LearnerRl for ShapedLearner<M> {
    type FitParams = M::FitParams;

    fn fit(
        base: Option<&Model>,
        params: &PolicyParams,
        fit_params: &M::FitParams,
        env: &dyn EnvironmentSource,
        val_env: Option<&dyn EnvironmentSource>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        fit_policy::<M>(base, &params.to_map(), &params.shield, fit_params, env, val_env, job)
    }
}

/// Refuses a shield in training: it would replace commands, not the actions that follow them.
fn no_shield(shield: &ShieldParams) -> Result<Option<Shield>> {
    match &shield.shield {
        None => shield.own_rule().map(|_| None),
        Some(rule) => Err(Error::invalid_param(format!(
            "shield is {rule}, but a policy of commands trains without a shield; give it to eval and infer instead"
        ))),
    }
}

macro_rules! shaped_method {
    (
        $(#[$doc:meta])* $method:ident, $fit_params:ident, $learner:ident,
        $algorithm:ident($config:ident), $prepare:expr, $spec:expr
    ) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy)]
        pub struct $method;

        /// Parameters of a training of commands.
        #[derive(Debug, Clone, PartialEq, Params)]
        pub struct $fit_params {
            /// Of the prior and its commands.
            #[param(flatten)]
            pub shaping: ShapingConfig,
            /// Of the method.
            #[param(flatten)]
            pub config: $config,
            /// Of any training in environments.
            #[param(flatten)]
            pub training: RlTrainingParams,
        }

        $(#[$doc])*
        pub type $learner = ShapedLearner<$method>;

        impl ShapedMethod for $method {}

        impl Method for $method {
            const SPEC: Spec = $spec;
            type FitParams = $fit_params;
            type Algorithm = $algorithm;

            fn with_preset(params: &$fit_params, id: &str) -> $fit_params {
                let Some(Preset { environments, timesteps, config }) =
                    $config::preset(id).filter(|_| params.training.preset)
                else {
                    return params.clone();
                };
                let defaults = RlTrainingParams::default();
                let training =
                    RlTrainingParams { n_envs: environments, total_timesteps: timesteps, ..defaults };
                over_preset(params, &$fit_params { shaping: ShapingConfig::default(), config, training })
            }

            fn wrap(
                params: &$fit_params,
                environment: Box<dyn Environment>,
                _: bool,
            ) -> Result<Box<dyn Environment>> {
                let controller = params.shaping.controller(&environment.spec().observation)?;
                Ok(Box::new(Commanded::new(environment, controller, params.shaping.hold)?))
            }

            fn inputs(params: &$fit_params) -> Result<Vec<(&'static str, Value)>> {
                let id = Prior::newest(&params.shaping.prior)?.id().clone();
                Ok(vec![CommandRecord { id, hold: params.shaping.hold }.input()?])
            }

            fn shield(_: &$fit_params, shield: &ShieldParams, _: &Space) -> Result<Option<Shield>> {
                no_shield(shield)
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
                let prepare: fn(&$fit_params) -> $config = $prepare;
                let mut algorithm = $algorithm::new(&prepare(params), spec)?.with_compute(compute);
                match base {
                    Some(base) => crate::Algorithm::set_policy(&mut algorithm, base)?,
                    None => begin_as_prior(&mut algorithm, params.shaping.command_log_std)?,
                }
                Ok(algorithm)
            }
        }
    };
}

shaped_method! {
    /// Commands to a prior, trained by PPO.
    ShapedPpoMethod, ShapedPpoFitParams, ShapedPpoLearner, Ppo(PpoConfig),
    |params| PpoConfig { log_std_init: params.shaping.command_log_std, ..params.config.clone() },
    Spec::new("shaped_ppo", Task::ReinforcementLearning)
        .class("ShapedPpoLearner")
        .about("A prior controller that follows commands of a policy that PPO trains.")
}

shaped_method! {
    /// Commands to a prior, trained by SAC.
    ShapedSacMethod, ShapedSacFitParams, ShapedSacLearner, Sac(SacConfig),
    |params| {
        let mut config = params.config.clone();
        config.off_policy.starts_with_policy = true;
        config
    },
    Spec::new("shaped_sac", Task::ReinforcementLearning)
        .class("ShapedSacLearner")
        .about("A prior controller that follows commands of a policy that SAC trains.")
}
