//! A policy of action chunks as a learner.

use opendr_engine::data::Observation;
use opendr_engine::dataset::DatasetRef;
use opendr_engine::environment::EnvironmentSource;
use opendr_engine::learner::{Fit, FitJob, Learner, LearnerRl, Spec};
use opendr_engine::model::Model;
use opendr_engine::target::RlTarget;
use opendr_engine::{Device, Error, Result, Statistics};
use opendr_kernels::Compute;
use opendr_rl::numbers_from_observation;

use super::fit::{POLICY_FILE, fit_dataset, fit_teacher};
use super::method::ImitationMethod;
use crate::policy::{ChunkPolicy, ChunkState};

/// A policy of the method `M`: predicts an element of the action space from an observation and those before it.
pub struct ImitationLearner<M: ImitationMethod> {
    policy: ChunkPolicy<M>,
    params: M::Params,
    compute: Compute,
}

/// State of one stream: observations and predicted chunks of an episode.
pub struct ImitationState<M: ImitationMethod> {
    chunks: ChunkState<M>,
    numbers: Vec<f32>,
}

impl<M: ImitationMethod> Default for ImitationState<M> {
    fn default() -> Self {
        Self { chunks: ChunkState::default(), numbers: Vec::new() }
    }
}

impl<M: ImitationMethod> ImitationLearner<M> {
    /// Returns the policy.
    pub fn policy(&self) -> &ChunkPolicy<M> {
        &self.policy
    }
}

impl<M: ImitationMethod> Learner for ImitationLearner<M> {
    const SPEC: Spec = M::SPEC;
    type Params = M::Params;
    type Input<'a> = &'a Observation;
    type Target = RlTarget;
    type State = ImitationState<M>;

    fn load(model: &Model, params: M::Params, device: Device) -> Result<Self> {
        if !matches!(device, Device::Auto | Device::Cpu) {
            return Err(Error::device(format!(
                "policies of {} run on the CPU, not on {device}; set the device to \"cpu\" or \"auto\"",
                M::SPEC.class
            )));
        }
        let policy = ChunkPolicy::from_bytes(&model.file(POLICY_FILE)?)?;
        Ok(Self { policy, params, compute: Compute::single() })
    }

    fn params(&self) -> &M::Params {
        &self.params
    }

    fn params_mut(&mut self) -> &mut M::Params {
        &mut self.params
    }

    fn infer_into(
        &self,
        state: &mut ImitationState<M>,
        observation: &Observation,
        target: &mut RlTarget,
    ) -> Result<()> {
        numbers_from_observation(self.policy.observation(), observation, &mut state.numbers)?;
        target.values.resize(self.policy.action().len(), 0.0);
        let ImitationState { chunks, numbers } = state;
        self.policy.act(&self.compute, &self.params, chunks, numbers, &mut target.values)
    }
}

impl<M: ImitationMethod> LearnerRl for ImitationLearner<M> {
    type FitParams = M::FitParams;

    fn fit(
        base: Option<&Model>,
        params: &M::Params,
        fit_params: &M::FitParams,
        env: &dyn EnvironmentSource,
        val_env: Option<&dyn EnvironmentSource>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        fit_teacher::<M>(base, params, fit_params, [env, val_env.unwrap_or(env)], job)
    }
}

impl<M: ImitationMethod> Fit for ImitationLearner<M> {
    type FitParams = M::FitParams;

    fn fit(
        base: Option<&Model>,
        params: &M::Params,
        fit_params: &M::FitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        fit_dataset::<M>(base, params, fit_params, [Some(dataset), val_dataset], job)
    }
}
