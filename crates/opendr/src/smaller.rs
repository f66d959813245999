//! Quantisation and FP16 conversion of a loaded learner.

use std::fs;
use std::path::Path;

use opendr_datasets::Problems;
use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{AnyLearner, Entry};
use opendr_engine::params::{ParamMap, Params};
use opendr_engine::{Progress, Result, ResultExt};
use opendr_evaluation::DatasetOpener;
use opendr_optimize::{OptimizeJob, OptimizeOptions, Report};

/// Name of the temporary copy of the original model.
const ORIGINAL: &str = "original";

/// Quantises the model of a loaded learner to INT8 or converts it to FP16, writes it to `output`, and loads it. `calibration`
/// is the data for the ranges of activations; on `validation` the model is evaluated before and after.
///
/// # Errors
/// `NotFound` when no model is loaded; `InvalidParam` for wrong options; as [`OptimizeJob::run`].
pub fn optimize_loaded(
    learner: &mut dyn AnyLearner,
    entry: &Entry,
    [calibration, validation]: [Option<DatasetRef<'_>>; 2],
    options: &ParamMap,
    output: &Path,
    progress: &dyn Progress,
) -> Result<Report> {
    let options = OptimizeOptions::from_map(options)?;
    let problems = Problems::strict();
    let opening = |annotated| DatasetOpener::new(entry, annotated, &problems, progress);
    let calibration = calibration.map(|dataset| opening(false).open_training(dataset, None)).transpose()?;
    let validation = validation.map(|dataset| opening(true).open_validation(dataset, None)).transpose()?;
    let mut original = output.as_os_str().to_owned();
    original.push(format!(".{}.{ORIGINAL}", std::process::id()));
    learner.save(original.as_ref())?;
    let job = OptimizeJob {
        entry,
        model: original.as_ref(),
        options: &options,
        calibration: calibration.as_deref().map(|samples| samples as &dyn DatasetIterator),
        validation: validation.as_deref().map(|samples| samples as &dyn DatasetIterator),
        output,
        device: learner.device(),
        progress,
    };
    let done = job.run();
    fs::remove_dir_all(&original).context(|| format!("removing {}", Path::new(&original).display()))?;
    let report = done?;
    learner.load(output)?;
    Ok(report)
}
