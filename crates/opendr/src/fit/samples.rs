//! Opening of training and validation samples.

use opendr_datasets::{FormatEntry, OpenOptions, Problems, UnlabelledImages, format_of};
use opendr_engine::dataset::{DatasetIterator, DatasetRef, ExternalDataset, Subset};
use opendr_engine::learner::Entry;
use opendr_engine::{Error, ErrorKind, Progress, Result, ValueType};
use opendr_evaluation::metric_of;

/// Usual names of training splits.
const TRAINING_SPLITS: [&str; 4] = ["train", "training", "trainval", "train2017"];

/// A boxed data set.
pub type Samples<'a> = Box<dyn DatasetIterator + 'a>;

/// Returns the type of annotation on which a learner trains: the one that its task's metric compares with.
pub fn annotation_type(entry: &Entry) -> Option<ValueType> {
    let metric = metric_of(entry.spec.task).and_then(opendr_metrics::find).ok();
    metric.map(|metric| metric.ground_truth).or_else(|| entry.outputs.first().map(|output| output.value_type))
}

/// Opens data sets for a learner.
pub struct DatasetOpener<'a> {
    /// Learner of the training.
    pub entry: &'a Entry,
    /// Whether annotations are needed; else a folder of images is enough.
    pub annotated: bool,
    /// Handling of broken samples.
    pub problems: &'a Problems,
    /// Progress display, which gets a note of the chosen split.
    pub progress: &'a dyn Progress,
}

impl DatasetOpener<'_> {
    /// Opens the training samples: those of `split` or, without one, of the training split.
    ///
    /// # Errors
    /// As [`opendr_datasets::open`]; `InvalidInput` without annotations of the type that the learner needs.
    pub fn open_training<'d>(&self, dataset: DatasetRef<'d>, split: Option<&str>) -> Result<Samples<'d>> {
        let external = match dataset {
            DatasetRef::Iterator(samples) => return Ok(Box::new(samples)),
            DatasetRef::External(external) => external,
        };
        let format = match format_of(external) {
            Ok(format) => format,
            // Samples for a teacher need no annotations.
            Err(_) if !self.annotated && UnlabelledImages::are_in(external.path()) => {
                return Ok(Box::new(UnlabelledImages::open(external.path())?));
            }
            Err(error) => return Err(error),
        };
        if split.is_some() {
            return self.open(external, format, split);
        }
        for part in TRAINING_SPLITS {
            match self.open(external, format, Some(part)) {
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
        self.open(external, format, None)
    }

    /// Opens the validation samples.
    ///
    /// # Errors
    /// As [`DatasetOpener::open_training`].
    pub fn open_validation<'d>(&self, dataset: DatasetRef<'d>, split: Option<&str>) -> Result<Samples<'d>> {
        match dataset {
            DatasetRef::Iterator(samples) => Ok(Box::new(samples)),
            DatasetRef::External(external) => self.open(external, format_of(external)?, split),
        }
    }

    fn open<'d>(
        &self,
        external: &ExternalDataset,
        format: &FormatEntry,
        split: Option<&str>,
    ) -> Result<Samples<'d>> {
        let wanted = annotation_type(self.entry).filter(|_| self.annotated);
        if let Some(wanted) = wanted.filter(|wanted| !format.targets.contains(wanted)) {
            let has: Vec<_> = format.targets.iter().map(|target| target.name()).collect();
            return Err(Error::invalid_input(format!(
                "{} trains on {}, but a data set of format {} has {}; name another format, or a teacher",
                self.entry.spec.class,
                wanted.name(),
                format.name,
                has.join(" or ")
            )));
        }
        let options = OpenOptions { split: split.map(str::to_owned), target: wanted };
        (format.open)(external.path(), &options, self.problems)
    }
}

/// Returns at most the first `limit` samples.
pub fn limited<'a>(samples: Samples<'a>, limit: Option<usize>) -> Samples<'a> {
    match limit {
        Some(limit) => Box::new(Subset::first(samples, limit)),
        None => samples,
    }
}
