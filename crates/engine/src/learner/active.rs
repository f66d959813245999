//! Learners that say how to move to see better.

use crate::dataset::DatasetRef;
use crate::environment::Environment;
use crate::learner::{FitJob, Learner};
use crate::model::Model;
use crate::params::Params;
use crate::{Result, Statistics};

/// A perception learner whose targets carry an [`crate::target::Action`], trained on a data set and in an environment
/// at once (the paper's `LearnerActive`).
pub trait LearnerActive: Learner {
    /// What a user may set of the training.
    type FitParams: Params;

    /// Trains perception on `dataset` and movement in `env`, and writes a container into [`FitJob::model`].
    ///
    /// # Errors
    /// `InvalidInput` when data set or environment do not fit.
    fn fit(
        base: Option<&Model>,
        params: &Self::Params,
        fit_params: &Self::FitParams,
        dataset: DatasetRef<'_>,
        env: &mut dyn Environment,
        job: &FitJob<'_>,
    ) -> Result<Statistics>;

    /// The task's metrics with and without movement.
    ///
    /// # Errors
    /// As [`Learner::infer_into`].
    fn eval(&self, dataset: DatasetRef<'_>, env: &mut dyn Environment) -> Result<Statistics>;
}
