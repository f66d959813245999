//! Training of every learner, shared by all surfaces.

mod check;
mod data;
mod fitted;
mod in_environment;
mod options;
mod run_folder;

use std::path::Path;
use std::time::Instant;

use opendr_datasets::Problems;
use opendr_engine::dataset::{DatasetIterator, DatasetRef, Subset};
use opendr_engine::learner::{AnyLearner, Capabilities, Entry, FitJob};
use opendr_engine::params::{ParamMap, ParamValue};
use opendr_engine::{Device, Error, Progress, Result, Statistics};
use opendr_evaluation::{DatasetOpener, Distillation, Samples, Teacher, annotation_type};
use opendr_inference as inference;

pub use check::check_fit;
pub use data::FitData;
pub use fitted::Fitted;
pub use in_environment::{FitEnvironments, fit_active, fit_policy};
pub use options::FitOptions;

use crate::{learner_with, registry};

/// Default score below which a teacher's predictions are dropped.
const TEACHER_THRESHOLD: f32 = 0.5;
/// Name of the score threshold among a learner's parameters.
const THRESHOLD: &str = "threshold";
/// Maximum number of streams of a teacher that run in parallel.
const MAX_STREAMS: usize = 4;

/// Trains a learner of `entry`, from its model if one is loaded, loads the result, and writes a report beside it.
///
/// When the user stops the training, the model is that of the steps so far, and [`Fitted::complete`] is false.
///
/// # Errors
/// `Unsupported` when the learner does not train; `InvalidParam` for a wrong parameter of the training; `InvalidInput` when
/// the data set does not match the task, or the output folder is not empty; `Io`.
pub fn fit(
    learner: &mut dyn AnyLearner,
    entry: &'static Entry,
    data: FitData<'_>,
    options: &FitOptions,
    progress: &dyn Progress,
) -> Result<Fitted> {
    let begun = Instant::now();
    match entry.capabilities {
        Capabilities { fit_in: true, fit: false, .. } => {
            let class = entry.spec.class;
            return Err(Error::unsupported(format!(
                "{class} trains in environments; give an environment instead of a data set"
            )));
        }
        Capabilities { fit_in: true, .. } => {
            return in_environment::fit_demonstrations(learner, entry, data, options, progress);
        }
        Capabilities { .. } => {}
    }
    check_fit(entry, &options.params)?;
    let output = options.output_folder(entry.spec.name)?;
    run_folder::check(&output, options.resume)?;
    let problems = options.problems();
    let preparation = Preparation { entry, options, output: &output, problems: &problems, progress };
    let external = options.val_dataset();
    let val = data.val_dataset.or(external.as_ref().map(DatasetRef::External));
    let val = preparation.val(val, data.dataset)?;
    let (dataset, samples) = preparation.samples(data.dataset, data.teacher, learner.device())?;
    let job = FitJob {
        output: &output,
        resume: options.resume,
        logging_path: options.logging_path.as_deref(),
        device: learner.device(),
        skip_broken: options.skip_broken,
        progress,
        group: data.group,
    };
    let statistics = match progress.stopped() {
        true => Statistics::default(),
        false => {
            let val = val.as_deref().map(DatasetRef::Iterator);
            learner.fit(&options.params, DatasetRef::Iterator(samples.as_ref()), val, &job)?
        }
    };
    let fitted = Fitted {
        learner: entry.spec.name.to_owned(),
        environment: None,
        dataset,
        samples: samples.len(),
        complete: !progress.stopped(),
        seconds: begun.elapsed().as_secs_f64(),
        statistics,
        model: Some(job.model()).filter(|model| model.exists()),
        logging_path: options.logging_path.clone(),
        skipped: problems.count(),
        problems: problems.list(),
        output,
    };
    fitted.finish(progress)
}

/// Checked options of a training.
struct Preparation<'a> {
    entry: &'static Entry,
    options: &'a FitOptions,
    output: &'a Path,
    problems: &'a Problems,
    progress: &'a dyn Progress,
}

impl Preparation<'_> {
    fn opening(&self, annotated: bool) -> DatasetOpener<'_> {
        DatasetOpener::new(self.entry, annotated, self.problems, self.progress)
    }

    /// Opens the validation samples: `val`, else the validation split of the training data, if one is named.
    fn val<'d>(&self, val: Option<DatasetRef<'d>>, dataset: DatasetRef<'d>) -> Result<Option<Samples<'d>>> {
        let split = self.options.val_split.as_deref();
        let val = val.or(split.is_some().then_some(dataset));
        val.map(|val| self.opening(true).open_validation(val, split)).transpose()
    }

    /// Returns the name of the data set and its samples, annotated by the teacher if there is one.
    fn samples<'d>(
        &self,
        dataset: DatasetRef<'d>,
        teacher: Option<Teacher>,
        device: Device,
    ) -> Result<(String, Samples<'d>)> {
        let teacher = match (teacher, &self.options.teacher) {
            (None, Some(name)) => {
                let load = |params: &ParamMap| learner_with(name, params, device, self.progress);
                Some(teacher_with(name, self.options.teacher_threshold, device, load)?)
            }
            (given, _) => given,
        };
        let name = self.options.dataset_name(dataset);
        let samples =
            self.opening(teacher.is_none()).open_training(dataset, self.options.split.as_deref())?;
        let limit = self.options.limit.unwrap_or(usize::MAX);
        let mut samples: Samples<'d> = Box::new(Subset::first(samples, limit));
        run_folder::make(self.output)?;
        self.progress.note(&format!("output: {}", self.output.display()));
        if let Some(teacher) = teacher {
            samples = Box::new(self.lesson(name.clone())?.label(teacher, samples)?);
        }
        if samples.is_empty() && !self.progress.stopped() {
            return Err(Error::invalid_input(format!(
                "there is nothing to train on in {name}: it has no samples"
            )));
        }
        Ok((name, samples))
    }

    fn lesson(&self, dataset: String) -> Result<Distillation<'_>> {
        Ok(Distillation {
            dataset,
            annotation_type: annotation_type(&self.entry.spec, self.entry.outputs)
                .ok_or_else(|| Error::internal("a learner without outputs"))?,
            threshold: self.options.teacher_threshold.unwrap_or(TEACHER_THRESHOLD),
            classes: self.options.teacher_classes.iter().cloned().collect(),
            class_matching: self.options.class_matching(),
            keep_empty: self.options.keep_empty,
            folder: self.output,
            problems: self.problems,
            progress: self.progress,
        })
    }
}

/// Creates a teacher from a loaded learner of `entry`; `name` is its name in the journal.
///
/// # Errors
/// `NotFound` when no model is loaded.
pub fn teacher(name: impl Into<String>, learner: &dyn AnyLearner, entry: &'static Entry) -> Result<Teacher> {
    Teacher::new(name, learner, entry, streams_at_once(learner.device())?)
}

/// Loads the learner that `spec` names as a teacher whose predictions count from the score `threshold` on (by default 0.5);
/// `load` loads it with the given parameters.
///
/// # Errors
/// `NotFound` for an unknown name; those of `load`.
pub fn teacher_with(
    spec: &str,
    threshold: Option<f32>,
    device: Device,
    load: impl FnOnce(&ParamMap) -> Result<Box<dyn AnyLearner>>,
) -> Result<Teacher> {
    let entry = registry().find(spec.split('/').next().unwrap_or(spec))?;
    let wanted = f64::from(threshold.unwrap_or(TEACHER_THRESHOLD));
    let own = entry.params.iter().find(|field| field.name == THRESHOLD);
    let own = own.and_then(|field| field.default.value().as_float()).filter(|own| *own > wanted);
    let params = own.map(|_| (THRESHOLD.to_owned(), ParamValue::Float(wanted))).into_iter().collect();
    // Several single-threaded streams are faster than one stream with several threads.
    let threads = (inference::default_threads()? / streams_at_once(device)?).max(1);
    teacher(spec, inference::with_threads(threads, || load(&params))?.as_ref(), entry)
}

fn streams_at_once(device: Device) -> Result<usize> {
    match inference::device(device)? {
        Device::Cpu => Ok(inference::default_threads()?.min(MAX_STREAMS)),
        _ => Ok(1),
    }
}
