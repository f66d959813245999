//! Data of a search.

use opendr_engine::dataset::DatasetRef;
use opendr_engine::environment::EnvironmentSource;
use opendr_engine::learner::AnyLearner;
use opendr_engine::params::ParamMap;
use opendr_engine::{Error, Result};
use opendr_evaluation::EvalOptions;
use opendr_rl::EvaluationProtocol;

/// Data on which configurations are trained and evaluated.
#[derive(Clone, Copy)]
pub enum TuneData<'a> {
    /// Policies in environments, evaluated by the success rate if there is one, else by the mean return.
    Environment {
        /// Source of the environments.
        env: &'a dyn EnvironmentSource,
        /// Episodes of the evaluation.
        protocol: &'a EvaluationProtocol,
    },
    /// Learners of a data set, evaluated by the main value of their task's metric on another split.
    Dataset {
        /// To train on.
        dataset: DatasetRef<'a>,
        /// To measure on.
        val_dataset: DatasetRef<'a>,
        /// The part to train on.
        split: Option<&'a str>,
        /// The part to measure on.
        val_split: Option<&'a str>,
    },
    /// Learners without training: their own parameters, evaluated on a data set.
    Inference {
        /// Loads a learner with the given parameters.
        make: &'a MakeLearner<'a>,
        /// To measure on.
        dataset: DatasetRef<'a>,
        /// The part to measure on.
        split: Option<&'a str>,
        /// Metric (default: that of the task).
        metric: Option<&'a str>,
    },
}

/// Loads a learner with the parameters of a trial and the fixed ones.
pub type MakeLearner<'a> = dyn Fn(&ParamMap) -> Result<Box<dyn AnyLearner>> + Sync + 'a;

impl TuneData<'_> {
    /// Returns the evaluation options of a trial on a data set.
    pub(super) fn eval_options(&self) -> EvalOptions {
        let (split, metric) = match *self {
            Self::Environment { .. } => (None, None),
            Self::Dataset { val_split, .. } => (val_split, None),
            Self::Inference { split, metric, .. } => (split, metric),
        };
        let [split, metric] = [split, metric].map(|name| name.map(str::to_owned));
        EvalOptions { split, metric, resamples: Some(0), ..EvalOptions::default() }
    }
}

/// Returns the error of data without a value of the metric.
pub(super) fn nothing_measured(name: &str) -> Error {
    Error::invalid_input(format!("there is no value of {name} on these data; check that they are annotated"))
}
