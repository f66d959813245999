//! Training of learners on data sets.

use std::path::{Path, PathBuf};

use crate::dataset::DatasetRef;
use crate::learner::{Handle, Learner, TrainingGroup};
use crate::model::Model;
use crate::params::Params;
use crate::{Device, Error, Progress, Result, Silent, Statistics};

/// Output folder, device and progress of a training.
#[derive(Clone, Copy)]
pub struct FitJob<'a> {
    /// Folder of the checkpoints and, in [`FitJob::model`], of the trained container.
    pub output: &'a Path,
    /// Whether to resume from the last checkpoint in `output`, if there is one.
    pub resume: bool,
    /// Folder of event files and curves; `None` writes none (the paper's `logging_path`).
    pub logging_path: Option<&'a Path>,
    /// Device of the training.
    pub device: Device,
    /// Whether unreadable samples are skipped with a note; otherwise they end the training.
    pub skip_broken: bool,
    /// Receiver of the progress; it also reports whether the user stops the training.
    pub progress: &'a dyn Progress,
    /// The processes that train together with this one; `None` for a training by itself.
    pub group: Option<&'a dyn TrainingGroup>,
}

impl<'a> FitJob<'a> {
    /// Creates a job without progress, on the best device, that writes to `output`.
    pub fn new(output: &'a Path) -> Self {
        Self {
            output,
            resume: false,
            logging_path: None,
            device: Device::Auto,
            skip_broken: false,
            progress: &Silent,
            group: None,
        }
    }

    /// Checks that the job is a training by itself.
    ///
    /// # Errors
    /// `Unsupported` for a job of a group.
    pub fn check_single(&self, learner: &str) -> Result<()> {
        match self.group {
            None => Ok(()),
            Some(_) => {
                Err(Error::unsupported(format!("{learner} trains in one process, not in a group of several")))
            }
        }
    }

    /// Returns the path of the trained container.
    pub fn model(&self) -> PathBuf {
        self.output.join("model")
    }
}

/// A learner that trains on a data set.
pub trait Fit: Learner {
    /// Parameters of the training: learning rate, epochs, batch size.
    type FitParams: Params;

    /// Trains, from `base` if it is given, and writes the trained model as a container to [`FitJob::model`].
    ///
    /// # Errors
    /// Returns `InvalidInput` if the data set does not fit the task, `Io` if writing fails.
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
    /// Trains the learner, starting from the loaded model if there is one, and loads the trained model. A training that the user stops
    /// before it wrote a model leaves the handle unchanged.
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
    /// Loads the model of a training; a stopped training may have written none.
    pub(super) fn load_trained(&mut self, job: &FitJob<'_>) -> Result<()> {
        let model = job.model();
        if model.exists() || !job.progress.stopped() { self.load(model) } else { Ok(()) }
    }
}
