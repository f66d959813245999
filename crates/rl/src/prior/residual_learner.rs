//! A prior and the policy that corrects it, as one learner.

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

use super::prior_record::PriorRecord;
use super::residual_controller::inner_spaces;
use super::{
    Prior, PriorId, Residual, ResidualConfig, ResidualController, Shield, ShieldParams, begin_as_prior,
};
use crate::learner::{Method, PolicyParams, RlTrainingParams, numbers_from_observation, over_preset};
use crate::policy::Policy;
use crate::training::{POLICY_FILE, fit_policy};
use crate::{Ppo, PpoConfig, Preset, Sac, SacConfig, Td3, Td3Config};

/// A method that trains corrections of a prior.
pub trait ResidualMethod: Method {}

/// A policy on top of a prior, trained by the method `M`: from observations of the environment to its actions. The container names the
/// prior with its version; loading fails where this program has no such prior.
pub struct ResidualLearner<M> {
    policy: Arc<Policy>,
    prior: Prior,
    alpha: f32,
    observation: Space,
    actions: usize,
    params: PolicyParams,
    method: PhantomData<M>,
}

/// The state of one stream: an episode of prior and policy.
#[derive(Default)]
pub struct ResidualState {
    controller: Option<ResidualController<Arc<Policy>>>,
    shield: Option<Shield>,
    numbers: Vec<f32>,
}

impl<M> ResidualLearner<M> {
    /// Returns the prior that the policy corrects.
    pub fn prior(&self) -> &PriorId {
        self.prior.id()
    }

    /// Returns the policy of corrections.
    pub fn policy(&self) -> &Policy {
        &self.policy
    }
}

impl<M: ResidualMethod> Learner for ResidualLearner<M> {
    const SPEC: Spec = M::SPEC;
    type Params = PolicyParams;
    type Input<'a> = &'a Observation;
    type Target = RlTarget;
    type State = ResidualState;

    fn load(model: &Model, params: PolicyParams, device: Device) -> Result<Self> {
        if !matches!(device, Device::Auto | Device::Cpu) {
            return Err(Error::device(format!(
                "policies of {} act on the processor, not on {device}; give \"cpu\" or \"auto\"",
                M::SPEC.class
            )));
        }
        let policy = Policy::from_bytes(&model.file(POLICY_FILE)?)?;
        let record = PriorRecord::of(model)?.ok_or_else(|| {
            Error::format(format!("the container names no prior; train the policy by {}", M::SPEC.class))
        })?;
        let prior = Prior::find(&record.id)?;
        let (observation, action) = inner_spaces(&policy)?;
        own_shield(&params.shield, &prior, observation)?;
        let (observation, actions) = (observation.clone(), action.len());
        let (policy, alpha, method) = (Arc::new(policy), record.alpha, PhantomData);
        Ok(Self { policy, prior, alpha, observation, actions, params, method })
    }

    fn params(&self) -> &PolicyParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut PolicyParams {
        &mut self.params
    }

    fn infer_into(&self, state: &mut ResidualState, seen: &Observation, target: &mut RlTarget) -> Result<()> {
        let ResidualState { controller, shield, numbers } = state;
        numbers_from_observation(&self.observation, seen, numbers)?;
        let controller = match controller {
            Some(controller) => controller,
            None => {
                let prior = self.prior.controller(&self.observation)?;
                let made = ResidualController::new(Arc::clone(&self.policy), prior, self.alpha)?;
                let controller = controller.insert(made);
                controller.reset();
                controller
            }
        };
        controller.set_sampled((!self.params.deterministic).then_some(self.params.seed));
        target.values.resize(self.actions, 0.0);
        controller.act(numbers, &mut target.values)?;
        if self.params.shield.shield.is_some() && shield.is_none() {
            *shield = own_shield(&self.params.shield, &self.prior, &self.observation)?;
        }
        let Some(shield) = shield else { return Ok(()) };
        if shield.arbitrate(numbers, &mut target.values)? {
            controller.executed(&target.values);
        }
        Ok(())
    }
}

/// Returns the shield under which the prior itself acts instead of a correction.
pub(super) fn own_shield(params: &ShieldParams, prior: &Prior, space: &Space) -> Result<Option<Shield>> {
    let fallback = prior.controller(space)?;
    let rule = params.own_rule()?.map(|rule| rule.predicate(space)).transpose()?;
    Ok(rule.map(|predicate| Shield::new(predicate, fallback)))
}

impl<M: ResidualMethod> LearnerRl for ResidualLearner<M> {
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

macro_rules! residual_method {
    (
        $(#[$doc:meta])* $method:ident, $fit_params:ident, $learner:ident,
        $algorithm:ident($config:ident), $settings:ident, $spec:expr
    ) => {
        $(#[$doc])*
        #[derive(Debug, Clone, Copy)]
        pub struct $method;

        /// Parameters of a training of corrections.
        #[derive(Debug, Clone, PartialEq, Params)]
        pub struct $fit_params {
            /// Of the prior and its corrections.
            #[param(flatten)]
            pub residual: ResidualConfig,
            /// Of the method.
            #[param(flatten)]
            pub config: $config,
            /// Of any training in environments.
            #[param(flatten)]
            pub training: RlTrainingParams,
        }

        $(#[$doc])*
        pub type $learner = ResidualLearner<$method>;

        impl ResidualMethod for $method {}

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
                over_preset(params, &$fit_params { residual: ResidualConfig::default(), config, training })
            }

            fn wrap(
                params: &$fit_params,
                environment: Box<dyn Environment>,
                in_training: bool,
            ) -> Result<Box<dyn Environment>> {
                let schedule = params.residual.schedule(params.training.n_envs)?;
                let schedule = if in_training { schedule } else { schedule.finished() };
                let prior = params.residual.prior()?.controller(&environment.spec().observation)?;
                Ok(Box::new(Residual::new(environment, prior, schedule)?))
            }

            fn inputs(params: &$fit_params) -> Result<Vec<(&'static str, Value)>> {
                let id = params.residual.prior()?.id().clone();
                Ok(vec![PriorRecord { id, alpha: params.residual.alpha }.input()?])
            }

            fn shield(params: &$fit_params, shield: &ShieldParams, space: &Space) -> Result<Option<Shield>> {
                shield.own_rule()?.map(|rule| params.residual.shield(&rule, space)).transpose()
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
                let config = params.residual.$settings(&params.config);
                let mut algorithm = $algorithm::new(&config, spec)?.with_compute(compute);
                match base {
                    Some(base) => crate::Algorithm::set_policy(&mut algorithm, base)?,
                    None => begin_as_prior(&mut algorithm, params.residual.correction_log_std)?,
                }
                Ok(algorithm)
            }
        }
    };
}

residual_method! {
    /// Corrections of a prior, trained by PPO.
    ResidualPpoMethod, ResidualPpoFitParams, ResidualPpoLearner, Ppo(PpoConfig), ppo,
    Spec::new("residual_ppo", Task::ReinforcementLearning)
        .class("ResidualPpoLearner")
        .about("A prior controller with corrections that PPO trains.")
}

residual_method! {
    /// Corrections of a prior, trained by SAC.
    ResidualSacMethod, ResidualSacFitParams, ResidualSacLearner, Sac(SacConfig), sac,
    Spec::new("residual_sac", Task::ReinforcementLearning)
        .class("ResidualSacLearner")
        .about("A prior controller with corrections that SAC trains.")
}

residual_method! {
    /// Corrections of a prior, trained by TD3.
    ResidualTd3Method, ResidualTd3FitParams, ResidualTd3Learner, Td3(Td3Config), td3,
    Spec::new("residual_td3", Task::ReinforcementLearning)
        .class("ResidualTd3Learner")
        .about("A prior controller with corrections that TD3 trains.")
}
