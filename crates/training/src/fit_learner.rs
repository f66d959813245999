//! `fit` of a learner: data sets by their format, validation by the task's metric.

use std::path::Path;

use opendr_datasets::{OpenOptions, Problems, picture_with_target};
use opendr_engine::data::Image;
use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{AnyLearner, Entry, FitJob, Learner, Ports, Probe, Targets};
use opendr_engine::params::Params;
use opendr_engine::{Device, Error, Result, Statistics};
use opendr_evaluation::{Evaluation, Subject, metric_of, open_for};
use opendr_metrics::{MetricEntry, find};
use opendr_vision::draw;

use crate::training::Score;
use crate::{Objective, TrainingParams, fit_network};

/// The data set to train a learner on, with targets of the type that it answers.
///
/// # Errors
/// `InvalidInput` when the format has none such, else what kept it from being read.
pub fn open_for_training<'a, L: Learner>(
    dataset: DatasetRef<'a>,
    job: &FitJob<'_>,
) -> Result<Box<dyn DatasetIterator + 'a>> {
    match dataset {
        DatasetRef::Iterator(dataset) => Ok(Box::new(dataset)),
        DatasetRef::External(external) => {
            let target = L::Target::OUTPUTS.first().map(|output| output.value_type);
            let problems = if job.skip_broken { Problems::skipping() } else { Problems::strict() };
            opendr_datasets::open(external, &OpenOptions { split: None, target }, &problems)
        }
    }
}

/// Trains the network of a learner on `dataset` and, where there are validation data, keeps the one that does best on
/// them by its task's metric, measured through the learner itself.
///
/// # Errors
/// As [`fit_network`] and the learner's evaluation.
pub fn fit_learner<L: Learner, O: Objective>(
    objective: &O,
    network: O::Network,
    learner_params: &L::Params,
    params: &TrainingParams,
    dataset: &dyn DatasetIterator,
    val_dataset: Option<DatasetRef<'_>>,
    job: &FitJob<'_>,
) -> Result<Statistics> {
    let Some(val_dataset) = val_dataset else {
        return fit_network(objective, network, params, dataset, None, job);
    };
    let metric = find(metric_of(L::SPEC.task)?)?;
    let problems = Problems::strict();
    let val_dataset = match val_dataset {
        DatasetRef::Iterator(dataset) => Box::new(dataset),
        DatasetRef::External(external) => open_for(metric, external, None, &problems)?,
    };
    let entry = Entry::of::<L>(Probe::<L>::abilities(None, None, None));
    let mut validate = |container: &Path| -> Result<Score> {
        let learner = entry.make(&learner_params.to_map(), Device::Auto)?;
        score(learner, &entry, metric, &*val_dataset, container, &problems, job)
    };
    fit_network(objective, network, params, dataset, Some(&mut validate), job)
}

/// Measures a container through the learner; the metric's headline counts.
fn score(
    mut learner: Box<dyn AnyLearner>,
    entry: &Entry,
    metric: &'static MetricEntry,
    dataset: &dyn DatasetIterator,
    container: &Path,
    problems: &Problems,
    job: &FitJob<'_>,
) -> Result<Score> {
    learner.load(container)?;
    let picture = answers(&mut *learner, entry, dataset);
    let subject = Subject { learner: entry.spec.name.to_owned(), model: None, params: learner.params() };
    let evaluation = Evaluation { progress: job.progress, ..Evaluation::new(subject, metric, problems) };
    let outcome = evaluation.run(std::slice::from_mut(&mut learner), entry, dataset)?;
    let name = outcome.report.headline;
    let numbers = outcome.report.statistics.scalars;
    let value = numbers.get(&name).copied().ok_or_else(|| {
        Error::invalid_input(format!(
            "{} has no {name} on the validation data: is anything annotated?",
            metric.name
        ))
    })?;
    let is_error = metric.is_error(&name);
    Ok(Score { name, value, is_error, numbers, picture })
}

/// How many answers the log shows.
const SHOWN: usize = 6;
/// Side of a picture in the log, pixels.
const SIDE: usize = 300;

/// The first samples with what the learner answers, where they can be looked at. A sample that fails is the evaluation's
/// to tell.
fn answers(learner: &mut dyn AnyLearner, entry: &Entry, dataset: &dyn DatasetIterator) -> Option<Image> {
    let mut pictures = Vec::new();
    for index in 0..dataset.len().min(SHOWN) {
        learner.reset();
        let Ok(mut sample) = dataset.get(index) else { continue };
        let Ok(outputs) = learner.infer(&Ports::of_sample(entry.ports, &sample.data)) else { continue };
        sample.target = outputs.iter().next().map(|(_, value)| value.clone());
        pictures.extend(picture_with_target(&sample).map(|picture| (picture, dataset.name(index))));
    }
    learner.reset();
    (!pictures.is_empty()).then(|| draw::contact_sheet(&pictures, pictures.len().min(3), SIDE).ok())?
}
