//! Reinforcement learners.

use crate::data::Observation;
use crate::environment::EnvironmentSource;
use crate::learner::{FitJob, Handle, Learner};
use crate::model::Model;
use crate::params::Params;
use crate::target::RlTarget;
use crate::{Result, Statistics};

/// A policy: the input is an observation, the target an element of the action space. It trains in environments (the
/// paper's `LearnerRL`).
pub trait LearnerRl: for<'a> Learner<Input<'a> = &'a Observation, Target = RlTarget> {
    /// Parameters of the training.
    type FitParams: Params;

    /// Trains in environments from `env`, starting from `base` if it is given, and writes a container to [`FitJob::model`].
    /// Evaluations during the training use environments from `val_env` if it is given, otherwise from `env`.
    ///
    /// # Errors
    /// Returns `InvalidInput` if the spaces do not fit the policy, and errors of the environment with the step at which they
    /// occurred; the last checkpoint is then kept.
    fn fit(
        base: Option<&Model>,
        params: &Self::Params,
        fit_params: &Self::FitParams,
        env: &dyn EnvironmentSource,
        val_env: Option<&dyn EnvironmentSource>,
        job: &FitJob<'_>,
    ) -> Result<Statistics>;
}

impl<L: LearnerRl> Handle<L> {
    /// Trains in environments, starting from the loaded model if there is one, and loads the trained model. A training that
    /// the user stops before it wrote a model leaves the handle unchanged.
    ///
    /// # Errors
    /// As [`LearnerRl::fit`].
    pub fn fit_in(
        &mut self,
        fit_params: &L::FitParams,
        env: &dyn EnvironmentSource,
        val_env: Option<&dyn EnvironmentSource>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        fit_params.check()?;
        let statistics = L::fit(self.model(), self.params(), fit_params, env, val_env, job)?;
        self.load_trained(job)?;
        Ok(statistics)
    }
}
