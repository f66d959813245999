//! A policy as a learner.

use std::marker::PhantomData;

use opendr_engine::data::Observation;
use opendr_engine::environment::EnvironmentSource;
use opendr_engine::learner::{FitJob, Learner, LearnerRl, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params as _;
use opendr_engine::target::RlTarget;
use opendr_engine::{Device, Error, Random, Result, Statistics};
use opendr_kernels::Compute;

use super::method::Method;
use super::observation::numbers_from_observation;
use super::policy_params::PolicyParams;
use crate::policy::{ActionMode, Policy, PolicyMemory};
use crate::prior::Shield;
use crate::training::{POLICY_FILE, fit_policy};

/// A policy trained by the method `M`: predicts an element of the action space from an observation.
pub struct PolicyLearner<M> {
    policy: Policy,
    params: PolicyParams,
    compute: Compute,
    method: PhantomData<M>,
}

/// State of one stream: recurrent state and random numbers.
#[derive(Default)]
pub struct PolicyState {
    memory: PolicyMemory,
    numbers: Vec<f32>,
    random: Option<Random>,
    shield: Option<Shield>,
}

impl<M: Method> PolicyLearner<M> {
    /// Returns the policy.
    pub fn policy(&self) -> &Policy {
        &self.policy
    }
}

impl<M: Method> Learner for PolicyLearner<M> {
    const SPEC: Spec = M::SPEC;
    type Params = PolicyParams;
    type Input<'a> = &'a Observation;
    type Target = RlTarget;
    type State = PolicyState;

    fn load(model: &Model, params: PolicyParams, device: Device) -> Result<Self> {
        if !matches!(device, Device::Auto | Device::Cpu) {
            return Err(Error::device(format!(
                "policies of {} run on the CPU, not on {device}; set the device to \"cpu\" or \"auto\"",
                M::SPEC.class
            )));
        }
        let policy = Policy::from_bytes(&model.file(POLICY_FILE)?)?;
        params.shield.shield(policy.observation())?;
        Ok(Self { policy, params, compute: Compute::single(), method: PhantomData })
    }

    fn params(&self) -> &PolicyParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut PolicyParams {
        &mut self.params
    }

    fn infer_into(
        &self,
        state: &mut PolicyState,
        observation: &Observation,
        target: &mut RlTarget,
    ) -> Result<()> {
        let PolicyState { memory, numbers, random, shield } = state;
        numbers_from_observation(self.policy.observation(), observation, numbers)?;
        target.values.resize(self.policy.head().action_len(), 0.0);
        let acting = match self.params.deterministic {
            true => ActionMode::Deterministic,
            false => ActionMode::Sampled(random.get_or_insert_with(|| Random::new(self.params.seed))),
        };
        self.policy.act(&self.compute, numbers, acting, memory, &mut target.values)?;
        if self.params.shield.shield.is_some() && shield.is_none() {
            *shield = self.params.shield.shield(self.policy.observation())?;
        }
        shield.as_mut().map_or(Ok(()), |shield| shield.arbitrate(numbers, &mut target.values).map(drop))
    }
}

impl<M: Method> LearnerRl for PolicyLearner<M> {
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
