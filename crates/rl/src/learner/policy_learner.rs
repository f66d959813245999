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
use crate::policy::{Acting, Policy, PolicyMemory};
use crate::training::{POLICY, fit_policy};

/// What a user may set of a policy that acts.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct PolicyParams {
    /// Whether it takes its most likely actions, else some by chance.
    #[param(default = true, live)]
    pub deterministic: bool,
    /// What fixes those by chance, from the beginning of a stream on.
    #[param(default = 0)]
    pub seed: u64,
}

/// A policy that was trained by the method `M`: from observations to elements of its action space.
pub struct PolicyLearner<M> {
    policy: Policy,
    params: PolicyParams,
    compute: Compute,
    method: PhantomData<M>,
}

/// What one stream of a policy remembers.
#[derive(Debug, Default)]
pub struct PolicyState {
    memory: PolicyMemory,
    numbers: Vec<f32>,
    random: Option<Random>,
}

impl<M: Method> PolicyLearner<M> {
    /// The policy.
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
                "policies of {} act on the processor, not on {device}; give \"cpu\" or \"auto\"",
                M::SPEC.class
            )));
        }
        let policy = Policy::from_bytes(&model.file(POLICY)?)?;
        Ok(Self { policy, params, compute: Compute::single(), method: PhantomData })
    }

    fn params(&self) -> &PolicyParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut PolicyParams {
        &mut self.params
    }

    fn infer_into(&self, state: &mut PolicyState, seen: &Observation, target: &mut RlTarget) -> Result<()> {
        let PolicyState { memory, numbers, random } = state;
        numbers_from_observation(self.policy.observation(), seen, numbers)?;
        target.values.resize(self.policy.head().action_len(), 0.0);
        let acting = match self.params.deterministic {
            true => Acting::Deterministic,
            false => Acting::Sampled(random.get_or_insert_with(|| Random::new(self.params.seed))),
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
