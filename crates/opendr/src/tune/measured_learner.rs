//! Evaluation of a learner without training as a trial of a tuner.

use std::path::Path;

use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::Entry;
use opendr_engine::params::ParamMap;
use opendr_engine::{Error, Progress, Result};
use opendr_evaluation::EvalOptions;
use opendr_tuning::Training;

use super::MakeLearner;
use super::data::nothing_measured;
use super::until::Until;

/// One configuration of a learner's own parameters, without training and therefore without a checkpoint.
pub(super) struct MeasuredLearner<'a> {
    pub entry: &'static Entry,
    pub make: &'a MakeLearner<'a>,
    pub params: ParamMap,
    pub dataset: DatasetRef<'a>,
    pub options: EvalOptions,
    pub progress: &'a dyn Progress,
}

impl Training for MeasuredLearner<'_> {
    fn advance(&mut self, _: u64) -> Result<Option<f64>> {
        let mut learner = (self.make)(&self.params)?;
        // The progress bar of an evaluation would replace that of the search.
        let quiet = Until::new(self.progress, u64::MAX);
        let outcome = self.options.run(&mut learner, self.entry, self.dataset, &quiet)?;
        if !outcome.complete {
            return Ok(None);
        }
        let (name, _) = self.options.metric_for(self.entry)?.numbers[0];
        let value = outcome.report.statistics.get(name);
        value.map(Some).ok_or_else(|| nothing_measured(name))
    }

    fn save(&self, _: &Path) -> Result<()> {
        Ok(())
    }

    fn load(&mut self, _: &Path) -> Result<()> {
        Err(Error::internal("an evaluation has no checkpoint to resume from"))
    }
}
