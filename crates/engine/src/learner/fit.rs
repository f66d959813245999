//! Learners that train.

use std::path::{Path, PathBuf};

use crate::dataset::DatasetRef;
use crate::learner::{Handle, Learner};
use crate::model::Model;
use crate::params::Params;
use crate::{Device, Progress, Result, Silent, Statistics};

/// Where a training writes and to whom it reports.
#[derive(Clone, Copy)]
pub struct FitJob<'a> {
    /// The folder of the checkpoints and, in [`FitJob::model`], of the trained container.
    pub output: &'a Path,
    /// Whether to go on from the last checkpoint in `output`, where there is one.
    pub resume: bool,
    /// The folder of event files and curves; `None` writes none (the paper's `logging_path`).
    pub logging_path: Option<&'a Path>,
    /// Where to train.
    pub device: Device,
    /// Whether samples that cannot be read are left out and told of, instead of ending the training.
    pub skip_broken: bool,
    /// To whom to report; it also says when the user wants to stop.
    pub progress: &'a dyn Progress,
}

impl<'a> FitJob<'a> {
    /// A silent job on the best device that writes to `output`.
    pub fn new(output: &'a Path) -> Self {
        Self {
            output,
            resume: false,
            logging_path: None,
            device: Device::Auto,
            skip_broken: false,
            progress: &Silent,
        }
    }

    /// Where the trained container is written.
    pub fn model(&self) -> PathBuf {
        self.output.join("model")
    }
}

/// A learner that trains on a data set.
pub trait Fit: Learner {
    /// What a user may set of the training: rate, epochs, batch size.
    type FitParams: Params;

    /// Trains, from `base` where one is given, and writes the trained model as a container into [`FitJob::model`].
    ///
    /// # Errors
    /// `InvalidInput` when the data set does not fit the task; `Io` when nothing can be written.
    fn fit(
        base: Option<&Model>,
        params: &Self::Params,
        fit_params: &Self::FitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics>;
}

impl<L: Fit> Handle<L> {
    /// Trains, starting from the loaded model where there is one, and loads the result; when the user stopped it before
    /// there was one, the handle is as it was.
    ///
    /// # Errors
    /// As [`Fit::fit`].
    pub fn fit(
        &mut self,
        fit_params: &L::FitParams,
        dataset: DatasetRef<'_>,
        val_dataset: Option<DatasetRef<'_>>,
        job: &FitJob<'_>,
    ) -> Result<Statistics> {
        fit_params.check()?;
        let statistics = L::fit(self.model(), self.params(), fit_params, dataset, val_dataset, job)?;
        self.load_trained(job)?;
        Ok(statistics)
    }
}

impl<L: Learner> Handle<L> {
    /// Loads what a training wrote; a training that was stopped may have written nothing.
    pub(super) fn load_trained(&mut self, job: &FitJob<'_>) -> Result<()> {
        let model = job.model();
        if model.exists() || !job.progress.stopped() { self.load(model) } else { Ok(()) }
    }
}
