//! Opening of training, calibration and validation samples.

use opendr_datasets::{OpenOptions, Problems, UnlabelledImages, format_of, open, open_for};
use opendr_engine::dataset::{DatasetIterator, DatasetRef, ExternalDataset};
use opendr_engine::learner::{Entry, Output, Spec};
use opendr_engine::{ErrorKind, Progress, Result, ValueType};

use crate::metric_of;

/// Usual names of training splits.
const TRAINING_SPLITS: [&str; 4] = ["train", "training", "trainval", "train2017"];

/// A boxed data set.
pub type Samples<'a> = Box<dyn DatasetIterator + 'a>;

/// Returns the type of annotation on which a learner trains: the one that its task's metric compares with, else its target type.
pub fn annotation_type(spec: &Spec, outputs: &[Output]) -> Option<ValueType> {
    let metric = metric_of(spec.task).and_then(opendr_metrics::find).ok();
    metric.map(|metric| metric.ground_truth).or_else(|| outputs.first().map(|output| output.value_type))
}

/// Opens data sets for a learner.
pub struct DatasetOpener<'a> {
    /// Name of the learner in errors.
    pub learner: &'a str,
    /// Types of annotation that it accepts; empty where a folder of images without annotations is enough.
    pub accepted: Vec<ValueType>,
    /// Handling of broken samples.
    pub problems: &'a Problems,
    /// Progress display, which gets a note of the chosen split.
    pub progress: &'a dyn Progress,
}

impl<'a> DatasetOpener<'a> {
    /// Creates an opener for the learner of `entry`, with or without annotations.
    pub fn new(entry: &Entry, annotated: bool, problems: &'a Problems, progress: &'a dyn Progress) -> Self {
        let accepted = annotation_type(&entry.spec, entry.outputs).filter(|_| annotated);
        Self { learner: entry.spec.class, accepted: accepted.into_iter().collect(), problems, progress }
    }

    /// Opens the training samples: those of `split` or, without one, of the training split.
    ///
    /// # Errors
    /// As [`open_for`].
    pub fn open_training<'d>(&self, dataset: DatasetRef<'d>, split: Option<&str>) -> Result<Samples<'d>> {
        let external = match dataset {
            DatasetRef::Iterator(samples) => return Ok(Box::new(samples)),
            DatasetRef::External(external) => external,
        };
        let is_annotated = !self.accepted.is_empty();
        if !is_annotated && format_of(external).is_err() && UnlabelledImages::are_in(external.path()) {
            return Ok(Box::new(UnlabelledImages::open(external.path())?));
        }
        let external = ExternalDataset::new(external.path(), format_of(external)?.name);
        if split.is_some() {
            return self.open(&external, split);
        }
        for part in TRAINING_SPLITS {
            match self.open(&external, Some(part)) {
                // There is no such split.
                Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::InvalidParam) => {}
                Ok(samples) => {
                    let path = external.path().display();
                    self.progress.note(&format!("training on the split {part:?} of {path}"));
                    return Ok(samples);
                }
                Err(error) => return Err(error),
            }
        }
        self.open(&external, None)
    }

    /// Opens the validation samples.
    ///
    /// # Errors
    /// As [`open_for`].
    pub fn open_validation<'d>(&self, dataset: DatasetRef<'d>, split: Option<&str>) -> Result<Samples<'d>> {
        match dataset {
            DatasetRef::Iterator(samples) => Ok(Box::new(samples)),
            DatasetRef::External(external) => self.open(external, split),
        }
    }

    fn open<'d>(&self, external: &ExternalDataset, split: Option<&str>) -> Result<Samples<'d>> {
        let split = split.map(str::to_owned);
        match self.accepted.is_empty() {
            true => open(external, &OpenOptions { split, target: None }, self.problems),
            false => open_for(
                &format!("{} trains on", self.learner),
                &self.accepted,
                external,
                split,
                self.problems,
            ),
        }
    }
}
