//! The samples of a training, opened as the learner needs them.

use opendr_datasets::{FormatEntry, OpenOptions, Pictures, Problems, format_of};
use opendr_engine::dataset::{DatasetIterator, DatasetRef, ExternalDataset, Subset};
use opendr_engine::learner::Entry;
use opendr_engine::{Error, ErrorKind, Progress, Result, ValueType};
use opendr_evaluation::metric_of;

/// What the data sets of the field call the part to train on.
const TRAINING_PARTS: [&str; 4] = ["train", "training", "trainval", "train2017"];

/// Samples of any kind.
pub type Samples<'a> = Box<dyn DatasetIterator + 'a>;

/// What a learner learns from: the annotations that its task's metric compares with.
pub fn wanted(entry: &Entry) -> Option<ValueType> {
    let metric = metric_of(entry.spec.task).and_then(opendr_metrics::find).ok();
    metric.map(|metric| metric.truth).or_else(|| entry.outputs.first().map(|output| output.value_type))
}

/// What to open of a data set on disk.
pub struct Opening<'a> {
    /// The learner that is to learn from it.
    pub entry: &'a Entry,
    /// Whether annotations are needed, or pictures will do.
    pub annotated: bool,
    /// What is done with what is broken.
    pub problems: &'a Problems,
    /// To whom to tell which part is taken.
    pub progress: &'a dyn Progress,
}

impl Opening<'_> {
    /// The samples to train on: those of the part `split` or, without one, of the part for training.
    ///
    /// # Errors
    /// As [`opendr_datasets::open`]; `InvalidInput` when there are no annotations of the type that the learner needs.
    pub fn to_train<'d>(&self, dataset: DatasetRef<'d>, split: Option<&str>) -> Result<Samples<'d>> {
        let external = match dataset {
            DatasetRef::Iterator(samples) => return Ok(Box::new(samples)),
            DatasetRef::External(external) => external,
        };
        let format = match format_of(external) {
            Ok(format) => format,
            // Whoever asks a teacher needs no annotations.
            Err(_) if !self.annotated && Pictures::are_in(external.path()) => {
                return Ok(Box::new(Pictures::open(external.path())?));
            }
            Err(error) => return Err(error),
        };
        if split.is_some() {
            return self.open(external, format, split);
        }
        for part in TRAINING_PARTS {
            match self.open(external, format, Some(part)) {
                // There is no such part.
                Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::InvalidParam) => {}
                Ok(samples) => {
                    let path = external.path().display();
                    self.progress.note(&format!("training on the part {part:?} of {path}"));
                    return Ok(samples);
                }
                Err(error) => return Err(error),
            }
        }
        self.open(external, format, None)
    }

    /// The samples to measure on.
    ///
    /// # Errors
    /// As [`Opening::to_train`].
    pub fn to_measure<'d>(&self, dataset: DatasetRef<'d>, split: Option<&str>) -> Result<Samples<'d>> {
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
        let wanted = wanted(self.entry).filter(|_| self.annotated);
        if let Some(wanted) = wanted.filter(|wanted| !format.targets.contains(wanted)) {
            let has: Vec<_> = format.targets.iter().map(|target| target.name()).collect();
            return Err(Error::invalid_input(format!(
                "{} learns from {}, but a data set of format {} has {}; name another format, or a teacher",
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

/// The first so many samples.
pub fn limited<'a>(samples: Samples<'a>, limit: Option<usize>) -> Samples<'a> {
    match limit {
        Some(limit) => Box::new(Subset::first(samples, limit)),
        None => samples,
    }
}
