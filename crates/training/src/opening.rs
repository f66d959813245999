//! Opening of the data sets of a training.

use opendr_datasets::Problems;
use opendr_engine::dataset::DatasetRef;
use opendr_engine::learner::{FitJob, Learner, Targets as _};
use opendr_engine::{Result, ValueType};
use opendr_evaluation::{DatasetOpener, Samples, annotation_type};

/// Opens the training data set of a learner: the training split, with the annotations of the metric of its task.
///
/// # Errors
/// As [`DatasetOpener::open_training`].
pub fn open_for_training<'a, L: Learner>(dataset: DatasetRef<'a>, job: &FitJob<'_>) -> Result<Samples<'a>> {
    let accepted = annotation_type(&L::SPEC, L::Target::OUTPUTS).into_iter().collect();
    let problems = Problems::new(job.skip_broken);
    opener::<L>(accepted, &problems, job).open_training(dataset, None)
}

/// As [`open_for_training`], for a learner that also trains on other annotations: the first type of the format that is
/// `accepted`.
///
/// # Errors
/// As [`DatasetOpener::open_training`].
pub fn open_accepted<'a, L: Learner>(
    accepted: &[ValueType],
    dataset: DatasetRef<'a>,
    job: &FitJob<'_>,
) -> Result<Samples<'a>> {
    let problems = Problems::new(job.skip_broken);
    opener::<L>(accepted.to_vec(), &problems, job).open_training(dataset, None)
}

/// Opens the validation data set of a learner, for one that validates on the loss.
///
/// # Errors
/// As [`DatasetOpener::open_validation`].
pub fn open_for_validation<'a, L: Learner>(dataset: DatasetRef<'a>, job: &FitJob<'_>) -> Result<Samples<'a>> {
    let accepted = annotation_type(&L::SPEC, L::Target::OUTPUTS).into_iter().collect();
    let problems = Problems::new(job.skip_broken);
    opener::<L>(accepted, &problems, job).open_validation(dataset, None)
}

fn opener<'a, L: Learner>(
    accepted: Vec<ValueType>,
    problems: &'a Problems,
    job: &'a FitJob<'_>,
) -> DatasetOpener<'a> {
    DatasetOpener { learner: L::SPEC.class, accepted, problems, progress: job.progress }
}
