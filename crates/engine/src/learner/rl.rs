//! Learners that train by acting.

use crate::data::Observation;
use crate::environment::EnvironmentSource;
use crate::learner::{FitJob, Handle, Learner};
use crate::model::Model;
use crate::params::Params;
use crate::target::RlTarget;
use crate::{Result, Statistics};

/// A policy: the input is an observation, the target an element of the action space, and training takes environments
/// (the paper's `LearnerRL`).
pub trait LearnerRl: for<'a> Learner<Input<'a> = &'a Observation, Target = RlTarget> {
    /// What a user may set of the training.
    type FitParams: Params;

    /// Trains in environments that `env` makes, from `base` where one is given, and writes a container into
    /// [`FitJob::model`]; `val_env` makes those in which it is measured on the way, else `env` does.
    ///
    /// # Errors
    /// `InvalidInput` when the spaces do not fit the policy, and those of the environment with the step at which they
    /// came; what was learnt up to the last checkpoint is then kept.
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
    /// Trains in environments, starting from the loaded model where there is one, and loads the result; when the user
    /// stopped it before there was one, the handle is as it was.
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
