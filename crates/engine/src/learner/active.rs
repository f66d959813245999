//! Learners for active perception.

use crate::dataset::DatasetRef;
use crate::environment::EnvironmentSource;
use crate::learner::{FitJob, Handle, Learner};
use crate::model::Model;
use crate::params::Params;
use crate::{Result, Statistics};

/// A perception learner whose targets contain a camera motion ([`crate::target::Action`]). It trains on a data set and in
/// environments together (the paper's `LearnerActive`).
pub trait LearnerActive: Learner {
    /// Parameters of the training.
    type FitParams: Params;

    /// Trains perception on `dataset`, or without it on views that the environments provide, then the motion in environments
    /// from `env`, starting from `base` if it is given. Writes a container to [`FitJob::model`].
    ///
    /// # Errors
    /// Returns `InvalidInput` if the data set or the environment does not fit the learner.
    fn fit(
        base: Option<&Model>,
        params: &Self::Params,
        fit_params: &Self::FitParams,
        dataset: Option<DatasetRef<'_>>,
        env: &dyn EnvironmentSource,
        job: &FitJob<'_>,
    ) -> Result<Statistics>;
}

impl<L: LearnerActive> Handle<L> {
    /// Trains perception and motion, starting from the loaded model if there is one, and loads the trained model. A training
    /// that the user stops before it wrote a model leaves the handle unchanged.
    ///
    /// # Errors
    /// As [`LearnerActive::fit`].
    pub fn fit_active(
        &mut self,
        fit_params: &L::FitParams,
        dataset: Option<DatasetRef<'_>>,
        env: &dyn EnvironmentSource,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        fit_params.check()?;
        let statistics = L::fit(self.model(), self.params(), fit_params, dataset, env, job)?;
        self.load_trained(job)?;
        Ok(statistics)
    }
}
