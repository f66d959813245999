//! Learners that train by acting.

use crate::environment::Environment;
use crate::learner::{FitJob, Learner};
use crate::model::Model;
use crate::params::Params;
use crate::{Result, Statistics};

/// A policy: the input is an observation, the target an action, and training takes an environment (the paper's
/// `LearnerRL`).
pub trait LearnerRl: Learner {
    /// What a user may set of the training.
    type FitParams: Params;

    /// Trains in `env`, from `base` where one is given, and writes a container into [`FitJob::model`].
    ///
    /// # Errors
    /// `InvalidInput` when the spaces do not fit the policy.
    fn fit(
        base: Option<&Model>,
        params: &Self::Params,
        fit_params: &Self::FitParams,
        env: &mut dyn Environment,
        val_env: Option<&mut dyn Environment>,
        job: &FitJob<'_>,
    ) -> Result<Statistics>;

    /// Return, length and success over the episodes that start from `seeds`.
    ///
    /// # Errors
    /// As [`Learner::infer_into`].
    fn eval(&self, env: &mut dyn Environment, seeds: &[u64]) -> Result<Statistics>;
}
