//! Learners for active perception.

use crate::dataset::DatasetRef;
use crate::environment::Environment;
use crate::learner::{FitJob, Learner};
use crate::model::Model;
use crate::params::Params;
use crate::{Result, Statistics};

/// A perception learner whose targets contain a camera motion ([`crate::target::Action`]). It trains on a data set and in
/// an environment together (the paper's `LearnerActive`).
pub trait LearnerActive: Learner {
    /// Parameters of the training.
    type FitParams: Params;

    /// Trains perception on `dataset` and motion in `env`, and writes a container to [`FitJob::model`].
    ///
    /// # Errors
    /// Returns `InvalidInput` if the data set or the environment does not fit the learner.
    fn fit(
        base: Option<&Model>,
        params: &Self::Params,
        fit_params: &Self::FitParams,
        dataset: DatasetRef<'_>,
        env: &mut dyn Environment,
        job: &FitJob<'_>,
    ) -> Result<Statistics>;

    /// Returns the metrics of the task, with and without motion.
    ///
    /// # Errors
    /// As [`Learner::infer_into`].
    fn eval(&self, dataset: DatasetRef<'_>, env: &mut dyn Environment) -> Result<Statistics>;
}
