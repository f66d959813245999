//! A policy as a learner.

use std::marker::PhantomData;

use opendr_engine::data::Observation;
use opendr_engine::environment::EnvironmentSource;
use opendr_engine::learner::{FitJob, Learner, LearnerRl, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::RlTarget;
use opendr_engine::{Device, Error, Random, Result, Statistics};
use opendr_kernels::Compute;

use super::method::Method;
use super::observation::numbers_from_observation;
use crate::policy::{ActionMode, Policy, PolicyMemory};
use crate::training::{POLICY_FILE, fit_policy};

/// Parameters of a policy at inference.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct PolicyParams {
    /// Whether the policy takes its most likely actions instead of sampling.
    #[param(default = true, live)]
    pub deterministic: bool,
    /// Seed of sampled actions, at the start of a stream.
    #[param(default = 0)]
    pub seed: u64,
}

/// A policy trained by the method `M`: predicts an element of the action space from an observation.
pub struct PolicyLearner<M> {
    policy: Policy,
    params: PolicyParams,
    compute: Compute,
    method: PhantomData<M>,
}

/// State of one stream: recurrent state and random numbers.
#[derive(Debug, Default)]
pub struct PolicyState {
    memory: PolicyMemory,
    numbers: Vec<f32>,
    random: Option<Random>,
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
        let PolicyState { memory, numbers, random } = state;
        numbers_from_observation(self.policy.observation(), observation, numbers)?;
        target.values.resize(self.policy.head().action_len(), 0.0);
        let acting = match self.params.deterministic {
            true => ActionMode::Deterministic,
            false => ActionMode::Sampled(random.get_or_insert_with(|| Random::new(self.params.seed))),
        };
        self.policy.act(&self.compute, numbers, acting, memory, &mut target.values)
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
        fit_policy::<M>(base, &params.to_map(), fit_params, env, val_env, job)
    }
}
